//! What happens to the agent.

use coin_schemas::household::{ObjectId, Score};
use coin_schemas::model::RelatedObjects;

use crate::dialogue::Reading;
use crate::owners::OwnerSetDistribution;

/// Something that the driver tells the agent.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// The run begins.
    Started,
    /// A model scored a thing (LLM-INFER).
    Inferred {
        /// The thing.
        object: ObjectId,
        /// What it said.
        inference: Inference,
    },
    /// A model could not be made to score a thing.
    InferenceFailed {
        /// The thing.
        object: ObjectId,
        /// Why, for the reader of the report.
        reason: String,
    },
    /// A person answered the question and the answer was read (UNDERSTAND-ANSWER).
    Answered {
        /// How it was read.
        reading: Reading,
    },
    /// A person heard the question and would not answer it.
    Declined,
    /// There is nobody left to ask.
    NobodyLeft,
}

/// A model's belief about one thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Inference {
    /// The score of every member, in the order of the roster.
    pub scores: Vec<Score>,
    /// The probabilities of owner sets: the model's own, or those that the scores imply.
    pub distribution: OwnerSetDistribution,
    /// The things whose known owners the model could see.
    pub related: RelatedObjects,
}
