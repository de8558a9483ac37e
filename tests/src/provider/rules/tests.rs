use std::collections::BTreeMap;

use coin_host::model::provider::Provider;
use rstest::rstest;
use serde_json::{Value, json};

use super::violations;

fn headers() -> BTreeMap<String, String> {
    [("content-type", "application/json"), ("x-api-key", "k"), ("anthropic-version", "2023-06-01")]
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .into()
}

fn openai() -> Value {
    let call = |id: &str| json!({"id": id, "type": "function", "function": {"name": "t", "arguments": "{}"}});
    json!({
        "model": "m",
        "messages": [
            {"role": "system", "content": "JSON"},
            {"role": "user", "content": "x"},
            {"role": "assistant", "content": null, "tool_calls": [call("a"), call("b")]},
            {"role": "tool", "tool_call_id": "a", "content": "1"},
            {"role": "tool", "tool_call_id": "b", "content": "2"},
        ],
        "tools": [{"type": "function", "function": {"name": "t"}}],
        "response_format": {"type": "json_schema", "json_schema": {"name": "n", "strict": true, "schema": {
            "type": "object", "properties": {"p": {"type": "number"}}, "required": ["p"], "additionalProperties": false,
        }}},
        "temperature": 0.2,
    })
}

fn anthropic() -> Value {
    let call = |id: &str| json!({"type": "tool_use", "id": id, "name": "t", "input": {}});
    let result =
        |id: &str| json!({"type": "tool_result", "tool_use_id": id, "content": "1", "is_error": true});
    json!({
        "model": "m",
        "max_tokens": 1,
        "system": [{"type": "text", "text": "x", "cache_control": {"type": "ephemeral"}}],
        "tools": [{"name": "t", "input_schema": {"type": "object"}}],
        "messages": [
            {"role": "user", "content": [{"type": "text", "text": "x"}]},
            {"role": "assistant", "content": [call("a"), call("b")]},
            {"role": "user", "content": [result("a"), result("b"), {"type": "text", "text": "x"}]},
        ],
    })
}

#[test]
fn what_is_right_breaks_no_rule() {
    assert_eq!(violations(Provider::OpenAi, &headers(), &openai()), Vec::<String>::new());
    assert_eq!(violations(Provider::Anthropic, &headers(), &anthropic()), Vec::<String>::new());
}

/// Puts a value into a request, or takes one out with null, and says what is wrong then.
#[track_caller]
fn changed(provider: Provider, pointer: &str, value: Value) -> String {
    let mut body = match provider {
        Provider::OpenAi => openai(),
        Provider::Anthropic => anthropic(),
    };
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match body.pointer_mut(parent).unwrap() {
        Value::Array(items) if value.is_null() => drop(items.remove(key.parse().unwrap())),
        Value::Array(items) => items[key.parse::<usize>().unwrap()] = value,
        Value::Object(entries) => drop(entries.insert(key.to_owned(), value)),
        other => panic!("{other} has no {key}"),
    }
    violations(provider, &headers(), &body).join("\n")
}

#[rstest]
#[case("/max_completion_token", json!(1), "max_completion_token")]
#[case("/messages/1/text", json!("x"), "/messages/1")]
#[case("/messages/3", json!(null), "the tool calls {\"a\"} are not answered")]
#[case("/messages/2", json!(null), "which was not called just before")]
#[case("/messages/2/tool_calls/1/id", json!("a"), "comes twice")]
#[case("/messages/2/tool_calls", json!([]), "must not be an empty list")]
#[case("/messages/2/tool_calls/0/function/arguments", json!({}), "/messages/2")]
#[case("/messages/2/tool_calls/0/function/name", json!("a tool"), "no name of a tool")]
#[case("/messages/1/role", json!("system"), "not the first")]
#[case("/tools", json!([]), "tools must not be an empty list")]
#[case("/temperature", json!(3), "between 0 and 2")]
#[case("/seed", json!(u64::MAX), "signed")]
#[case("/response_format/json_schema/name", json!("a name"), "no name of a schema")]
#[case("/response_format/json_schema/schema/required", json!([]), "are required of")]
#[case("/response_format/json_schema/schema/additionalProperties", json!({}), "other properties are allowed")]
fn what_is_wrong_for_openai_is_found(#[case] pointer: &str, #[case] value: Value, #[case] told: &str) {
    let found = changed(Provider::OpenAi, pointer, value);
    assert!(found.contains(told), "{found}");
}

#[rstest]
#[case("/seed", json!(1), "seed")]
#[case("/messages/0/content/0/text", json!(" "), "blank")]
#[case("/messages/0/content", json!([]), "no content")]
#[case("/messages/0", json!(null), "where the turn is the user's")]
#[case("/messages/1/content/1/id", json!("a"), "comes twice")]
#[case("/messages/1/content/1/id", json!("a b"), "no tool call id")]
#[case("/messages/1/content/1/input", json!("{}"), "/messages/1")]
#[case("/messages/2/content/0", json!(null), "the tool calls {\"a\"} are not answered")]
#[case("/messages/2/content/0", json!({"type": "text", "text": "x"}), "are not answered")]
#[case("/messages/2", json!(null), "the last message is not the user's")]
#[case("/tools", json!([]), "none is defined")]
#[case("/tools/0/parameters", json!({}), "/tools/0")]
#[case("/temperature", json!(1.5), "between 0 and 1")]
fn what_is_wrong_for_anthropic_is_found(#[case] pointer: &str, #[case] value: Value, #[case] told: &str) {
    let found = changed(Provider::Anthropic, pointer, value);
    assert!(found.contains(told), "{found}");
}

#[test]
fn headers_are_looked_at() {
    let found = violations(Provider::Anthropic, &BTreeMap::new(), &anthropic()).join("\n");
    for told in ["content-type", "anthropic-version", "x-api-key"] {
        assert!(found.contains(told), "{found}");
    }
    let basic = [("authorization".to_owned(), "Basic x".to_owned())].into();
    assert!(violations(Provider::OpenAi, &basic, &openai()).join("\n").contains("bearer"));
}
