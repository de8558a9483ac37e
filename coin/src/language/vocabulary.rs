//! The words for people whom no name and no role tells: groups, relatives, outsiders; and short forms. Lists are written
//! with commas.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::parties::Party;

/// Phrases for groups of people.
const PARTIES: &[(Party, &str)] = &[
    (
        Party::Everyone,
        "everyone, everybody, all, the family, the whole family, whole family, family, \
         the entire family, the household, household, the whole household, communal, common property, \
         community property, all of them, them all, they all, each of us, every one of us, \
         everyone of us, the whole house, all of you, you all",
    ),
    (
        Party::Ours,
        "ours, us, we, our, all of us, all of ours, we all, us all, our family, our household, \
         my family, our whole family, my whole family, all our, ours all",
    ),
    (
        Party::Both,
        "both, both of us, both of ours, both of them, both of theirs, we both, they both, \
         the both of us, the two of us, us both, them both, both of you, the two of them, two of us",
    ),
    (Party::Three, "all three of us, the three of us, all three, three of us, all three of them, us three"),
    (Party::SomeoneElse, "someone else, somebody else, another person, someone different, other people"),
    (Party::Nobody, "nobody, no one, no-one, noone, none, nobody else, no one else"),
    (
        Party::NoneOfUs,
        "none of us, none of ours, nobody here, no one here, no-one here, nobody in this house, \
         nobody in the house, no one in this house, no one in the house, nobody in this family, \
         nobody in the family, no one in this family, no one in the family, nobody of us, \
         nobody in the household, no one in the household, neither of us",
    ),
    (
        Party::AnyOfUs,
        "any of us, any of ours, anyone here, anybody here, anyone in this house, anybody in this house, \
         anyone of us, either of us, anyone in the family, anyone in this family, anyone in the house, \
         anybody in the house",
    ),
    (Party::Anyone, "anyone, anybody, whoever wants, whoever needs"),
    (Party::They, "they, them, theirs"),
    (Party::Unknown, "he, she, him, hers"),
];

static GROUPS: LazyLock<HashMap<&str, Party>> = LazyLock::new(|| index(PARTIES));

/// What each phrase of the lists means.
pub(crate) fn index<T: Copy>(lists: &'static [(T, &'static str)]) -> HashMap<&'static str, T> {
    lists.iter().flat_map(|&(value, list)| list.split(", ").map(move |phrase| (phrase, value))).collect()
}

/// The group that a phrase means.
pub(crate) fn group(phrase: &str) -> Option<Party> {
    GROUPS.get(phrase).copied()
}

/// Whether a list holds a word.
pub(crate) fn lists(list: &str, word: &str) -> bool {
    list.split(", ").any(|listed| listed == word)
}

/// People who do not live in a household, unless a member has that role.
pub(crate) const OUTSIDERS: &str = "guest, visitor, neighbour, neighbor, friend, colleague, coworker, co-worker, boss, landlord, \
     landlady, cleaner, plumber, babysitter, sitter, classmate, schoolmate, teammate, teacher, stranger, \
     girlfriend, boyfriend, ex, client, customer, employer, ex-wife, ex-husband, ex-girlfriend, \
     ex-boyfriend, buddy, pal, mate, acquaintance, postman, mailman, handyman, electrician, doctor, \
     nurse, coach, supervisor, secretary";

/// Institutions. In front of another noun they only describe it: "Tom's school bag".
pub(crate) const INSTITUTIONS: &str = "library, school, kindergarten, university, church";

/// Kin whom [`super::people::Kin`] does not know.
pub(crate) const FAR_KIN: &str = "aunt, auntie, aunty, uncle, cousin, niece, nephew, grandson, granddaughter, grandchild, godmother, \
     godfather, godson, goddaughter, fiance, fiancée, fiancé, stepmother, stepfather, stepson, \
     stepdaughter, stepbrother, stepsister, grandparent, relative, twin";

/// May stand between a possessor and a relative: "my older sister".
pub(crate) const KIN_ADJECTIVES: &str = "old, older, elder, eldest, oldest, younger, youngest, young, little, big, best, good, dear, new, \
     late, former, close, own, great, next-door, school, family, direct, nice";

/// Short forms without their apostrophe, and forms with one: the words that they stand for.
pub(crate) const CONTRACTIONS: &[(&str, &str)] = &[
    ("its", "it is"),
    ("thats", "that is"),
    ("hes", "he is"),
    ("shes", "she is"),
    ("theyre", "they are"),
    ("im", "i am"),
    ("isnt", "is not"),
    ("arent", "are not"),
    ("dont", "do not"),
    ("doesnt", "does not"),
    ("didnt", "did not"),
    ("cant", "can not"),
    ("can't", "can not"),
    ("won't", "will not"),
    ("cannot", "can not"),
    ("wasnt", "was not"),
    ("ain't", "is not"),
    ("aint", "is not"),
    ("whos", "who is"),
    ("everyones", "everyone"),
    ("everybodys", "everybody"),
    ("gonna", "will"),
    ("lemme", "let"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_group_has_two_meanings() {
        let listed: usize = PARTIES.iter().map(|(_, list)| list.split(", ").count()).sum();
        assert_eq!(listed, GROUPS.len());
    }
}
