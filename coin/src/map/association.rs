//! Which entry each detection of a view belongs to: the assignment with the least Jeffreys divergence in all.

use std::collections::{BTreeMap, BTreeSet};

use super::SemanticMap;
use super::detection::Seen;
use super::entry::{Entry, EntryId};
use super::gaussian::{Gaussian, jeffreys};
use super::kind::is_same_kind;
use super::parameters::MapParameters;
use crate::assignment::least_cost;

/// Whether an entry may be what a sighting shows, as far as class and appearance tell.
///
/// Appearance decides where both are known: it can tell a red cup from a blue one that stood there before, and a mug
/// from what the detector calls it this time. Else the class decides: any class that the thing was given before,
/// however it is spelt.
pub fn agrees(entry: &Entry, seen: &Seen, parameters: &MapParameters) -> bool {
    match (&entry.look, &seen.feature) {
        (Some(look), Some(feature)) => look.cosine(feature) >= parameters.same_look,
        _ => entry.classes.keys().any(|class| is_same_kind(class, &seen.sighting.class)),
    }
}

/// The divergence between a sighting and an entry, if the one may be of the other.
fn divergence(entry: &Entry, seen: &Seen, parameters: &MapParameters) -> Option<f64> {
    let sighting = &seen.sighting;
    let gaussian =
        Gaussian { mean: sighting.position.metres(), variance: parameters.spread * sighting.radius };
    let divergence = jeffreys(&gaussian, &entry.place.gaussian(parameters.spread));
    // A sighting from before the last move is none of where the thing is now.
    let is_of_this_place = entry.settled().is_none_or(|settled| sighting.at >= settled);
    (divergence < parameters.largest_divergence && is_of_this_place && agrees(entry, seen, parameters))
        .then_some(divergence)
}

/// The entry of each sighting of one view, with the divergence from it; `None` for what is new. No entry gets two of them, and none of `taken`,
/// which this view has shown already, gets one.
///
/// The sum of the divergences is least, where a sighting without an entry counts as much as the largest divergence that is
/// allowed. What is gone is considered last, for the sightings that are of nothing else: of two equal cups side by side
/// one was taken away, and the other must not be seen as now the one, now the other.
pub(super) fn associate(
    map: &SemanticMap,
    sightings: &[&Seen],
    taken: &BTreeSet<EntryId>,
) -> Vec<Option<(EntryId, f64)>> {
    let is_gone = |id: &EntryId| map.state.entries.get(id).is_some_and(|entry| map.is_gone(entry));
    let (gone, present): (Vec<_>, Vec<_>) = sightings
        .iter()
        .map(|sighting| {
            candidates(map, sighting, taken).into_iter().partition::<BTreeMap<_, _>, _>(|(id, _)| is_gone(id))
        })
        .unzip();
    let worst = map.parameters.largest_divergence;
    let mut assigned = assign(&present, worst);
    let left = |row: usize, entries| if assigned[row].is_none() { entries } else { BTreeMap::new() };
    let gone: Vec<_> = gone.into_iter().enumerate().map(|(row, entries)| left(row, entries)).collect();
    for (entry, returned) in assigned.iter_mut().zip(assign(&gone, worst)) {
        *entry = entry.or(returned);
    }
    assigned
}

/// The assignment with the least divergence in all. Groups of sightings that share no possible entry are solved one by one,
/// so a view costs little more than its crowded corners.
fn assign(possible: &[BTreeMap<EntryId, f64>], worst: f64) -> Vec<Option<(EntryId, f64)>> {
    let mut assigned = vec![None; possible.len()];
    for group in groups(possible) {
        let entries: BTreeSet<EntryId> =
            group.iter().flat_map(|&row| possible[row].keys().copied()).collect();
        let entries: Vec<EntryId> = entries.into_iter().collect();
        let cost = |row: usize, entry: &EntryId| possible[row].get(entry).copied().unwrap_or(f64::INFINITY);
        let costs: Vec<Vec<f64>> =
            group.iter().map(|&row| entries.iter().map(|entry| cost(row, entry)).collect()).collect();
        for (&row, column) in group.iter().zip(least_cost(&costs, worst)) {
            let entry = column.map(|column| entries[column]);
            assigned[row] = entry.and_then(|entry| Some((entry, *possible[row].get(&entry)?)));
        }
    }
    assigned
}

fn candidates(map: &SemanticMap, seen: &Seen, taken: &BTreeSet<EntryId>) -> BTreeMap<EntryId, f64> {
    let reach = map.parameters.reach(seen.sighting.radius);
    let middle = seen.sighting.position.metres();
    map.grid
        .around(middle.map(|metres| metres - reach), middle.map(|metres| metres + reach))
        .into_iter()
        .filter(|id| !taken.contains(id))
        .filter_map(|id| {
            let entry = map.state.entries.get(&id)?;
            divergence(entry, seen, &map.parameters).map(|divergence| (id, divergence))
        })
        .collect()
}

/// The sightings that have a possible entry, in groups that share none with each other.
fn groups(possible: &[BTreeMap<EntryId, f64>]) -> Vec<Vec<usize>> {
    let mut of_entry: BTreeMap<EntryId, Vec<usize>> = BTreeMap::new();
    for (row, entries) in possible.iter().enumerate() {
        for &entry in entries.keys() {
            of_entry.entry(entry).or_default().push(row);
        }
    }
    let mut is_grouped = vec![false; possible.len()];
    let mut groups = Vec::new();
    for row in (0..possible.len()).filter(|&row| !possible[row].is_empty()) {
        let mut group = Vec::new();
        let mut open = vec![row];
        while let Some(row) = open.pop() {
            if !std::mem::replace(&mut is_grouped[row], true) {
                group.push(row);
                open.extend(possible[row].keys().filter_map(|entry| of_entry.remove(entry)).flatten());
            }
        }
        if !group.is_empty() {
            group.sort_unstable();
            groups.push(group);
        }
    }
    groups
}
