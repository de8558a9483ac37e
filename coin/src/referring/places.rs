//! Where a request says that the thing is.

use super::interpretation::{Hint, NounPhrase, Relation};
use super::labels::{fit, joined, words_of};
use super::synonyms::{Kinship, kinship};
use super::{LEAST_MATCH, MappedThing, RIVAL, SURE};
use crate::space::{distance, weight};

/// What lies next to something lies within an arm's length of it: at this distance in metres a thing still counts
/// exp(−½) ≈ 0.61, and from 1.18 m on less than half.
const ARM: f64 = 1.0;

/// Words for rooms. A room that the map does not know still says that the thing is in no other.
const ROOMS: &[&str] = &[
    "kitchen",
    "living room",
    "bedroom",
    "bathroom",
    "hallway",
    "hall",
    "corridor",
    "study",
    "office",
    "garage",
    "cellar",
    "basement",
    "attic",
    "balcony",
    "terrace",
    "garden",
    "dining room",
    "nursery",
    "playroom",
    "pantry",
    "laundry room",
    "guest room",
    "toilet",
    "porch",
    "lobby",
    "entrance",
];

/// How well the thing's place fits all hints, 0…1: the product over the hints. A hint that names nothing the map knows
/// says nothing and counts 1.
pub(super) fn place_fit(things: &[MappedThing<'_>], thing: usize, hints: &[Hint]) -> f64 {
    hints.iter().map(|hint| hint_fit(things, thing, hint)).product()
}

fn hint_fit(things: &[MappedThing<'_>], thing: usize, hint: &Hint) -> f64 {
    let asked = joined(&hint.place);
    let is_asked = |room: &str| {
        let room = joined(&words_of(room));
        room == asked || kinship(&room, &asked) == Some(Kinship::Same)
    };
    let in_room = |room: Option<&str>| room.is_some_and(is_asked);
    let is_room = things.iter().any(|other| in_room(other.room)) || ROOMS.iter().any(|room| is_asked(room));
    if is_room && (hint.relation == Relation::In || anchors(things, &hint.anchor).is_empty()) {
        return match things[thing].room {
            Some(room) if !in_room(Some(room)) => 0.0,
            _ => 1.0,
        };
    }
    let anchors = anchors(things, &hint.anchor);
    anchors
        .iter()
        .filter(|&&anchor| anchor != thing)
        .map(|&anchor| nearness(&things[thing], &things[anchor]))
        .reduce(f64::max)
        .unwrap_or(1.0)
}

/// The paper's Gaussian weight of the distance; 0 through a wall.
fn nearness(thing: &MappedThing<'_>, anchor: &MappedThing<'_>) -> f64 {
    match (thing.room, anchor.room) {
        (Some(room), Some(other)) if room != other => 0.0,
        _ => weight(distance(thing.position, anchor.position, 1.0), ARM),
    }
}

/// The things that the words beside "next to" may mean: the best ones by label, of the owner they name.
fn anchors(things: &[MappedThing<'_>], anchor: &NounPhrase) -> Vec<usize> {
    if anchor.class.is_empty() {
        return Vec::new();
    }
    let fits: Vec<f64> = things
        .iter()
        .map(|thing| {
            let owned = anchor.owner.ownership(thing.scores).is_some_and(|owner| owner.probability >= SURE);
            if owned { fit(&anchor.class, &words_of(thing.class)).whole } else { 0.0 }
        })
        .collect();
    let best = fits.iter().copied().fold(0.0, f64::max);
    (0..things.len()).filter(|&place| fits[place] >= LEAST_MATCH && fits[place] >= RIVAL * best).collect()
}
