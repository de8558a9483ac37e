//! Requests that a reply may depend on differ, and others do not.

use serde_json::{Map, Value, json};

use super::*;
use crate::model::{ToolArguments, ToolCall};

struct Asked {
    model: &'static str,
    conversation: Vec<Message>,
    tools: Vec<ToolDefinition>,
    reply: ReplyFormat,
}

fn asked() -> Asked {
    Asked {
        model: "echo",
        conversation: vec![
            Message::System { text: "Answer.".to_owned() },
            Message::User { text: "Whose?".to_owned() },
            called(json!({"object_id": "3", "days": 7})),
        ],
        tools: vec![tool("list_users", json!({"type": "object", "title": "Users"}))],
        reply: ReplyFormat::Json { name: "ownership".to_owned(), schema: json!({"type": "object"}) },
    }
}

fn object(value: Value) -> Map<String, Value> {
    let Value::Object(object) = value else { panic!("an object") };
    object
}

fn called(arguments: Value) -> Message {
    let arguments = ToolArguments::Object(object(arguments));
    let call = ToolCall { id: "1".to_owned(), tool: "list_users".to_owned(), arguments };
    Message::Assistant { text: None, tool_calls: vec![call] }
}

fn tool(name: &str, schema: Value) -> ToolDefinition {
    ToolDefinition {
        name: name.to_owned(),
        description: "The people.".to_owned(),
        input_schema: object(schema),
    }
}

fn of(asked: &Asked) -> Fingerprint {
    let Asked { model, conversation, tools, reply } = asked;
    fingerprint(model, &ChatRequest { conversation, tools, reply }).unwrap()
}

#[test]
fn whatever_a_reply_may_depend_on_makes_another_fingerprint() {
    let mut all = vec![of(&asked())];
    all.push(of(&Asked { model: "other", ..asked() }));
    all.push(of(&Asked { conversation: asked().conversation[..2].to_vec(), ..asked() }));
    let mut conversation = asked().conversation;
    conversation[2] = called(json!({"object_id": "3", "days": 8}));
    all.push(of(&Asked { conversation, ..asked() }));
    all.push(of(&Asked { tools: Vec::new(), ..asked() }));
    all.push(of(&Asked { tools: vec![tool("list_users", json!({"type": "object"}))], ..asked() }));
    all.push(of(&Asked { reply: ReplyFormat::Text, ..asked() }));
    let other_schema = ReplyFormat::Json { name: "ownership".to_owned(), schema: json!({}) };
    all.push(of(&Asked { reply: other_schema, ..asked() }));
    let different: std::collections::BTreeSet<Fingerprint> = all.iter().copied().collect();
    assert_eq!(different.len(), all.len());
}

#[test]
fn the_order_of_keys_makes_none() {
    let mut other = asked();
    other.conversation[2] = called(json!({"days": 7, "object_id": "3"}));
    other.tools = vec![tool("list_users", json!({"title": "Users", "type": "object"}))];
    assert_eq!(of(&other), of(&asked()));
}

/// Computed with Python: `sha256(json.dumps(request, sort_keys=True, separators=(",", ":")).encode())`. Were it to
/// change, every tape would be worthless.
#[test]
fn a_fingerprint_is_what_it_always_was() {
    insta::assert_snapshot!(of(&asked()), @r#"d14c25237781c5894199fd34b5f9e3c67b2287ba37b1c7ac51683187018b3cf9"#);
}
