//! Anthropic's form, from the side of the provider.

use coin_host::model::{
    ChatReply, Ending, Message, ReplyFormat, TokenUsage, ToolArguments, ToolCall, ToolDefinition,
};
use serde_json::{Value, json};

use super::brain::Turn;
use super::openai::{list, text, tool_of};

/// Reads a request. What is missing is read as empty; the rules have complained about it.
pub(super) fn turn(body: &Value) -> Turn {
    let instructions = list(&body["system"]).iter().map(|block| text(&block["text"])).collect::<String>();
    let mut conversation = vec![Message::System { text: instructions }];
    for message in list(&body["messages"]) {
        let content = list(&message["content"]);
        if message["role"] == "assistant" {
            conversation.push(assistant(content));
            continue;
        }
        for block in content {
            let is_task = !conversation.iter().any(|said| matches!(said, Message::User { .. }));
            conversation.push(match block["type"].as_str() {
                Some("tool_result") => {
                    let call_id = text(&block["tool_use_id"]);
                    Message::Tool {
                        tool: tool_of(&conversation, &call_id),
                        call_id,
                        text: text(&block["content"]),
                        is_error: block["is_error"] == true,
                    }
                }
                _ if is_task => Message::User { text: text(&block["text"]) },
                _ => Message::System { text: text(&block["text"]) },
            });
        }
    }
    let definition = |tool: &Value| ToolDefinition {
        name: text(&tool["name"]),
        description: text(&tool["description"]),
        input_schema: tool["input_schema"].as_object().cloned().unwrap_or_default(),
    };
    Turn {
        conversation,
        tools: list(&body["tools"]).iter().map(definition).collect(),
        reply: ReplyFormat::Text,
    }
}

fn assistant(content: &[Value]) -> Message {
    let of_kind = |kind: &'static str| content.iter().filter(move |block| block["type"] == kind);
    let words: String = of_kind("text").map(|block| text(&block["text"])).collect();
    Message::Assistant {
        text: Some(words).filter(|words| !words.is_empty()),
        tool_calls: of_kind("tool_use")
            .map(|block| ToolCall {
                id: text(&block["id"]),
                tool: text(&block["name"]),
                arguments: ToolArguments::Object(block["input"].as_object().cloned().unwrap_or_default()),
            })
            .collect(),
    }
}

/// A message. `id` tells the answers apart.
pub(super) fn answer(reply: &ChatReply, model: &Value, id: &str, usage: TokenUsage) -> Value {
    let words = reply.text.as_ref().map(|text| json!({"type": "text", "text": text}));
    let calls = reply.tool_calls.iter().enumerate().map(|(place, call)| {
        let input = match &call.arguments {
            ToolArguments::Object(arguments) => Value::Object(arguments.clone()),
            ToolArguments::Malformed(text) => json!(text),
        };
        json!({"type": "tool_use", "id": format!("toolu_{id}{place}"), "name": call.tool, "input": input})
    });
    let (stop_reason, details) = match &reply.ending {
        Ending::CutShort => ("max_tokens", Value::Null),
        Ending::Refused { reason } => {
            ("refusal", json!({"type": "refusal", "category": null, "explanation": reason}))
        }
        Ending::Finished if !reply.tool_calls.is_empty() => ("tool_use", Value::Null),
        Ending::Finished => ("end_turn", Value::Null),
    };
    // What is charged comes in three parts, which only together are the prompt.
    let (written, read) = (usage.prompt_tokens / 4, usage.prompt_tokens / 3);
    json!({
        "id": format!("msg_{id}"),
        "type": "message",
        "role": "assistant",
        "model": model,
        "content": words.into_iter().chain(calls).collect::<Vec<Value>>(),
        "stop_reason": stop_reason,
        "stop_details": details,
        "stop_sequence": null,
        "usage": {
            "input_tokens": usage.prompt_tokens - written - read,
            "cache_creation_input_tokens": written,
            "cache_read_input_tokens": read,
            "output_tokens": usage.completion_tokens,
        },
    })
}

/// An error.
pub(super) fn error(message: &str, kind: &str) -> Value {
    json!({"type": "error", "error": {"type": kind, "message": message}, "request_id": "req_scripted"})
}
