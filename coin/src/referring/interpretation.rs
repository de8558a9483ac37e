//! Reads a request: which words are the thing's, whose it is said to be, and where.

use super::labels::{properties_first, words_of};
use super::ownership::OwnerReference;
use super::phrases::{LONGEST_PHRASE, Mark, mark};
use crate::language::contractions::{Token, longest, tokens};
use crate::language::parties::{Finder, Found, Party, Speech};
use crate::language::people::People;
use crate::language::words::{Gap, Word, Words};
use crate::owners::OwnerSet;
use crate::roster::{Roster, UserIndex};

/// What a request asks about the thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The thing itself: "bring me", "where is".
    Thing,
    /// Its owner: "whose is".
    Owner,
}

/// How a place is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// Next to another thing.
    Near,
    /// On another thing or above it.
    Above,
    /// Under another thing.
    Below,
    /// In a room, or in another thing.
    In,
}

/// The words for a thing and the reference to its owner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NounPhrase {
    /// The words of the thing in lower case and singular: class and properties. Empty where the request names none.
    pub class: Vec<String>,
    /// The same words as they were said, in lower case.
    pub said: String,
    /// Whose it is said to be.
    pub owner: OwnerReference,
}

impl Default for NounPhrase {
    fn default() -> Self {
        Self { class: Vec::new(), said: String::new(), owner: OwnerReference::Anybody }
    }
}

impl NounPhrase {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn finish(&mut self) {
        self.said = self.class.join(" ");
        self.class = properties_first(words_of(&self.said));
    }
}

/// A place that the request names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hint {
    /// How the place is named.
    pub relation: Relation,
    /// All words for the place in lower case and singular: the name of a room may hold a possessor ("the children's
    /// room").
    pub place: Vec<String>,
    /// The same words as another thing and its owner.
    pub anchor: NounPhrase,
}

/// What a request means.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interpretation {
    /// What is asked.
    pub purpose: Purpose,
    /// The thing.
    pub thing: NounPhrase,
    /// Where it is said to be.
    pub hints: Vec<Hint>,
}

/// Reads a request. `speaker` gives "my" and "our" a meaning.
///
/// The reader is as conservative as that of answers: a possessor who is no member, no relative and nobody from outside
/// is [`OwnerReference::Unknown`], never the member with the most similar name. "His" means whoever was named before.
/// Letters in capitals, and the spaces between words, mean nothing.
pub fn interpret(roster: &Roster, query: &str, speaker: Option<UserIndex>) -> Interpretation {
    let people = People::new(roster);
    let text = with_apostrophes(&people, query);
    let mut words: Vec<Word> = Words::new(&text).collect();
    for word in &mut words {
        // A name that is an everyday word counts only with a capital, and what is typed in capitals means the same.
        word.capital = true;
    }
    let tokens = tokens(&text, &words);
    let finder = Finder::new(&people, &text, &words, &tokens, Speech::Answer { speaker });
    let mut reader = Reader {
        roster,
        speaker,
        finder,
        tokens: &tokens,
        named: None,
        putting: false,
        placing: false,
        meaning: Interpretation { purpose: Purpose::Thing, thing: NounPhrase::default(), hints: Vec::new() },
    };
    reader.read();
    reader.meaning
}

/// "Marys cup" is Mary's cup: an s behind a name or a role that means one member.
fn with_apostrophes(people: &People, query: &str) -> String {
    let mut text = String::with_capacity(query.len() + 4);
    let mut behind = 0;
    for word in Words::new(query) {
        let spelled = word.text(query);
        let end = word.end();
        text.push_str(&query[behind..end]);
        behind = end;
        if let Some(stem) = spelled.strip_suffix(['s', 'S'])
            && !word.possessive
            && names_one(people, stem)
            && !names_one(people, spelled)
        {
            text.truncate(text.len() - 1);
            text.push_str("'s");
        }
    }
    text.push_str(&query[behind..]);
    text
}

fn names_one(people: &People, text: &str) -> bool {
    let words: Vec<Word> = Words::new(text).collect();
    words.len() == 1 && people.mention(text, &words, 0).is_some_and(|mention| mention.who.is_some())
}

struct Reader<'text> {
    roster: &'text Roster,
    speaker: Option<UserIndex>,
    finder: Finder<'text>,
    tokens: &'text [Token],
    /// The member who was named last and is no owner: "bring Mary her cup".
    named: Option<UserIndex>,
    /// Whether the thing is to be put somewhere.
    putting: bool,
    /// Whether words belong to the last place, and not to the thing.
    placing: bool,
    meaning: Interpretation,
}

impl Reader<'_> {
    fn read(&mut self) {
        let mut at = 0;
        while at < self.tokens.len() {
            // A comma ends a place: "the book in the study, the red one".
            self.placing &= self.tokens[at].gap < Gap::Comma;
            if let Some((owner, next)) = self.possessor(at) {
                self.set_owner(owner);
                let tokens = &self.tokens[at..next];
                if let Some(hint) = self.place() {
                    hint.place.extend(tokens.iter().map(|token| token.text.clone()));
                }
                at = next;
                continue;
            }
            let (mark, length) =
                longest(
                    &self.tokens[at..],
                    LONGEST_PHRASE,
                    |phrase, possessive| {
                        if possessive { None } else { mark(phrase) }
                    },
                )
                .map_or((None, 1), |(mark, length)| (Some(mark), length));
            if let Some(found) = self.finder.at(at, self.named).filter(|found| found.next - at >= length)
                && is_somebody(found.party)
                && !matches!(self.tokens[at].text.as_str(), "i" | "me" | "myself" | "we" | "us")
            {
                // "the book that Mary owns"
                if let Some(length) = self.owns(found.next) {
                    self.set_owner(self.reference(found));
                    at = found.next + length;
                    continue;
                }
                if let Party::Members(members) = found.party
                    && members.len() == 1
                {
                    self.named = members.iter().next();
                }
                at = found.next;
                continue;
            }
            match mark {
                // What is behind a destination is said of it; before the thing, "to" belongs to a verb.
                Some(Mark::Destination) if !self.meaning.thing.is_empty() => break,
                Some(Mark::Place(_)) if self.putting => break,
                Some(Mark::Of) => {
                    if let Some((owner, next)) = self.owner_behind(at + length) {
                        self.set_owner(owner);
                        at = next;
                        continue;
                    }
                    if length == 1 && !self.phrase().class.is_empty() {
                        self.push("of");
                    }
                }
                Some(Mark::Put) => self.putting = true,
                Some(Mark::Whose) => self.meaning.purpose = Purpose::Owner,
                Some(Mark::Place(relation)) => self.begin_place(relation),
                Some(Mark::Over) if !self.meaning.thing.is_empty() && !self.putting => {
                    self.begin_place(Relation::Above);
                }
                Some(Mark::Not) => {
                    if let Some((_, next)) = self.owner_behind(at + length) {
                        at = next;
                        continue;
                    }
                }
                Some(Mark::Frame | Mark::And | Mark::Own | Mark::Over | Mark::Destination) => {}
                None => {
                    let word = self.tokens[at].text.clone();
                    self.push(&word);
                }
            }
            at += length;
        }
        for hint in &mut self.meaning.hints {
            hint.place = words_of(&hint.place.join(" "));
            hint.anchor.finish();
        }
        self.meaning.hints.retain(|hint| !hint.anchor.class.is_empty());
        self.meaning.thing.finish();
    }

    /// The number of words that make the person before them the owner.
    fn owns(&self, at: usize) -> Option<usize> {
        let rest = self.tokens.get(at..)?;
        let (mark, length) = longest(rest, LONGEST_PHRASE, |phrase, _| mark(phrase))?;
        (mark == Mark::Own && !self.meaning.thing.class.is_empty()).then_some(length)
    }

    /// The phrase that is being read: the last place, or the thing.
    fn phrase(&mut self) -> &mut NounPhrase {
        match self.meaning.hints.last_mut().filter(|_| self.placing) {
            Some(hint) => &mut hint.anchor,
            None => &mut self.meaning.thing,
        }
    }

    fn begin_place(&mut self, relation: Relation) {
        self.placing = true;
        self.meaning.hints.push(Hint { relation, place: Vec::new(), anchor: NounPhrase::default() });
    }

    fn place(&mut self) -> Option<&mut Hint> {
        self.meaning.hints.last_mut().filter(|_| self.placing)
    }

    fn push(&mut self, word: &str) {
        if let Some(hint) = self.place() {
            hint.place.push(word.to_owned());
        }
        self.phrase().class.push(word.to_owned());
    }

    /// Two owners that are named apart leave it open who is meant.
    fn set_owner(&mut self, owner: OwnerReference) {
        let phrase = self.phrase();
        phrase.owner = match phrase.owner {
            OwnerReference::Anybody => owner,
            before if before == owner => owner,
            _ => OwnerReference::Unknown,
        };
    }

    /// "my", "Mary's", "Bob and Mary's", and the place behind.
    fn possessor(&self, at: usize) -> Option<(OwnerReference, usize)> {
        self.owners(at).filter(|&(_, _, possessive)| possessive).map(|(owner, next, _)| (owner, next))
    }

    /// Behind "of": "Mary", "Mary's", "mine".
    fn owner_behind(&self, at: usize) -> Option<(OwnerReference, usize)> {
        self.owners(at).map(|(owner, next, _)| (owner, next))
    }

    /// Owners joined by "and", the place behind, and whether the last one is possessive.
    fn owners(&self, at: usize) -> Option<(OwnerReference, usize, bool)> {
        let (mut owner, mut next, mut possessive) = self.owner(at)?;
        while let Some(joined) = self.joined(next)
            && let Some((other, behind, other_possessive)) = self.owner(joined)
        {
            owner = match (owner, other) {
                (OwnerReference::Members(members), OwnerReference::Members(others)) => {
                    OwnerReference::Members(members.union(others))
                }
                _ => OwnerReference::Unknown,
            };
            (next, possessive) = (behind, other_possessive);
        }
        Some((owner, next, possessive))
    }

    /// The place behind an "and" or a comma.
    fn joined(&self, at: usize) -> Option<usize> {
        let token = self.tokens.get(at)?;
        if mark(&token.text) == Some(Mark::And) {
            return Some(at + 1);
        }
        matches!(token.gap, Gap::Comma | Gap::Ampersand).then_some(at)
    }

    fn owner(&self, at: usize) -> Option<(OwnerReference, usize, bool)> {
        let token = self.tokens.get(at)?;
        let text = token.text.as_str();
        if let (None, "my" | "mine") = (self.speaker, text) {
            // Of an unknown speaker's wife nothing is known.
            let found = self.finder.at(at, None)?;
            let owner = if found.next == at + 1 { OwnerReference::Speaker } else { OwnerReference::Unknown };
            return Some((owner, found.next, found.possessive));
        }
        if let (Some(named), "his" | "her" | "hers" | "their") = (self.named, text) {
            let found = self.finder.at(at, Some(named)).filter(|found| found.next > at + 1);
            let (owner, next) = found.map_or_else(
                || (OwnerReference::Members(OwnerSet::single(named)), at + 1),
                |found| (self.reference(found), found.next),
            );
            return Some((owner, next, true));
        }
        let anybody = matches!(text, "anybody" | "anyone" | "somebody" | "someone");
        if anybody && token.possessive {
            return Some((OwnerReference::Anybody, at + 1, true));
        }
        if let Some(found) = self.finder.at(at, self.named).filter(|found| is_somebody(found.party)) {
            return Some((self.reference(found), found.next, found.possessive));
        }
        token.possessive.then_some((OwnerReference::Unknown, at + 1, true))
    }

    fn reference(&self, found: Found) -> OwnerReference {
        match found.party {
            Party::Members(members) => OwnerReference::Members(members),
            Party::OneOf(members) => OwnerReference::OneOf(members),
            // Who lives alone owns what is ours.
            Party::Ours if self.roster.len() > 1 => OwnerReference::Ours(self.speaker),
            Party::Everyone | Party::Ours => OwnerReference::Members(self.roster.everyone()),
            Party::Both if self.roster.len() == 2 => OwnerReference::Members(self.roster.everyone()),
            Party::Three if self.roster.len() == 3 => OwnerReference::Members(self.roster.everyone()),
            Party::Outside => OwnerReference::Outside,
            _ => OwnerReference::Unknown,
        }
    }
}

/// Whether the words name people; "any" and "all" before a thing do not.
fn is_somebody(party: Party) -> bool {
    !matches!(party, Party::Anyone | Party::AnyOfUs | Party::Nobody | Party::NoneOfUs)
}

#[cfg(test)]
mod tests;
