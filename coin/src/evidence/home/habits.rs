//! The habits of a home, which its things have in common: how much is lent, how evenly what is shared is used, how often
//! a sighting is mistaken, and how many things have several owners.
//!
//! The habits are one of [`HABITS`] points of a grid, and how probable each is follows exactly from all things of the
//! home and all answers about them (an empirical-Bayes hierarchy without an iteration, so that the same home gives the
//! same habits).

use super::super::prior::SizePrior;

/// How often what is lent is lent: a Beta prior of the share of sessions by others, which differs from thing to thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lending {
    /// First parameter.
    pub(super) borrowed: f64,
    /// Second parameter.
    pub(super) own_use: f64,
}

/// Shares about one in ten, in five, in three and in two and a half, each ± a tenth or more.
pub(super) const LENDING: [Lending; 4] = [
    Lending { borrowed: 1.2, own_use: 10.8 },
    Lending { borrowed: 2.0, own_use: 8.0 },
    Lending { borrowed: 3.3, own_use: 6.7 },
    Lending { borrowed: 5.0, own_use: 7.5 },
];

/// Concentration α of the split of sessions among owners who take no turns: the larger, the more even.
pub(super) const EVENNESS: [f64; 2] = [8.0, 25.0];

/// The share of sightings that name anybody at random.
pub(super) const MISTAKEN: [f64; 2] = [0.01, 0.06];

/// The share of the things of one owner that nobody else uses.
const SINGLE_KEPT: [f64; 2] = [0.2, 0.5];

/// The share of the things of several owners that these use in turns.
const SHARED_KEPT: [f64; 3] = [0.1, 0.35, 0.65];

/// How many owners things have: in homes where what is shared is mostly everybody's, and then in homes of [`GROUPS`].
pub(super) const SIZES: [SizePrior; 6] = [
    SizePrior { single: 0.75, everyone: 0.15 },
    SizePrior { single: 0.60, everyone: 0.25 },
    SizePrior { single: 0.45, everyone: 0.30 },
    SizePrior { single: 0.75, everyone: 0.05 },
    SizePrior { single: 0.60, everyone: 0.08 },
    SizePrior { single: 0.45, everyone: 0.11 },
];

/// From this place of [`SIZES`] on what is shared is mostly a group's.
const GROUPS: usize = 3;

/// How probable a home of groups is relative to another, for every size that there is between one person and everybody.
const OF_GROUP_SIZE: f64 = 0.25;

/// The number of points of the grid.
pub(super) const HABITS: usize =
    SIZES.len() * LENDING.len() * EVENNESS.len() * MISTAKEN.len() * SINGLE_KEPT.len() * SHARED_KEPT.len();

/// One point of the grid: the places of its habits in their lists, and the shares of what is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Habits {
    pub(super) sizes: usize,
    pub(super) lending: usize,
    pub(super) evenness: usize,
    pub(super) mistaken: usize,
    single_kept: f64,
    shared_kept: f64,
}

impl Habits {
    /// Every point of the grid.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        (0..HABITS).map(|point| {
            let mut rest = point;
            let mut place = |length: usize| {
                let place = rest % length;
                rest /= length;
                place
            };
            Self {
                sizes: place(SIZES.len()),
                lending: place(LENDING.len()),
                evenness: place(EVENNESS.len()),
                mistaken: place(MISTAKEN.len()),
                single_kept: SINGLE_KEPT[place(SINGLE_KEPT.len())],
                shared_kept: SHARED_KEPT[place(SHARED_KEPT.len())],
            }
        })
    }

    /// How probable the point is before anything was seen, relative to others, in a home of so many people. The more there
    /// are, the more groups they can form.
    pub(super) fn prior(&self, people: usize) -> f64 {
        if self.sizes < GROUPS { 1.0 } else { OF_GROUP_SIZE * people.saturating_sub(2) as f64 }
    }

    /// How probable it is that a thing of so many owners is used by them alone.
    pub(super) fn kept(&self, owners: usize) -> f64 {
        if owners == 1 { self.single_kept } else { self.shared_kept }
    }

    /// The place of the account of lending among its kinds.
    pub(super) fn lent(&self) -> usize {
        self.lending * EVENNESS.len() + self.evenness
    }
}
