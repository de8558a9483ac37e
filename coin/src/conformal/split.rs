//! Split conformal prediction over single users (the paper's Section 4.4).

use coin_schemas::calibration::NonconformityScore;
use coin_schemas::household::Score;

use super::{Level, Quantile, quantile};
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// How badly the scores fit the true owners, 0…1; `None` where nobody of the household owns the thing, because
/// then no set of members can hold an owner.
///
/// [`NonconformityScore::AnyOwner`] is the paper's nc(o, U_true) = 1 − max_{u∈U_true} s_u(o). Its Γ holds at
/// least one true owner with probability 1 − α; the paper's line P(U_true ⊆ Γ) ≥ 1 − α does not follow from it.
/// [`NonconformityScore::AllOwners`] is 1 − min_{u∈U_true} s_u(o), for which that line does hold.
pub fn nonconformity(score: NonconformityScore, scores: &[Score], owners: OwnerSet) -> Option<f64> {
    let of_owner = |user: UserIndex| scores.get(user.place()).map(|owner_score| 1.0 - owner_score.value());
    let losses = owners.iter().filter_map(of_owner);
    match score {
        NonconformityScore::AnyOwner => losses.reduce(f64::min),
        NonconformityScore::AllOwners => losses.reduce(f64::max),
    }
}

/// q_α: the ⌈(N+1)(1−α)⌉-th smallest nonconformity score.
pub fn coverage_threshold(nonconformities: &[f64], alpha: Level) -> Quantile {
    quantile(nonconformities, alpha.upper_rank(nonconformities.len()))
}

/// Γ(o) = {u : s_u(o) ≥ 1 − q_α}, computed as 1 − s_u ≤ q_α so that a score which equals a calibration sample is
/// not lost to rounding.
pub fn prediction_set(scores: &[Score], q_alpha: f64) -> OwnerSet {
    scores
        .iter()
        .enumerate()
        .filter(|(_, score)| 1.0 - score.value() <= q_alpha)
        .filter_map(|(place, _)| UserIndex::new(place))
        .collect()
}

/// cp_s(o) = 1 − (1/|Γ|) Σ_{u∈Γ} s_u(o), 0…1; 1 where Γ is empty.
pub fn uncertainty(scores: &[Score], prediction_set: OwnerSet) -> f64 {
    if prediction_set.is_empty() {
        return 1.0;
    }
    let sum: f64 =
        prediction_set.iter().filter_map(|user| scores.get(user.place())).map(|score| score.value()).sum();
    1.0 - sum / prediction_set.len() as f64
}

/// q_cp: the ⌈(N+1)α_cp⌉-th smallest cp_s of the calibration things, the rank clamped to 1…N.
pub fn stopping_threshold(uncertainties: &[f64], alpha_cp: Level) -> Quantile {
    quantile(uncertainties, alpha_cp.lower_rank(uncertainties.len()))
}

#[cfg(test)]
mod tests;
