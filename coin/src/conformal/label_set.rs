//! Split conformal prediction over whole owner sets (the label powerset).

use super::{Level, Quantile, quantile};
use crate::owners::{OwnerSet, OwnerSetDistribution};

/// 1 − p(S_true), 0…1. A true owner set that is no candidate, such as the empty one, has probability 0.
pub fn nonconformity(distribution: &OwnerSetDistribution, owners: OwnerSet) -> f64 {
    1.0 - distribution.probability(owners)
}

/// The ⌈(N+1)(1−α)⌉-th smallest nonconformity score.
pub fn coverage_threshold(nonconformities: &[f64], alpha: Level) -> Quantile {
    quantile(nonconformities, alpha.upper_rank(nonconformities.len()))
}

/// {S : p(S) ≥ 1 − q} of the candidate sets. Holds the true owner set with probability 1 − α, as long as that is a
/// candidate: things that nobody of the household owns take their share of α.
pub fn prediction_set(distribution: &OwnerSetDistribution, q_set: f64) -> Vec<OwnerSet> {
    distribution
        .entries()
        .iter()
        .filter(|&&(_, probability)| 1.0 - probability <= q_set)
        .map(|&(set, _)| set)
        .collect()
}

#[cfg(test)]
mod tests;
