//! Undoing a wrong join: one entry becomes two.

use std::collections::{BTreeMap, BTreeSet};

use thiserror::Error;

use super::detection::{Seen, Sighting};
use super::entry::{Entry, EntryId, SightingId};
use super::{Change, SemanticMap};

/// Why an entry was not split. The map is as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SplitError {
    /// No entry has this id.
    #[error("the map has no entry {}", entry.0)]
    UnknownEntry {
        /// The id.
        entry: EntryId,
    },
    /// The entry was not made from this sighting.
    #[error("entry {} was not made from sighting {}", entry.0, sighting.0)]
    UnknownSighting {
        /// The entry.
        entry: EntryId,
        /// The sighting.
        sighting: SightingId,
    },
    /// Nothing was to be taken out, or nothing would be left.
    #[error("both parts of entry {} need a sighting", entry.0)]
    EmptyPart {
        /// The entry.
        entry: EntryId,
    },
}

impl SemanticMap {
    /// Takes sightings out of an entry, which keeps its id, into a new one, whose id is returned. Both are made anew from
    /// their sightings and `features`, what the sightings of the entry looked like. They are told apart from then on: the
    /// map does not take the one for the other that moved.
    ///
    /// # Errors
    /// If there is no such entry, if it was not made from one of the sightings, or if a part would be empty.
    pub fn split(
        &mut self,
        id: EntryId,
        sightings: &BTreeSet<SightingId>,
        features: &BTreeMap<SightingId, Vec<f32>>,
    ) -> Result<EntryId, SplitError> {
        let entry = self.state.entries.get(&id).ok_or(SplitError::UnknownEntry { entry: id })?;
        if let Some(&sighting) = sightings.iter().find(|sighting| !entry.sightings.contains_key(sighting)) {
            return Err(SplitError::UnknownSighting { entry: id, sighting });
        }
        let seen = |(&number, sighting): (&SightingId, &Sighting)| {
            (number, Seen { sighting: sighting.clone(), feature: features.get(&number).cloned() })
        };
        let (out, rest): (BTreeMap<_, _>, BTreeMap<_, _>) =
            entry.sightings.iter().map(seen).partition(|(number, _)| sightings.contains(number));
        let into = EntryId(self.state.entries_so_far);
        let taken = Entry::from_sightings(into, out, &entry.moves);
        let left = Entry::from_sightings(id, rest, &entry.moves);
        let (Some(mut taken), Some(mut left)) = (taken, left) else {
            return Err(SplitError::EmptyPart { entry: id });
        };
        left.recorded = entry.recorded.clone();
        left.told_apart = entry.told_apart.clone();
        taken.told_apart = entry.told_apart.clone();
        left.told_apart.insert(into);
        taken.told_apart.insert(id);
        self.state.entries_so_far += 1;
        self.withdraw(id);
        self.rename(id, into, &taken.sightings);
        self.state.undecided.remove(&id);
        self.enter(left);
        self.enter(taken);
        self.history.push(Change::Split { entry: id, into, sightings: sightings.clone() });
        Ok(into)
    }
}
