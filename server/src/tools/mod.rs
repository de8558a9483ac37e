//! The tools: one file each, and what they have in common.
//!
//! A tool's schemas are derived from the types that parse its arguments and make its result. Whatever a caller
//! can do wrong is answered with a [`ToolError`], whose text is meant for the model that made the call.

mod add_user;
mod arguments;
mod ask_owner;
mod conversation;
pub(crate) mod document;
mod error;
mod fields;
mod find_object;
mod get_usage_summary;
mod list_objects;
mod list_users;
mod nearby_objects;
mod next_question;
mod observe_objects;
mod record_answer;
mod record_scores;
mod record_usage;
mod registry;
mod retract_answer;
mod schema;
mod similar_objects;
#[cfg(test)]
mod tests;
mod whose_is;

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::store::Store;

pub(crate) use arguments::item as read_item;
pub(crate) use ask_owner::FORM_LIFETIME;
pub(crate) use conversation::{Form, FormState, Person, Reply, Turn};
pub(crate) use error::ToolError;
pub(crate) use fields::quoted;
pub(crate) use registry::{Entry, Registry};
pub use registry::{ToolSelection, UnknownTool};
pub(crate) use schema::of_arguments as argument_schema;

/// What a tool does to the home. None destroys anything, and none reaches outside the home.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// It looks.
    Reads,
    /// It records something. The same call again has no further effect.
    Records,
    /// It asks a person and records the answer. The same call again asks again.
    Asks,
}

/// How long a tool keeps a thread busy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Well under a millisecond for a thing with a thousand events: it looks at one thing, or at the people.
    Brief,
    /// Longer: it looks at many things, or waits until what it writes is on the disk.
    Long,
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
    /// How long it takes.
    const EFFORT: Effort = Effort::Long;

    /// What it takes.
    type Arguments: DeserializeOwned + JsonSchema;
    /// What it gives.
    type Output: Serialize + JsonSchema;

    /// Does it, without a person to ask.
    fn call(store: &Store, arguments: Self::Arguments) -> Result<Self::Output, ToolError>;

    /// Does it, or gives a form that a person has to fill in first.
    fn converse(
        store: &Store,
        arguments: Self::Arguments,
        _person: Person,
    ) -> Result<Turn<Self::Output>, ToolError> {
        Self::call(store, arguments).map(Turn::Done)
    }
}
