//! Request bodies of a conversation of two turns, with a correction.

use serde_json::{Map, Value, json};

use super::super::concessions::{Offer, Parameter};
use super::super::{anthropic, openai};
use crate::model::{ChatRequest, Message, ReplyFormat, ToolArguments, ToolCall, ToolDefinition};

fn call(id: &str, tool: &str, arguments: ToolArguments) -> ToolCall {
    ToolCall { id: id.to_owned(), tool: tool.to_owned(), arguments }
}

fn result(call_id: &str, text: &str, is_error: bool) -> Message {
    Message::Tool {
        call_id: call_id.to_owned(),
        tool: "nearby_objects".to_owned(),
        text: text.to_owned(),
        is_error,
    }
}

fn said(text: &str) -> Message {
    Message::Assistant { text: Some(text.to_owned()), tool_calls: Vec::new() }
}

fn correction(text: &str) -> Message {
    Message::System { text: text.to_owned() }
}

fn conversation() -> Vec<Message> {
    let arguments = Map::from_iter([("object_id".to_owned(), json!("marker"))]);
    vec![
        Message::System { text: "Judge.".to_owned() },
        Message::User { text: r#"{"task": "infer_ownership"}"#.to_owned() },
        Message::Assistant {
            text: Some("I look around.".to_owned()),
            tool_calls: vec![
                call("c1", "nearby_objects", ToolArguments::Object(arguments)),
                call("c2", "nearby_objects", ToolArguments::Malformed(r#"{"object_id": "#.to_owned())),
            ],
        },
        result("c1", r#"{"nearby_objects": []}"#, false),
        result("c2", "the arguments must be a JSON object", true),
        said("It is Bob's."),
        correction("Answer again with JSON only."),
        said(""),
        correction("Your reply was empty."),
    ]
}

fn body(write: impl Fn(&ChatRequest<'_>) -> Value) -> Value {
    let tools = [ToolDefinition {
        name: "nearby_objects".to_owned(),
        description: "What lies near a thing.".to_owned(),
        input_schema: Map::from_iter([("type".to_owned(), json!("object"))]),
    }];
    let reply = ReplyFormat::Json { name: "ownership".to_owned(), schema: json!({"type": "object"}) };
    write(&ChatRequest { conversation: &conversation(), tools: &tools, reply: &reply })
}

#[test]
fn openai_is_asked() {
    insta::assert_json_snapshot!(body(|request| openai::body("gpt", request, &Offer::default(), 7)), @r#"
    {
      "model": "gpt",
      "messages": [
        {
          "role": "system",
          "content": "Judge."
        },
        {
          "role": "user",
          "content": "{\"task\": \"infer_ownership\"}"
        },
        {
          "role": "assistant",
          "content": "I look around.",
          "tool_calls": [
            {
              "id": "c1",
              "type": "function",
              "function": {
                "name": "nearby_objects",
                "arguments": "{\"object_id\":\"marker\"}"
              }
            },
            {
              "id": "c2",
              "type": "function",
              "function": {
                "name": "nearby_objects",
                "arguments": "{\"object_id\": "
              }
            }
          ]
        },
        {
          "role": "tool",
          "tool_call_id": "c1",
          "content": "{\"nearby_objects\": []}"
        },
        {
          "role": "tool",
          "tool_call_id": "c2",
          "content": "the arguments must be a JSON object"
        },
        {
          "role": "assistant",
          "content": "It is Bob's."
        },
        {
          "role": "user",
          "content": "Answer again with JSON only."
        },
        {
          "role": "assistant",
          "content": ""
        },
        {
          "role": "user",
          "content": "Your reply was empty."
        }
      ],
      "tools": [
        {
          "type": "function",
          "function": {
            "name": "nearby_objects",
            "description": "What lies near a thing.",
            "parameters": {
              "type": "object"
            }
          }
        }
      ],
      "response_format": {
        "type": "json_schema",
        "json_schema": {
          "name": "ownership",
          "strict": true,
          "schema": {
            "type": "object"
          }
        }
      },
      "temperature": 0.2,
      "seed": 7,
      "max_completion_tokens": 8192
    }
    "#);
}

#[test]
fn anthropic_is_asked() {
    insta::assert_json_snapshot!(body(|request| anthropic::body("claude", request, &Offer::default())), @r#"
    {
      "model": "claude",
      "max_tokens": 8192,
      "temperature": 0.2,
      "system": [
        {
          "type": "text",
          "text": "Judge.",
          "cache_control": {
            "type": "ephemeral"
          }
        }
      ],
      "tools": [
        {
          "name": "nearby_objects",
          "description": "What lies near a thing.",
          "input_schema": {
            "type": "object"
          }
        }
      ],
      "messages": [
        {
          "role": "user",
          "content": [
            {
              "type": "text",
              "text": "{\"task\": \"infer_ownership\"}"
            }
          ]
        },
        {
          "role": "assistant",
          "content": [
            {
              "type": "text",
              "text": "I look around."
            },
            {
              "type": "tool_use",
              "id": "c1",
              "name": "nearby_objects",
              "input": {
                "object_id": "marker"
              }
            },
            {
              "type": "tool_use",
              "id": "c2",
              "name": "nearby_objects",
              "input": {
                "malformed_arguments": "{\"object_id\": "
              }
            }
          ]
        },
        {
          "role": "user",
          "content": [
            {
              "type": "tool_result",
              "tool_use_id": "c1",
              "content": "{\"nearby_objects\": []}"
            },
            {
              "type": "tool_result",
              "tool_use_id": "c2",
              "content": "the arguments must be a JSON object",
              "is_error": true
            }
          ]
        },
        {
          "role": "assistant",
          "content": [
            {
              "type": "text",
              "text": "It is Bob's."
            }
          ]
        },
        {
          "role": "user",
          "content": [
            {
              "type": "text",
              "text": "Answer again with JSON only."
            },
            {
              "type": "text",
              "text": "Your reply was empty."
            }
          ]
        }
      ]
    }
    "#);
}

#[test]
fn everything_that_can_be_left_out_is_left_out() {
    let mut offer = Offer::default();
    let parameters = [Parameter::ReplyForm, Parameter::Length, Parameter::Temperature, Parameter::Seed];
    for parameter in parameters.into_iter().chain(parameters) {
        offer = offer.without(parameter);
    }
    let keys = |body: &Value| body.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(
        keys(&body(|request| openai::body("gpt", request, &offer, 7))),
        ["model", "messages", "tools"]
    );
    assert_eq!(
        keys(&body(|request| anthropic::body("claude", request, &offer))),
        ["model", "max_tokens", "system", "tools", "messages"]
    );
}

#[test]
fn without_tools_or_a_form_none_are_sent() {
    let conversation = [Message::User { text: "Hello".to_owned() }];
    let request = ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text };
    let body = openai::body("gpt", &request, &Offer::default(), u64::MAX);
    assert_eq!((body.get("tools"), body.get("response_format")), (None, None));
    assert_eq!(body["seed"], i64::MAX);
    let body = anthropic::body("claude", &request, &Offer::default());
    assert_eq!((body.get("tools"), body.get("system")), (None, None));
}

#[test]
fn a_call_without_words_has_no_content() {
    let calls = vec![call("c1", "nearby_objects", ToolArguments::Object(Map::new()))];
    for text in [None, Some(String::new())] {
        let conversation = [Message::Assistant { text, tool_calls: calls.clone() }];
        let request = ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text };
        let body = openai::body("gpt", &request, &Offer::default(), 0);
        assert_eq!(body["messages"][0]["content"], Value::Null);
        let body = anthropic::body("claude", &request, &Offer::default());
        assert_eq!(body["messages"][0]["content"].as_array().unwrap().len(), 1);
    }
}
