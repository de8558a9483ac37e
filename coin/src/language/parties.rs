//! Finds whom a text speaks of: names, roles, relatives, "mine", "everybody", "a guest".

use super::contractions::{Token, longest};
use super::people::{Called, Kin, Mention, People, Relative, kin_of_plural};
use super::vocabulary::{FAR_KIN, INSTITUTIONS, KIN_ADJECTIVES, OUTSIDERS, group, lists};
use super::words::{Gap, Key, Word};
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// Whose words are read: it decides who "me" and "you" are.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Speech {
    /// A person answers.
    Answer {
        /// Who, where it is known.
        speaker: Option<UserIndex>,
    },
    /// The robot asks.
    Question {
        /// Who is asked, where it is known.
        asked: Option<UserIndex>,
    },
}

/// Whom a text speaks of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Party {
    /// These members.
    Members(OwnerSet),
    /// One of these members, and it is not said which.
    OneOf(OwnerSet),
    /// All of the household.
    Everyone,
    /// All of the household, said by one of them.
    Ours,
    /// The two that the question names, or the two of a household of two.
    Both,
    /// All of a household of three.
    Three,
    /// People who do not live here.
    Outside,
    /// Somebody other than those named.
    SomeoneElse,
    /// Nobody.
    Nobody,
    /// Nobody of the household.
    NoneOfUs,
    /// Anyone of the household.
    AnyOfUs,
    /// Anyone.
    Anyone,
    /// People whom the text does not name again.
    They,
    /// Somebody whom the reader cannot identify.
    Unknown,
}

/// The longest phrase for a group, in words.
const LONGEST_PHRASE: usize = 5;

/// Somebody found in the text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) party: Party,
    pub(crate) possessive: bool,
    /// The place of the token behind.
    pub(crate) next: usize,
    /// Whether it begins with a name.
    pub(crate) named: bool,
}

/// What a noun for a person means, whoever they belong to.
#[derive(Debug, Clone, Copy)]
enum Noun {
    /// A kinship that roles can tell.
    Kin(Kin),
    /// Several of a kinship.
    Plural(Kin),
    /// Kin whom no role tells.
    FarKin,
    /// No kin, and not of the household.
    Outsider,
}

/// Looks for people in one text.
pub(crate) struct Finder<'text> {
    people: &'text People,
    text: &'text str,
    words: &'text [Word],
    tokens: &'text [Token],
    me: Party,
    you: Option<Party>,
}

impl<'text> Finder<'text> {
    pub(crate) fn new(
        people: &'text People,
        text: &'text str,
        words: &'text [Word],
        tokens: &'text [Token],
        speech: Speech,
    ) -> Self {
        let party = |user: Option<UserIndex>| {
            user.map_or(Party::Unknown, |user| Party::Members(OwnerSet::single(user)))
        };
        let (me, you) = match speech {
            Speech::Answer { speaker } => (party(speaker), None),
            Speech::Question { asked } => (Party::Unknown, Some(party(asked))),
        };
        Self { people, text, words, tokens, me, you }
    }

    /// Whoever is named from the token `at` on. `last` is the member who was named last and whom "his" means before a
    /// relative.
    pub(crate) fn at(&self, at: usize, last: Option<UserIndex>) -> Option<Found> {
        self.name(at)
            .map(|found| Found { named: true, ..found })
            .or_else(|| self.indefinite(at, last))
            .or_else(|| self.group(at))
            .or_else(|| self.pronoun(at, last))
            .or_else(|| self.definite(at))
            .map(|found| self.relatives_of(found))
            .map(|found| self.named_behind(found))
    }

    fn text_at(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text.as_str())
    }

    fn mention(&self, at: usize) -> Option<(Mention, usize)> {
        let word = self.tokens.get(at)?.word;
        // The second half of a short form is no word of the text.
        if at > 0 && self.tokens[at - 1].word == word {
            return None;
        }
        let mention = self.people.mention(self.text, self.words, word)?;
        let behind = word + mention.length;
        let next = (at..self.tokens.len()).find(|&token| self.tokens[token].word >= behind);
        Some((mention, next.unwrap_or(self.tokens.len())))
    }

    fn name(&self, at: usize) -> Option<Found> {
        let (mention, next) = self.mention(at)?;
        (mention.called == Called::Name).then(|| found(mention, next))
    }

    /// "everyone", "all of us"
    fn group(&self, at: usize) -> Option<Found> {
        let (possessive, length) = longest(&self.tokens[at..], LONGEST_PHRASE, |phrase, possessive| {
            group(phrase).map(|_| possessive)
        })?;
        let words: Vec<&str> = (at..at + length).map(|place| self.text_at(place)).collect();
        let party = group(&words.join(" "))?;
        let inherent = lists("ours, theirs, hers, our, family, communal", words[length - 1]);
        Some(Found { party, possessive: possessive || inherent, next: at + length, named: false })
    }

    fn pronoun(&self, at: usize, last: Option<UserIndex>) -> Option<Found> {
        let found =
            |party: Party, possessive: bool| Some(Found { party, possessive, next: at + 1, named: false });
        match (self.text_at(at), self.you) {
            ("i" | "me" | "myself", None) => found(self.me, false),
            ("my" | "mine", None) => found(self.me, true),
            ("you", Some(you)) => found(you, false),
            ("your" | "yours", you) => found(you.unwrap_or(Party::Unknown), true),
            ("his" | "her" | "their", _) => {
                // With a relative behind it the pronoun means whoever was named last; alone it means nobody
                // that the reader could tell.
                let noun = self.noun_behind(at + 1).is_some();
                let last = last.map(|user| Party::Members(OwnerSet::single(user)));
                found(last.filter(|_| noun).unwrap_or(Party::Unknown), true)
            }
            _ => None,
        }
    }

    /// "a guest", "one of our neighbours", "some colleague of mine": nobody in particular.
    fn indefinite(&self, at: usize, last: Option<UserIndex>) -> Option<Found> {
        match (self.text_at(at), self.text_at(at + 1)) {
            ("one" | "some" | "any", "of") => return self.one_of(at + 2, last),
            ("a" | "an" | "some" | "another" | "one" | "any", _) => {}
            _ => return None,
        }
        if let Some((mention, next)) = self.mention(at + 1)
            && mention.called == Called::Role
        {
            return Some(Found { party: Party::Unknown, possessive: mention.possessive, next, named: false });
        }
        let (noun, place) = self.noun_behind(at + 1)?;
        let party = match noun {
            Noun::Outsider => Party::Outside,
            _ => Party::Unknown,
        };
        Some(self.of_somebody(Found {
            party,
            possessive: self.tokens[place].possessive,
            next: place + 1,
            named: false,
        }))
    }

    fn one_of(&self, at: usize, last: Option<UserIndex>) -> Option<Found> {
        let whole = self.at(at, last)?;
        (whole.party == Party::Outside).then_some(whole)
    }

    /// "the father", "Dad", "the kids", "the neighbour"
    fn definite(&self, at: usize) -> Option<Found> {
        let start = if self.text_at(at) == "the" { at + 1 } else { at };
        let with_article = start > at;
        if let Some((mention, next)) = self.mention(start) {
            let mut found = found(mention, next);
            if let (None, Some(noun)) = (mention.who, self.noun(start)) {
                found.party = self.of_household(noun);
            }
            return Some(self.of_somebody(found));
        }
        let (noun, place) = if with_article { self.noun_behind(start)? } else { (self.noun(start)?, start) };
        let possessive = self.tokens[place].possessive;
        let addressed = at > 0 && lists("to, by, from", self.text_at(at - 1));
        let party = match noun {
            Noun::Outsider if with_article || possessive || addressed => Party::Outside,
            Noun::Outsider => return None,
            _ => self.of_household(noun),
        };
        Some(self.of_somebody(Found { party, possessive, next: place + 1, named: false }))
    }

    fn noun(&self, at: usize) -> Option<Noun> {
        let token = self.tokens.get(at)?;
        let text = token.text.as_str();
        let key = Key::of_folded(text);
        let listed = |list: &str| {
            lists(list, text) || text.strip_suffix('s').is_some_and(|singular| lists(list, singular))
        };
        let last = self.tokens.get(at + 1).is_none_or(|next| next.gap > Gap::Space);
        if let Some(kin) = Kin::of_word(key) {
            Some(Noun::Kin(kin))
        } else if let Some(kin) = kin_of_plural(key) {
            Some(Noun::Plural(kin))
        } else if listed(FAR_KIN) || text.ends_with("-in-law") {
            Some(Noun::FarKin)
        } else {
            (listed(OUTSIDERS) || listed(INSTITUTIONS) && (last || token.possessive))
                .then_some(Noun::Outsider)
        }
    }

    /// A noun for a person, adjectives before it left out, and its place.
    fn noun_behind(&self, at: usize) -> Option<(Noun, usize)> {
        let skips = (at..self.tokens.len())
            .take_while(|&place| lists(KIN_ADJECTIVES, self.text_at(place)))
            .take(2)
            .count();
        (0..=skips).rev().find_map(|skipped| {
            let place = at + skipped;
            let close = self.tokens.get(place)?.gap == Gap::Space;
            self.noun(place).filter(|_| close).map(|noun| (noun, place))
        })
    }

    /// Whom a noun means without a possessor, or with "our".
    fn of_household(&self, noun: Noun) -> Party {
        match noun {
            Noun::Kin(kin) => match (self.people.all(kin), kin) {
                (members, _) if members.len() == 1 => Party::Members(members),
                (members, _) if members.len() > 1 => Party::OneOf(members),
                (members, Kin::Grandmother | Kin::Grandfather) if members.is_empty() => {
                    party_of(self.people.stranger())
                }
                _ => Party::Unknown,
            },
            Noun::Plural(kin) if !self.people.all(kin).is_empty() => Party::Members(self.people.all(kin)),
            Noun::Plural(_) => Party::Unknown,
            Noun::FarKin => party_of(self.people.stranger()),
            Noun::Outsider => Party::Outside,
        }
    }

    /// Whom a noun means that belongs to somebody.
    fn of_party(&self, possessor: Party, noun: Noun) -> Party {
        let one = match possessor {
            Party::Members(members) if members.len() == 1 => members.iter().next(),
            Party::Outside => return Party::Outside,
            Party::Ours | Party::Everyone => return self.of_household(noun),
            _ => None,
        };
        match (one, noun) {
            (_, Noun::Outsider) => Party::Outside,
            (_, Noun::FarKin) => party_of(self.people.stranger()),
            (Some(of), Noun::Kin(kin)) => match self.people.relatives(of, kin) {
                members if members.len() > 1 => Party::OneOf(members),
                _ => party_of(self.people.relative(of, kin)),
            },
            (Some(of), Noun::Plural(kin)) => match self.people.relatives(of, kin) {
                members if members.is_empty() => party_of(self.people.relative(of, kin)),
                members => Party::Members(members),
            },
            (None, Noun::Kin(Kin::Grandmother | Kin::Grandfather)) => self.of_household(noun),
            (None, Noun::Kin(_) | Noun::Plural(_)) => Party::Unknown,
        }
    }

    /// "Bob's older sister's friend": follows the possessors to the last one.
    fn relatives_of(&self, mut found: Found) -> Found {
        while found.possessive {
            // A member's own role ("my flatmate", "our lodger") is a relative as well.
            let Some((noun, place)) = self.noun_behind(found.next) else { break };
            let known = match (noun, self.mention(place)) {
                (Noun::Outsider, Some((mention, _))) => mention.who,
                _ => None,
            };
            let party = known.map_or_else(
                || self.of_party(found.party, noun),
                |user| Party::Members(OwnerSet::single(user)),
            );
            found = self.of_somebody(Found {
                party,
                possessive: self.tokens[place].possessive,
                next: place + 1,
                named: false,
            });
        }
        found
    }

    /// "the mother of Tom", "a friend of Tom's"
    fn of_somebody(&self, found: Found) -> Found {
        if self.text_at(found.next) != "of" || found.possessive {
            return found;
        }
        let start = found.next + 1;
        if start >= self.tokens.len() {
            return found;
        }
        let article = usize::from(self.text_at(start) == "the");
        let of =
            self.name(start + article).or_else(|| self.pronoun(start, None)).or_else(|| self.group(start));
        let Some(of) = of else { return found };
        let party = match (found.party, of.party, self.noun(found.next - 1)) {
            (Party::Outside, ..) => Party::Outside,
            (_, Party::Members(_), Some(noun)) => self.of_party(of.party, noun),
            _ => Party::Unknown,
        };
        Found { party, possessive: of.possessive, next: of.next, named: false }
    }

    /// "my flatmate Bea": the name tells which one.
    fn named_behind(&self, found: Found) -> Found {
        let close = self.tokens.get(found.next).is_some_and(|token| token.gap == Gap::Space);
        let noun = found.next.checked_sub(1).and_then(|last| self.noun(last)).is_some();
        if found.possessive || !close || !noun {
            return found;
        }
        match (found.party, self.name(found.next)) {
            (Party::Unknown | Party::OneOf(_), Some(name)) => name,
            (Party::Outside, Some(name)) => Found { party: Party::Unknown, ..name },
            (party, Some(name)) if party == name.party => name,
            _ => found,
        }
    }
}

fn found(mention: Mention, next: usize) -> Found {
    let party = mention.who.map_or(Party::Unknown, |user| Party::Members(OwnerSet::single(user)));
    Found { party, possessive: mention.possessive, next, named: false }
}

fn party_of(relative: Relative) -> Party {
    match relative {
        Relative::Member(user) => Party::Members(OwnerSet::single(user)),
        Relative::Outside => Party::Outside,
        Relative::Unclear => Party::Unknown,
    }
}
