use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::captions::test_support::roster;
use crate::dialogue::{Reading, read_answer};
use crate::owners::OwnerSet;

const NAMES: [(&str, &str); 4] = [("Bob", "father"), ("Mary", "mother"), ("Tom", "son"), ("Uma", "daughter")];

fn ask(class: &str, room: Option<&str>, scores: &[f64], times_asked: u32) -> String {
    let roster = roster(&NAMES[..scores.len()]);
    let scores: Vec<Score> = scores.iter().map(|&score| Score::new(score).unwrap()).collect();
    let position = [12.4686, 2.9626, 1.1051];
    word_question(&QuestionContext { roster: &roster, class, room, position, scores: &scores, times_asked })
}

#[rstest]
#[case::one(&[0.9, 0.1, 0.0], 0, "Is the mug in the kitchen Bob's, or does it belong to someone else?")]
#[case::which(&[0.6, 0.4, 0.0], 0, "Does the mug in the kitchen belong to Bob or Mary, or to someone else?")]
#[case::likeliest_first(&[0.1, 0.3, 0.4], 0, "Does the mug in the kitchen belong to Tom or Mary, or to someone else?")]
#[case::nothing_known(&[0.0, 0.0, 0.0], 0, "Does the mug in the kitchen belong to Bob or Mary, or to someone else?")]
#[case::pair(&[0.8, 0.7, 0.1], 0, "Do Bob and Mary share the mug in the kitchen, or does it belong to just one of them?")]
#[case::all(&[0.8, 0.7, 0.9], 0, "Do you all share the mug in the kitchen, or is it just Tom's or Bob's?")]
#[case::couple(&[0.5, 0.4], 0, "Is the mug in the kitchen Bob's or Mary's, or do they share it?")]
#[case::sure_couple(&[0.9, 0.1], 0, "Is the mug in the kitchen just Bob's, or is it Mary's too?")]
#[case::sharing_couple(&[0.9, 0.8], 0, "Do Bob and Mary share the mug in the kitchen, or does it belong to just one of them?")]
#[case::single(&[0.4], 0, "Is the mug in the kitchen Bob's, or does it belong to someone else?")]
#[case::again(&[0.9, 0.1, 0.0], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Bob or someone else?")]
#[case::again_which(&[0.6, 0.4, 0.0], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Bob, Mary or someone else?")]
#[case::again_pair(&[0.8, 0.7, 0.1], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Bob, Mary, both or someone else?")]
#[case::again_all(&[0.8, 0.7, 0.9], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Tom, Bob or all of you?")]
#[case::again_couple(&[0.5, 0.4], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Bob, Mary or both?")]
#[case::again_single(&[0.5], 1, "Sorry to ask again: who does the mug in the kitchen belong to, Bob or someone from outside?")]
#[case::and_again(&[0.9, 0.1, 0.0], 7, "Sorry, I still do not know this: who does the mug in the kitchen belong to, Bob or someone else?")]
fn the_scores_tell_what_is_asked(#[case] scores: &[f64], #[case] times_asked: u32, #[case] question: &str) {
    assert_eq!(ask("mug", Some("kitchen"), scores, times_asked), question);
}

#[rstest]
#[case(
    "scissors",
    Some("kitchen"),
    "Are the scissors in the kitchen Bob's, or do they belong to someone else?"
)]
#[case("pants", None, "Are the pants Bob's, or do they belong to someone else?")]
#[case("Marker", None, "Is the marker Bob's, or does it belong to someone else?")]
#[case("drinking glass", None, "Is the drinking glass Bob's, or does it belong to someone else?")]
#[case("deck of cards", None, "Is the deck of cards Bob's, or does it belong to someone else?")]
#[case("basket for clothes", None, "Is the basket for clothes Bob's, or does it belong to someone else?")]
#[case(
    "cd player",
    Some("living_room"),
    "Is the CD player in the living room Bob's, or does it belong to someone else?"
)]
#[case("iPhone", Some("the office"), "Is the iPhone in the office Bob's, or does it belong to someone else?")]
#[case("mug", Some("Mary's room"), "Is the mug in Mary's room Bob's, or does it belong to someone else?")]
#[case("chair", Some("Balcony"), "Is the chair on the balcony Bob's, or does it belong to someone else?")]
#[case("object", Some("hall"), "Is the thing in the hall Bob's, or does it belong to someone else?")]
#[case("mug", Some("  "), "Is the mug Bob's, or does it belong to someone else?")]
#[case(
    "unknown",
    None,
    "Is the thing at 12.5, 3.0, 1.1 metres on my map Bob's, or does it belong to someone else?"
)]
fn the_thing_is_called_as_people_call_it(
    #[case] class: &str,
    #[case] room: Option<&str>,
    #[case] question: &str,
) {
    assert_eq!(ask(class, room, &[0.9, 0.1, 0.0], 0), question);
}

/// The classes of the public HOMER routines that take "are".
#[rstest]
#[case(&["gloves", "painkillers", "pajamas", "pants", "socks", "spectacles", "scissors", "glasses", "keys"], "Are")]
#[case(&["bread", "chessboard", "cloth napkin", "dress", "milk", "underwear", "wine glass", "bus", "tooth paste", "lens"], "Is")]
fn the_verb_agrees(#[case] classes: &[&str], #[case] verb: &str) {
    for class in classes {
        let question = ask(class, None, &[0.9, 0.1, 0.0], 0);
        assert!(question.starts_with(verb), "{question}");
    }
}

/// What the robot asks, "yes" answers, or it is left open which of several is meant.
#[rstest]
#[case(&[0.9, 0.1, 0.0], &[0])]
#[case(&[0.6, 0.4, 0.0], &[])]
#[case(&[0.8, 0.7, 0.1], &[0, 1])]
#[case(&[0.8, 0.7, 0.9], &[0, 1, 2])]
#[case(&[0.5, 0.4], &[])]
#[case(&[0.9, 0.8], &[0, 1])]
#[case(&[0.9], &[0])]
fn a_yes_to_the_question_is_understood(#[case] scores: &[f64], #[case] owners: &[usize]) {
    let question = ask("mug", Some("kitchen"), scores, 0);
    let roster = roster(&NAMES[..scores.len()]);
    let owners: OwnerSet = owners.iter().filter_map(|&place| UserIndex::new(place)).collect();
    assert_eq!(
        read_answer(&roster, &question, "Yes.", None),
        Reading { owners, outside_household: false },
        "{question}"
    );
}

proptest! {
    #[test]
    fn every_question_is_one_sentence_that_names_the_thing_and_the_likeliest(
        scores in prop::collection::vec(0.0..=1.0_f64, 1..5),
        times_asked in 0..4_u32,
    ) {
        let question = ask("red mug", Some("hall"), &scores, times_asked);
        prop_assert!(question.ends_with('?'));
        prop_assert_eq!(question.matches(['?', '.', '!']).count(), 1);
        prop_assert!(question.contains("the red mug in the hall"));
        let best = scores.iter().enumerate().fold(0, |best, (place, &score)| if score > scores[best] { place } else { best });
        prop_assert!(question.contains(NAMES[best].0));
        let named = NAMES.iter().filter(|(name, _)| question.contains(name)).count();
        prop_assert!((1..=2).contains(&named));
        prop_assert!(!question.contains(|letter: char| letter.is_ascii_digit()));
        prop_assert_eq!(&question, &ask("red mug", Some("hall"), &scores, times_asked));
        prop_assert_eq!(times_asked > 0, question.starts_with("Sorry"));
    }

    #[test]
    fn no_label_and_no_room_makes_it_panic(class in any::<String>(), room in prop::option::of(any::<String>())) {
        let question = ask(&class, room.as_deref(), &[0.4, 0.3, 0.1], 0);
        prop_assert!(question.ends_with('?'));
    }
}
