//! An answer as a row of units: people, words that the grammar knows, and others.

use super::vocabulary::{BEHIND_CONTRACTED_IS, NOT_POSSESSIONS, mark};
use crate::language::contractions::{Token, longest, tokens};
use crate::language::parties::{Finder, Party, Speech};
use crate::language::people::People;
use crate::language::vocabulary::{KIN_ADJECTIVES, lists};
use crate::language::words::{Gap, Word, Words};
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// The relation that a preposition makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    To,
    By,
    From,
    With,
    Of,
    For,
    Elsewhere,
}

/// What a verb says of ownership.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verb {
    Own,
    Use,
    Share,
    Lend,
    Borrow,
    /// A thing left behind belongs to who left it, if that is a visitor.
    Leave,
    Other,
}

/// What a word or phrase does in an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Yes,
    No,
    Doubt,
    /// Takes back what was said before.
    Correction,
    /// A correction at the beginning of a clause, else nothing.
    Actually,
    Not,
    Only,
    /// "is the only one who"
    OnlyOne,
    And,
    Or,
    Except,
    Also,
    Now,
    But,
    /// Begins another clause.
    Break,
    Be,
    Was,
    Auxiliary,
    It,
    Place(Place),
    Verb(Verb),
    /// Behind a possessor: something that is no possession.
    NoPossession,
    Filler,
    Address,
}

/// One step of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Party { party: Party, possessive: bool },
    Mark(Mark),
    Word { capital: bool },
}

/// A step and what separates it from the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Unit {
    pub(super) kind: Kind,
    pub(super) gap: Gap,
}

impl Unit {
    pub(super) fn is(&self, mark: Mark) -> bool {
        self.kind == Kind::Mark(mark)
    }

    pub(super) fn party(&self) -> Option<(Party, bool)> {
        match self.kind {
            Kind::Party { party, possessive } => Some((party, possessive)),
            _ => None,
        }
    }

    pub(super) fn is_verb(&self) -> bool {
        matches!(self.kind, Kind::Mark(Mark::Verb(_) | Mark::Be | Mark::Was | Mark::Auxiliary))
    }
}

/// The units of a text and what stands behind the last one.
#[derive(Debug, Clone)]
pub(super) struct Units {
    pub(super) row: Vec<Unit>,
    pub(super) end: Gap,
    /// Whether the text asks who, whose or which.
    pub(super) asks_openly: bool,
}

/// The longest phrase of the vocabulary, in words.
const LONGEST_PHRASE: usize = 6;

pub(super) fn units(people: &People, text: &str, speech: Speech) -> Units {
    let words: Vec<Word> = Words::new(text).collect();
    let tokens = tokens(text, &words);
    let asks_openly = matches!(speech, Speech::Question { .. })
        && tokens
            .iter()
            .any(|token| matches!(token.text.as_str(), "who" | "whose" | "whom" | "which" | "what"));
    let finder = Finder::new(people, text, &words, &tokens, speech);
    let mut row: Vec<Unit> = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        let gap = tokens[at].gap;
        match gap {
            Gap::Slash => row.push(Unit { kind: Kind::Mark(Mark::Or), gap: Gap::Space }),
            Gap::Ampersand => row.push(Unit { kind: Kind::Mark(Mark::And), gap: Gap::Space }),
            _ => {}
        }
        let (mark, length) = phrase(&tokens[at..]);
        // "I think" is a phrase, "I" alone is a person; a name is always one.
        let found = finder
            .at(at, last_named(&row))
            .filter(|found| found.named || length == 1 || found.next - at > length);
        if let Some(found) = found {
            let next = tokens.get(found.next);
            let contracted =
                found.possessive && next.is_some_and(|next| is_contracted(next, &finder, found.next, &row));
            row.push(Unit {
                kind: Kind::Party { party: found.party, possessive: found.possessive && !contracted },
                gap,
            });
            if contracted {
                row.push(Unit { kind: Kind::Mark(Mark::Be), gap: Gap::Space });
            }
            at = found.next;
            if found.possessive
                && let Some(length) = no_possession(&tokens[at..])
            {
                row.push(Unit { kind: Kind::Mark(Mark::NoPossession), gap: tokens[at].gap });
                at += length;
            }
            continue;
        }
        let token = &tokens[at];
        let kind = match mark {
            Some(mark) => Kind::Mark(mark),
            None if token.possessive => Kind::Party { party: Party::Unknown, possessive: true },
            // "Bob and Steve": somebody whom the household does not know.
            None if token.capital && row.last().is_some_and(|before| before.is(Mark::And)) => {
                Kind::Party { party: Party::Unknown, possessive: false }
            }
            None => Kind::Word { capital: token.capital },
        };
        row.push(Unit { kind, gap });
        at += length;
    }
    Units { row, end: Words::end(text), asks_openly }
}

/// "Bob's in the kitchen": at the beginning of a clause the ending stands for "is".
fn is_contracted(next: &Token, finder: &Finder<'_>, at: usize, row: &[Unit]) -> bool {
    let opens = row.iter().rev().find(|unit| !unit.is(Mark::Filler)).is_none_or(|before| {
        matches!(before.kind, Kind::Mark(Mark::Yes | Mark::No | Mark::But | Mark::Break))
    });
    let follows = next.gap < Gap::Comma && lists(BEHIND_CONTRACTED_IS, &next.text);
    // "Bob's not Mary's" says whose, "Bob's not here" says where.
    follows && opens && !(next.text == "not" && finder.at(at + 1, last_named(row)).is_some())
}

/// The number of words up to and with one that names no possession: "birthday present".
fn no_possession(tokens: &[Token]) -> Option<usize> {
    let noun = tokens.iter().take(3).position(|token| !lists(KIN_ADJECTIVES, &token.text))?;
    (tokens[noun].gap < Gap::Comma && lists(NOT_POSSESSIONS, &tokens[noun].text)).then_some(noun + 1)
}

/// What the longest phrase at the beginning of the tokens does, and its length.
fn phrase(tokens: &[Token]) -> (Option<Mark>, usize) {
    longest(tokens, LONGEST_PHRASE, |phrase, possessive| if possessive { None } else { mark(phrase) })
        .map_or((None, 1), |(mark, length)| (Some(mark), length))
}

/// The member who was named last, alone.
fn last_named(row: &[Unit]) -> Option<UserIndex> {
    row.iter().rev().find_map(|unit| match unit.kind {
        Kind::Party { party: Party::Members(members), .. } if members.len() == 1 => members.iter().next(),
        _ => None,
    })
}

/// All members that a text names.
pub(super) fn members_named(units: &Units) -> OwnerSet {
    units.row.iter().fold(OwnerSet::EMPTY, |named, unit| match unit.party() {
        Some((Party::Members(members), _)) => named.union(members),
        _ => named,
    })
}

/// Whether a text speaks of sharing.
pub(super) fn has_sharing(units: &Units) -> bool {
    units.row.iter().any(|unit| unit.is(Mark::Verb(Verb::Share)))
}
