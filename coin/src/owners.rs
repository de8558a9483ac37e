//! Owner sets and probability distributions over them.

use std::cmp::Reverse;
use std::collections::HashSet;
use std::sync::Arc;

use coin_schemas::household::{Score, UserName};
use coin_schemas::model::OwnerSetProbability;
use thiserror::Error;

use crate::roster::{Roster, RosterError, UserIndex};

/// Up to this many members every non-empty owner set is a candidate.
pub const FULL_ENUMERATION_USERS: usize = 8;

/// In a larger household the candidates are the sets of up to this many members, and everyone.
pub const LARGEST_PARTIAL_SET: usize = 4;

/// How far probabilities that are handed in may be from summing to 1.
pub const SUM_TOLERANCE: f64 = 1e-6;

/// A set of members of the household, one bit each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OwnerSet(u64);

impl OwnerSet {
    /// Nobody of the household.
    pub const EMPTY: Self = Self(0);

    /// One member alone.
    pub fn single(user: UserIndex) -> Self {
        Self(1 << user.place())
    }

    /// This set and one more member.
    #[must_use]
    pub fn with(self, user: UserIndex) -> Self {
        Self(self.0 | 1 << user.place())
    }

    /// Whether the member belongs to the set.
    pub fn contains(self, user: UserIndex) -> bool {
        self.0 >> user.place() & 1 == 1
    }

    /// How many members the set has.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether the set has no member.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether every member of this set is in the other.
    pub fn is_subset(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }

    /// The members of both.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The members of either.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Smaller sets first, then by their members in the order of the roster: {0}, {1}, {0, 1}, {0, 2}, {1, 2}.
    fn order(self) -> (usize, Reverse<u64>) {
        (self.len(), Reverse(self.0.reverse_bits()))
    }

    /// The members in order.
    pub fn iter(self) -> impl Iterator<Item = UserIndex> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let first = UserIndex::new(rest.trailing_zeros() as usize)?;
            rest &= rest - 1;
            Some(first)
        })
    }
}

impl FromIterator<UserIndex> for OwnerSet {
    fn from_iter<I: IntoIterator<Item = UserIndex>>(users: I) -> Self {
        users.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// The owner sets that are considered in a household of `members`: all non-empty ones up to
/// [`FULL_ENUMERATION_USERS`] members; beyond that the sets of up to [`LARGEST_PARTIAL_SET`] members, and
/// everyone (a home of ten does not share a cup among seven). Smaller sets first, then by members.
pub fn candidate_sets(members: usize) -> Vec<OwnerSet> {
    let everyone: OwnerSet = (0..members).filter_map(UserIndex::new).collect();
    let largest = if members <= FULL_ENUMERATION_USERS { members } else { LARGEST_PARTIAL_SET };
    let mut sets = Vec::new();
    let mut layer: Vec<(OwnerSet, usize)> = vec![(OwnerSet::EMPTY, 0)];
    for _ in 0..largest {
        layer = layer
            .iter()
            .flat_map(|&(set, next)| {
                (next..members).filter_map(move |place| Some((set.with(UserIndex::new(place)?), place + 1)))
            })
            .collect();
        sets.extend(layer.iter().map(|&(set, _)| set));
    }
    if largest < members {
        sets.push(everyone);
    }
    sets
}

/// Why numbers are no distribution over owner sets.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DistributionError {
    /// A probability is negative, above 1 or not a number.
    #[error("a probability lies between 0 and 1, and {given} does not")]
    Probability {
        /// The number.
        given: f64,
    },
    /// The probabilities do not sum to 1.
    #[error("the probabilities of the owner sets sum to {sum}, not to 1")]
    Sum {
        /// What they sum to.
        sum: f64,
    },
    /// A set has no member, or stands twice.
    #[error("the owner set {{{}}} is empty or stands twice", owners.join(", "))]
    Set {
        /// The names in it.
        owners: Vec<String>,
    },
    /// A name is not of the household.
    #[error(transparent)]
    Roster(#[from] RosterError),
}

/// Probabilities of owner sets; they sum to 1. The default, without a set, is of a household without members.
#[derive(Debug, Clone, Default)]
pub struct OwnerSetDistribution {
    /// Shared, because a belief is told to many and changes as a whole.
    entries: Arc<[(OwnerSet, f64)]>,
}

impl PartialEq for OwnerSetDistribution {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.entries, &other.entries) || self.entries == other.entries
    }
}

impl OwnerSetDistribution {
    /// Normalises exp(weight). Weights are natural logarithms and need no common scale; −∞ excludes a set.
    ///
    /// # Panics
    /// If there is no set, none has a finite weight, or a weight is not a number.
    pub fn from_log_weights(weights: impl IntoIterator<Item = (OwnerSet, f64)>) -> Self {
        let mut entries: Vec<(OwnerSet, f64)> = weights.into_iter().collect();
        let largest = entries.iter().map(|&(_, weight)| weight).fold(f64::NEG_INFINITY, f64::max);
        assert!(largest.is_finite(), "at least one owner set must be possible");
        assert!(entries.iter().all(|(_, weight)| !weight.is_nan()), "every weight must be a number");
        for (_, weight) in &mut entries {
            *weight = libm::exp(*weight - largest);
        }
        Self::from_weights(entries)
    }

    /// Makes weights sum to 1.
    ///
    /// # Panics
    /// If they do not sum to a positive number.
    pub fn from_weights(mut entries: Vec<(OwnerSet, f64)>) -> Self {
        let sum: f64 = entries.iter().map(|&(_, weight)| weight).sum();
        assert!(sum > 0.0 && sum.is_finite(), "at least one owner set must be possible");
        for (_, weight) in &mut entries {
            *weight /= sum;
        }
        Self { entries: entries.into() }
    }

    /// p(S) = ∏_{u∈S} s_u · ∏_{u∉S} (1 − s_u), normalised over the candidate sets: the distribution that
    /// independent scores imply once "nobody" is excluded. Where no candidate has a positive product nothing is
    /// known, and the sets are equally probable: every score is 0, or, in a household of more than
    /// [`FULL_ENUMERATION_USERS`], more than [`LARGEST_PARTIAL_SET`] scores are 1 and another is 0.
    pub fn from_scores(scores: &[Score]) -> Self {
        let product = |set: OwnerSet| -> f64 {
            scores
                .iter()
                .enumerate()
                .map(|(place, score)| {
                    let owner = UserIndex::new(place).is_some_and(|user| set.contains(user));
                    if owner { score.value() } else { 1.0 - score.value() }
                })
                .product()
        };
        let sets = candidate_sets(scores.len());
        let sum: f64 = sets.iter().map(|&set| product(set)).sum();
        let uniform = 1.0 / sets.len() as f64;
        let entries =
            sets.into_iter().map(|set| (set, if sum > 0.0 { product(set) / sum } else { uniform })).collect();
        Self { entries }
    }

    /// Takes probabilities by name, as a model hands them over. Sets that are left out have probability 0; they
    /// stay candidates, because a prediction set that may exclude nothing must hold them too.
    pub fn from_named(roster: &Roster, sets: &[OwnerSetProbability]) -> Result<Self, DistributionError> {
        let restored = Self::restored(roster, sets)?;
        let sum = sets.iter().fold(0.0, |sum, set| sum + set.probability);
        let entries = restored.entries.iter().map(|&(set, probability)| (set, probability / sum));
        Ok(Self { entries: entries.collect() })
    }

    /// Takes back what [`Self::to_named`] gave, to the last bit: the probabilities are not made to sum to 1 once more.
    pub fn restored(roster: &Roster, sets: &[OwnerSetProbability]) -> Result<Self, DistributionError> {
        let mut entries: Vec<(OwnerSet, f64)> = Vec::with_capacity(sets.len());
        let mut named: HashSet<OwnerSet> = HashSet::with_capacity(sets.len());
        for OwnerSetProbability { owners, probability } in sets {
            if !(0.0..=1.0).contains(probability) {
                return Err(DistributionError::Probability { given: *probability });
            }
            let set = roster.owner_set(owners)?;
            if set.is_empty() || !named.insert(set) {
                return Err(DistributionError::Set {
                    owners: owners.iter().map(UserName::to_string).collect(),
                });
            }
            entries.push((set, *probability));
        }
        let sum = entries.iter().fold(0.0, |sum, &(_, probability)| sum + probability);
        if (sum - 1.0).abs() > SUM_TOLERANCE {
            return Err(DistributionError::Sum { sum });
        }
        let left_out = candidate_sets(roster.len()).into_iter().filter(|set| !named.contains(set));
        entries.extend(left_out.map(|set| (set, 0.0)));
        entries.sort_by_key(|&(set, _)| set.order());
        Ok(Self { entries: entries.into() })
    }

    /// The possible sets by name, most probable first. Sets of probability 0 are left out.
    pub fn to_named(&self, roster: &Roster) -> Vec<OwnerSetProbability> {
        self.named_where(roster, |probability| probability > 0.0)
    }

    /// The best set and all of at least this probability by name, most probable first. They sum to 1, as if the others
    /// were impossible.
    pub fn likely(&self, roster: &Roster, least: f64) -> Vec<OwnerSetProbability> {
        let least = least.min(self.best().1);
        let mut likely = self.named_where(roster, |probability| probability >= least);
        let sum = likely.iter().fold(0.0, |sum, set| sum + set.probability);
        likely.iter_mut().for_each(|set| set.probability /= sum);
        likely
    }

    fn named_where(&self, roster: &Roster, counts: impl Fn(f64) -> bool) -> Vec<OwnerSetProbability> {
        let mut named: Vec<OwnerSetProbability> = self
            .entries
            .iter()
            .filter(|&&(_, probability)| counts(probability))
            .map(|&(set, probability)| OwnerSetProbability { owners: roster.owners(set), probability })
            .collect();
        named.sort_by(|left, right| right.probability.total_cmp(&left.probability));
        named
    }

    /// Sets and their probabilities.
    pub fn entries(&self) -> &[(OwnerSet, f64)] {
        &self.entries
    }

    /// The probability of a set; 0 where it is no candidate.
    pub fn probability(&self, set: OwnerSet) -> f64 {
        self.entries.iter().find(|&&(other, _)| other == set).map_or(0.0, |&(_, probability)| probability)
    }

    /// The most probable set and its probability, conf(o). Exact ties go to the smaller set, then to the one
    /// that comes first in the roster.
    pub fn best(&self) -> (OwnerSet, f64) {
        self.entries
            .iter()
            .copied()
            .min_by(|left, right| {
                right.1.total_cmp(&left.1).then_with(|| left.0.order().cmp(&right.0.order()))
            })
            .unwrap_or((OwnerSet::EMPTY, 0.0))
    }

    /// s_u = Σ_{S∋u} p(S) for each of `members`.
    pub fn marginals(&self, members: usize) -> Vec<Score> {
        (0..members)
            .filter_map(UserIndex::new)
            .map(|user| {
                let of_user = self.entries.iter().filter(|(set, _)| set.contains(user));
                // Not `sum()`, whose empty sum is −0: it would rank below 0 and show as "-0.0" in files.
                let sum = of_user.fold(0.0, |sum, &(_, probability)| sum + probability);
                // Rounding can carry a sum of probabilities past 1 by an ulp or two.
                Score::new(sum.min(1.0)).unwrap_or(Score::ZERO)
            })
            .collect()
    }

    /// Shannon entropy in nats: how much doubt is left.
    pub fn entropy(&self) -> f64 {
        self.entries
            .iter()
            .filter(|&&(_, probability)| probability > 0.0)
            .fold(0.0, |sum, &(_, probability)| sum - probability * libm::log(probability))
    }
}

#[cfg(test)]
mod tests;
