//! Finding a thing by words.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DEFAULT_K;
use crate::household::{ObjectId, Owners, Position};

fn default_k() -> u32 {
    DEFAULT_K
}

/// Arguments of `find_object`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FindObject {
    /// What the person said.
    pub query: String,
    /// The member who says it: whose "my" is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub speaker: Option<String>,
    /// The words' feature by the map's encoder: 512 numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<f64>")]
    pub query_embedding: Option<Vec<f64>>,
    /// At most this many matches.
    #[serde(default = "default_k")]
    #[schemars(range(min = 1, max = 100))]
    pub k: u32,
}

impl Default for FindObject {
    fn default() -> Self {
        Self { query: String::new(), speaker: None, query_embedding: None, k: DEFAULT_K }
    }
}

/// Result of `find_object`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FindObjectResult {
    /// What to do.
    pub decision: FindDecision,
    /// The thing that is found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "FoundObject")]
    pub object: Option<FoundObject>,
    /// Where it is ambiguous: the question that tells best which thing is meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub question: Option<String>,
    /// Where it is ambiguous: the things that could be meant, at most `k`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<ObjectId>,
    /// Where nothing is found: what is there instead, and whose it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub reason: Option<String>,
    /// Where nothing is found: the things of which the reason speaks, at most `k`. They are not what was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instead: Vec<ObjectId>,
    /// How the words were understood.
    pub interpretation: RequestInterpretation,
    /// What the words describe, whosever it is, best score first.
    pub matches: Vec<ObjectMatch>,
}

/// What a request in words comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FindDecision {
    /// One thing is meant.
    Found,
    /// A person has to say which one, or whether it is the one.
    Ambiguous,
    /// Nothing here is meant.
    None,
}

/// What is asked about a thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AskedFor {
    /// The thing itself.
    Object,
    /// Its owner.
    Owner,
}

/// How a request was understood.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RequestInterpretation {
    /// The thing, in lower case and singular; empty where the words name none.
    pub class: String,
    /// Whose it is said to be, in words; `anybody` where the words say nothing of it.
    pub owner: String,
    /// The words that stand for the thing, as they were said.
    pub words: String,
    /// Where it is said to be.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<String>,
    /// Whether the thing or its owner is asked for.
    pub asked_for: AskedFor,
}

/// A thing that the words describe.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectMatch {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// `[x, y, z]` in metres.
    pub position: Position,
    /// How well the words fit its label, or how much it looks like them, whichever is more; 0…1, 4 decimals.
    #[serde(rename = "match")]
    pub matched: f64,
    /// The probability that its owners are those of the words, 4 decimals; absent where it is not known whom they mean.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub ownership: Option<f64>,
    /// How well all of it fits: match, ownership and place; 0…1, 4 decimals.
    pub score: f64,
}

/// The thing that is found, and whose it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FoundObject {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// `[x, y, z]` in metres.
    pub position: Position,
    /// The room that it is in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub room: Option<String>,
    /// The most probable owners; empty where somebody outside the household owns it.
    pub owners: Owners,
    /// The probability of that.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
    /// Two sentences: whose it is held to be, and why.
    pub explanation: String,
}
