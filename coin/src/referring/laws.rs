//! Laws of finding things, over what people say in the fixtures and over made-up homes.

use coin_schemas::household::{ObjectId, Position, Score};
use proptest::prelude::*;

use super::judged_tests::{Expression, Home, expressions, find_among};
use super::{Decision, Finding, MappedThing, SURE};
use crate::captions::test_support::roster;
use crate::roster::{Roster, UserIndex};
use crate::support::{id, scores, user};

const FILES: [&str; 4] = ["expressions.txt", "winding.txt", "unseen.txt", "heights.txt"];

fn said() -> impl Strategy<Value = Expression> {
    let all: Vec<Expression> = FILES.into_iter().flat_map(expressions).collect();
    proptest::sample::select(all)
}

fn found(home: &Home, expression: &Expression, said: &str, things: &[MappedThing<'_>]) -> Finding {
    let speaker = expression.speaker.as_ref().map(|name| home.roster.index_of(name).unwrap());
    home.find(things, said, speaker)
}

/// The words with other capitals and other spaces.
fn retyped(said: &str, capitals: &[bool], spaces: &[u8]) -> String {
    let gaps = [" ", "  ", "\t", "   "];
    let mut text = String::from(gaps[usize::from(spaces[0]) % gaps.len()]);
    for (place, letter) in said.chars().enumerate() {
        if letter == ' ' {
            text.push_str(gaps[usize::from(spaces[place % spaces.len()]) % gaps.len()]);
        } else if capitals[place % capitals.len()] {
            text.extend(letter.to_uppercase());
        } else {
            text.extend(letter.to_lowercase());
        }
    }
    text
}

/// Class, place, room, and what the members' scores are made of.
type Thing<T> = (&'static str, [f64; 3], Option<&'static str>, Vec<T>);

/// A home of three people with cups, mugs and books of random owners at random places.
fn made_up() -> impl Strategy<Value = Vec<Thing<f64>>> {
    let class = proptest::sample::select(vec!["cup", "mug", "red cup", "book", "kettle"]);
    let room = proptest::option::of(proptest::sample::select(vec!["kitchen", "study"]));
    let thing = (class, [0.0..9.0, 0.0..9.0, 0.0..2.0], room, proptest::collection::vec(0.0..=1.0, 3));
    proptest::collection::vec(thing, 0..8)
}

const REQUESTS: [&str; 8] = [
    "my cup",
    "Mary's mug",
    "bring me dad's red cup",
    "our book",
    "the cup in the kitchen",
    "the book by the kettle",
    "a mug",
    "mom's stuff",
];

struct Map {
    roster: Roster,
    ids: Vec<ObjectId>,
    things: Vec<Thing<Score>>,
}

impl Map {
    fn new(things: Vec<Thing<f64>>) -> Self {
        let roster = roster(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")]);
        let ids = (0..things.len()).map(|place| id(&place.to_string())).collect();
        let things = things
            .into_iter()
            .map(|(class, position, room, values)| (class, position, room, scores(&values)))
            .collect();
        Self { roster, ids, things }
    }

    /// The things may stand in another order.
    fn find(&self, things: &[MappedThing<'_>], said: &str, speaker: Option<UserIndex>) -> Finding {
        let scores = |thing: usize| {
            let place = self.ids.iter().position(|id| id == things[thing].id).unwrap();
            self.things[place].3.clone()
        };
        find_among(&self.roster, things, scores, said, speaker)
    }

    fn things(&self) -> Vec<MappedThing<'_>> {
        self.ids
            .iter()
            .zip(&self.things)
            .map(|(id, (class, position, room, _))| MappedThing {
                id,
                class,
                room: *room,
                position: Position::new(*position).unwrap(),
                likeness: None,
            })
            .collect()
    }
}

proptest! {
    #[test]
    fn capitals_and_spaces_mean_nothing(
        expression in said(),
        capitals in proptest::collection::vec(any::<bool>(), 1..9),
        spaces in proptest::collection::vec(any::<u8>(), 1..5),
    ) {
        let home = Home::read(&expression.home, 1.0);
        let things = home.things();
        let plain = found(&home, &expression, &expression.said, &things);
        let retyped = found(&home, &expression, &retyped(&expression.said, &capitals, &spaces), &things);
        prop_assert_eq!(plain, retyped);
    }

    #[test]
    fn a_thing_that_nobody_speaks_of_changes_nothing_that_is_found(
        expression in said(),
        position in [0.0..13.0, 0.0..10.0, 0.0..2.0],
        room in proptest::option::of("[a-z]{3,8}"),
        owners in proptest::collection::vec(0.0..=1.0, 6),
    ) {
        let home = Home::read(&expression.home, 1.0);
        let mut things = home.things();
        let before = found(&home, &expression, &expression.said, &things);
        prop_assume!(!before.interpretation.thing.class.is_empty());
        let added = id("added");
        let owners = scores(&owners[..home.roster.len()]);
        things.push(MappedThing {
            id: &added,
            class: "zither",
            room: room.as_deref(),
            position: Position::new(position).unwrap(),
            likeness: None,
        });
        let speaker = expression.speaker.as_ref().map(|name| home.roster.index_of(name).unwrap());
        let scores = |thing: usize| home.scores.get(thing).unwrap_or(&owners).clone();
        let after = find_among(&home.roster, &things, scores, &expression.said, speaker);
        if let Decision::Found(_) = before.decision {
            prop_assert_eq!(before.decision, after.decision);
        }
        prop_assert_eq!(before.matches, after.matches);
    }

    #[test]
    fn nobody_gets_what_is_not_surely_theirs(things in made_up(), speaker in 0_usize..3) {
        let map = Map::new(things);
        for (said, owner) in [("my cup", speaker), ("bring me Mary's mug", 1), ("the father's book", 0), ("toms kettle", 2)] {
            let finding = map.find(&map.things(), said, Some(user(speaker)));
            if let Decision::Found(id) = finding.decision {
                let place = map.ids.iter().position(|other| *other == id).unwrap();
                prop_assert!(map.things[place].3[owner].value() >= SURE);
            }
        }
    }

    #[test]
    fn the_speakers_own_things_are_no_one_elses(things in made_up(), speaker in 0_usize..3) {
        let own = |mut thing: Thing<f64>| {
            thing.3 = (0..3).map(|place| if place == speaker { 1.0 } else { 0.0 }).collect();
            thing
        };
        let map = Map::new(things.into_iter().map(own).collect());
        for (other, name) in ["Bob's", "Mary's", "Tom's"].iter().enumerate().filter(|(other, _)| *other != speaker) {
            for noun in ["cup", "mug", "book", "things"] {
                let said = format!("bring me {name} {noun}");
                let finding = map.find(&map.things(), &said, Some(user(speaker)));
                let refused = matches!(finding.decision, Decision::None { .. });
                prop_assert!(refused, "{} {} {:?}", said, other, finding.decision);
            }
        }
    }

    #[test]
    fn the_order_of_the_map_changes_no_decision(things in made_up(), turned in 0_usize..8, request in 0..REQUESTS.len()) {
        let map = Map::new(things);
        let mut other = map.things();
        let turn = turned % other.len().max(1);
        other.rotate_left(turn);
        let decided = |things: &[MappedThing<'_>]| {
            match map.find(things, REQUESTS[request], Some(user(0))).decision {
                Decision::Found(id) => (0, vec![id]),
                Decision::Ambiguous { mut candidates, .. } => {
                    candidates.sort();
                    (1, candidates)
                }
                Decision::None { mut instead, .. } => {
                    instead.sort();
                    (2, instead)
                }
            }
        };
        prop_assert_eq!(decided(&map.things()), decided(&other));
    }

    #[test]
    fn numbers_are_between_nothing_and_one_and_questions_are_questions(things in made_up(), request in 0..REQUESTS.len()) {
        let map = Map::new(things);
        let finding = map.find(&map.things(), REQUESTS[request], Some(user(0)));
        match finding.decision {
            Decision::Found(_) => {}
            Decision::Ambiguous { question, .. } => prop_assert!(question.ends_with('?'), "{}", question),
            Decision::None { reason, .. } => prop_assert!(reason.ends_with('.'), "{}", reason),
        }
        for one in finding.matches {
            for value in [one.matched, one.place, one.score, one.ownership.unwrap_or(0.0)] {
                prop_assert!((0.0..=1.0).contains(&value));
            }
        }
    }

    #[test]
    fn any_text_is_read(said in "\\PC{0,60}", words in proptest::collection::vec(
        proptest::sample::select(vec!["my", "Mary's", "of", "and", "next to", "in", "the", "not", "whose", "cup", "kitchen", "to", "her", "our", "dad's", "owns", ","]), 0..9,
    )) {
        let map = Map::new(vec![("cup", [0.0; 3], Some("kitchen"), vec![1.0, 0.0, 0.0])]);
        for said in [said, words.join(" ")] {
            for speaker in [None, Some(user(1))] {
                map.find(&map.things(), &said, speaker);
            }
        }
    }
}
