//! OpenAI's form, from the side of the provider.

use coin_host::model::{
    ChatReply, Ending, Message, ReplyFormat, TokenUsage, ToolArguments, ToolCall, ToolDefinition,
};
use serde_json::{Value, json};

use super::brain::Turn;

/// Reads a request. What is missing is read as empty; the rules have complained about it.
pub(super) fn turn(body: &Value) -> Turn {
    let mut conversation: Vec<Message> = Vec::new();
    for message in list(&body["messages"]) {
        let words = || text(&message["content"]);
        conversation.push(match message["role"].as_str() {
            Some("assistant") => Message::Assistant {
                text: message["content"].as_str().map(str::to_owned),
                tool_calls: list(&message["tool_calls"]).iter().map(call).collect(),
            },
            Some("tool") => tool_result(&conversation, text(&message["tool_call_id"]), words()),
            Some("user") if !conversation.iter().any(|said| matches!(said, Message::User { .. })) => {
                Message::User { text: words() }
            }
            _ => Message::System { text: words() },
        });
    }
    let format = &body["response_format"]["json_schema"];
    Turn {
        conversation,
        tools: list(&body["tools"]).iter().map(|tool| definition(&tool["function"])).collect(),
        reply: match format["name"].as_str() {
            Some(name) => ReplyFormat::Json { name: name.to_owned(), schema: format["schema"].clone() },
            None => ReplyFormat::Text,
        },
    }
}

pub(super) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

pub(super) fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The form has no mark for errors; what is no JSON is one.
fn tool_result(conversation: &[Message], call_id: String, text: String) -> Message {
    let is_error = serde_json::from_str::<Value>(&text).is_err();
    Message::Tool { tool: tool_of(conversation, &call_id), call_id, text, is_error }
}

/// The tool that a call called.
pub(super) fn tool_of(conversation: &[Message], call_id: &str) -> String {
    let calls = conversation.iter().rev().filter_map(|message| match message {
        Message::Assistant { tool_calls, .. } => Some(tool_calls),
        _ => None,
    });
    calls.flatten().find(|call| call.id == call_id).map(|call| call.tool.clone()).unwrap_or_default()
}

fn call(call: &Value) -> ToolCall {
    let arguments = text(&call["function"]["arguments"]);
    ToolCall {
        id: text(&call["id"]),
        tool: text(&call["function"]["name"]),
        arguments: serde_json::from_str(&arguments)
            .map_or_else(|_| ToolArguments::Malformed(arguments.clone()), ToolArguments::Object),
    }
}

fn definition(function: &Value) -> ToolDefinition {
    ToolDefinition {
        name: text(&function["name"]),
        description: text(&function["description"]),
        input_schema: function["parameters"].as_object().cloned().unwrap_or_default(),
    }
}

/// A chat completion. `id` tells the answers apart.
pub(super) fn answer(reply: &ChatReply, model: &Value, id: &str, usage: TokenUsage) -> Value {
    let calls: Vec<Value> = reply
        .tool_calls
        .iter()
        .enumerate()
        .map(|(place, call)| {
            json!({
                "id": format!("call_{id}{place}"),
                "type": "function",
                "function": {"name": call.tool, "arguments": call.arguments.to_text()},
            })
        })
        .collect();
    let refusal = match &reply.ending {
        Ending::Refused { reason } => Some(reason),
        _ => None,
    };
    let mut message = json!({
        "role": "assistant",
        "content": reply.text,
        "refusal": refusal,
        "annotations": [],
    });
    if !calls.is_empty() {
        message["tool_calls"] = Value::Array(calls);
    }
    let finish_reason = match reply.ending {
        Ending::CutShort => "length",
        _ if !reply.tool_calls.is_empty() => "tool_calls",
        _ => "stop",
    };
    json!({
        "id": format!("chatcmpl-{id}"),
        "object": "chat.completion",
        "created": 1_735_689_600,
        "model": model,
        "choices": [{"index": 0, "message": message, "logprobs": null, "finish_reason": finish_reason}],
        "usage": {
            "prompt_tokens": usage.prompt_tokens,
            "completion_tokens": usage.completion_tokens,
            "total_tokens": usage.prompt_tokens + usage.completion_tokens,
        },
        "service_tier": "default",
        "system_fingerprint": "fp_scripted",
    })
}

/// The embedding of one text.
pub(super) fn embedding(embedding: &[f64], model: &Value) -> Value {
    json!({
        "object": "list",
        "data": [{"object": "embedding", "index": 0, "embedding": embedding}],
        "model": model,
        "usage": {"prompt_tokens": 1, "total_tokens": 1},
    })
}

/// An error. `parameter` is what it is about.
pub(super) fn error(message: &str, kind: &str, code: Option<&str>, parameter: Option<&str>) -> Value {
    json!({"error": {"message": message, "type": kind, "param": parameter, "code": code}})
}
