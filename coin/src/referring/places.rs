//! Where a request says that the thing is.

use std::collections::HashSet;

use coin_schemas::household::Score;

use super::interpretation::{Hint, NounPhrase, Relation};
use super::labels::{LabelFits, joined, words_of};
use super::ownership::KnownOwners;
use super::synonyms::{Kinship, kinship};
use super::{LEAST_MATCH, MappedThing, RIVAL, SURE};
use crate::space::{distance, weight};

/// What lies next to something lies within an arm's length of it: at this distance in metres a thing still counts
/// exp(−½) ≈ 0.61, and from 1.18 m on less than half.
const ARM: f64 = 1.0;

/// Nothing lies next to what is further away than this, in metres: there a thing would count exp(−8) < 0.0004.
const FAR: f64 = 4.0;

/// Heights are known to about this, in metres. A thing on another is at least as high as it and a thing under another
/// lower by this at least, wherever the map has the middle of either; what misses that by as much again counts
/// exp(−½) ≈ 0.61, and by 12 cm less than half.
const HEIGHT: f64 = 0.1;

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

/// A place that a request names, found in the map.
pub(super) enum Place<'a> {
    /// Rooms: those of this name.
    Rooms(HashSet<&'a str>),
    /// Beside, on or under one of these things, which stand by their first coordinate.
    Beside {
        /// How.
        relation: Relation,
        /// The things.
        anchors: Vec<Anchor>,
    },
    /// Nothing that the map knows.
    Unknown,
}

impl<'a> Place<'a> {
    /// Finds the place of a hint; `owners` where it names another thing with its owner.
    pub(super) fn locate<E, F: FnMut(usize) -> Result<Vec<Score>, E>>(
        things: &[MappedThing<'a>],
        hint: &Hint,
        owners: &mut KnownOwners<F>,
    ) -> Result<Self, E> {
        let asked = joined(&hint.place);
        let is_asked = |room: &str| {
            let room = joined(&words_of(room));
            room == asked || kinship(&room, &asked) == Some(Kinship::Same)
        };
        let mut rooms: HashSet<&str> = things.iter().filter_map(|thing| thing.room).collect();
        rooms.retain(|room| is_asked(room));
        let is_room = !rooms.is_empty() || ROOMS.iter().any(|room| is_asked(room));
        if is_room && hint.relation == Relation::In {
            return Ok(Self::Rooms(rooms));
        }
        let anchors = anchors(things, &hint.anchor, owners)?;
        if anchors.is_empty() {
            return Ok(if is_room { Self::Rooms(rooms) } else { Self::Unknown });
        }
        Ok(Self::beside(things, hint.relation, anchors))
    }

    fn beside(things: &[MappedThing<'_>], relation: Relation, anchors: Vec<usize>) -> Self {
        let mut anchors: Vec<Anchor> = anchors.into_iter().map(|thing| Anchor::of(things, thing)).collect();
        anchors.sort_by(|left, right| left.plan[0].total_cmp(&right.plan[0]));
        Self::Beside { relation, anchors }
    }

    /// How well the thing's place fits, 0…1. A place that the map does not know says nothing and counts 1.
    pub(super) fn fit(&self, things: &[MappedThing<'_>], thing: usize) -> f64 {
        match self {
            Self::Unknown => 1.0,
            Self::Rooms(rooms) => match things[thing].room {
                Some(room) if !rooms.contains(room) => 0.0,
                _ => 1.0,
            },
            Self::Beside { relation, anchors } => beside(things, thing, *relation, anchors),
        }
    }
}

/// A thing beside which others may be, with its place on the floor plan at hand: there may be thousands to pass over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    thing: usize,
    plan: [f64; 2],
}

impl Anchor {
    fn of(things: &[MappedThing<'_>], thing: usize) -> Self {
        let [x, y, _] = things[thing].position.metres();
        Self { thing, plan: [x, y] }
    }
}

/// The best fit to any of the things, which is never the thing itself.
fn beside(things: &[MappedThing<'_>], thing: usize, relation: Relation, anchors: &[Anchor]) -> f64 {
    let [x, y] = Anchor::of(things, thing).plan;
    let first = anchors.partition_point(|anchor| anchor.plan[0] < x - FAR);
    anchors[first..]
        .iter()
        .take_while(|anchor| anchor.plan[0] <= x + FAR)
        .filter(|anchor| (anchor.plan[1] - y).abs() <= FAR && anchor.thing != thing)
        .map(|anchor| relation_fit(relation, &things[thing], &things[anchor.thing]))
        .fold(0.0, f64::max)
}

/// The paper's Gaussian weight of the distance, which for what is on or under a thing is that on the floor plan; 0 through
/// a wall.
fn relation_fit(relation: Relation, thing: &MappedThing<'_>, anchor: &MappedThing<'_>) -> f64 {
    if let (Some(room), Some(other)) = (thing.room, anchor.room)
        && room != other
    {
        return 0.0;
    }
    let lower = anchor.position.metres()[2] - thing.position.metres()[2];
    let missing = match relation {
        Relation::Near | Relation::In => {
            return weight(distance(thing.position, anchor.position, 1.0), ARM);
        }
        Relation::Above => lower,
        Relation::Below => HEIGHT - lower,
    };
    weight(distance(thing.position, anchor.position, 0.0), ARM) * weight(missing.max(0.0), HEIGHT)
}

/// The things that the words beside "next to" may mean: the best ones by label, of the owner they name.
fn anchors<E, F: FnMut(usize) -> Result<Vec<Score>, E>>(
    things: &[MappedThing<'_>],
    anchor: &NounPhrase,
    owners: &mut KnownOwners<F>,
) -> Result<Vec<usize>, E> {
    if anchor.class.is_empty() {
        return Ok(Vec::new());
    }
    let mut fits = LabelFits::new(&anchor.class);
    let mut described = Vec::new();
    for (place, thing) in things.iter().enumerate() {
        let fit = fits.of(thing.class).whole;
        if fit < LEAST_MATCH {
            continue;
        }
        let ownership = match anchor.owner.depends_on_owners() {
            true => anchor.owner.ownership(owners.of(place)?),
            false => anchor.owner.ownership(&[]),
        };
        if ownership.is_some_and(|owner| owner.probability >= SURE) {
            described.push((place, fit));
        }
    }
    let best = described.iter().map(|&(_, fit)| fit).fold(0.0, f64::max);
    Ok(described.into_iter().filter(|&(_, fit)| fit >= RIVAL * best).map(|(place, _)| place).collect())
}

#[cfg(test)]
mod tests;
