//! What is said to a model and what it says back: the slots of the model-driven steps and their replies.
//!
//! A task is handed over as JSON, never woven into prose, so that a name or a caption that looks like an
//! instruction stays a value.

use std::collections::{BTreeMap, BTreeSet};

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::episode::EpisodeObject;
use crate::household::{ClassLabel, ObjectId, Owners, OwnershipBoolean, Scores, UserName, Users};
use crate::tools::{LookAlike, Neighbour, UsageSummary};

/// The slots of one of the three model-driven steps, and of the one that a baseline has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "task", rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// LLM-INFER: score every member of the household as an owner of the thing. The reply is an
    /// [`OwnershipReply`].
    InferOwnership {
        /// The members of the household and their background.
        household: Users,
        /// The moment for which the question is put.
        #[schemars(with = "String")]
        as_of: DateTime,
        /// The thing in question.
        object: TaskObject,
        /// What is known of it, where the model is to fetch nothing.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "GivenContext")]
        context: Option<GivenContext>,
    },
    /// LLM-INFER for several things in one call. The reply is an [`OwnershipsReply`].
    InferSeveral {
        /// The members of the household and their background.
        household: Users,
        /// The moment for which the question is put.
        #[schemars(with = "String")]
        as_of: DateTime,
        /// The things in question, each with what is known of it.
        things: Vec<ThingInContext>,
    },
    /// QUESTION-GENERATION: word one question to a person. The reply is one sentence.
    AskQuestion {
        /// The candidate owners.
        household: Users,
        /// The thing in question.
        object: TaskObject,
        /// The present scores.
        scores: Scores,
        /// How often the same thing has been asked about before.
        #[serde(default)]
        times_asked: u32,
    },
    /// UNDERSTAND-ANSWER: read a person's answer. The reply is a [`ReadingReply`].
    ReadAnswer {
        /// The candidate owners.
        household: Users,
        /// The question as it was asked.
        question: String,
        /// The answer as it was given.
        answer: String,
        /// Who answered, where known, so that "mine" has a meaning.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "String")]
        answered_by: Option<UserName>,
    },
    /// The first step of Active Ownership Learning, a baseline: call every class shared or owned. The reply is a
    /// [`SharingReply`].
    JudgeSharing {
        /// The classes of the home, each once.
        classes: BTreeSet<ClassLabel>,
    },
}

/// A thing, and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThingInContext {
    /// The thing.
    pub object: TaskObject,
    /// What is known of it.
    pub context: GivenContext,
}

/// What the tools would have told of a thing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GivenContext {
    /// Who used it; absent where somebody else weighs that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "UsageSummary")]
    pub usage: Option<UsageSummary>,
    /// What lies near it, nearest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nearby_objects: Vec<Neighbour>,
    /// What looks like it, most similar first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub similar_objects: Vec<LookAlike>,
}

/// A thing as a task names it: just what the map knows of it.
pub type TaskObject = EpisodeObject;

/// The reply to [`Task::InferOwnership`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnershipReply {
    /// A score for every member, each on its own between 0 and 1.
    pub ownership_distribution: Scores,
    /// The probabilities of whole owner sets, from a model that has them. They sum to 1. Without them they
    /// are made from the scores (see `coin::owners`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<OwnerSetProbability>")]
    pub owner_sets: Option<Vec<OwnerSetProbability>>,
}

/// The reply to [`Task::InferSeveral`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnershipsReply {
    /// For every thing a score for every member, each on its own between 0 and 1.
    pub ownership_distributions: BTreeMap<ObjectId, Scores>,
}

/// How probable it is that exactly these people own a thing together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OwnerSetProbability {
    /// The owner set.
    pub owners: Owners,
    /// Its probability, 0…1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub probability: f64,
}

/// The reply to [`Task::ReadAnswer`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ReadingReply {
    /// Is this person an owner? People left out are not.
    pub ownership_boolean: OwnershipBoolean,
    /// The owner is somebody who does not belong to the household.
    #[serde(default)]
    pub owner_outside_household: bool,
}

/// The reply to [`Task::JudgeSharing`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SharingReply {
    /// Does everybody in a home use and own such a thing together? Classes left out are owned.
    pub shared_classes: BTreeMap<ClassLabel, bool>,
}

/// What a thing's inference was made from: the things whose known owners it could see.
pub type RelatedObjects = BTreeSet<ObjectId>;
