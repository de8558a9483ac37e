//! The rules of OpenAI's chat completions that no schema says.

use std::collections::BTreeMap;

use serde_json::Value;

use super::super::openai::list;
use super::{Calls, is_name};

pub(super) fn check(headers: &BTreeMap<String, String>, body: &Value, found: &mut Vec<String>) {
    check_key(headers, found);
    if body["tools"].as_array().is_some_and(Vec::is_empty) {
        found.push("tools must not be an empty list".to_owned());
    }
    for name in list(&body["tools"]).iter().filter_map(|tool| tool["function"]["name"].as_str()) {
        if !is_name(name, 64) {
            found.push(format!("{name:?} is no name of a tool"));
        }
    }
    if body.get("max_tokens").is_some() && body.get("max_completion_tokens").is_some() {
        found.push("max_tokens and max_completion_tokens exclude each other".to_owned());
    }
    if body["temperature"].as_f64().is_some_and(|temperature| !(0.0..=2.0).contains(&temperature)) {
        found.push("temperature must be between 0 and 2".to_owned());
    }
    if body["seed"].is_u64() && !body["seed"].is_i64() {
        found.push("seed must be a signed number of 64 bits".to_owned());
    }
    check_messages(list(&body["messages"]), found);
    check_form(body, found);
}

pub(super) fn check_key(headers: &BTreeMap<String, String>, found: &mut Vec<String>) {
    if headers.get("authorization").is_some_and(|value| !value.starts_with("Bearer ")) {
        found.push("authorization must be a bearer token".to_owned());
    }
}

fn check_messages(messages: &[Value], found: &mut Vec<String>) {
    let mut calls = Calls::default();
    for (place, message) in messages.iter().enumerate() {
        if message["role"] == "tool" {
            calls.result(message["tool_call_id"].as_str().unwrap_or_default(), found);
            continue;
        }
        calls.others_follow(found);
        if place > 0 && message["role"] == "system" {
            found.push("many servers refuse a system message that is not the first".to_owned());
        }
        let called = list(&message["tool_calls"]);
        if message["role"] == "assistant" && called.is_empty() && message["content"].is_null() {
            found.push("an assistant's message needs content or tool calls".to_owned());
        }
        if message.get("tool_calls").is_some() && called.is_empty() {
            found.push("tool_calls must not be an empty list".to_owned());
        }
        for call in called {
            let name = call["function"]["name"].as_str().unwrap_or_default();
            calls.call(call["id"].as_str().unwrap_or_default(), name, found);
        }
    }
    calls.others_follow(found);
}

fn check_form(body: &Value, found: &mut Vec<String>) {
    let form = &body["response_format"];
    if form["type"] == "json_object" && !body["messages"].to_string().to_lowercase().contains("json") {
        found.push("a reply as a JSON object must be asked for in words too".to_owned());
    }
    if form["type"] != "json_schema" {
        return;
    }
    let name = form["json_schema"]["name"].as_str().unwrap_or_default();
    if !is_name(name, 64) {
        found.push(format!("{name:?} is no name of a schema"));
    }
    if form["json_schema"]["strict"] == true {
        check_strict(&form["json_schema"]["schema"], "", found);
    }
}

/// A strict schema names every property of every object, requires them all and allows no others.
fn check_strict(schema: &Value, path: &str, found: &mut Vec<String>) {
    if schema["type"] == "object" {
        let mut named: Vec<&String> =
            schema["properties"].as_object().into_iter().flat_map(|map| map.keys()).collect();
        let mut required: Vec<&str> = list(&schema["required"]).iter().filter_map(Value::as_str).collect();
        named.sort();
        required.sort_unstable();
        if named != required {
            found.push(format!("strict schema, {path}: {required:?} are required of {named:?}"));
        }
        if schema["additionalProperties"] != false {
            found.push(format!("strict schema, {path}: other properties are allowed"));
        }
    }
    match schema {
        Value::Object(entries) => {
            for (key, inner) in entries {
                check_strict(inner, &format!("{path}/{key}"), found);
            }
        }
        Value::Array(entries) => entries.iter().for_each(|inner| check_strict(inner, path, found)),
        _ => {}
    }
}
