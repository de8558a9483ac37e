//! Judging a map by a tour whose truth is known.

use std::collections::BTreeMap;

use super::Tour;
use crate::metrics::identity::{IdentityScores, identity_scores};

/// How well the entries of a map are the things of the tour.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TourScores {
    /// Identities over all detections. A missed thing is no detection; a false one is a false positive in whichever entry
    /// it ends, an entry of its own included.
    pub identities: IdentityScores,
    /// How many things were moved.
    pub moved: usize,
    /// How many of them have most of their detections of the first day and most of those of the second in one entry, and
    /// so kept their id and their owner.
    pub kept: usize,
    /// Pairs of things, of different people, whose detections of a day are mostly in one entry: on the same day, or the
    /// one's first day with the other's second.
    pub merged: Vec<(usize, usize)>,
}

/// Judges the entry in which each detection of each view ended.
pub fn judge<E: Ord + Copy>(tour: &Tour, entries: &[Vec<Option<E>>]) -> TourScores {
    let detections: Vec<(Option<usize>, Option<E>)> =
        tour.truth.iter().flatten().copied().zip(entries.iter().flatten().copied()).collect();
    let homes: [Vec<Option<E>>; 2] = [
        main_entries(tour, &tour.truth[..tour.first_day], &entries[..tour.first_day]),
        main_entries(tour, &tour.truth[tour.first_day..], &entries[tour.first_day..]),
    ];
    let moved: Vec<usize> = (0..tour.things.len()).filter(|&thing| tour.things[thing].moved()).collect();
    let kept = |thing: &&usize| homes[0][**thing].is_some() && homes[0][**thing] == homes[1][**thing];
    let mut merged = Vec::new();
    for one in 0..tour.things.len() {
        for other in one + 1..tour.things.len() {
            let together = |day: usize, other_day: usize| {
                homes[day][one].is_some() && homes[day][one] == homes[other_day][other]
            };
            let days = [(0, 0), (0, 1), (1, 0), (1, 1)];
            let two_people = tour.things[one].owner != tour.things[other].owner;
            if two_people && days.into_iter().any(|(day, other_day)| together(day, other_day)) {
                merged.push((one, other));
            }
        }
    }
    TourScores {
        identities: identity_scores(&detections),
        kept: moved.iter().filter(kept).count(),
        moved: moved.len(),
        merged,
    }
}

/// The entry that holds most detections of each thing.
fn main_entries<E: Ord + Copy>(
    tour: &Tour,
    truth: &[Vec<Option<usize>>],
    entries: &[Vec<Option<E>>],
) -> Vec<Option<E>> {
    let mut counts: Vec<BTreeMap<E, usize>> = vec![BTreeMap::new(); tour.things.len()];
    for (thing, entry) in truth.iter().flatten().zip(entries.iter().flatten()) {
        if let (Some(thing), Some(entry)) = (thing, entry) {
            *counts[*thing].entry(*entry).or_default() += 1;
        }
    }
    let most =
        |counts: &BTreeMap<E, usize>| counts.iter().max_by_key(|(_, count)| **count).map(|(&entry, _)| entry);
    counts.iter().map(most).collect()
}
