//! Anthropic's messages: requests as JSON, and replies from it.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::concessions::{Offer, Parameter};
use super::{MOST_COMPLETION_TOKENS, TEMPERATURE, echoed_name, unique_id};
use crate::model::{
    ChatReply, ChatRequest, Ending, Message, Origin, TokenUsage, ToolArguments, ToolCall, ToolDefinition,
};

/// The key under which arguments that are no object are shown to the model again.
const MALFORMED: &str = "malformed_arguments";

/// The body of a request. The form of the reply is not sent: the instructions ask for it.
pub(super) fn body(model: &str, request: &ChatRequest<'_>, offer: &Offer) -> Value {
    let mut body = Map::new();
    body.insert("model".to_owned(), json!(model));
    body.insert("max_tokens".to_owned(), json!(MOST_COMPLETION_TOKENS));
    if offer.step(Parameter::Temperature) == 0 {
        body.insert("temperature".to_owned(), json!(TEMPERATURE));
    }
    let (instructions, said) = match request.conversation.split_first() {
        Some((Message::System { text }, said)) => (Some(text), said),
        _ => (None, request.conversation),
    };
    if let Some(text) = instructions.filter(|text| !text.trim().is_empty()) {
        // Tools stand before the instructions, so that this mark lets both be kept for the next request.
        let block = json!({"type": "text", "text": text, "cache_control": {"type": "ephemeral"}});
        body.insert("system".to_owned(), json!([block]));
    }
    if !request.tools.is_empty() {
        body.insert("tools".to_owned(), request.tools.iter().map(tool).collect());
    }
    body.insert("messages".to_owned(), Value::Array(messages(said)));
    Value::Object(body)
}

/// The turns. All that comes between two words of the model is one turn of the user: the results of its tool calls
/// must be together in one message, and corrections are words like others.
fn messages(said: &[Message]) -> Vec<Value> {
    let mut turns: Vec<(&str, Vec<Value>)> = Vec::new();
    for message in said {
        let (role, blocks) = match message {
            Message::System { text } | Message::User { text } => ("user", words(text).into_iter().collect()),
            Message::Assistant { text, tool_calls } => {
                let text = text.as_deref().and_then(words);
                ("assistant", text.into_iter().chain(tool_calls.iter().map(echoed_call)).collect())
            }
            Message::Tool { call_id, text, is_error, .. } => ("user", vec![result(call_id, text, *is_error)]),
        };
        match turns.last_mut() {
            _ if blocks.is_empty() => {}
            Some((last, there)) if *last == role => there.extend(blocks),
            _ => turns.push((role, blocks)),
        }
    }
    turns.into_iter().map(|(role, content)| json!({"role": role, "content": content})).collect()
}

/// A block of words; blank ones are refused.
fn words(text: &str) -> Option<Value> {
    (!text.trim().is_empty()).then(|| json!({"type": "text", "text": text}))
}

fn echoed_call(call: &ToolCall) -> Value {
    let input = match &call.arguments {
        ToolArguments::Object(arguments) => Value::Object(arguments.clone()),
        ToolArguments::Malformed(text) => json!({MALFORMED: text}),
    };
    json!({"type": "tool_use", "id": call.id, "name": echoed_name(&call.tool), "input": input})
}

fn result(call_id: &str, text: &str, is_error: bool) -> Value {
    let mut block = json!({"type": "tool_result", "tool_use_id": call_id, "content": text});
    if is_error {
        block["is_error"] = json!(true);
    }
    block
}

fn tool(tool: &ToolDefinition) -> Value {
    json!({"name": tool.name, "description": tool.description, "input_schema": tool.input_schema})
}

/// Reads an answer. `taken` are the ids that new calls may not have.
///
/// # Errors
/// What is missing, if it is no message.
pub(super) fn reply(body: &Value, mut taken: BTreeSet<String>) -> Result<ChatReply, String> {
    let content = body.get("content").and_then(Value::as_array).ok_or("the answer has no content")?;
    let kind = |block: &Value, kind: &str| block.get("type").and_then(Value::as_str) == Some(kind);
    let text: String = content
        .iter()
        .filter(|block| kind(block, "text"))
        .filter_map(|block| block.get("text")?.as_str())
        .collect();
    let tool_calls = content
        .iter()
        .filter(|block| kind(block, "tool_use"))
        .map(|block| tool_call(block, &mut taken))
        .collect();
    let text = Some(text).filter(|text| !text.trim().is_empty());
    let ending = match body.get("stop_reason").and_then(Value::as_str) {
        Some("max_tokens" | "model_context_window_exceeded") => Ending::CutShort,
        Some("refusal") => {
            let explanation = body.pointer("/stop_details/explanation").and_then(Value::as_str);
            let reason = explanation.or(text.as_deref()).unwrap_or("the model refused to answer");
            Ending::Refused { reason: reason.to_owned() }
        }
        _ => Ending::Finished,
    };
    let tokens = |name: &str| body.pointer(name).and_then(Value::as_u64).unwrap_or(0);
    let usage = TokenUsage {
        prompt_tokens: tokens("/usage/input_tokens")
            + tokens("/usage/cache_creation_input_tokens")
            + tokens("/usage/cache_read_input_tokens"),
        completion_tokens: tokens("/usage/output_tokens"),
    };
    Ok(ChatReply { text, tool_calls, ending, usage, origin: Origin::Model })
}

fn tool_call(block: &Value, taken: &mut BTreeSet<String>) -> ToolCall {
    ToolCall {
        id: unique_id(block.get("id").and_then(Value::as_str), taken),
        tool: block.get("name").and_then(Value::as_str).unwrap_or_default().to_owned(),
        arguments: match block.get("input") {
            None | Some(Value::Null) => ToolArguments::Object(Map::new()),
            Some(Value::Object(arguments)) => ToolArguments::Object(arguments.clone()),
            Some(Value::String(text)) => ToolArguments::Malformed(text.clone()),
            Some(other) => ToolArguments::Malformed(other.to_string()),
        },
    }
}
