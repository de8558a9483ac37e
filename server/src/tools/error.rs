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
