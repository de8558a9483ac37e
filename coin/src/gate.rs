//! The gates: which thing is asked about next, if any.

use std::cmp::Ordering;

use coin_schemas::household::ObjectId;
use coin_schemas::report::Gate;

use crate::calibration::{Assessment, Thresholds, UNCALIBRATED_CONFIDENCE};

/// Whether the gate wants to ask about the thing.
///
/// * `risk`: conf(o) < λ̂ (conformal risk control).
/// * `set`: the label-set prediction set does not hold exactly one owner set.
/// * `paper`: cp_s(o) > q_cp.
/// * `always`, `never`: as they say.
///
/// Without a calibration the first three ask where the best owner set has less than
/// [`UNCALIBRATED_CONFIDENCE`].
pub fn wants_to_ask(gate: Gate, thresholds: &Thresholds, assessment: &Assessment) -> bool {
    match (gate, *thresholds) {
        (Gate::Always, _) => true,
        (Gate::Never, _) => false,
        (_, Thresholds::Uncalibrated) => assessment.confidence < UNCALIBRATED_CONFIDENCE,
        (Gate::Risk, Thresholds::Calibrated { lambda, .. }) => assessment.confidence < lambda,
        (Gate::Set, Thresholds::Calibrated { .. }) => assessment.plausible_sets != 1,
        (Gate::Paper, Thresholds::Calibrated { q_cp, .. }) => assessment.uncertainty > q_cp,
    }
}

/// Ids in the order that a person expects: numbers by value and before texts, texts by character.
pub fn compare_ids(left: &ObjectId, right: &ObjectId) -> Ordering {
    let number = |id: &ObjectId| id.as_str().parse::<u64>().ok();
    match (number(left), number(right)) {
        (Some(a), Some(b)) => a.cmp(&b).then_with(|| left.cmp(right)),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => left.cmp(right),
    }
}

/// Which of two things is asked about first. The paper's gate: the larger cp_s, then the larger Γ, then the
/// lower id. The others: the less probable best owner set, then the lower id.
pub fn compare_priority(
    gate: Gate,
    left: (&ObjectId, &Assessment),
    right: (&ObjectId, &Assessment),
) -> Ordering {
    let by_doubt = match gate {
        Gate::Paper => right
            .1
            .uncertainty
            .total_cmp(&left.1.uncertainty)
            .then_with(|| right.1.prediction_set.len().cmp(&left.1.prediction_set.len())),
        Gate::Risk | Gate::Set | Gate::Always | Gate::Never => {
            left.1.confidence.total_cmp(&right.1.confidence)
        }
    };
    by_doubt.then_with(|| compare_ids(left.0, right.0))
}

#[cfg(test)]
mod tests;
