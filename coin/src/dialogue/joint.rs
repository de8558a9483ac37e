//! Words one question about all things of a class in a room, and reads the answer.

use super::answer::Reading;
use super::thing::Thing;
use super::wording::{Joined, list};
use crate::owners::OwnerSet;
use crate::roster::Roster;

/// Whether several things are these people's: one sentence that ends with a question mark, and to which "yes" says so of each.
///
/// # Panics
/// If nobody is named.
pub fn word_joint_question(roster: &Roster, class: &str, room: Option<&str>, owners: OwnerSet) -> String {
    assert!(!owners.is_empty(), "somebody has to own them");
    let thing = Thing::new(class, room, [0.0; 3]);
    let plural = thing.is == "Are";
    let bare = thing.name.strip_prefix("the ").unwrap_or(&thing.name);
    // "All the scissors" would leave open whether all the people are meant.
    let every = if plural { thing.name.clone() } else { format!("every {bare}") };
    if owners == roster.everyone() && owners.len() > 2 {
        return format!("Do you all share {every}?");
    }
    match owners.len() {
        1 => format!("{} {every} {}'s?", thing.is, list(roster, owners, Joined::And)),
        _ => format!("Do {} share {every}?", list(roster, owners, Joined::And)),
    }
}

/// What is said of several things, and the same said of one.
const OF_ONE: [(&str, &str); 12] = [
    (", every one of them", ""),
    (", each of them", ""),
    (", both of them", ""),
    (", all of them", ""),
    ("they belong", "it belongs"),
    ("they are", "it is"),
    ("they're", "it's"),
    ("those are", "that is"),
    ("these are", "this is"),
    ("share them", "share it"),
    ("own them", "own it"),
    ("use them", "use it"),
];

/// An answer about several things as if it spoke of one, so that "them" is not taken for people.
pub fn as_of_one_thing(answer: &str) -> String {
    let mut spoken = answer.to_owned();
    for (of_several, of_one) in OF_ONE {
        // Lower case may have another length in other scripts; such words are none of these.
        while let Some(start) = spoken.to_ascii_lowercase().find(of_several) {
            spoken.replace_range(start..start + of_several.len(), of_one);
        }
    }
    spoken
}

/// What the reading of an answer says of several things. It settles them where it names the very people that were asked
/// about; whatever else it says may be true of one thing and not of another, and leaves them open.
pub fn read_joint_answer(reading: Reading, asked: OwnerSet) -> Reading {
    if reading.owners == asked { reading } else { Reading::default() }
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;
    use crate::captions::test_support::roster;
    use crate::dialogue::read_answer;
    use crate::support::set;

    #[rstest]
    #[case("They belong to Tom.", "it belongs to Tom.")]
    #[case("Yes, all of them, they're mine", "Yes, it's mine")]
    #[case("Bob and I share them", "Bob and I share it")]
    #[case("It is one of them", "It is one of them")]
    #[case("Ðorđe: they belong to İpek, ſ", "Ðorđe: it belongs to İpek, ſ")]
    fn several_are_spoken_of_as_one(#[case] answer: &str, #[case] spoken: &str) {
        assert_eq!(as_of_one_thing(answer), spoken);
    }

    #[rstest]
    #[case("mug", Some("kitchen"), &[2], "Is every mug in the kitchen Tom's?")]
    #[case("pencil", None, &[2], "Is every pencil Tom's?")]
    #[case("scissors", Some("study"), &[0, 1], "Do Bob and Mary share the scissors in the study?")]
    #[case("mug", Some("kitchen"), &[0, 1, 2], "Do you all share every mug in the kitchen?")]
    fn a_yes_settles_all_and_anything_else_leaves_them_open(
        #[case] class: &str,
        #[case] room: Option<&str>,
        #[case] asked: &[usize],
        #[case] question: &str,
    ) {
        let roster = roster(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")]);
        let worded = word_joint_question(&roster, class, room, set(asked));
        assert_eq!(worded, question);
        let read = |answer| {
            let answer = as_of_one_thing(answer);
            read_joint_answer(read_answer(&roster, &worded, &answer, None), set(asked))
        };
        for yes in ["Yes.", "Yes, all of them.", "Yes, every one of them!", "yes"] {
            assert_eq!(read(yes), Reading { owners: set(asked), outside_household: false }, "{yes}");
        }
        for open in
            ["No.", "No, they are not all the same person's.", "I don't know.", "Some are a neighbour's."]
        {
            assert!(read(open).is_unresolved(), "{open}");
        }
    }
}
