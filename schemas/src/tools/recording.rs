//! Tools that record what was seen, what people said and what models concluded.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ObjectRef;
use crate::household::{Owners, Scores, Source};
use crate::model::OwnerSetProbability;
use crate::report::AnswerStatus;

/// Arguments of `record_answer`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordAnswer {
    /// Id of the thing, as list_objects gives it.
    pub object_id: String,
    /// The question as the person heard it.
    pub question: String,
    /// The person's words.
    pub answer: String,
    /// For each member of the household: does the answer make this person an owner? People left out are not.
    pub ownership: BTreeMap<String, bool>,
    /// True if the answer says that somebody outside the household owns the thing.
    #[serde(default)]
    pub owner_outside_household: bool,
    /// Who answered, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub answered_by: Option<String>,
    /// Local time of the answer. Default: the home's present.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub as_of: Option<String>,
}

/// Result of `record_answer`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RecordAnswerResult {
    /// The thing.
    pub object: ObjectRef,
    /// The owners that the answer names.
    pub owners: Owners,
    /// 1 for the owners, 0 for the others.
    pub scores: Scores,
    /// `unresolved`: the answer is kept, but it names nobody, so somebody else may be asked.
    pub status: AnswerStatus,
}

/// Arguments of `retract_answer`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RetractAnswer {
    /// Id of the thing, as list_objects gives it.
    pub object_id: String,
}

/// Result of `retract_answer`: what is believed of the thing without the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RetractAnswerResult {
    /// The thing.
    pub object: ObjectRef,
    /// Who is held to own it; empty where nothing is believed.
    pub owners: Owners,
    /// Probability of that owner set, 0…1; 0 where nothing is believed.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
    /// `inferred` where a model's scores count again; absent where nothing is believed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Source")]
    pub source: Option<Source>,
}

/// Arguments of `record_usage`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordUsage {
    /// What was seen, in any order of time; at most 100000 lines a call.
    pub captions: Vec<UsageCaption>,
}

/// A caption as `record_usage` takes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UsageCaption {
    /// Id of the thing, as list_objects gives it.
    pub object_id: String,
    /// One line: local time, then what was seen, such as `2025-01-19 19:00 Bob takes the Marker`.
    pub caption: String,
}

/// Result of `record_usage`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RecordUsageResult {
    /// Captions that were stored, unattributed ones included.
    pub recorded: u64,
    /// Captions among them whose actor could not be told.
    pub unattributed: u64,
    /// Captions that were stored before, by this call or another.
    pub duplicates: u64,
    /// Captions that were refused; all others are stored.
    pub rejected: Vec<RejectedCaption>,
}

/// A caption that was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RejectedCaption {
    /// Its place in the call, from 0.
    pub index: u64,
    /// What is wrong with it.
    pub reason: String,
}

/// Arguments of `record_scores`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordScores {
    /// Id of the thing, as list_objects gives it.
    pub object_id: String,
    /// A score between 0 and 1 for every member of the household, each on its own.
    pub scores: BTreeMap<String, f64>,
    /// Probabilities of whole owner sets, if the model has them; they sum to 1. Default: made from the scores.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<OwnerSetProbability>")]
    pub owner_sets: Option<Vec<OwnerSetProbability>>,
    /// Name of the model that scored, so that its own calibration is used. Default: no calibration, no guarantee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub model: Option<String>,
}

/// Result of `record_scores`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RecordScoresResult {
    /// The thing.
    pub object: ObjectRef,
    /// The most probable owners, or the answered ones where a person has answered.
    pub owners: Owners,
    /// Whether the scores make the thing a shared one.
    pub shared: bool,
    /// The plausible owners.
    pub prediction_set: Owners,
    /// One minus the mean score of the plausible owners; 1 where there is none.
    pub uncertainty: f64,
    /// Probability of the most probable owner set; 1 where a person has answered.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
}
