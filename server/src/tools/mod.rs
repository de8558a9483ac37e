//! The tools: one file each, and what they have in common.
//!
//! A tool's schemas are derived from the types that parse its arguments and make its result. Whatever a caller
//! can do wrong is answered with a [`ToolError`], whose text is meant for the model that made the call.

mod arguments;
mod error;
mod fields;
mod get_usage_summary;
mod known_ownership;
mod list_objects;
mod list_users;
mod nearby_objects;
mod record_answer;
mod record_scores;
mod record_usage;
mod registry;
mod retract_answer;
mod schema;
mod similar_objects;
#[cfg(test)]
mod tests;

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::store::Store;

pub(crate) use error::ToolError;
pub(crate) use registry::Registry;
pub use registry::{ToolSelection, UnknownTool};

/// What a tool does to the home. Every tool may be called again with the same arguments without a further
/// effect, none destroys anything, and none reaches outside the home.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// It looks.
    Reads,
    /// It records something.
    Records,
}

/// A tool: its words and what it does.
pub(crate) trait Tool {
    /// What it is called by.
    const NAME: &'static str;
    /// What people see.
    const TITLE: &'static str;
    /// What models read: what it tells, when to call it, where its arguments come from.
    const DESCRIPTION: &'static str;
    /// Arguments that can be copied, as JSON.
    const EXAMPLE: &'static str;
    /// What it does to the home.
    const EFFECT: Effect;

    /// What it takes.
    type Arguments: DeserializeOwned + JsonSchema;
    /// What it gives.
    type Output: Serialize + JsonSchema;

    /// Does it.
    fn call(store: &Store, arguments: Self::Arguments) -> Result<Self::Output, ToolError>;
}
