//! From calibration samples to thresholds, and from thresholds to what is thought of one thing.

mod built_in;

use std::collections::BTreeSet;

use coin_schemas::calibration::{CALIBRATION_VERSION, Calibration, History, NonconformityScore};
use coin_schemas::household::Score;
use coin_schemas::report::{Scoring, Withheld};
use thiserror::Error;

use crate::conformal::risk::{Outcome, RiskSample, risk_threshold};
use crate::conformal::{Level, label_set, split};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::sharing::{ShareThresholds, detect_share};
pub use built_in::{EMBEDDED_MODEL, EMBEDDED_SCORING, embedded_calibration, score_of};

/// Without a calibration a thing is settled where its best owner set has at least this probability.
pub const UNCALIBRATED_CONFIDENCE: f64 = 0.95;

/// A thing of a calibration household, scored by the model and with its true owners.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationSample {
    /// The model's score of every member.
    pub scores: Vec<Score>,
    /// The probabilities of owner sets.
    pub distribution: OwnerSetDistribution,
    /// The true owners.
    pub owners: OwnerSet,
}

/// The levels to calibrate for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Levels {
    /// Miscoverage α of prediction sets.
    pub alpha: Level,
    /// α_cp of the paper's stopping threshold.
    pub alpha_cp: Level,
    /// ε: the share of wrong owner sets that is tolerated in the end.
    pub risk: Level,
}

/// What calibration samples were made from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// The model that scored.
    pub model: String,
    /// The episodes' names, one for each household.
    pub episodes: Vec<String>,
    /// Which part of their history was scored.
    pub history: History,
    /// What the model was not told.
    pub withheld: BTreeSet<Withheld>,
    /// How the scores were made.
    pub scoring: Scoring,
}

/// Why there is no calibration.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CalibrationError {
    /// No thing of the calibration households has an owner in its household.
    #[error("no calibration sample has an owner in the household; give episodes with a truth file")]
    NoSamples,
}

/// Computes every threshold on the samples. Things that nobody of the household owns are left out of q_α, whose
/// prediction set over members could never hold their owner; they count as wrong in q_set and λ̂, and have a
/// cp_s as every other thing.
pub fn calibrate(
    provenance: Provenance,
    samples: &[CalibrationSample],
    levels: Levels,
    score: NonconformityScore,
) -> Result<Calibration, CalibrationError> {
    let nonconformities: Vec<f64> = samples
        .iter()
        .filter_map(|sample| split::nonconformity(score, &sample.scores, sample.owners))
        .collect();
    if nonconformities.is_empty() {
        return Err(CalibrationError::NoSamples);
    }
    let q_alpha = split::coverage_threshold(&nonconformities, levels.alpha).threshold();
    let uncertainties: Vec<f64> = samples
        .iter()
        .map(|sample| split::uncertainty(&sample.scores, split::prediction_set(&sample.scores, q_alpha)))
        .collect();
    let set_nonconformities: Vec<f64> =
        samples.iter().map(|sample| label_set::nonconformity(&sample.distribution, sample.owners)).collect();
    let risk_samples: Vec<RiskSample> = samples
        .iter()
        .map(|sample| {
            let (best, confidence) = sample.distribution.best();
            let outcome = if best == sample.owners { Outcome::Right } else { Outcome::Wrong };
            RiskSample { confidence, outcome }
        })
        .collect();
    let Provenance { model, episodes, history, withheld, scoring } = provenance;
    Ok(Calibration {
        version: CALIBRATION_VERSION,
        model,
        alpha: levels.alpha.value(),
        alpha_cp: levels.alpha_cp.value(),
        risk: levels.risk.value(),
        score,
        samples: samples.len(),
        households: episodes.len(),
        q_alpha,
        q_cp: split::stopping_threshold(&uncertainties, levels.alpha_cp).threshold(),
        q_set: label_set::coverage_threshold(&set_nonconformities, levels.alpha).threshold(),
        lambda: risk_threshold(&risk_samples, levels.risk),
        episodes,
        history,
        withheld,
        scoring,
        created_with: concat!("coin ", env!("CARGO_PKG_VERSION")).to_owned(),
    })
}

/// A threshold that there were too few samples for, so that it settles nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooFewSamples {
    /// The threshold by its name in the file.
    pub threshold: &'static str,
    /// The level by its name in the file.
    pub level_name: &'static str,
    /// The level.
    pub level: f64,
    /// The least number of samples with which the level can be kept, if every one of them is scored well.
    pub needed: usize,
    /// What follows.
    pub consequence: &'static str,
}

/// Which thresholds of a calibration settle nothing for want of samples.
pub fn too_few_samples(samples: usize, levels: Levels) -> Vec<TooFewSamples> {
    let mut lacking = Vec::new();
    let needed = levels.alpha.least_samples();
    if samples < needed {
        for (threshold, consequence) in [
            ("q_alpha", "every prediction set holds everybody"),
            ("q_set", "every owner set stays plausible, so the set gate asks about everything"),
        ] {
            let level = levels.alpha.value();
            lacking.push(TooFewSamples { threshold, level_name: "alpha", level, needed, consequence });
        }
    }
    let needed = levels.risk.least_samples();
    if samples < needed {
        lacking.push(TooFewSamples {
            threshold: "lambda",
            level_name: "risk",
            level: levels.risk.value(),
            needed,
            consequence: "the risk gate asks about everything",
        });
    }
    lacking
}

/// The least number of households with which what λ̂ promises holds for homes taken as whole homes, however alike the
/// things of one home are: their losses average over households, and a household is one draw. With fewer the promise
/// is that of independent things, which things of one home are not.
pub fn households_wanted(levels: Levels) -> usize {
    levels.risk.least_samples()
}

/// What the gates compare with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thresholds {
    /// From a calibration: the guarantees hold.
    Calibrated {
        /// Threshold of Γ(o).
        q_alpha: f64,
        /// The paper's stopping threshold.
        q_cp: f64,
        /// Threshold of the label-set prediction set.
        q_set: f64,
        /// Risk control.
        lambda: f64,
    },
    /// There is none for the model: Γ(o) excludes nobody, and [`UNCALIBRATED_CONFIDENCE`] settles a thing.
    Uncalibrated,
}

impl From<&Calibration> for Thresholds {
    fn from(calibration: &Calibration) -> Self {
        let &Calibration { q_alpha, q_cp, q_set, lambda, .. } = calibration;
        Self::Calibrated { q_alpha, q_cp, q_set, lambda }
    }
}

/// What is thought of one thing that nobody was asked about.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// The most probable owner set.
    pub owners: OwnerSet,
    /// Its probability, conf(o).
    pub confidence: f64,
    /// Γ(o).
    pub prediction_set: OwnerSet,
    /// cp_s(o).
    pub uncertainty: f64,
    /// The number of owner sets that label-set conformal prediction leaves.
    pub plausible_sets: usize,
    /// The shared owners of DETECT-SHARE, where it finds any.
    pub shared_owners: Option<OwnerSet>,
    /// Whether DETECT-SHARE holds the thing to be shared.
    pub shared: bool,
    /// Whether risk control settles the thing without a question (the default gate).
    pub settled: bool,
}

impl Thresholds {
    /// The thresholds of a model by name: the built-in ones of the embedded model, none for any other.
    pub fn for_model(model: Option<&str>) -> Self {
        match model {
            Some(EMBEDDED_MODEL) => {
                match embedded_calibration(EMBEDDED_SCORING, NonconformityScore::AllOwners, &BTreeSet::new())
                {
                    Ok(Some(calibration)) => Self::from(&calibration),
                    Ok(None) | Err(_) => Self::Uncalibrated,
                }
            }
            _ => Self::Uncalibrated,
        }
    }

    /// λ̂, or the fixed confidence where there is no calibration.
    pub fn lambda(&self) -> f64 {
        match *self {
            Self::Calibrated { lambda, .. } => lambda,
            Self::Uncalibrated => UNCALIBRATED_CONFIDENCE,
        }
    }

    /// Everything that the gates ask about one thing.
    pub fn assess(
        &self,
        scores: &[Score],
        distribution: &OwnerSetDistribution,
        share: &ShareThresholds,
    ) -> Assessment {
        let (q_alpha, q_set) = match *self {
            Self::Calibrated { q_alpha, q_set, .. } => (q_alpha, q_set),
            Self::Uncalibrated => (1.0, 1.0),
        };
        let (owners, confidence) = distribution.best();
        let prediction_set = split::prediction_set(scores, q_alpha);
        let shared_owners = detect_share(scores, share);
        Assessment {
            owners,
            confidence,
            prediction_set,
            uncertainty: split::uncertainty(scores, prediction_set),
            plausible_sets: label_set::prediction_set(distribution, q_set).len(),
            shared_owners,
            shared: shared_owners.is_some(),
            settled: confidence >= self.lambda(),
        }
    }
}

#[cfg(test)]
mod tests;
