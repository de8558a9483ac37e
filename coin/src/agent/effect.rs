//! What the agent wants done.

use coin_schemas::household::ObjectId;
use coin_schemas::report::Stopped;

/// Something that the driver does for the agent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Effect {
    /// Have a model score these things; answer each with `Inferred` or `InferenceFailed`, in any order.
    Infer {
        /// The things, by id.
        objects: Vec<ObjectId>,
    },
    /// Store the present beliefs about these things.
    Record {
        /// The things, by id.
        objects: Vec<ObjectId>,
    },
    /// Work out what questions about these things are worth; answer with `Weighed`.
    Weigh {
        /// The things, the least sure one first.
        objects: Vec<ObjectId>,
    },
    /// Ask a person about this thing (QUESTION-GENERATION); answer with `Answered`, `Declined` or `NobodyLeft`.
    Ask {
        /// The thing.
        object: ObjectId,
    },
    /// Ask a person about all these things in one question; answer with the same. An answer that is the same for all is
    /// `Answered`; one that leaves them open is `Answered` without a resolved reading.
    AskTogether {
        /// The things, the least sure one first, all held to belong to the same people.
        objects: Vec<ObjectId>,
    },
    /// The run is over.
    Finish {
        /// Why.
        stopped: Stopped,
    },
}
