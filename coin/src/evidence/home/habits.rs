//! The habits of a home, which its things have in common: how much is lent, how evenly people use what they share and what
//! they borrow, how often a sighting is mistaken, how many things have several owners, and how far they are whose one would
//! expect.
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

/// How evenly people use what several of them use, as concentrations of a Dirichlet–multinomial: the larger, the more even.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Evenness {
    /// α of the split among owners who take no turns.
    pub(super) owners: f64,
    /// The same of the split among those who borrow a thing; `None` where everybody is as likely to.
    pub(super) borrowers: Option<f64>,
}

/// Homes in which anybody borrows anything, and then, from [`SAME_BORROWERS`] on, those in which the same person borrows the same
/// thing again.
pub(super) const EVENNESS: [Evenness; 4] = [
    Evenness { owners: 8.0, borrowers: None },
    Evenness { owners: 25.0, borrowers: None },
    Evenness { owners: 8.0, borrowers: Some(1.0) },
    Evenness { owners: 3.0, borrowers: Some(1.0) },
];

/// See [`EVENNESS`].
const SAME_BORROWERS: usize = 2;

/// The places in [`EVENNESS`] by which a thing that changed hands was used: where anybody borrows, and in other homes. Both
/// its pasts are short, so that the loosest of either does.
pub(super) const LOOSEST: [usize; 2] = [0, 3];

/// The weights of what is thought of a thing's owners before anybody used it: the usual one, or, where the things of the home
/// turn out to be whose one would expect, [`FOLLOWED`].
pub(super) const OPINIONS: usize = 2;

/// The weight of an opinion in a home whose things are whose one would expect.
pub(super) const FOLLOWED: f64 = 0.5;

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
pub(super) const HABITS: usize = SIZES.len()
    * OPINIONS
    * LENDING.len()
    * EVENNESS.len()
    * MISTAKEN.len()
    * SINGLE_KEPT.len()
    * SHARED_KEPT.len();

/// One point of the grid: the places of its habits in their lists, and the shares of what is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Habits {
    sizes: usize,
    opinion: usize,
    lending: usize,
    evenness: usize,
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
                opinion: place(OPINIONS),
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

    /// The place of the prior among those of every of [`SIZES`] with every one of [`OPINIONS`].
    pub(super) fn prior_place(&self) -> usize {
        self.sizes * OPINIONS + self.opinion
    }

    /// The place of the account of lending among its kinds.
    pub(super) fn lent(&self) -> usize {
        self.lending * EVENNESS.len() + self.evenness
    }

    /// The place of the account of a change of hands among its kinds.
    pub(super) fn changed(&self) -> usize {
        self.lending * LOOSEST.len() + usize::from(self.evenness >= SAME_BORROWERS)
    }
}
