//! What the looks of things tell of their owners in one home.
//!
//! Whether people's things look like each other is a habit of a home too: in one the child's things are all of one
//! colour, in another everybody buys the same brand. So the home itself is asked: how alike are things of the same
//! owners, of overlapping ones and of others, where these are known or nearly so?

use std::collections::BTreeMap;

use crate::owners::OwnerSet;

/// The shrinkage of James and Stein: differences between the three kinds of pairs count by `1 − c/F`, with F the
/// between-kinds sum of squares over the variance within, which has a mean of 2 where looks tell nothing. With c = 4 they
/// count for nothing until they are clear of chance.
const SHRINKAGE: f64 = 4.0;

/// The fewest pairs of one kind from which a mean is taken.
const FEWEST_PAIRS: usize = 3;

/// The most look-alikes that are heard about one thing.
pub(super) const MOST_ALIKE: usize = 40;

/// How the owners of two things are related.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kinship {
    Same,
    Overlapping,
    Apart,
}

impl Kinship {
    fn of(one: OwnerSet, other: OwnerSet) -> Self {
        if one == other {
            Self::Same
        } else if one.intersection(other).is_empty() {
            Self::Apart
        } else {
            Self::Overlapping
        }
    }

    fn place(self) -> usize {
        self as usize
    }
}

/// How alike things of different classes are in a home, by how their owners are related.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Resemblance {
    /// The mean cosine of every kind of pair, shrunk towards the mean of all.
    means: [f64; 3],
    /// The variance of the cosine within a kind.
    variance: f64,
}

impl Resemblance {
    /// From pairs of things whose owners are known, with their cosines; `None` where they tell nothing.
    pub(super) fn learn(pairs: impl Iterator<Item = (OwnerSet, OwnerSet, f64)>) -> Option<Self> {
        let mut kinds: [Vec<f64>; 3] = Default::default();
        for (one, other, cosine) in pairs {
            kinds[Kinship::of(one, other).place()].push(cosine);
        }
        let count: usize = kinds.iter().map(Vec::len).sum();
        let mean = kinds.iter().flatten().sum::<f64>() / count as f64;
        let means = kinds.each_ref().map(|kind| match kind.len() < FEWEST_PAIRS {
            true => mean,
            false => kind.iter().sum::<f64>() / kind.len() as f64,
        });
        let squares =
            |kind: &Vec<f64>, mean: f64| kind.iter().map(|cosine| (cosine - mean).powi(2)).sum::<f64>();
        let within: f64 = kinds.iter().zip(means).map(|(kind, mean)| squares(kind, mean)).sum();
        let variance = within / count.checked_sub(kinds.len()).filter(|&freedom| freedom > 0)? as f64;
        let between: f64 =
            kinds.iter().zip(means).map(|(kind, of_kind)| kind.len() as f64 * (of_kind - mean).powi(2)).sum();
        let clear = 1.0 - SHRINKAGE * variance / between;
        (variance > 0.0 && clear > 0.0)
            .then(|| Self { means: means.map(|of_kind| mean + clear * (of_kind - mean)), variance })
    }

    /// What things of known owners, which look like a thing by these cosines, have to say of its owners.
    pub(super) fn witnesses(&self, others: impl Iterator<Item = (OwnerSet, f64)>) -> Witnesses {
        let mut by_owners: BTreeMap<OwnerSet, [f64; 3]> = BTreeMap::new();
        for (owners, cosine) in others {
            let sums = by_owners.entry(owners).or_default();
            for (sum, mean) in sums.iter_mut().zip(self.means) {
                *sum -= (cosine - mean).powi(2) / (2.0 * self.variance);
            }
        }
        Witnesses { by_owners: by_owners.into_iter().collect() }
    }
}

/// For every owner set of known things, ln of how well their looks fit a thing whose owners are the same, overlapping or
/// others.
pub(super) struct Witnesses {
    by_owners: Vec<(OwnerSet, [f64; 3])>,
}

impl Witnesses {
    /// ln of how well the looks fit that a thing has these owners, up to a constant.
    pub(super) fn log_likelihood(&self, owners: OwnerSet) -> f64 {
        self.by_owners.iter().map(|&(others, fits)| fits[Kinship::of(owners, others).place()]).sum()
    }
}
