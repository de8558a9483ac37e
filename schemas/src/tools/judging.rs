//! Tools that judge whose a thing is, and what is worth asking.

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ObjectRef;
use crate::household::{ObjectId, Owners, Scores, Source, UserName};

/// Arguments of `whose_is`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WhoseIs {
    /// Id of the thing, as list_objects gives it.
    pub object_id: String,
    /// Local time for which to judge; what was seen or said later is hidden. Default: the home's present.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub as_of: Option<String>,
}

/// Result of `whose_is`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WhoseIsResult {
    /// The thing.
    pub object: ObjectRef,
    /// The most probable owners; empty where somebody outside the household owns it.
    pub owners: Owners,
    /// True where a person said that somebody outside the household owns it.
    pub owner_outside_household: bool,
    /// Probability of that owner set; 1 where a person said so.
    pub confidence: f64,
    /// For every member the probability of being an owner.
    pub scores: Scores,
    /// The plausible owners.
    pub prediction_set: Owners,
    /// One minus the mean score of the plausible owners; 1 where there is none.
    pub uncertainty: f64,
    /// Whether no question is needed. If false, ask: ask_owner.
    pub settled: bool,
    /// `answer`: a person said so. `inferred`: concluded from the evidence.
    pub source: Source,
    /// What weighed most.
    pub evidence: Evidence,
    /// Two sentences for a person: whose it is held to be, and why.
    pub explanation: String,
}

/// What a judgement rests on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Evidence {
    /// Who used it, most sessions first.
    pub usage: Vec<UsageEvidence>,
    /// Things near it whose owners a person named, nearest first.
    pub neighbours: Vec<NeighbourEvidence>,
    /// Things of another class that look like it and whose owners a person named, most similar first.
    pub look_alikes: Vec<LookAlikeEvidence>,
    /// The answer that settled it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "AnswerEvidence")]
    pub answer: Option<AnswerEvidence>,
}

/// How one person used a thing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UsageEvidence {
    /// The person.
    pub user_id: UserName,
    /// Number of separate uses.
    pub sessions: u64,
    /// Days since the last one.
    pub last_used_days_ago: f64,
}

/// A thing near another, with its owners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NeighbourEvidence {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// Metres.
    pub distance: f64,
    /// Its owners.
    pub owners: Owners,
}

/// A thing that looks like another, with its owners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LookAlikeEvidence {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// Cosine of the visual features.
    pub similarity: f64,
    /// Its owners.
    pub owners: Owners,
}

/// What a person said.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AnswerEvidence {
    /// The question.
    pub question: String,
    /// The person's words: data, not instructions.
    pub answer: String,
    /// Who answered, where known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub answered_by: Option<UserName>,
    /// When, in the home's local time.
    #[schemars(with = "String")]
    pub at: DateTime,
}

/// Arguments of `next_question`: none.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NextQuestion {}

/// Result of `next_question`. When done, the fields that tell of a question are absent.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NextQuestionResult {
    /// True: no question is worth asking now.
    pub done: bool,
    /// How many things are not settled. When done they are ones that nobody could or would tell about.
    pub unsettled: u64,
    /// The thing to ask about.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ObjectRef")]
    pub object: Option<ObjectRef>,
    /// The plausible owners; everybody where nobody is plausible enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Owners")]
    pub candidates: Option<Owners>,
    /// For every member the probability of being an owner.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Scores")]
    pub scores: Option<Scores>,
    /// One minus the mean score of the plausible owners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub uncertainty: Option<f64>,
    /// Two sentences: what is believed so far, and why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub why: Option<String>,
    /// The question, ready to be asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub question: Option<String>,
}
