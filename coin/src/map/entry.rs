//! An entry of the map: one real thing, and every sighting it was made from.

use std::collections::{BTreeMap, BTreeSet};

use coin_schemas::household::ClassLabel;
use jiff::civil::DateTime;

use super::detection::{Seen, Sighting};
use super::gaussian::Gaussian;
use super::look::Look;

/// The id of an entry. It is never given twice, and stays with the thing when that is moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EntryId(pub u64);

/// The id of a sighting, in the order in which they arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SightingId(pub u64);

/// Where a thing is held to be, from the sightings since it was last moved.
///
/// With precisions λ_i = 1 / α r_i the entry is the Gaussian of precision λ = mean of the λ_i and of mean Σ λ_i p_i / Σ λ_i.
/// That is the one with the least Σ KL(G ‖ G_i), the normalised geometric mean of the G_i. α cancels: r is the harmonic
/// mean of the r_i. The extent says how large the thing is, so it does not shrink as views add up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The middle, `[x, y, z]` in metres.
    pub position: [f64; 3],
    /// Σ 1/r_i, in 1/metres.
    pub weight: f64,
    /// How many sightings it is made from.
    pub sightings: usize,
}

impl Place {
    fn new(sighting: &Sighting) -> Self {
        Self { position: sighting.position.metres(), weight: sighting.radius.recip(), sightings: 1 }
    }

    /// Fuses two places; each is worth the sightings that it was made from.
    fn absorb(&mut self, other: &Self) {
        let total = self.weight + other.weight;
        for (own, seen) in self.position.iter_mut().zip(other.position) {
            *own = (*own * self.weight + seen * other.weight) / total;
        }
        self.weight = total;
        self.sightings += other.sightings;
    }

    /// The harmonic mean of the radii, in metres.
    pub fn radius(&self) -> f64 {
        self.sightings as f64 / self.weight
    }

    /// N(p, α r I) with α = `spread` in metres.
    pub fn gaussian(&self, spread: f64) -> Gaussian {
        Gaussian { mean: self.position, variance: spread * self.radius() }
    }
}

/// That a thing was moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// Since when it has been seen at the new place.
    pub at: DateTime,
    /// The middle of the old place, in metres.
    pub from: [f64; 3],
}

/// One real thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Its id.
    pub id: EntryId,
    /// How many sightings called it what.
    pub classes: BTreeMap<ClassLabel, usize>,
    /// Where it is.
    pub place: Place,
    /// What it looks like; `None` where no sighting had a feature.
    pub look: Option<Look>,
    /// The earliest sighting.
    pub first_seen: DateTime,
    /// The latest sighting.
    pub last_seen: DateTime,
    /// Views in a row, up to now, that covered its place and did not show it.
    pub absences: usize,
    /// Where it was moved from, the latest move last.
    pub moves: Vec<Move>,
    /// Entries that a person said are other things; nothing joins it with them.
    pub told_apart: BTreeSet<EntryId>,
    /// Every sighting it was made from, each of another view.
    pub sightings: BTreeMap<SightingId, Sighting>,
    /// What a person or a recording calls the thing, whatever the detector says; `None` where it was only ever detected.
    pub recorded: Option<ClassLabel>,
}

/// Several sightings, with what they looked like as far as that is known.
pub(super) type Sightings = BTreeMap<SightingId, Seen>;

impl Entry {
    /// An entry of one sighting.
    pub(super) fn new(id: EntryId, number: SightingId, seen: Seen) -> Self {
        let Seen { sighting, feature } = seen;
        let weight = sighting.radius.recip();
        Self {
            id,
            classes: BTreeMap::from([(sighting.class.clone(), 1)]),
            place: Place::new(&sighting),
            look: feature.as_deref().map(|feature| Look::new(feature, weight)),
            first_seen: sighting.at,
            last_seen: sighting.at,
            absences: 0,
            moves: Vec::new(),
            told_apart: BTreeSet::new(),
            sightings: BTreeMap::from([(number, sighting)]),
            recorded: None,
        }
    }

    /// A thing that is known without having been detected; what is known of it counts as one sighting, and its class
    /// stays what it is.
    pub fn recorded(id: EntryId, number: SightingId, seen: Seen) -> Self {
        let recorded = Some(seen.sighting.class.clone());
        Self { recorded, ..Self::new(id, number, seen) }
    }

    /// The entry that some sightings make; `None` where there are none. Of `moves` those stay that have sightings
    /// before and after them.
    pub(super) fn from_sightings(id: EntryId, sightings: Sightings, moves: &[Move]) -> Option<Self> {
        let is_between = |moved: &&Move| {
            sightings.values().any(|seen| seen.sighting.at < moved.at)
                && sightings.values().any(|seen| seen.sighting.at >= moved.at)
        };
        let moves: Vec<Move> = moves.iter().filter(is_between).copied().collect();
        let settled = moves.last().map(|moved| moved.at);
        let (before, after): (BTreeMap<_, _>, BTreeMap<_, _>) = sightings
            .into_iter()
            .partition(|(_, seen)| settled.is_some_and(|settled| seen.sighting.at < settled));
        let mut current = after.into_iter();
        let (number, seen) = current.next()?;
        let mut entry = Self { moves, ..Self::new(id, number, seen) };
        for (number, seen) in current {
            entry.join(number, seen);
        }
        for (number, seen) in before {
            entry.remember(number, seen);
        }
        Some(entry)
    }

    /// Takes in a sighting of the thing where it is.
    pub(super) fn join(&mut self, number: SightingId, seen: Seen) {
        self.place.absorb(&Place::new(&seen.sighting));
        self.remember(number, seen);
    }

    /// Takes in all of a sighting but its place.
    fn remember(&mut self, number: SightingId, seen: Seen) {
        let Seen { sighting, feature } = seen;
        *self.classes.entry(sighting.class.clone()).or_default() += 1;
        if let Some(feature) = &feature {
            let weight = sighting.radius.recip();
            match &mut self.look {
                Some(look) => look.add(feature, weight),
                look => *look = Some(Look::new(feature, weight)),
            }
        }
        self.first_seen = self.first_seen.min(sighting.at);
        self.last_seen = self.last_seen.max(sighting.at);
        self.sightings.insert(number, sighting);
    }

    /// Takes over what was held to be another thing and is this one, at a new place.
    pub(super) fn move_to(&mut self, newcomer: Self) {
        self.moves.push(Move { at: newcomer.first_seen, from: self.place.position });
        self.moves.extend(&newcomer.moves);
        self.place = newcomer.place;
        self.absences = newcomer.absences;
        self.absorb(newcomer);
    }

    /// Takes over what was held to be another thing and is this one, at the same place.
    pub(super) fn merge(&mut self, other: Self) {
        self.place.absorb(&other.place);
        self.absences = self.absences.min(other.absences);
        self.absorb(other);
    }

    /// Takes over all of an entry but where it is.
    fn absorb(&mut self, other: Self) {
        self.first_seen = self.first_seen.min(other.first_seen);
        self.last_seen = self.last_seen.max(other.last_seen);
        self.told_apart.extend(other.told_apart);
        self.recorded = self.recorded.take().or(other.recorded);
        for (class, votes) in other.classes {
            *self.classes.entry(class).or_default() += votes;
        }
        match (&mut self.look, other.look) {
            (Some(look), Some(other)) => look.absorb(&other),
            (look @ None, other) => *look = other,
            (Some(_), None) => {}
        }
        self.sightings.extend(other.sightings);
    }

    /// Whether a person said that the two are two things.
    pub fn is_told_apart_from(&self, other: &Self) -> bool {
        self.told_apart.contains(&other.id) || other.told_apart.contains(&self.id)
    }

    /// The class that was recorded, or else that most sightings gave; of equally many the first by name.
    pub fn class(&self) -> Option<&ClassLabel> {
        if self.recorded.is_some() {
            return self.recorded.as_ref();
        }
        self.classes.iter().rev().max_by_key(|(_, votes)| **votes).map(|(class, _)| class)
    }

    /// How many views showed it. No view shows a thing twice, so these are its sightings.
    pub fn views(&self) -> usize {
        self.sightings.len()
    }

    /// Since when it has been where it is, if it was ever moved.
    pub fn settled(&self) -> Option<DateTime> {
        self.moves.last().map(|moved| moved.at)
    }
}
