//! The journal of a run (`DB.run.jsonl` beside the database): what was concluded and answered, so that
//! `host --resume` goes on where a run ended, also after a crash. JSON Lines, the heading first.

use std::collections::BTreeMap;

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::household::{ObjectId, Owners, Scores};
use crate::model::{OwnerSetProbability, RelatedObjects};
use crate::report::{Gate, QuestionReport, Reinference, ScoreParts, Scoring, Withheld};

/// The version of the file's form.
pub const JOURNAL_VERSION: u32 = 1;

/// One line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "entry", rename_all = "snake_case")]
pub enum JournalEntry {
    /// The first line: what has to be the same for the run to go on.
    Run(JournalHeading),
    /// A thing was inferred.
    Inferred {
        /// The thing.
        object_id: ObjectId,
        /// Every member's score.
        scores: Scores,
        /// The probabilities of owner sets, to the last bit.
        owner_sets: Vec<OwnerSetProbability>,
        /// The things whose known owners the scores rest on.
        related: RelatedObjects,
        /// The two parts of fused scores.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "ScoreParts")]
        parts: Option<ScoreParts>,
        /// What went wrong, and what was done about it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "String")]
        problem: Option<String>,
    },
    /// A question was answered. The line is written before the answer is recorded in the database, so that no answer is
    /// lost between the two.
    Answered {
        /// The question and its answer.
        question: QuestionReport,
        /// The owner is somebody outside the household.
        owner_outside_household: bool,
    },
    /// Somebody heard a question and would not answer it.
    Declined {
        /// The question; its answer is empty.
        question: QuestionReport,
    },
    /// The last question's answer was taken back.
    Undone,
}

/// The run that a journal is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct JournalHeading {
    /// The version of the file's form; this program reads version 1.
    pub version: u32,
    /// The episode's name.
    pub episode: String,
    /// The episode's present.
    #[schemars(with = "String")]
    pub now: DateTime,
    /// The members of the household.
    pub users: Owners,
    /// The things.
    pub objects: Vec<ObjectId>,
    /// Who owned what by answers from before the run.
    pub answered: BTreeMap<ObjectId, Owners>,
    /// The model.
    pub model: String,
    /// The gate.
    pub gate: Gate,
    /// λ̂ of the calibration; absent where there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub lambda: Option<f64>,
    /// ε of the adaptive gate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub risk: Option<f64>,
    /// The seed.
    pub seed: u64,
    /// Which things are inferred again after an answer.
    pub reinference: Reinference,
    /// What the model was not told.
    pub withheld: Vec<Withheld>,
    /// How the scores are made.
    pub scoring: Scoring,
    /// Who answers.
    pub answers: String,
}
