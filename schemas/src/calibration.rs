//! The calibration file: thresholds, and what they were made from.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::report::{Scoring, Withheld};

/// Which true owners a nonconformity score looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NonconformityScore {
    /// The paper's: one minus the largest score of a true owner. Its prediction set holds *at least one* true
    /// owner with probability 1 − α.
    AnyOwner,
    /// One minus the smallest score of a true owner. Its prediction set holds *all* true owners with
    /// probability 1 − α.
    AllOwners,
}

/// The version of the file's form.
pub const CALIBRATION_VERSION: u32 = 1;

/// Which part of the calibration households' history was scored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum History {
    /// All of it.
    #[default]
    Whole,
    /// The first days, up to each episode's `train_until` (the paper's split in time).
    TrainingDays,
}

/// Thresholds that were computed on calibration households, and where they come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The version of the file's form; this program reads version 1.
    #[serde(default = "first_version")]
    pub version: u32,
    /// The model whose scores were used; the thresholds hold for no other.
    pub model: String,
    /// The miscoverage level α of prediction sets.
    pub alpha: f64,
    /// The level α_cp of the paper's stopping threshold.
    pub alpha_cp: f64,
    /// The share ε of wrong owner sets that risk control tolerates.
    pub risk: f64,
    /// Which nonconformity score `q_alpha` belongs to.
    pub score: NonconformityScore,
    /// The number of things that were scored.
    pub samples: usize,
    /// The number of households that they came from.
    pub households: usize,
    /// Threshold of Γ(o) = {u : s_u ≥ 1 − q_α}. It is 1, so that Γ holds everybody, where `samples` are too few
    /// for `alpha`.
    pub q_alpha: f64,
    /// The paper's stopping threshold on cp_s.
    pub q_cp: f64,
    /// Threshold of the label-set prediction set {S : p(S) ≥ 1 − q_set}.
    pub q_set: f64,
    /// Risk control: a thing is settled without a question where its best owner set has at least this
    /// probability. Above 1 where no threshold keeps the risk, so that everything is asked.
    pub lambda: f64,
    /// The names of the episodes that were scored. For a home of such a name a report promises nothing: the thresholds
    /// know what they judge.
    #[serde(default)]
    pub episodes: Vec<String>,
    /// Which part of their history was scored.
    #[serde(default)]
    pub history: History,
    /// What the model was not told; thresholds of a model that knows less are no good for one that knows more.
    #[serde(default)]
    pub withheld: BTreeSet<Withheld>,
    /// How the scores were made; thresholds of scores that are made otherwise mean something else.
    #[serde(default, skip_serializing_if = "Scoring::is_default")]
    pub scoring: Scoring,
    /// The program and version that wrote the file.
    pub created_with: String,
}

fn first_version() -> u32 {
    1
}
