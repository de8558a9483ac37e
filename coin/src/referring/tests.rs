//! What is said to a person, and what a decision is made of beyond the owners of the fixtures.

use coin_schemas::household::{ObjectId, Position, Score};
use rstest::rstest;

use super::judged_tests::{Home, find_among};
use super::{Decision, Finding, MappedThing, find};
use crate::captions::test_support::roster;
use crate::roster::Roster;
use crate::support::{id, scores, user};

fn words(decision: Decision) -> String {
    match decision {
        Decision::Found(id) => format!("found {id}"),
        Decision::Ambiguous { question, .. } => question,
        Decision::None { reason, .. } => reason,
    }
}

fn said(home: &str, speaker: Option<&str>, request: &str) -> String {
    let home = Home::read(home, 1.0);
    let speaker = speaker.map(|name| home.roster.index_of(name).unwrap());
    words(home.find(&home.things(), request, speaker).decision)
}

#[rstest]
#[case("small-house", Some("Bob"), "a mug", "Whose mug do you mean: Mary's or Tom's?")]
#[case("small-house", None, "my towel", "Whose towel do you mean: Mary's or Tom's?")]
#[case("three-things", None, "my mug", "I know only the mug in the study, which is Bob's. Who are you?")]
#[case("shared-flat", Some("Anna"), "the laptop", "Whose laptop do you mean: Ben's or Chloe's?")]
#[case("shared-flat", Some("Chloe"), "the mug", "Which one do you mean: the red mug or the blue mug?")]
#[case(
    "shared-flat",
    Some("Anna"),
    "my umbrella",
    "I know 2 like the umbrella in the hallway and cannot tell them apart. Will any of them do?"
)]
#[case(
    "shared-flat",
    Some("Anna"),
    "our scissors",
    "Whose scissors do you mean: Anna and Ben's or everybody's?"
)]
#[case(
    "three-generations",
    Some("Paul"),
    "my cup",
    "Which one do you mean: the cup in the kitchen or the cup in the living room?"
)]
#[case(
    "three-generations",
    Some("Max"),
    "the toothbrush",
    "Whose toothbrush do you mean: Lina's, Nora's, yours or Paul's?"
)]
#[case("three-generations", Some("Paul"), "the cup in the kitchen", "Whose cup do you mean: Eva's or yours?")]
#[case(
    "small-house",
    Some("Bob"),
    "my stuff",
    "Which one do you mean: the calculator, the jacket, the book, the keyboard or another one?"
)]
#[case(
    "small-house",
    Some("Bob"),
    "my mug",
    "I know of no mug of yours. I know the mug in the kitchen, which is Mary's, and the mug in the kitchen, which is Tom's."
)]
#[case(
    "small-house",
    Some("Mary"),
    "Tom's jacket",
    "I know of no jacket of Tom's. I know the jacket in the bedroom 1, which is Bob's."
)]
#[case(
    "small-house",
    Some("Tom"),
    "our car keys in the kitchen",
    "I know of no car keys there that you share. I know the car keys in the hallway, which are Mary and Tom's."
)]
#[case("small-house", Some("Bob"), "my violin", "I know of no violin.")]
#[case(
    "small-house",
    Some("Bob"),
    "Steve's umbrella",
    "I do not know whose umbrella you mean. I know the umbrella in the study, which is Mary's."
)]
#[case("small-house", Some("Bob"), "bring me that", "I do not know which thing is meant.")]
#[case(
    "shared-flat",
    Some("Ben"),
    "the green mug",
    "I know of no green mug. I know the red mug in the kitchen, which is Anna's, and the blue mug in the kitchen, which is yours."
)]
#[case(
    "shared-flat",
    Some("Anna"),
    "my scissors in the bathroom",
    "I know of no scissors of yours there. I know the scissors in the living room, which are Anna and Ben's, and the scissors in the kitchen, which are everybody's."
)]
fn a_person_is_told(
    #[case] home: &str,
    #[case] speaker: Option<&str>,
    #[case] request: &str,
    #[case] words: &str,
) {
    assert_eq!(said(home, speaker, request), words);
}

/// Things of Bob (the father) and Mary (the mother): class, room, place on a line in metres, scores.
struct Map {
    roster: Roster,
    ids: Vec<ObjectId>,
    things: Vec<(&'static str, Option<&'static str>, f64, Vec<Score>)>,
}

impl Map {
    fn new(things: &[(&'static str, Option<&'static str>, f64, [f64; 2])]) -> Self {
        Self {
            roster: roster(&[("Bob", "father"), ("Mary", "mother")]),
            ids: (1..=things.len()).map(|place| id(&place.to_string())).collect(),
            things: things
                .iter()
                .map(|&(class, room, along, values)| (class, room, along, scores(&values)))
                .collect(),
        }
    }

    fn things(&self) -> Vec<MappedThing<'_>> {
        self.ids
            .iter()
            .zip(&self.things)
            .map(|(id, (class, room, along, _))| MappedThing {
                id,
                class,
                room: *room,
                position: Position::new([*along, 0.0, 0.0]).unwrap(),
                likeness: None,
            })
            .collect()
    }

    /// Bob speaks.
    fn find(&self, things: &[MappedThing<'_>], request: &str) -> Finding {
        find_among(&self.roster, things, |thing| self.things[thing].3.clone(), request, Some(user(0)))
    }

    /// Bob speaks.
    fn say(&self, request: &str) -> String {
        words(self.find(&self.things(), request).decision)
    }
}

const BOBS: [f64; 2] = [1.0, 0.0];
const MARYS: [f64; 2] = [0.0, 1.0];

#[test]
fn neighbours_tell_equal_things_apart() {
    let map = Map::new(&[
        ("cup", Some("kitchen"), 0.0, BOBS),
        ("cup", Some("kitchen"), 4.0, BOBS),
        ("sink", Some("kitchen"), 0.3, [1.0, 1.0]),
        ("kettle", Some("kitchen"), 4.5, [1.0, 1.0]),
    ]);
    assert_eq!(map.say("my cup"), "Which one do you mean: the cup by the sink or the cup by the kettle?");
    assert_eq!(map.say("my cup by the sink"), "found 1");
    assert_eq!(map.say("my cup by the kettle"), "found 2");
}

#[test]
fn a_thing_of_a_doubtful_owner_is_asked_about() {
    let map = |own: f64| Map::new(&[("cup", Some("kitchen"), 0.0, [own, 1.0 - own])]);
    assert_eq!(map(0.8).say("my cup"), "found 1");
    assert_eq!(map(0.79).say("my cup"), "Is the cup in the kitchen yours?");
    assert_eq!(map(0.21).say("my cup"), "Is the cup in the kitchen yours?");
    assert_eq!(
        map(0.1).say("my cup"),
        "I know of no cup of yours. I know the cup in the kitchen, which is Mary's."
    );
}

#[test]
fn the_word_itself_comes_before_a_kind_and_an_owner_before_both() {
    let map = |cup: [f64; 2]| Map::new(&[("mug", None, 0.0, BOBS), ("cup", None, 5.0, cup)]);
    assert_eq!(map(BOBS).say("my cup"), "found 2");
    assert_eq!(map(MARYS).say("my cup"), "found 1");
    assert_eq!(map(MARYS).say("the cup"), "found 2");
    assert_eq!(map(MARYS).say("Mary's mug"), "found 2");
}

#[test]
fn what_a_thing_looks_like_counts_where_its_label_does_not() {
    let map = Map::new(&[("object", None, 0.0, BOBS), ("object", None, 5.0, MARYS)]);
    let mut things = map.things();
    let decision = |things: &[MappedThing<'_>], said: &str| words(map.find(things, said).decision);
    assert_eq!(decision(&things, "my violin"), "I know of no violin.");
    for thing in &mut things {
        thing.likeness = Some(Score::new(0.9).unwrap());
    }
    assert_eq!(decision(&things, "my violin"), "found 1");
    assert_eq!(decision(&things, "Mary's violin"), "found 2");
}

#[test]
fn matches_come_with_their_numbers_the_best_first() {
    let map =
        Map::new(&[("mug", None, 0.0, [0.5, 0.5]), ("cup", None, 1.0, BOBS), ("book", None, 0.0, BOBS)]);
    let finding = map.find(&map.things(), "my cup next to the book");
    let [cup, mug] = finding.matches.as_slice() else { panic!("{finding:?}") };
    // exp(−½) one metre away; fits of 1 and of 0.8 · ½ + 0.2 · ½ · ½.
    let beside = 0.606_530_659_712_633_4;
    assert_eq!((cup.id.as_str(), cup.matched, cup.ownership), ("2", 1.0, Some(1.0)));
    assert!((cup.place - beside).abs() < 1e-15 && (cup.score - beside).abs() < 1e-15);
    assert_eq!((mug.id.as_str(), mug.matched, mug.place, mug.ownership), ("1", 0.8, 1.0, Some(0.5)));
    assert!((mug.score - 0.8 * 0.45).abs() < 1e-15);
}

#[test]
fn an_empty_home_has_nothing() {
    assert_eq!(Map::new(&[]).say("my cup"), "I know of no cup.");
}

/// Owners are asked for once, and only where an answer depends on them.
#[rstest]
#[case("my cup", &["1", "2"])]
#[case("my cup in the kitchen", &["1", "2"])]
#[case("the cup", &["1", "2"])]
#[case("the book", &[])]
#[case("the book next to my cup", &["1", "2"])]
#[case("my violin", &[])]
#[case("the red book", &[])]
#[case("the teapot", &[])]
fn owners_are_judged_only_where_they_count(#[case] said: &str, #[case] expected: &[&str]) {
    let map = Map::new(&[
        ("cup", Some("kitchen"), 0.0, BOBS),
        ("cup", Some("kitchen"), 4.0, MARYS),
        ("book", None, 0.0, BOBS),
    ]);
    let mut asked = Vec::new();
    let scores = |thing: usize| {
        asked.push(map.ids[thing].as_str());
        Ok::<_, std::convert::Infallible>(map.things[thing].3.clone())
    };
    assert!(find(&map.roster, &map.things(), said, Some(user(0)), scores).is_ok());
    assert_eq!(asked, expected);
}

#[test]
fn a_failure_to_judge_an_owner_is_passed_on() {
    let map = Map::new(&[("cup", None, 0.0, BOBS)]);
    let failed = find(&map.roster, &map.things(), "my cup", Some(user(0)), |_| Err("no owners"));
    assert_eq!(failed, Err("no owners"));
}
