//! Arguments and results of the MCP tools: the types that parse a call and the types that answer it.
//!
//! The doc comments of argument fields are read by models: they say what a value means, what the default is
//! and where the value comes from. Ids and names are plain strings here, because an unknown one must be
//! answered with near misses and not with a parse error.

mod asking;
mod finding;
mod judging;
mod listing;
mod looking;
mod observing;
mod recording;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use asking::{AskOutcome, AskOwner, AskOwnerResult};
pub use finding::{
    AskedFor, FindDecision, FindObject, FindObjectResult, FoundObject, ObjectMatch, RequestInterpretation,
};
pub use judging::{
    AnswerEvidence, Evidence, LookAlikeEvidence, NeighbourEvidence, NextQuestion, NextQuestionResult,
    UsageEvidence, WhoseIs, WhoseIsResult,
};
pub use listing::{
    AddUser, AddUserResult, ListObjects, ListObjectsResult, ListUsers, ListUsersResult, ListedObject,
    ListedUser,
};
pub use looking::{
    GetUsageSummary, LookAlike, NearbyObjects, NearbyObjectsResult, Neighbour, SimilarObjects,
    SimilarObjectsResult, UsageSummary, UserUsage,
};
pub use observing::{
    MovedObject, Observation, ObserveObjects, ObserveObjectsResult, PerhapsMoved, RejectedObservation,
    SeenObject, SeenView,
};
pub use recording::{
    RecordAnswer, RecordAnswerResult, RecordScores, RecordScoresResult, RecordUsage, RecordUsageResult,
    RejectedCaption, RetractAnswer, RetractAnswerResult, UsageCaption,
};

use crate::household::{ClassLabel, ObjectId, Owners, Position, Scores, Source};

/// Default of `window_days`: a year.
pub const DEFAULT_WINDOW_DAYS: u32 = 365;
/// Largest `window_days`: a hundred years.
pub const MAX_WINDOW_DAYS: u32 = 36_500;
/// Default of `max_examples`.
pub const DEFAULT_MAX_EXAMPLES: u32 = 5;
/// Largest `max_examples`; more would crowd out the conversation.
pub const MAX_EXAMPLES: u32 = 50;
/// Largest `max_sessions`.
pub const MAX_SESSIONS: u32 = 1000;
/// Default of `k`, the paper's K_near and K_sim.
pub const DEFAULT_K: u32 = 5;
/// Largest `k`.
pub const MAX_K: u32 = 100;
/// Default of `sigma`, in metres (the paper's σ).
pub const DEFAULT_SIGMA: f64 = 0.5;
/// Default of `gamma` (the paper's γ).
pub const DEFAULT_GAMMA: f64 = 1.0;
/// Default of `min_weight`.
pub const DEFAULT_MIN_WEIGHT: f64 = 0.01;
/// Most captions in one `record_usage` call.
pub const MAX_CAPTIONS: usize = 100_000;
/// Most observations in one `observe_objects` call.
pub const MAX_OBSERVATIONS: usize = 10_000;
/// Longest caption, question or answer, in bytes.
pub const MAX_TEXT_BYTES: usize = 2_000;
/// Default of `limit` in `list_objects`.
pub const DEFAULT_LIMIT: u32 = 50;
/// Largest `limit` in `list_objects`.
pub const MAX_LIMIT: u32 = 500;

/// A thing by id and name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ObjectRef {
    /// Its id.
    pub id: ObjectId,
    /// Its class label, with a capital as in captions.
    pub name: String,
}

/// A thing by id and name, and where it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlacedObjectRef {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// `[x, y, z]` in metres.
    pub position: Position,
}

/// What is reliably known of a thing's owners (the paper's BUILD-KNOWN).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KnownOwnership {
    /// The owners.
    pub owners: Owners,
    /// The score of every member of the household.
    pub scores: Scores,
    /// `answer`: a person said so. `inferred`: concluded with a confidence of at least 0.9.
    pub source: Source,
}

/// The name of a class as captions write it: every word with a capital (`Coffee Table`).
pub fn display_name(class: &ClassLabel) -> String {
    class
        .as_str()
        .split(' ')
        .map(|word| {
            let mut characters = word.chars();
            characters
                .next()
                .map(|first| first.to_uppercase().chain(characters).collect::<String>())
                .unwrap_or_default()
        })
        .collect::<Vec<_>>()
        .join(" ")
}
