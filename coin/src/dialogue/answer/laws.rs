use proptest::prelude::*;

use super::{Reading, read_answer};
use crate::captions::test_support::roster;
use crate::owners::OwnerSet;
use crate::roster::Roster;

const QUESTIONS: [&str; 4] = [
    "Whose is the mug?",
    "Is the mug Bob's, or does it belong to someone else?",
    "Does the mug belong to Bob or Mary, or to someone else?",
    "Do Bob and Mary share the mug, or does it belong to just one of them?",
];

fn family() -> Roster {
    roster(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")])
}

/// Answers made of the reader's own words, which reach more of its rules than random letters do.
fn babble() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "Bob",
        "Mary",
        "Tom",
        "Bob's",
        "Mary's",
        "Tom's",
        "the father's",
        "my",
        "wife's",
        "mine",
        "ours",
        "we",
        "all",
        "everyone",
        "nobody",
        "both",
        "they",
        "it",
        "is",
        "isn't",
        "it's",
        "not",
        "only",
        "and",
        "or",
        "but",
        "except",
        "belongs to",
        "owns",
        "uses",
        "shares",
        "lets",
        "borrows",
        "from",
        "with",
        "in",
        "room",
        "a guest's",
        "friend",
        "maybe",
        "I think",
        "yes",
        "no",
        "actually",
        "now",
        "too",
        "was",
        "of",
        ",",
        ".",
        "?",
        "Steve's",
        "mug",
        "his",
        "sister's",
        "neither",
        "nor",
        "one of",
        "who",
        "none of us",
        "as well as",
        "/",
        "&",
        "- ",
    ]);
    prop::collection::vec(words, 0..12).prop_map(|words| words.join(" "))
}

/// Those among them that the reader does not know.
const UNKNOWN: [&str; 4] = ["Steve's", "friend", "mug", "room"];

fn rename(text: &str) -> String {
    // The new names stand in another order than the old ones.
    text.replace("Bob", "Zacharias").replace("Mary", "Änne-Sophie").replace("Tom", "Mia Lou")
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(question in any::<String>(), answer in any::<String>()) {
        let reading = read_answer(&family(), &question, &answer, family().indices().next());
        prop_assert!(reading.owners.is_subset(family().everyone()));
    }

    #[test]
    fn babble_does_not_make_it_panic(question in babble(), answer in babble()) {
        let reading = read_answer(&family(), &question, &answer, None);
        prop_assert!(reading.owners.is_subset(family().everyone()));
        prop_assert_eq!(reading.is_unresolved(), reading == Reading::default());
    }

    #[test]
    fn who_is_not_named_alone_or_in_a_group_is_no_owner(answer in babble(), question in 0..QUESTIONS.len()) {
        let roster = roster(&[("Bob", ""), ("Mary", ""), ("Tom", ""), ("Xenia", "")]);
        let reading = read_answer(&roster, QUESTIONS[question], &answer, None);
        let groups = ["ours", "we", "all", "everyone", "nobody", "both", "they", "us"];
        let spoken = format!("{} {answer}", QUESTIONS[question]);
        let grouped = spoken.split([' ', '.', ',']).any(|word| groups.contains(&word));
        for user in reading.owners.iter() {
            prop_assert!(grouped || spoken.contains(roster.name(user).as_str()), "{}", answer);
        }
    }

    #[test]
    fn another_name_is_another_owner_and_nothing_else(
        answer in babble(),
        question in 0..QUESTIONS.len(),
        speaker in prop::option::of(0..3_usize),
    ) {
        let old = family();
        let new = roster(&[("Zacharias", "father"), ("Änne-Sophie", "mother"), ("Mia Lou", "son")]);
        let renamed = |user| new.index_of(&rename(old.name(user).as_str())).unwrap();
        let speaker = speaker.and_then(|place| old.indices().nth(place));
        let reading = read_answer(&old, QUESTIONS[question], &answer, speaker);
        let expected =
            Reading { owners: reading.owners.iter().map(renamed).collect::<OwnerSet>(), ..reading };
        let seen = read_answer(&new, &rename(QUESTIONS[question]), &rename(&answer), speaker.map(renamed));
        prop_assert_eq!(seen, expected);
    }

    /// A capital letter makes a stranger of a word that the reader does not know ("Bob and Steve"). Those that it knows
    /// mean the same in any letters.
    #[test]
    fn known_words_mean_the_same_in_capitals(answer in babble(), question in 0..QUESTIONS.len()) {
        let read = |answer: &str| read_answer(&family(), QUESTIONS[question], answer, None);
        let known = UNKNOWN.iter().fold(answer, |answer, word| answer.replace(word, ""));
        prop_assert_eq!(read(&known.to_lowercase()), read(&known));
        prop_assert_eq!(read(&known.to_uppercase()), read(&known));
    }

    #[test]
    fn a_list_of_names_is_its_set(members in prop::collection::vec(0..3_usize, 1..6)) {
        let roster = family();
        let users: Vec<_> = members.iter().filter_map(|&place| roster.indices().nth(place)).collect();
        let names: Vec<&str> = users.iter().map(|&user| roster.name(user).as_str()).collect();
        let expected = Reading { owners: users.iter().copied().collect(), outside_household: false };
        for answer in [
            names.join(" and "),
            names.join(", "),
            format!("It belongs to {}.", names.join(" and ")),
            format!("{} own it", names.join(" and ")),
            format!("It's {}'s", names.join("'s, ")),
        ] {
            prop_assert_eq!(read_answer(&roster, QUESTIONS[0], &answer, None), expected, "{}", answer);
        }
    }

    #[test]
    fn a_question_mark_takes_an_owner_back(answer in babble()) {
        let spoken = format!("{} ?", answer.replace(['.', '?'], "").replace("- ", ""));
        let reading = read_answer(&family(), QUESTIONS[0], &spoken, None);
        prop_assert!(reading.is_unresolved());
    }
}
