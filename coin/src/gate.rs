//! The gates: which thing is asked about next, if any.

mod adaptive;
mod together;

use std::cmp::Ordering;

use coin_schemas::household::ObjectId;
use coin_schemas::report::Gate;

pub use adaptive::{AdaptedThreshold, Held, TrackRecord};
pub use together::{Alike, AlikeStanding, asked_together};

use crate::calibration::{Assessment, Thresholds, UNCALIBRATED_CONFIDENCE};

/// How often a thing is asked about when answers leave it open.
pub const MOST_TIMES_ASKED: u32 = 2;

/// Whether the gate wants to ask about the thing.
///
/// * `risk`: conf(o) < λ̂ (conformal risk control).
/// * `adaptive`: the same, where no higher threshold follows from the answers ([`AdaptedThreshold`]).
/// * `set`: the label-set prediction set does not hold exactly one owner set.
/// * `paper`: cp_s(o) > q_cp.
/// * `always`, `never`: as they say.
///
/// Without a calibration the first four ask where the best owner set has less than
/// [`UNCALIBRATED_CONFIDENCE`].
pub fn wants_to_ask(gate: Gate, thresholds: &Thresholds, assessment: &Assessment) -> bool {
    match (gate, *thresholds) {
        (Gate::Always, _) => true,
        (Gate::Never, _) => false,
        (_, Thresholds::Uncalibrated) => assessment.confidence < UNCALIBRATED_CONFIDENCE,
        (Gate::Risk | Gate::Adaptive, Thresholds::Calibrated { lambda, .. }) => {
            assessment.confidence < lambda
        }
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

/// Puts ids in the order of [`compare_ids`], and reads each as a number only once.
pub fn sort_ids(ids: &mut [ObjectId]) {
    ids.sort_by_cached_key(|id| match id.as_str().parse::<u64>() {
        Ok(number) => (false, number, id.clone()),
        Err(_) => (true, 0, id.clone()),
    });
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
        Gate::Risk | Gate::Adaptive | Gate::Set | Gate::Always | Gate::Never => {
            left.1.confidence.total_cmp(&right.1.confidence)
        }
    };
    by_doubt.then_with(|| compare_ids(left.0, right.0))
}

/// A thing that a person may be asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate<'a> {
    /// The thing.
    pub object: &'a ObjectId,
    /// How often a person was asked about it already.
    pub times_asked: u32,
    /// What is thought of it; `None` where nothing is, which makes it the first to be asked about.
    pub assessment: Option<&'a Assessment>,
}

/// Which thing a person is asked about first: one that was asked about less often, then the one that
/// [`compare_priority`] puts first. Who was asked [`MOST_TIMES_ASKED`] times about a thing is not asked again.
pub fn first_to_ask<'a>(
    gate: Gate,
    candidates: impl IntoIterator<Item = Candidate<'a>>,
) -> Option<&'a ObjectId> {
    let may_be_asked = candidates.into_iter().filter(|candidate| candidate.times_asked < MOST_TIMES_ASKED);
    may_be_asked.min_by(|left, right| left.compare(gate, right)).map(|candidate| candidate.object)
}

/// The same for as many as that, first the one that is asked about first.
pub fn first_few_to_ask<'a>(
    gate: Gate,
    candidates: impl IntoIterator<Item = Candidate<'a>>,
    most: usize,
) -> Vec<Candidate<'a>> {
    let may_be_asked = candidates.into_iter().filter(|candidate| candidate.times_asked < MOST_TIMES_ASKED);
    let mut in_order: Vec<Candidate<'a>> = may_be_asked.collect();
    in_order.sort_by(|left, right| left.compare(gate, right));
    in_order.truncate(most);
    in_order
}

impl Candidate<'_> {
    fn compare(&self, gate: Gate, other: &Self) -> Ordering {
        self.times_asked.cmp(&other.times_asked).then_with(|| match (self.assessment, other.assessment) {
            (Some(a), Some(b)) => compare_priority(gate, (self.object, a), (other.object, b)),
            (None, Some(_)) => Ordering::Less,
            (Some(_), None) => Ordering::Greater,
            (None, None) => compare_ids(self.object, other.object),
        })
    }
}

#[cfg(test)]
mod tests;
