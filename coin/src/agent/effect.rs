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
    /// The run is over.
    Finish {
        /// Why.
        stopped: Stopped,
    },
}
