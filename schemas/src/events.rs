//! The event log of a run (`host --events FILE`): JSON Lines, one [`LogEvent`] a line, in the order of time.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::household::{ClassLabel, ObjectId, Owners, OwnershipBoolean, Scores, UserName, Users};
use crate::report::{AnswerStatus, Gate, MetricsReport, Stopped};

/// Something that happened in a run. The `event` field names it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum LogEvent {
    /// The run begins.
    RunStarted {
        /// The episode's name.
        episode: String,
        /// The model.
        model: String,
        /// The gate.
        gate: Gate,
        /// The seed.
        seed: u64,
        /// The members of the household and their background.
        users: Users,
        /// The class label of every thing, by id.
        objects: BTreeMap<ObjectId, ClassLabel>,
    },
    /// A pass over things whose context is new begins.
    InferenceStarted {
        /// The number of the pass, from 0; one pass precedes every question.
        pass: usize,
        /// The things that are inferred.
        objects: Vec<ObjectId>,
    },
    /// A model called a tool of the server.
    ToolCalled {
        /// The thing that the conversation is about.
        object_id: ObjectId,
        /// The tool.
        tool: String,
        /// Whether the tool answered with an error.
        is_error: bool,
    },
    /// A model scored a thing.
    ObjectInferred {
        /// The thing.
        object_id: ObjectId,
        /// The scores.
        scores: Scores,
        /// The most probable owner set.
        owners: Owners,
        /// Its probability.
        confidence: f64,
    },
    /// A model failed on a thing or had to be corrected. The scores follow as those of another event.
    ModelFaltered {
        /// The thing.
        object_id: ObjectId,
        /// What was wrong and what was done about it.
        reason: String,
    },
    /// A person is asked.
    QuestionAsked {
        /// The number of the question, from 1.
        step: usize,
        /// The thing.
        object_id: ObjectId,
        /// Other things that the question is about as well.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        also: Vec<ObjectId>,
        /// The question.
        question: String,
    },
    /// A question that was put in an earlier part of the run; what became of it follows.
    QuestionRecalled {
        /// The number of the question, from 1.
        step: usize,
        /// The thing.
        object_id: ObjectId,
        /// The question.
        question: String,
        /// The answer; empty where there was none.
        answer: String,
    },
    /// A person answered.
    AnswerRead {
        /// The number of the question, from 1.
        step: usize,
        /// The thing.
        object_id: ObjectId,
        /// The answer.
        answer: String,
        /// Who gave it, where known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "UserName")]
        answered_by: Option<UserName>,
        /// How it was read.
        ownership: OwnershipBoolean,
        /// The owner is somebody outside the household.
        owner_outside_household: bool,
        /// What became of it.
        status: AnswerStatus,
    },
    /// A person would not answer.
    QuestionDeclined {
        /// The number of the question, from 1.
        step: usize,
        /// The thing.
        object_id: ObjectId,
    },
    /// The answer to a question was taken back; the question is put again.
    AnswerUndone {
        /// The number of the question, from 1.
        step: usize,
        /// The thing.
        object_id: ObjectId,
    },
    /// There was nobody left to ask; the question stays open.
    NobodyLeft {
        /// The thing.
        object_id: ObjectId,
    },
    /// The run ended.
    RunFinished {
        /// Why.
        stopped: Stopped,
        /// The result in figures.
        metrics: MetricsReport,
    },
}
