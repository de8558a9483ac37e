//! OpenAI's chat completions: requests as JSON, and replies from it.
//!
//! What is sent is what the published API allows. What is read is what servers that speak it are known to send.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::concessions::{Offer, Parameter};
use super::{MOST_COMPLETION_TOKENS, TEMPERATURE, echoed_name, unique_id};
use crate::model::{
    ChatReply, ChatRequest, Ending, Message, Origin, ReplyFormat, TokenUsage, ToolArguments, ToolCall,
    ToolDefinition,
};

/// The body of a request.
pub(super) fn body(model: &str, request: &ChatRequest<'_>, offer: &Offer, seed: u64) -> Value {
    let mut body = Map::new();
    body.insert("model".to_owned(), json!(model));
    let messages: Vec<Value> =
        request.conversation.iter().enumerate().map(|(place, said)| message(place, said)).collect();
    body.insert("messages".to_owned(), Value::Array(messages));
    if !request.tools.is_empty() {
        body.insert("tools".to_owned(), request.tools.iter().map(tool).collect());
    }
    if let ReplyFormat::Json { name, schema } = request.reply {
        let form = match offer.step(Parameter::ReplyForm) {
            0 => Some(json!({
                "type": "json_schema",
                "json_schema": {"name": name, "strict": true, "schema": schema},
            })),
            1 => Some(json!({"type": "json_object"})),
            _ => None,
        };
        body.extend(form.map(|form| ("response_format".to_owned(), form)));
    }
    if offer.step(Parameter::Temperature) == 0 {
        body.insert("temperature".to_owned(), json!(TEMPERATURE));
    }
    if offer.step(Parameter::Seed) == 0 {
        // The API takes a signed number.
        body.insert("seed".to_owned(), json!(seed & i64::MAX.unsigned_abs()));
    }
    let length = match offer.step(Parameter::Length) {
        0 => Some("max_completion_tokens"),
        1 => Some("max_tokens"),
        _ => None,
    };
    body.extend(length.map(|name| (name.to_owned(), json!(MOST_COMPLETION_TOKENS))));
    Value::Object(body)
}

fn message(place: usize, message: &Message) -> Value {
    match message {
        Message::System { text } => {
            // Many chat templates refuse instructions that do not stand at the beginning.
            let role = if place == 0 { "system" } else { "user" };
            json!({"role": role, "content": text})
        }
        Message::User { text } => json!({"role": "user", "content": text}),
        Message::Assistant { text, tool_calls } if tool_calls.is_empty() => {
            json!({"role": "assistant", "content": text.as_deref().unwrap_or_default()})
        }
        Message::Assistant { text, tool_calls } => json!({
            "role": "assistant",
            // Content may only be missing beside tool calls.
            "content": text.as_deref().filter(|text| !text.is_empty()),
            "tool_calls": tool_calls.iter().map(echoed_call).collect::<Vec<Value>>(),
        }),
        Message::Tool { call_id, text, .. } => {
            json!({"role": "tool", "tool_call_id": call_id, "content": text})
        }
    }
}

fn echoed_call(call: &ToolCall) -> Value {
    json!({
        "id": call.id,
        "type": "function",
        "function": {"name": echoed_name(&call.tool), "arguments": call.arguments.to_text()},
    })
}

fn tool(tool: &ToolDefinition) -> Value {
    json!({
        "type": "function",
        "function": {"name": tool.name, "description": tool.description, "parameters": tool.input_schema},
    })
}

/// Reads an answer. `taken` are the ids that new calls may not have.
///
/// # Errors
/// What is missing, if it is no chat completion.
pub(super) fn reply(body: &Value, mut taken: BTreeSet<String>) -> Result<ChatReply, String> {
    let choice = body.pointer("/choices/0").ok_or_else(|| match body.pointer("/error/message") {
        // Some gateways answer 200 although the model behind them failed.
        Some(Value::String(message)) => format!("the answer is an error, {message:?}"),
        _ => "the answer has no choices".to_owned(),
    })?;
    let message = choice
        .get("message")
        .filter(|message| message.is_object())
        .ok_or("the answer's first choice has no message")?;
    let text = text(message.get("content")).filter(|text| !text.trim().is_empty());
    let tool_calls: Vec<ToolCall> = message
        .get("tool_calls")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .map(|call| tool_call(call, &mut taken))
        .collect();
    let words = |value: Option<&Value>| {
        value.and_then(Value::as_str).filter(|words| !words.is_empty()).map(str::to_owned)
    };
    let refusal = words(message.get("refusal")).or_else(|| refusal_part(message.get("content")));
    let ending = match (choice.get("finish_reason").and_then(Value::as_str), refusal) {
        (_, Some(reason)) => Ending::Refused { reason },
        (Some("content_filter"), None) => {
            Ending::Refused { reason: "the provider's content filter stopped the reply".to_owned() }
        }
        (Some("length"), None) => Ending::CutShort,
        _ => Ending::Finished,
    };
    let tokens = |name: &str| body.pointer(name).and_then(Value::as_u64).unwrap_or(0);
    let usage = TokenUsage {
        prompt_tokens: tokens("/usage/prompt_tokens"),
        completion_tokens: tokens("/usage/completion_tokens"),
    };
    Ok(ChatReply { text, tool_calls, ending, usage, origin: Origin::Model })
}

/// The words of a message: a text, or a list of parts. Parts that hold reasoning are no words.
fn text(content: Option<&Value>) -> Option<String> {
    match content? {
        Value::String(text) => Some(without_reasoning(text).to_owned()),
        Value::Array(parts) => Some(
            parts
                .iter()
                .filter(|part| part.get("type").is_none_or(|kind| kind == "text"))
                .filter_map(|part| part.get("text")?.as_str())
                .collect(),
        ),
        _ => None,
    }
}

/// Local servers pass on reasoning before the words where they do not know the model.
fn without_reasoning(text: &str) -> &str {
    let reasoning = text.trim_start().strip_prefix("<think>").and_then(|rest| rest.split_once("</think>"));
    reasoning.map_or(text, |(_, words)| words.trim_start())
}

fn refusal_part(content: Option<&Value>) -> Option<String> {
    let parts = content?.as_array()?;
    parts.iter().find_map(|part| part.get("refusal")?.as_str()).map(str::to_owned)
}

fn tool_call(call: &Value, taken: &mut BTreeSet<String>) -> ToolCall {
    let function = call.get("function").unwrap_or(&Value::Null);
    ToolCall {
        id: unique_id(call.get("id").and_then(Value::as_str), taken),
        tool: function.get("name").and_then(Value::as_str).unwrap_or_default().to_owned(),
        arguments: arguments(function.get("arguments")),
    }
}

/// The arguments: JSON in a text, or, from some servers, the object itself. Nothing at all means none.
fn arguments(given: Option<&Value>) -> ToolArguments {
    match given {
        None | Some(Value::Null) => ToolArguments::Object(Map::new()),
        Some(Value::Object(arguments)) => ToolArguments::Object(arguments.clone()),
        Some(Value::String(text)) if text.trim().is_empty() => ToolArguments::Object(Map::new()),
        Some(Value::String(text)) => match serde_json::from_str(text) {
            Ok(arguments) => ToolArguments::Object(arguments),
            Err(_) => ToolArguments::Malformed(text.clone()),
        },
        Some(other) => ToolArguments::Malformed(other.to_string()),
    }
}
