use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::captions::test_support::roster;
use crate::support::set;

fn household() -> Roster {
    roster(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")])
}

fn used(sessions: &[u64]) -> Grounds {
    let users = sessions
        .iter()
        .enumerate()
        .filter(|&(_, &sessions)| sessions > 0)
        .map(|(place, &sessions)| UserGrounds {
            user: crate::support::user(place),
            sessions,
            days_ago: 0.8 + 2.0 * place as f64,
        })
        .collect();
    Grounds { users, relative: None }
}

fn inferred(owners: &[usize], confidence: f64, standing: Standing, others: &[usize]) -> Conclusion<'static> {
    Conclusion::Inferred { owners: set(owners), confidence, standing, others: set(others), model: None }
}

fn explained(class: &str, conclusion: Conclusion<'_>, grounds: Grounds) -> String {
    let roster = household();
    explain(&Explained {
        roster: &roster,
        class,
        room: Some("office"),
        position: [0.0; 3],
        conclusion,
        grounds,
    })
}

#[rstest]
#[case::settled(
    "marker", inferred(&[0], 0.9712, Standing::Settled, &[]), used(&[3, 1, 0]),
    "The marker in the office almost certainly belongs to Bob (97 %). Bob used it in 3 sessions (last within a day) and Mary in 1 session (last 3 days ago)."
)]
#[case::open(
    "scissors", inferred(&[0], 0.541, Standing::Open, &[1, 2]), used(&[1, 0, 0]),
    "The scissors in the office most probably belong to Bob (54 %), but Mary or Tom may own them too. Bob used them in 1 session (last within a day)."
)]
#[case::open_without_rivals(
    "sofa", inferred(&[0, 1, 2], 0.8, Standing::Open, &[]), used(&[0, 0, 0]),
    "The sofa in the office is most probably shared by everybody (80 %), which is not sure enough to act on. Nobody was seen using it; such things are mostly everybody's."
)]
#[case::pair(
    "marker", inferred(&[0, 2], 0.9999, Standing::Settled, &[]), used(&[9, 0, 9]),
    "The marker in the office is almost certainly shared by Bob and Tom (over 99 %). Bob used it in 9 sessions (last within a day) and Tom in 9 sessions (last 5 days ago)."
)]
fn an_inference_is_told_with_its_doubt_and_its_grounds(
    #[case] class: &str,
    #[case] conclusion: Conclusion<'_>,
    #[case] grounds: Grounds,
    #[case] expected: &str,
) {
    assert_eq!(explained(class, conclusion, grounds), expected);
}

#[test]
fn an_outdated_answer_is_told_with_what_speaks_against_it() {
    let said = Reading { owners: set(&[2]), outside_household: false };
    let on = "2025-01-19".parse().unwrap();
    let by = Some(crate::support::user(1));
    let outdated = Conclusion::Outdated { said, by, on, owners: set(&[0, 1]), confidence: 0.97 };
    assert_eq!(
        explained("scissors", outdated, Grounds::default()),
        "Mary said on 2025-01-19 that the scissors in the office belong to Tom, but judging by who has used them since, they are now shared by Bob and Mary (97 %). Only a person can tell whether they changed hands."
    );
}

#[test]
fn an_answer_is_told_with_its_words() {
    let reading = Reading { owners: set(&[1]), outside_household: false };
    let on = "2025-01-19".parse().unwrap();
    let by = Some(crate::support::user(1));
    let words = "It is\u{202e} mine,\nof course";
    let told = explained(
        "marker",
        Conclusion::Answered { reading, words, by, on, against: None },
        Grounds::default(),
    );
    assert_eq!(
        told,
        "Mary said on 2025-01-19 that the marker in the office belongs to Mary. The words were: \"It is\\u{202e} mine, of course\"."
    );
    let reading = Reading { owners: OwnerSet::EMPTY, outside_household: true };
    let told = explained(
        "marker",
        Conclusion::Answered { reading, words: "A guest's.", by: None, on, against: None },
        Grounds::default(),
    );
    assert_eq!(
        told,
        "A person said on 2025-01-19 that the marker in the office belongs to somebody outside the household. The words were: \"A guest's.\""
    );
}

#[test]
fn what_speaks_against_an_answer_is_told() {
    let reading = Reading { owners: set(&[1]), outside_household: false };
    let on = "2025-01-19".parse().unwrap();
    let against = Some(set(&[0, 2]));
    let told = explained(
        "marker",
        Conclusion::Answered { reading, words: "Mine.", by: Some(crate::support::user(1)), on, against },
        Grounds::default(),
    );
    assert_eq!(
        told,
        "Mary said on 2025-01-19 that the marker in the office belongs to Mary, although everything else that is known speaks for Bob and Tom. The words were: \"Mine.\""
    );
}

#[rstest]
#[case(SeenRelation::Near { distance: 0.42 }, "; the cup, 0.4 m away, belongs to Tom.")]
#[case(SeenRelation::LooksAlike, "; the cup, which looks alike, belongs to Tom.")]
fn a_thing_with_known_owners_is_told(#[case] relation: SeenRelation, #[case] expected: &str) {
    let relative = Some(RelativeGrounds { class: "cup".to_owned(), owners: set(&[2]), relation });
    let grounds = Grounds { relative, ..used(&[1, 0, 0]) };
    let told = explained("marker", inferred(&[0], 0.97, Standing::Settled, &[]), grounds);
    assert!(told.ends_with(expected), "{told}");
}

#[rstest]
#[case("claude", "says the model \"claude\"")]
#[case("", "says the model that scored it")]
fn a_model_is_named(#[case] model: &str, #[case] said: &str) {
    let conclusion = Conclusion::Inferred {
        owners: set(&[0]),
        confidence: 0.97,
        standing: Standing::Settled,
        others: OwnerSet::EMPTY,
        model: Some(model),
    };
    let told = explained("marker", conclusion, Grounds::default());
    let beginning = format!("The marker in the office almost certainly belongs to Bob (97 %, {said}).");
    assert!(told.starts_with(&beginning), "{told}");
}

proptest! {
    /// Nothing that is not certain is called certain, and nothing possible impossible.
    #[test]
    fn percents_keep_doubt(probability in 0.0..1.0_f64) {
        let told = percent(probability);
        prop_assert_ne!(&told, "100 %");
        prop_assert_ne!(&told, "0 %");
    }
}
