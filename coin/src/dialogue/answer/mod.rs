//! Understands an answer to "whose is this?".
//!
//! The reader is conservative: it names an owner only where the answer says so. Everything else is unresolved,
//! and the thing may be asked about again. Decisions where everyday language is open:
//! * A leaning ("I think", "probably", "must be") is an answer; a guess ("maybe", "could be", "I guess", a
//!   question mark) is not.
//! * Using is not owning: "Bob uses it" says nothing. "Only Bob uses it", "Bob and Mary use it" and "we all
//!   use it" do, unless the answer names an owner besides.
//! * Who lends a thing owns it; who bought or gave it may or may not.
//! * What was ("it was Bob's", "it used to be Bob's") need not be so any more.
//! * "Ours" is everybody's; "not ours" is somebody's outside the household.
//! * Yes and no answer the question's first alternative. "No" and "not Bob's" leave an owner over only in a
//!   household of two.
//! * A name that is not of the household is no reason to call the owner an outsider: it may be a nickname.

use coin_schemas::tools::MAX_TEXT_BYTES;

use self::clauses::{Named, Segment, Statement, sentences};
use self::units::units;
use crate::language::parties::Speech;
use crate::language::people::People;
use crate::language::words::Gap;
use crate::owners::OwnerSet;
use crate::roster::{Roster, UserIndex};

mod clauses;
mod statements;
mod units;
mod vocabulary;

#[cfg(test)]
mod laws;
#[cfg(test)]
mod phrasings;
#[cfg(test)]
mod tests;

/// What an answer says of the owners.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Reading {
    /// The owners within the household.
    pub owners: OwnerSet,
    /// Whether somebody who does not live here owns the thing, alone or with them.
    pub outside_household: bool,
}

impl Reading {
    /// Whether the answer settles nothing.
    pub fn is_unresolved(&self) -> bool {
        self.owners.is_empty() && !self.outside_household
    }
}

/// Reads an answer. `answered_by` gives "mine" a meaning; the question gives one to "yes" and "both". What is
/// longer than [`MAX_TEXT_BYTES`] is no answer to a question, and no question: it is not read.
pub fn read_answer(roster: &Roster, question: &str, answer: &str, answered_by: Option<UserIndex>) -> Reading {
    if answer.len() > MAX_TEXT_BYTES {
        return Reading::default();
    }
    let question = if question.len() > MAX_TEXT_BYTES { "" } else { question };
    let people = People::new(roster);
    let question = Question::read(roster, &people, question, answered_by);
    let units = units(&people, answer, Speech::Answer { speaker: answered_by });
    let named = Named { everyone: roster.everyone(), in_question: question.named };
    let mut verdict = Verdict::default();
    for sentence in sentences(units) {
        if sentence.end == Gap::Question {
            // "Bob's?" proposes: it casts doubt on what was said before, and what comes after it counts.
            verdict.doubtful |=
                verdict.claim.is_some() && sentence.segments.iter().any(Segment::names_somebody);
            continue;
        }
        for segment in &sentence.segments {
            verdict.hear(statements::read(segment, &named), &question);
        }
    }
    verdict.conclude(&question)
}

/// What the question makes of short answers.
#[derive(Debug, Clone, Copy)]
struct Question {
    everyone: OwnerSet,
    /// The members that the question names.
    named: OwnerSet,
    /// Whom "yes" makes the owners.
    proposed: Option<OwnerSet>,
    /// Whether the question offers sharing as an alternative.
    offers_sharing: bool,
}

impl Question {
    fn read(roster: &Roster, people: &People, text: &str, asked: Option<UserIndex>) -> Self {
        let units = units(people, text, Speech::Question { asked });
        let named = units::members_named(&units);
        let offers_sharing = units::has_sharing(&units);
        let everyone = roster.everyone();
        let proposed = clauses::first_alternative(units).and_then(|segments| {
            let named = Named { everyone, in_question: named };
            let mut claims = segments.iter().filter_map(|segment| match statements::read(segment, &named) {
                Statement::Claim { owners, outside: false } | Statement::Use { owners }
                    if !owners.is_empty() =>
                {
                    Some(owners)
                }
                _ => None,
            });
            let claim = claims.next();
            claim.filter(|_| claims.next().is_none())
        });
        Self { everyone, named, proposed, offers_sharing }
    }

    /// Who shares, where an answer says only that the thing is shared.
    fn sharers(&self) -> Option<OwnerSet> {
        match self.proposed {
            Some(owners) if owners.len() > 1 => Some(owners),
            _ if self.everyone.len() == 2 => Some(self.everyone),
            _ if self.offers_sharing && self.named.len() > 1 => Some(self.named),
            _ => None,
        }
    }
}

/// What the answer has said so far.
#[derive(Debug, Clone, Copy, Default)]
struct Verdict {
    claim: Option<Reading>,
    /// Owners of whom the answer says that they are not the only ones.
    partial: Option<OwnerSet>,
    denied: OwnerSet,
    used_by: Option<OwnerSet>,
    says_no: bool,
    doubtful: bool,
    /// Something was said that the reader does not understand.
    unread: bool,
    /// The answer says that the owner is none of the household.
    stranger: bool,
}

impl Verdict {
    fn hear(&mut self, statement: Statement, question: &Question) {
        match statement {
            Statement::Claim { owners, outside } => {
                self.claim(Reading { owners, outside_household: outside });
            }
            Statement::Instead { owners, outside } => {
                self.claim = None;
                self.claim(Reading { owners, outside_household: outside });
            }
            Statement::Also { owners, outside } => self.add(Reading { owners, outside_household: outside }),
            Statement::Partial(owners) => self.partial = Some(owners),
            Statement::Deny(owners) => self.denied = self.denied.union(owners),
            Statement::DenyAll => self.stranger = true,
            Statement::Use { owners } => self.used_by = Some(owners),
            Statement::Shared => match question.sharers() {
                Some(owners) => self.claim(Reading { owners, outside_household: false }),
                None => self.unread = true,
            },
            Statement::Yes => {
                if let Some(owners) = question.proposed {
                    self.claim(Reading { owners, outside_household: false });
                }
            }
            // "Bob: no", "Bob's, no": one of the two is wrong.
            Statement::No => {
                self.doubtful |= self.claim.is_some();
                self.says_no = true;
            }
            Statement::Doubt => self.doubtful = true,
            Statement::Correction => *self = Self::default(),
            Statement::Silence => {}
            Statement::Unread => self.unread = true,
        }
    }

    /// Two claims that differ leave it open which is right.
    fn claim(&mut self, reading: Reading) {
        let owners = self.partial.take().map_or(reading.owners, |owners| owners.union(reading.owners));
        let reading = Reading { owners, ..reading };
        match self.claim {
            Some(before) => self.doubtful |= before != reading,
            None => self.claim = Some(reading),
        }
    }

    fn add(&mut self, reading: Reading) {
        let before = self.claim.unwrap_or_default();
        let partial = self.partial.take().unwrap_or_default();
        self.claim = Some(Reading {
            owners: before.owners.union(reading.owners).union(partial),
            outside_household: before.outside_household || reading.outside_household,
        });
    }

    fn conclude(mut self, question: &Question) -> Reading {
        if self.doubtful || self.partial.is_some() {
            return Reading::default();
        }
        if let Some(claim) = self.claim {
            let left = minus(claim.owners, self.denied);
            let contradicted = left != claim.owners && claim.owners != question.everyone
                || self.stranger && !claim.owners.is_empty();
            return if contradicted { Reading::default() } else { Reading { owners: left, ..claim } };
        }
        if self.stranger {
            return Reading { owners: OwnerSet::EMPTY, outside_household: true };
        }
        if let Some(owners) = self.used_by {
            return Reading { owners: minus(owners, self.denied), outside_household: false };
        }
        if self.says_no
            && let Some(owners) = question.proposed
            && owners.len() == 1
        {
            self.denied = self.denied.union(owners);
        }
        if question.everyone.len() == 2 && self.denied.len() == 1 && !self.unread {
            return Reading { owners: minus(question.everyone, self.denied), outside_household: false };
        }
        Reading::default()
    }
}

fn minus(set: OwnerSet, without: OwnerSet) -> OwnerSet {
    set.iter().filter(|&user| !without.contains(user)).collect()
}
