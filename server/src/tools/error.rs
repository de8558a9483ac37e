//! Why a tool did not do what it was asked to, in words that the caller can act on.

use thiserror::Error;

use crate::store::StoreError;

/// The text of an `isError` result.
#[derive(Debug, Error)]
pub(crate) enum ToolError {
    /// A field of the arguments is wrong.
    #[error("{field}: {problem}")]
    Field {
        /// The field, with its path where it is nested.
        field: String,
        /// What was given and what is allowed.
        problem: String,
    },
    /// The arguments as a whole do not fit.
    #[error("{problem} Example: {tool} {example}")]
    Arguments {
        /// The tool.
        tool: &'static str,
        /// What is wrong, in a sentence.
        problem: String,
        /// Arguments that fit.
        example: &'static str,
    },
    /// A person has to be asked, and the client shows no forms.
    #[error(
        "this client cannot show a form to a person. Ask in the chat: {question:?} Then call ask_owner with \
         object_id {object_id:?} and what the person said as owner."
    )]
    Unreachable {
        /// The question, ready to be asked.
        question: String,
        /// The thing.
        object_id: String,
    },
    /// A form came back that does not count.
    #[error("this form {reason}; call ask_owner again for a new one")]
    StaleForm {
        /// Why not.
        reason: &'static str,
    },
    /// The operating system gives no random numbers.
    #[error("no form can be made, because the operating system gives no random numbers: {reason}")]
    NoRandomness {
        /// What it says.
        reason: String,
    },
    /// The store refused or failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The result could not be written down.
    #[error("the result cannot be written as JSON: {0}")]
    Output(serde_json::Error),
}

impl ToolError {
    pub(crate) fn field(field: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Field { field: field.into(), problem: problem.into() }
    }
}
