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
    /// Pairs of things of different people that have most of their detections of one day in one entry.
    pub merged: Vec<(usize, usize)>,
    /// Pairs of things of different people where the entry of the one's first day is that of the other's second.
    pub swapped: Vec<(usize, usize)>,
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
    let pairs =
        (0..tour.things.len()).flat_map(|one| (one + 1..tour.things.len()).map(move |other| (one, other)));
    let of_two_people: Vec<(usize, usize)> =
        pairs.filter(|&(one, other)| tour.things[one].owner != tour.things[other].owner).collect();
    let together = |days: [(usize, usize); 2]| {
        let is_shared = |&(one, other): &(usize, usize)| {
            let in_one = |(day, other_day): (usize, usize)| {
                homes[day][one].is_some() && homes[day][one] == homes[other_day][other]
            };
            days.into_iter().any(in_one)
        };
        of_two_people.iter().copied().filter(is_shared).collect()
    };
    TourScores {
        identities: identity_scores(&detections),
        kept: moved.iter().filter(kept).count(),
        moved: moved.len(),
        merged: together([(0, 0), (1, 1)]),
        swapped: together([(0, 1), (1, 0)]),
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
