//! The messages of one step and what is remembered of them.

use std::collections::BTreeMap;

use coin_schemas::model::{RelatedObjects, Task};
use coin_schemas::tools::{NearbyObjectsResult, SimilarObjectsResult};
use serde_json::Value;

use super::{CalledTool, StepError};
use crate::client::ToolOutcome;
use crate::lines::json_in_lines;
use crate::model::{Message, ToolCall};

/// A tool result that is longer is cut before the model sees it, in bytes.
pub(super) const MOST_RESULT_BYTES: usize = 64 * 1024;

/// What a tool result says of the beliefs about things, which somebody else weighs where scores are fused.
const BELIEFS: [&str; 5] = ["known_ownership", "owners", "confidence", "settled", "source"];

/// In which form a model sees the results of its tool calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    /// Unchanged.
    AsTheServerGaveIt,
    /// Without what is believed of the owners of things.
    WithoutOwners,
}

/// A call that a model made, and what it was shown of the result.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenResult {
    /// The call.
    pub call: ToolCall,
    /// What the server answered, in full.
    pub text: String,
}

/// The messages of one step and what is remembered of them.
pub(super) struct Conversation {
    pub(super) messages: Vec<Message>,
    pub(super) called: Vec<CalledTool>,
    pub(super) seen: Vec<SeenResult>,
    pub(super) related: RelatedObjects,
    calls: BTreeMap<String, usize>,
    shown: Shown,
}

impl Conversation {
    pub(super) fn new(instructions: &str, task: &Task, shown: Shown) -> Result<Self, StepError> {
        let slots = serde_json::to_value(task).map_err(|error| StepError::Unusable {
            reason: format!("the task cannot be written: {error}"),
        })?;
        Ok(Self {
            messages: vec![
                Message::System { text: instructions.to_owned() },
                Message::User { text: json_in_lines(&slots) },
            ],
            called: Vec::new(),
            seen: Vec::new(),
            related: RelatedObjects::new(),
            calls: BTreeMap::new(),
            shown,
        })
    }

    pub(super) fn say(&mut self, text: Option<String>, tool_calls: Vec<ToolCall>) {
        self.messages.push(Message::Assistant { text, tool_calls });
    }

    /// How often this very call was made, this time included.
    pub(super) fn count_call(&mut self, call: &ToolCall) -> usize {
        let key = format!("{} {}", call.tool, call.arguments.to_text());
        let count = self.calls.entry(key).or_insert(0);
        *count += 1;
        *count
    }

    pub(super) fn take_result(&mut self, call: ToolCall, outcome: ToolOutcome) {
        let ToolOutcome { text, is_error } = outcome;
        let mut shown = match (self.shown, is_error) {
            (Shown::WithoutOwners, false) => without_beliefs(&text),
            _ => text.clone(),
        };
        if shown.len() > MOST_RESULT_BYTES {
            shown.truncate(shown.floor_char_boundary(MOST_RESULT_BYTES));
            shown.push_str("… (cut: the result is too long)");
        }
        self.called.push(CalledTool { tool: call.tool.clone(), is_error });
        self.messages.push(Message::Tool {
            call_id: call.id.clone(),
            tool: call.tool.clone(),
            text: shown,
            is_error,
        });
        if !is_error {
            self.related.extend(related_objects(&call.tool, &text));
            self.seen.push(SeenResult { call, text });
        }
    }

    /// Shows the model its own words and what is wrong with them. The last user message stays the task, so
    /// the correction comes as an instruction.
    pub(super) fn correct(&mut self, text: String, reason: &str) {
        self.messages.push(Message::Assistant { text: Some(text), tool_calls: Vec::new() });
        self.messages.push(Message::System { text: reason.to_owned() });
    }
}

/// The things whose known owners a tool result shows.
fn related_objects(tool: &str, text: &str) -> RelatedObjects {
    match tool {
        "nearby_objects" => serde_json::from_str::<NearbyObjectsResult>(text)
            .map(|result| result.nearby_objects.into_iter().map(|neighbour| neighbour.id).collect())
            .unwrap_or_default(),
        "similar_objects" => serde_json::from_str::<SimilarObjectsResult>(text)
            .map(|result| result.similar_objects.into_iter().map(|look_alike| look_alike.id).collect())
            .unwrap_or_default(),
        _ => RelatedObjects::new(),
    }
}

/// A result without what is believed of owners. A result that is no JSON is left as it is: it holds no belief that
/// could be told apart.
fn without_beliefs(text: &str) -> String {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(fields) => {
                fields.retain(|name, _| !BELIEFS.contains(&name.as_str()));
                fields.values_mut().for_each(strip);
            }
            Value::Array(items) => items.iter_mut().for_each(strip),
            _ => {}
        }
    }
    match serde_json::from_str::<Value>(text) {
        Ok(mut value) => {
            strip(&mut value);
            value.to_string()
        }
        Err(_) => text.to_owned(),
    }
}
