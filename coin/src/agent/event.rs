//! What happens to the agent.

use coin_schemas::household::{ObjectId, Score};
use coin_schemas::model::RelatedObjects;
use coin_schemas::report::Stopped;

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
    /// It was worked out what questions are worth.
    Weighed {
        /// The doubt that is expected to be left in the home after each, in the order of the things.
        doubt_left: Vec<f64>,
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
    /// The run ends here, whatever is under way; what has been concluded so far is kept.
    Ended {
        /// Why.
        stopped: Stopped,
    },
}

/// A belief about one thing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inference {
    /// The score of every member, in the order of the roster.
    pub scores: Vec<Score>,
    /// The probabilities of owner sets: the model's own, or those that the scores imply.
    pub distribution: OwnerSetDistribution,
    /// The things whose known owners it rests on.
    pub related: RelatedObjects,
    /// What its two parts say by themselves, where it was fused from two.
    pub parts: Option<Parts>,
    /// What went wrong on the way and what was done about it, for the reader of the report.
    pub problem: Option<String>,
}

/// The two parts of a fused belief: every member's score, in the order of the roster.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// What a language model makes of the class, the people and the place; `None` where it failed, or was not asked
    /// because no opinion could have unsettled what the evidence says.
    pub model: Option<Vec<Score>>,
    /// What the evidence model makes of the usage and of the answers about other things.
    pub evidence: Vec<Score>,
}
