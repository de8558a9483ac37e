//! DETECT-SHARE: when scores say that a thing is shared (the paper's Section 4.3, equations for s_(k)).

use std::cmp::Ordering;

use coin_schemas::household::Score;

use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// The paper's three thresholds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShareThresholds {
    /// ε_min: the least score of a shared owner.
    pub least_score: f64,
    /// ε_in: the largest spread of scores among the shared owners.
    pub largest_spread: f64,
    /// ε_out: the least gap between the shared owners and the others.
    pub least_gap: f64,
}

impl Default for ShareThresholds {
    /// The paper's values .80, .08 and .20.
    fn default() -> Self {
        Self { least_score: 0.80, largest_spread: 0.08, least_gap: 0.20 }
    }
}

/// Models give scores as decimals, whose differences are a little off in binary: 1.0 − 0.8 < 0.2 and
/// 0.9 − 0.82 > 0.08. The three inequalities forgive this much.
const ROUNDING: f64 = 1e-9;

/// Members by falling score; ties in the order of the roster.
fn ranking(scores: &[Score]) -> Vec<(UserIndex, f64)> {
    let mut ranked: Vec<(UserIndex, f64)> = scores
        .iter()
        .enumerate()
        .filter_map(|(place, score)| Some((UserIndex::new(place)?, score.value())))
        .collect();
    // A stable sort keeps the order of the roster; `partial_cmp` because −0 ties with 0.
    ranked.sort_by(|left, right| right.1.partial_cmp(&left.1).unwrap_or(Ordering::Equal));
    ranked
}

/// The shared owners: the top k ≥ 2 with s_(k) ≥ ε_min, s_(1) − s_(k) ≤ ε_in and s_(k) − s_(k+1) ≥ ε_out, where
/// s_(n+1) = 0. At most one k satisfies all three as long as ε_out > ε_in.
pub fn detect_share(scores: &[Score], thresholds: &ShareThresholds) -> Option<OwnerSet> {
    let ranked = ranking(scores);
    let score_at = |rank: usize| ranked.get(rank - 1).map_or(0.0, |&(_, score)| score);
    (2..=ranked.len())
        .find(|&k| {
            score_at(k) >= thresholds.least_score - ROUNDING
                && score_at(1) - score_at(k) <= thresholds.largest_spread + ROUNDING
                && score_at(k) - score_at(k + 1) >= thresholds.least_gap - ROUNDING
        })
        .map(|k| ranked[..k].iter().map(|&(user, _)| user).collect())
}

/// The paper's owner set of a thing nobody was asked about: the shared owners where there are any, else the
/// member with the highest score (ties: the first in the roster).
pub fn owner_set(scores: &[Score], thresholds: &ShareThresholds) -> OwnerSet {
    detect_share(scores, thresholds)
        .unwrap_or_else(|| ranking(scores).into_iter().take(1).map(|(user, _)| user).collect())
}

#[cfg(test)]
mod tests;
