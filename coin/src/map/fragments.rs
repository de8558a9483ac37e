//! Entries that are parts of one thing: its first views were too far apart, and two entries grew from them.
//!
//! The part that nothing joins any more is found to be gone. If no view ever showed it beside an entry that is within the largest
//! divergence and looks the same, the two are one: had the one been known better, the other would never have been made.

use std::collections::BTreeSet;

use super::detection::ViewId;
use super::entry::{Entry, EntryId};
use super::gaussian::jeffreys;
use super::{Change, SemanticMap};

impl SemanticMap {
    /// Joins each of the entries, which were just found to be gone, to the one that it is a part of.
    pub(super) fn join_fragments(&mut self, gone: &BTreeSet<EntryId>) {
        for &part in gone {
            if let Some(whole) = self.state.entries.get(&part).and_then(|part| self.whole(part)) {
                // The older id stays: it is the one that others may know.
                self.merge(whole.min(part), whole.max(part));
            }
        }
    }

    /// The entry with the least divergence that this one is a part of.
    fn whole(&self, part: &Entry) -> Option<EntryId> {
        let views = views(part)?;
        let gaussian = part.place.gaussian(self.parameters.spread);
        let reach = self.parameters.reach(part.place.radius());
        let middle = part.place.position;
        let near = self.grid.around(middle.map(|metres| metres - reach), middle.map(|metres| metres + reach));
        near.into_iter()
            .filter_map(|id| self.state.entries.get(&id))
            .filter(|whole| whole.id != part.id && !self.is_gone(whole) && whole.settled() == part.settled())
            .map(|whole| (jeffreys(&gaussian, &whole.place.gaussian(self.parameters.spread)), whole))
            .filter(|(divergence, _)| *divergence < self.parameters.largest_divergence)
            .filter(|(_, whole)| {
                self.looks_same(whole, part)
                    && self::views(whole).is_some_and(|of_whole| views.is_disjoint(&of_whole))
            })
            .min_by(|(divergence, _), (other, _)| divergence.total_cmp(other))
            .map(|(_, whole)| whole.id)
    }

    fn merge(&mut self, id: EntryId, other: EntryId) {
        let (Some(mut entry), Some(other)) = (self.withdraw(id), self.withdraw(other)) else { return };
        self.state.undecided.remove(&other.id);
        self.rename(other.id, id, &other.sightings);
        self.history.push(Change::Merged { entry: id, other: other.id });
        entry.merge(other);
        self.enter(entry);
    }
}

/// The views that an entry is from; `None` where one has no id, because then it cannot be told what was beside it.
fn views(entry: &Entry) -> Option<BTreeSet<&ViewId>> {
    entry.sightings.values().map(|sighting| sighting.view.as_ref()).collect()
}
