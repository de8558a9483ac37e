//! How fast a thing is found by words in a large map.
//!
//! `cargo bench -p coin` prints the figures. The owners are at hand, so that reading and comparing is what is measured.

#![expect(clippy::unwrap_used, reason = "a benchmark stops at the first fault")]

use std::collections::BTreeMap;
use std::convert::Infallible;

use coin::referring::{MappedThing, find, likenesses};
use coin::roster::{Roster, UserIndex};
use coin_schemas::household::{Background, ObjectId, Position, Score, UserName};
use divan::Bencher;

fn main() {
    divan::main();
}

const CLASSES: [&str; 12] = [
    "mug",
    "red cup",
    "book",
    "kettle",
    "phone charger",
    "desk",
    "towel",
    "laptop",
    "slippers",
    "umbrella",
    "lamp",
    "deck of cards",
];
const ROOMS: [&str; 4] = ["kitchen", "study", "living room", "bedroom"];
const REQUESTS: [&str; 6] = [
    "bring me my cup",
    "a mug",
    "Mary's red cup in the kitchen",
    "the book on my desk",
    "my violin",
    "my things next to the lamp",
];

struct Map {
    roster: Roster,
    ids: Vec<ObjectId>,
    scores: [Vec<Score>; 2],
}

impl Map {
    fn new(things: usize) -> Self {
        let users: BTreeMap<UserName, Background> = ["Bob", "Mary"]
            .into_iter()
            .map(|name| (UserName::new(name).unwrap(), Background::default()))
            .collect();
        let ids = (0..things).map(|thing| ObjectId::new(thing.to_string()).unwrap()).collect();
        let scores = [vec![Score::ONE, Score::ZERO], vec![Score::ZERO, Score::ONE]];
        Self { roster: Roster::new(&users).unwrap(), ids, scores }
    }

    /// Things on a square, 30 cm apart, of twelve labels and in four rooms.
    fn things(&self) -> Vec<MappedThing<'_>> {
        let side = (self.ids.len() as f64).sqrt();
        self.ids
            .iter()
            .enumerate()
            .map(|(place, id)| {
                let (row, column) = ((place as f64 / side).floor(), place as f64 % side);
                MappedThing {
                    id,
                    class: CLASSES[place * 7 % CLASSES.len()],
                    room: Some(ROOMS[place * 5 / 3 % ROOMS.len()]),
                    position: Position::new([row * 0.3, column * 0.3, (place % 3) as f64 * 0.4]).unwrap(),
                    likeness: None,
                }
            })
            .collect()
    }
}

#[divan::bench(args = [34, 1_000, 100_000], consts = [0, 1, 2, 3, 4, 5])]
fn find_by_words<const REQUEST: usize>(bencher: Bencher<'_, '_>, things: usize) {
    let map = Map::new(things);
    let things = map.things();
    let speaker = UserIndex::new(0);
    bencher.bench(|| {
        let scores = |thing: usize| Ok::<_, Infallible>(map.scores[thing / 12 % 2].clone());
        find(&map.roster, &things, REQUESTS[REQUEST], speaker, scores)
    });
}

#[divan::bench(args = [34, 1_000, 100_000])]
fn bring_cosines_to_likenesses(bencher: Bencher<'_, '_>, things: usize) {
    let cosines: Vec<Option<f64>> =
        (0..things).map(|thing| Some((thing * 7_919 % 1_009) as f64 / 1_009.0)).collect();
    bencher.bench(|| likenesses(&cosines));
}
