//! The tools that a server offers: their definitions, made once, and their functions.

use std::collections::BTreeMap;
use std::str::FromStr;
use std::sync::Arc;

use rmcp::model::{JsonObject, Tool as Definition, ToolAnnotations};
use serde_json::Value;
use thiserror::Error;

use super::add_user::AddUserTool;
use super::ask_owner::AskOwnerTool;
use super::find_object::FindObjectTool;
use super::get_usage_summary::GetUsageSummaryTool;
use super::list_objects::ListObjectsTool;
use super::list_users::ListUsersTool;
use super::nearby_objects::NearbyObjectsTool;
use super::next_question::NextQuestionTool;
use super::observe_objects::ObserveObjectsTool;
use super::record_answer::RecordAnswerTool;
use super::record_scores::RecordScoresTool;
use super::record_usage::RecordUsageTool;
use super::retract_answer::RetractAnswerTool;
use super::similar_objects::SimilarObjectsTool;
use super::whose_is::WhoseIsTool;
use super::{Effect, Effort, Person, Tool, ToolError, Turn, arguments, schema};
use crate::near_miss;
use crate::store::{Access, Store};

/// The tools of the paper: what a client with an ownership loop of its own needs.
const CORE: [&str; 4] = ["get_usage_summary", "nearby_objects", "similar_objects", "record_answer"];

/// Which tools are offered. Read from a text: `all`, `core` or names with commas between them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ToolSelection {
    /// All of them where there are no names.
    names: Option<Vec<&'static str>>,
}

impl ToolSelection {
    /// Every tool.
    pub fn all() -> Self {
        Self { names: None }
    }

    /// The paper's four, which a client with an ownership loop of its own needs: `get_usage_summary`,
    /// `nearby_objects`, `similar_objects` and `record_answer`.
    pub fn core() -> Self {
        Self { names: Some(CORE.to_vec()) }
    }

    fn holds(&self, name: &str) -> bool {
        self.names.as_ref().is_none_or(|names| names.contains(&name))
    }
}

impl FromStr for ToolSelection {
    type Err = UnknownTool;

    fn from_str(text: &str) -> Result<Self, UnknownTool> {
        match text.trim() {
            "all" => Ok(Self::all()),
            "core" => Ok(Self::core()),
            names => {
                let known = Registry::all();
                let names =
                    names.split(',').map(|name| known.known_name(name.trim())).collect::<Result<_, _>>()?;
                Ok(Self { names: Some(names) })
            }
        }
    }
}

/// There is no tool of this name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no tool {given:?}.{hint} The tools are {known}.")]
pub struct UnknownTool {
    given: String,
    hint: String,
    known: String,
}

type Function = fn(&Store, &JsonObject, &JsonObject, Person) -> Result<Turn<Value>, ToolError>;

/// A tool that is offered.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    definition: Definition,
    effect: Effect,
    effort: Effort,
    function: Function,
}

impl Entry {
    fn new<T: Tool>() -> Self {
        let reads = T::EFFECT == Effect::Reads;
        let annotations = ToolAnnotations::from_raw(
            None,
            Some(reads),
            Some(false),
            Some(T::EFFECT != Effect::Asks),
            Some(false),
        );
        let mut definition = Definition::new(T::NAME, T::DESCRIPTION, schema::of_arguments::<T::Arguments>());
        definition.title = Some(T::TITLE.to_owned());
        definition.output_schema = Some(Arc::new(schema::of_output::<T::Output>()));
        definition.annotations = Some(annotations);
        Self { definition, effect: T::EFFECT, effort: T::EFFORT, function: call::<T> }
    }

    /// Whether the tool keeps a thread busy for less than it takes to hand it to another one.
    pub(crate) fn is_brief(&self) -> bool {
        self.effort == Effort::Brief
    }

    /// Whether the tool may have a person fill in a form.
    pub(crate) fn asks(&self) -> bool {
        self.effect == Effect::Asks
    }

    /// Runs the tool.
    pub(crate) fn call(
        &self,
        store: &Store,
        arguments: &JsonObject,
        person: Person,
    ) -> Result<Turn<Value>, ToolError> {
        (self.function)(store, &self.definition.input_schema, arguments, person)
    }
}

fn call<T: Tool>(
    store: &Store,
    schema: &JsonObject,
    arguments: &JsonObject,
    person: Person,
) -> Result<Turn<Value>, ToolError> {
    match T::converse(store, arguments::parse::<T>(schema, arguments)?, person)? {
        Turn::Done(output) => serde_json::to_value(output).map(Turn::Done).map_err(ToolError::Output),
        Turn::Ask(form) => Ok(Turn::Ask(form)),
    }
}

/// The offered tools by name.
#[derive(Debug)]
pub(crate) struct Registry {
    entries: BTreeMap<&'static str, Entry>,
}

impl Registry {
    fn all() -> Self {
        let mut entries = BTreeMap::new();
        let mut add = |name, entry| entries.insert(name, entry);
        add(AddUserTool::NAME, Entry::new::<AddUserTool>());
        add(AskOwnerTool::NAME, Entry::new::<AskOwnerTool>());
        add(FindObjectTool::NAME, Entry::new::<FindObjectTool>());
        add(GetUsageSummaryTool::NAME, Entry::new::<GetUsageSummaryTool>());
        add(ListObjectsTool::NAME, Entry::new::<ListObjectsTool>());
        add(ListUsersTool::NAME, Entry::new::<ListUsersTool>());
        add(NearbyObjectsTool::NAME, Entry::new::<NearbyObjectsTool>());
        add(NextQuestionTool::NAME, Entry::new::<NextQuestionTool>());
        add(ObserveObjectsTool::NAME, Entry::new::<ObserveObjectsTool>());
        add(RecordAnswerTool::NAME, Entry::new::<RecordAnswerTool>());
        add(RecordScoresTool::NAME, Entry::new::<RecordScoresTool>());
        add(RecordUsageTool::NAME, Entry::new::<RecordUsageTool>());
        add(RetractAnswerTool::NAME, Entry::new::<RetractAnswerTool>());
        add(SimilarObjectsTool::NAME, Entry::new::<SimilarObjectsTool>());
        add(WhoseIsTool::NAME, Entry::new::<WhoseIsTool>());
        Self { entries }
    }

    /// The selected tools; those that record something only where that is possible.
    pub(crate) fn new(selection: &ToolSelection, access: Access) -> Self {
        let mut registry = Self::all();
        registry.entries.retain(|name, entry| {
            selection.holds(name) && (access == Access::ReadWrite || entry.effect == Effect::Reads)
        });
        registry
    }

    fn known_name(&self, given: &str) -> Result<&'static str, UnknownTool> {
        self.entries.get_key_value(given).map(|(&name, _)| name).ok_or_else(|| self.unknown(given))
    }

    /// The tool of this name.
    pub(crate) fn get(&self, name: &str) -> Option<&Entry> {
        self.entries.get(name)
    }

    /// Whether all of these tools are offered.
    pub(crate) fn offers(&self, names: &[&str]) -> bool {
        names.iter().all(|name| self.entries.contains_key(name))
    }

    /// The definitions by name.
    pub(crate) fn definitions(&self) -> Vec<Definition> {
        self.entries.values().map(|entry| entry.definition.clone()).collect()
    }

    /// The definition of the tool of this name.
    pub(crate) fn definition(&self, name: &str) -> Option<Definition> {
        self.get(name).map(|entry| entry.definition.clone())
    }

    /// Says that there is no such tool, and which there are.
    pub(crate) fn unknown(&self, given: &str) -> UnknownTool {
        UnknownTool {
            given: given.to_owned(),
            hint: near_miss::hint(given, self.entries.keys().copied()),
            known: self.entries.keys().copied().collect::<Vec<_>>().join(", "),
        }
    }

    /// Adds a tool that only tests have.
    #[cfg(test)]
    pub(crate) fn with<T: Tool>(mut self) -> Self {
        self.entries.insert(T::NAME, Entry::new::<T>());
        self
    }
}
