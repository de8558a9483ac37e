//! Remote models against a scripted provider, over real HTTP: what is answered, what is tried again, what is given
//! up and in which words.

mod answers;
mod concessions;
mod connections;
mod embeddings;
mod keys;
mod refusals;
mod retries;
mod spoilt;
mod surroundings;

use std::time::{Duration, Instant};

use coin_host::model::provider::{Provider, ProviderSettings, RemoteModel, RetryPolicy};
use coin_host::model::{
    ChatModel, ChatReply, ChatRequest, Message, ModelError, ReplyFormat, ToolArguments, ToolDefinition,
};
use coin_tests::provider::ScriptedProvider;
use serde_json::{Map, Value, json};

/// A key that no other text holds.
const KEY: &str = "sk-live-0123456789abcdef";

const BOTH: [Provider; 2] = [Provider::OpenAi, Provider::Anthropic];

/// Pauses as short as tests want them.
fn settings() -> ProviderSettings {
    ProviderSettings {
        seed: 7,
        timeout: Duration::from_secs(20),
        retry: RetryPolicy { base: Duration::from_millis(2), ..RetryPolicy::default() },
    }
}

fn base_url(server: &ScriptedProvider, provider: Provider) -> String {
    match provider {
        Provider::OpenAi => server.openai_url(),
        Provider::Anthropic => server.anthropic_url(),
    }
}

fn model_with(server: &ScriptedProvider, provider: Provider, settings: ProviderSettings) -> RemoteModel {
    RemoteModel::at(provider, "scripted-1", &base_url(server, provider), Some(KEY), &settings).unwrap()
}

fn model(server: &ScriptedProvider, provider: Provider) -> RemoteModel {
    model_with(server, provider, settings())
}

fn task() -> Value {
    json!({
        "task": "infer_ownership",
        "household": {
            "Alice": {"role": "mother", "occupation": "teacher"},
            "Bob": {"role": "father", "occupation": "cook"},
            "Carol": {"role": "daughter", "occupation": "pupil"},
        },
        "object": {"id": "marker", "class": "marker", "position": [0.0, 0.0, 0.8]},
        "as_of": "2025-01-20T00:00:00",
    })
}

fn tools() -> Vec<ToolDefinition> {
    let schema = json!({
        "type": "object",
        "properties": {"object_id": {"type": "string"}},
        "required": ["object_id"],
    });
    ["get_usage_summary", "nearby_objects", "similar_objects"]
        .map(|name| ToolDefinition {
            name: name.to_owned(),
            description: format!("Tells what {name} says."),
            input_schema: schema.as_object().unwrap().clone(),
        })
        .to_vec()
}

fn ownership_form() -> ReplyFormat {
    let people = json!({
        "type": "object",
        "properties": {"Alice": {"type": "number"}, "Bob": {"type": "number"}, "Carol": {"type": "number"}},
        "required": ["Alice", "Bob", "Carol"],
        "additionalProperties": false,
    });
    ReplyFormat::Json {
        name: "ownership".to_owned(),
        schema: json!({
            "type": "object",
            "properties": {"ownership_distribution": people},
            "required": ["ownership_distribution"],
            "additionalProperties": false,
        }),
    }
}

/// A conversation at its beginning.
fn opening() -> Vec<Message> {
    vec![
        Message::System { text: "Judge who owns the thing. Answer with JSON.".to_owned() },
        Message::User { text: task().to_string() },
    ]
}

/// What a tool of a home with Bob as the only user says.
fn tool_answer(tool: &str) -> Value {
    let object = json!({"id": "marker", "name": "marker"});
    match tool {
        "get_usage_summary" => json!({
            "object": object,
            "as_of": "2025-01-20T00:00:00",
            "window_days": 30,
            "user_summary": [{
                "user_id": "Bob", "total_events": 12, "sessions": 6, "actions": {"takes": 12},
                "last_used_days_ago": 0.5, "example_events": [],
            }],
            "unattributed_events": 0,
        }),
        "nearby_objects" => json!({
            "object": {"id": "marker", "name": "marker", "position": [0.0, 0.0, 0.8]},
            "nearby_objects": [],
        }),
        _ => json!({"object": object, "similar_objects": []}),
    }
}

/// The conversation after the model's calls were answered.
fn answered(mut conversation: Vec<Message>, reply: &ChatReply) -> Vec<Message> {
    conversation.push(Message::Assistant { text: reply.text.clone(), tool_calls: reply.tool_calls.clone() });
    conversation.extend(reply.tool_calls.iter().map(|call| Message::Tool {
        call_id: call.id.clone(),
        tool: call.tool.clone(),
        text: tool_answer(&call.tool).to_string(),
        is_error: false,
    }));
    conversation
}

/// One turn with tools and a form.
async fn turn(model: &RemoteModel, conversation: &[Message]) -> Result<ChatReply, ModelError> {
    let (tools, reply) = (tools(), ownership_form());
    model.complete(&ChatRequest { conversation, tools: &tools, reply: &reply }).await
}

/// The first turn of a conversation.
async fn first_turn(model: &RemoteModel) -> Result<ChatReply, ModelError> {
    turn(model, &opening()).await
}

/// The last turn of a conversation, whose tools are answered.
async fn last_turn(model: &RemoteModel) -> Result<ChatReply, ModelError> {
    let calls = tools()
        .iter()
        .map(|tool| coin_host::model::ToolCall {
            id: format!("id_{}", tool.name),
            tool: tool.name.clone(),
            arguments: ToolArguments::Object(Map::from_iter([("object_id".to_owned(), json!("marker"))])),
        })
        .collect();
    turn(model, &answered(opening(), &ChatReply::calls(calls))).await
}

/// The reason of an error that another request may not meet.
#[track_caller]
fn unanswered(result: Result<ChatReply, ModelError>) -> String {
    match result {
        Err(ModelError::Unanswered { reason }) => without_key(reason),
        other => panic!("this should be unanswered: {other:?}"),
    }
}

/// The reason of an error that every request meets.
#[track_caller]
fn unusable(result: Result<ChatReply, ModelError>) -> String {
    match result {
        Err(ModelError::Unusable { reason }) => without_key(reason),
        other => panic!("this should be unusable: {other:?}"),
    }
}

/// No error ever holds the key.
#[track_caller]
fn without_key(reason: String) -> String {
    assert!(!reason.contains(KEY), "{reason}");
    reason
}

/// What is asked for and how long it took.
async fn timed<T>(asked: impl Future<Output = T>) -> (T, Duration) {
    let start = Instant::now();
    let answer = asked.await;
    (answer, start.elapsed())
}

/// Waits until something is so.
async fn eventually(mut is_so: impl FnMut() -> bool) -> bool {
    for _ in 0..500 {
        if is_so() {
            return true;
        }
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    false
}
