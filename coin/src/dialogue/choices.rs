//! What a form offers a person who is asked whose a thing is, in the person's own words.

use std::collections::HashSet;

use crate::dialogue::Reading;
use crate::owners::{OwnerSet, candidate_sets};
use crate::roster::Roster;

use super::wording::{Joined, list};

/// Up to this many members every set of them is offered. Four have fifteen sets, more than one likes to read.
const MOST_ENUMERATED: usize = 3;

/// One line of a form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choice {
    /// What the person reads.
    pub words: String,
    /// What picking it says.
    pub meaning: Meaning,
}

/// What picking a choice says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Whose the thing is, or that the person does not know.
    Says(Reading),
    /// What the person wrote beside it.
    OwnWords,
}

/// The choices for a household: its members alone and together, somebody else, and "I do not know". Where there are too
/// many sets to offer, only single members, everybody and the `likely` ones are, and the person's own words. The order
/// is that of the roster, so that it leans to nobody. No two choices have the same words.
pub fn choices(roster: &Roster, likely: impl IntoIterator<Item = OwnerSet>) -> Vec<Choice> {
    let everyone = roster.everyone();
    let mut sets = candidate_sets(roster.len());
    if roster.len() > MOST_ENUMERATED {
        let likely: Vec<OwnerSet> = likely.into_iter().collect();
        sets.retain(|set| set.len() == 1 || *set == everyone || likely.contains(set));
    }
    sets.sort_by_key(|set| (set.len(), set.iter().collect::<Vec<_>>()));
    let own_words = (roster.len() > MOST_ENUMERATED)
        .then(|| Choice { words: "other, as I write below".to_owned(), meaning: Meaning::OwnWords });
    let outside = Reading { owners: OwnerSet::EMPTY, outside_household: true };
    let of_set = |owners: OwnerSet| Choice {
        words: words(roster, owners),
        meaning: Meaning::Says(Reading { owners, outside_household: false }),
    };
    let mut choices: Vec<Choice> = sets
        .into_iter()
        .map(of_set)
        .chain([Choice { words: "nobody here owns it".to_owned(), meaning: Meaning::Says(outside) }])
        .chain(own_words)
        .chain([Choice { words: "I do not know".to_owned(), meaning: Meaning::Says(Reading::default()) }])
        .collect();
    // Somebody may be called "Bob and Mary", beside Bob and Mary.
    let mut offered = HashSet::new();
    choices.retain(|choice| offered.insert(choice.words.clone()));
    choices
}

/// What a choice says, by its words; `None` where no form of this household offers such words.
pub fn meaning_of(roster: &Roster, words: &str) -> Option<Meaning> {
    let offered = choices(roster, candidate_sets(roster.len()));
    offered.into_iter().find(|choice| choice.words == words).map(|choice| choice.meaning)
}

/// "Bob", "Bob and Mary", "all of us".
fn words(roster: &Roster, owners: OwnerSet) -> String {
    if owners == roster.everyone() && owners.len() > 2 {
        "all of us".to_owned()
    } else {
        list(roster, owners, Joined::And)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::captions::test_support::roster;
    use crate::dialogue::read_answer;

    const NAMES: [(&str, &str); 5] =
        [("Bob", "father"), ("Mary", "mother"), ("Tom", "son"), ("Uma", "daughter"), ("Vic", "uncle")];

    fn offered(members: usize, likely: &[&[&str]]) -> Vec<String> {
        let roster = roster(&NAMES[..members]);
        let sets =
            likely.iter().map(|names| names.iter().map(|name| roster.index_of(name).unwrap()).collect());
        choices(&roster, sets).into_iter().map(|choice| choice.words).collect()
    }

    #[test]
    fn a_small_household_is_offered_every_set() {
        assert_eq!(
            offered(3, &[]),
            [
                "Bob",
                "Mary",
                "Tom",
                "Bob and Mary",
                "Bob and Tom",
                "Mary and Tom",
                "all of us",
                "nobody here owns it",
                "I do not know",
            ]
        );
        assert_eq!(offered(1, &[]), ["Bob", "nobody here owns it", "I do not know"]);
        assert_eq!(offered(2, &[])[2], "Bob and Mary");
    }

    #[test]
    fn a_large_household_is_offered_what_is_likely_and_its_own_words() {
        assert_eq!(
            offered(5, &[&["Mary", "Uma"], &["Bob"]]),
            [
                "Bob",
                "Mary",
                "Tom",
                "Uma",
                "Vic",
                "Mary and Uma",
                "all of us",
                "nobody here owns it",
                "other, as I write below",
                "I do not know",
            ]
        );
    }

    /// What is offered means the same to the reader of free answers: a client that sends the words is understood.
    #[test]
    fn the_words_of_a_choice_read_as_what_it_means() {
        for members in 1..=4 {
            let roster = roster(&NAMES[..members]);
            for choice in choices(&roster, []) {
                if let Meaning::Says(meant) = choice.meaning {
                    assert_eq!(read_answer(&roster, "", &choice.words, None), meant, "{:?}", choice.words);
                }
            }
        }
    }
}
