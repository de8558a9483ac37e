//! The rules of Anthropic's messages that no schema says.

use std::collections::BTreeMap;

use serde_json::Value;

use super::super::openai::list;
use super::{Calls, is_name};

pub(super) fn check(headers: &BTreeMap<String, String>, body: &Value, found: &mut Vec<String>) {
    if headers.get("anthropic-version").map(String::as_str) != Some("2023-06-01") {
        found.push("anthropic-version must be 2023-06-01".to_owned());
    }
    if !headers.contains_key("x-api-key") {
        found.push("x-api-key is missing".to_owned());
    }
    if body["temperature"].as_f64().is_some_and(|temperature| !(0.0..=1.0).contains(&temperature)) {
        found.push("temperature must be between 0 and 1".to_owned());
    }
    for name in list(&body["tools"]).iter().filter_map(|tool| tool["name"].as_str()) {
        if !is_name(name, 128) {
            found.push(format!("{name:?} is no name of a tool"));
        }
    }
    check_words(list(&body["system"]), found);
    check_messages(list(&body["messages"]), list(&body["tools"]), found);
}

fn check_messages(messages: &[Value], tools: &[Value], found: &mut Vec<String>) {
    let mut calls = Calls::default();
    let mut expected = "user";
    for message in messages {
        if message["role"] != expected {
            found.push(format!("{} speaks where the turn is the {expected}'s", message["role"]));
        }
        expected = if message["role"] == "user" { "assistant" } else { "user" };
        let content = list(&message["content"]);
        if content.is_empty() {
            found.push("a message has no content".to_owned());
        }
        check_words(content, found);
        for block in content {
            if block["type"] == "tool_result" {
                calls.result(block["tool_use_id"].as_str().unwrap_or_default(), found);
                continue;
            }
            // Results come first in the message that follows the calls.
            if message["role"] == "user" {
                calls.others_follow(found);
            }
            if block["type"] == "tool_use" {
                let name = block["name"].as_str().unwrap_or_default();
                calls.call(block["id"].as_str().unwrap_or_default(), name, found);
            }
        }
        if message["role"] == "user" {
            calls.others_follow(found);
        }
    }
    if expected != "assistant" {
        found.push("the last message is not the user's".to_owned());
    }
    if !calls.seen.is_empty() && tools.is_empty() {
        found.push("tools were called, but none is defined".to_owned());
    }
}

fn check_words(content: &[Value], found: &mut Vec<String>) {
    let blank = |block: &&Value| {
        block["type"] == "text" && block["text"].as_str().is_some_and(|text| text.trim().is_empty())
    };
    if content.iter().any(|block| blank(&block)) {
        found.push("a block of words is blank".to_owned());
    }
}
