//! The class knowledge: its file is whole, and labels find their entries.

use std::collections::BTreeSet;

use coin_schemas::household::{Background, UserName, Users};
use rstest::rstest;

use super::{CLASSES, Tendency, entries, entry, expect, tendency};
use crate::roster::Roster;

#[test]
fn every_line_of_the_file_is_an_entry_and_no_name_stands_twice() {
    let mut seen = BTreeSet::new();
    for entry in entries(CLASSES) {
        for name in entry.unwrap().names {
            assert!(seen.insert(name), "{name} stands twice");
            assert_eq!(name, name.to_lowercase());
        }
    }
    assert!(seen.len() > 150, "only {} names", seen.len());
}

#[rstest]
#[case("Mug", Some(Tendency::Personal))]
#[case("coffee mug", Some(Tendency::Personal))]
#[case("socks", Some(Tendency::Personal))]
#[case("spectacles", Some(Tendency::Personal))]
#[case("coffee maker", Some(Tendency::Shared))]
#[case("water bottle", Some(Tendency::Personal))]
#[case("remote_control", Some(Tendency::Shared))]
#[case("T-shirt", Some(Tendency::Personal))]
#[case("zorblax", None)]
#[case("", None)]
fn labels_find_their_entries(#[case] class: &str, #[case] expected: Option<Tendency>) {
    assert_eq!(tendency(class), expected);
}

#[rstest]
#[case("mug | personal")]
#[case("mug | mine |")]
#[case(" | shared |")]
#[case("mug | shared | a | b")]
fn a_malformed_line_is_none(#[case] line: &'static str) {
    assert_eq!(entry(line), None);
}

fn roster(people: &[(&str, &str, &str)]) -> Roster {
    let users: Users = people
        .iter()
        .map(|(name, role, occupation)| {
            let background =
                Background { role: Some((*role).to_owned()), occupation: Some((*occupation).to_owned()) };
            (UserName::new(*name).unwrap(), background)
        })
        .collect();
    Roster::new(&users).unwrap()
}

#[test]
fn a_role_or_an_occupation_suits_by_whole_words() {
    let home = roster(&[
        ("Bob", "father", "office worker"),
        ("Mary", "grandmother", "retired"),
        ("Tom", "son", "elementary school student"),
    ]);
    assert_eq!(expect("textbook", &home).unwrap().suitability, [1.0, 1.0, 3.0]);
    assert_eq!(expect("tie", &home).unwrap().suitability, [3.0, 1.0, 1.0]);
    assert_eq!(expect("mug", &home).unwrap().suitability, [1.0, 1.0, 1.0]);
    // "grandmother" holds "mother", and is another word.
    assert_eq!(expect("apron", &home).unwrap().suitability, [1.0, 1.0, 1.0]);
    assert_eq!(expect("zorblax", &home), None);
}
