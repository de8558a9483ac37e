//! Replies as servers are known to send them.

use std::collections::BTreeSet;

use proptest::prelude::*;
use rstest::rstest;
use serde_json::{Value, json};

use super::super::{anthropic, call_ids, openai, unique_id};
use crate::model::{ChatReply, Ending, Message, TokenUsage};

fn openai_reply(message: &Value, finish_reason: &str) -> ChatReply {
    let body = json!({"choices": [{"message": message, "finish_reason": finish_reason}]});
    openai::reply(&body, BTreeSet::new()).unwrap()
}

fn arguments(given: &Value) -> String {
    let message = json!({"tool_calls": [{"id": "a", "function": {"name": "t", "arguments": given}}]});
    openai_reply(&message, "tool_calls").tool_calls[0].arguments.to_text()
}

#[rstest]
#[case(json!("Bob"), Some("Bob"))]
#[case(json!(null), None)]
#[case(json!("  \n"), None)]
#[case(json!([{"type": "text", "text": "Bo"}, {"type": "thinking", "text": "Who?"}, {"text": "b"}]), Some("Bob"))]
#[case(json!("<think>\nWho? Bob.\n</think>\n\nBob"), Some("Bob"))]
#[case(json!("<think>\nWho?"), Some("<think>\nWho?"))]
fn words_of_openai(#[case] content: Value, #[case] words: Option<&str>) {
    let message = json!({"content": content, "reasoning_content": "Who?", "reasoning": "Who?"});
    assert_eq!(openai_reply(&message, "stop").text.as_deref(), words);
}

#[rstest]
#[case(json!(r#"{"a": 1}"#), r#"{"a":1}"#)]
#[case(json!({"a": 1}), r#"{"a":1}"#)]
#[case(json!(""), "{}")]
#[case(json!(null), "{}")]
#[case(json!(r#"{"a": "#), r#"{"a": "#)]
#[case(json!("[1]"), "[1]")]
#[case(json!([1]), "[1]")]
fn arguments_of_openai(#[case] given: Value, #[case] read: &str) {
    assert_eq!(arguments(&given), read);
}

#[rstest]
#[case(json!({"content": "x"}), "stop", Ending::Finished)]
#[case(json!({"content": "x"}), "length", Ending::CutShort)]
#[case(json!({"content": null, "refusal": "No."}), "stop", Ending::Refused { reason: "No.".to_owned() })]
#[case(json!({"content": [{"type": "refusal", "refusal": "No."}]}), "stop", Ending::Refused { reason: "No.".to_owned() })]
#[case(json!({"content": "x", "refusal": ""}), "stop", Ending::Finished)]
#[case(
    json!({"content": null}), "content_filter",
    Ending::Refused { reason: "the provider's content filter stopped the reply".to_owned() }
)]
fn endings_of_openai(#[case] message: Value, #[case] finish_reason: &str, #[case] ending: Ending) {
    assert_eq!(openai_reply(&message, finish_reason).ending, ending);
}

#[rstest]
#[case("end_turn", Ending::Finished)]
#[case("tool_use", Ending::Finished)]
#[case("max_tokens", Ending::CutShort)]
#[case("model_context_window_exceeded", Ending::CutShort)]
#[case("refusal", Ending::Refused { reason: "Words.".to_owned() })]
fn endings_of_anthropic(#[case] stop_reason: &str, #[case] ending: Ending) {
    let body = json!({"content": [{"type": "text", "text": "Words."}], "stop_reason": stop_reason});
    assert_eq!(anthropic::reply(&body, BTreeSet::new()).unwrap().ending, ending);
}

#[test]
fn a_message_of_anthropic_is_read_block_by_block() {
    let body = json!({
        "content": [
            {"type": "thinking", "thinking": "Who?", "signature": "s"},
            {"type": "text", "text": "I look "},
            {"type": "text", "text": "around."},
            {"type": "tool_use", "id": "toolu_1", "name": "nearby_objects", "input": {"object_id": "mug"}},
            {"type": "tool_use", "id": "toolu_1", "name": "similar_objects", "input": "{\"object_id"},
        ],
        "stop_reason": "tool_use",
        "usage": {
            "input_tokens": 5, "cache_creation_input_tokens": 20, "cache_read_input_tokens": 300,
            "output_tokens": 40,
        },
    });
    let reply = anthropic::reply(&body, BTreeSet::new()).unwrap();
    assert_eq!(reply.usage, TokenUsage { prompt_tokens: 325, completion_tokens: 40 });
    insta::assert_json_snapshot!(reply, @r#"
    {
      "text": "I look around.",
      "tool_calls": [
        {
          "id": "toolu_1",
          "tool": "nearby_objects",
          "arguments": {
            "object_id": "mug"
          }
        },
        {
          "id": "call_1",
          "tool": "similar_objects",
          "arguments": "{\"object_id"
        }
      ],
      "ending": {
        "how": "finished"
      },
      "usage": {
        "prompt_tokens": 325,
        "completion_tokens": 40
      }
    }
    "#);
}

#[test]
fn usage_that_is_not_told_is_none() {
    assert_eq!(openai_reply(&json!({"content": "x"}), "stop").usage, TokenUsage::default());
}

#[rstest]
#[case(json!({}), "the answer has no choices")]
#[case(json!([]), "the answer has no choices")]
#[case(json!({"choices": []}), "the answer has no choices")]
#[case(json!({"choices": [{"text": "Bob"}]}), "the answer's first choice has no message")]
#[case(json!({"error": {"message": "busy"}}), "the answer is an error, \"busy\"")]
fn what_is_no_completion_is_refused(#[case] body: Value, #[case] reason: &str) {
    assert_eq!(openai::reply(&body, BTreeSet::new()).unwrap_err(), reason);
}

#[test]
fn what_is_no_message_is_refused() {
    for body in [json!({}), json!({"content": "Bob"}), json!([1])] {
        assert_eq!(anthropic::reply(&body, BTreeSet::new()).unwrap_err(), "the answer has no content");
    }
}

#[test]
fn calls_without_an_id_get_one() {
    let calls = json!({"tool_calls": [
        {"function": {"name": "a"}}, {"id": "", "function": {"name": "b"}}, {"id": "call_1", "function": {"name": "c"}},
        {"id": "call_3", "function": {"name": "d"}}, {"id": "call_3", "function": {"name": "e"}},
    ]});
    let body = json!({"choices": [{"message": calls}]});
    let reply = openai::reply(&body, BTreeSet::from(["call_2".to_owned()])).unwrap();
    let ids: Vec<&str> = reply.tool_calls.iter().map(|call| call.id.as_str()).collect();
    assert_eq!(ids, ["call_1", "call_3", "call_4", "call_5", "call_6"]);
}

#[test]
fn calls_of_earlier_turns_keep_their_ids_to_themselves() {
    let body = json!({"content": [{"type": "tool_use", "id": "call_0", "name": "a", "input": {}}]});
    let first = anthropic::reply(&body, BTreeSet::new()).unwrap();
    let conversation = [Message::Assistant { text: None, tool_calls: first.tool_calls }];
    let second = anthropic::reply(&body, call_ids(&conversation)).unwrap();
    assert_eq!(second.tool_calls[0].id, "call_1");
}

proptest! {
    #[test]
    fn no_two_calls_have_the_same_id(given in prop::collection::vec(prop::option::of("(call_)?[0-9]?"), 0..12)) {
        let mut taken = BTreeSet::from(["call_2".to_owned(), "3".to_owned()]);
        let before = taken.len();
        let ids: Vec<String> = given.iter().map(|id| unique_id(id.as_deref(), &mut taken)).collect();
        prop_assert_eq!(taken.len(), before + ids.len());
        prop_assert!(ids.iter().all(|id| !id.is_empty() && taken.contains(id)));
    }

    #[test]
    fn no_json_makes_a_reader_fail(text in r#"[\[\]{}":,a-z0-9]{0,60}"#) {
        if let Ok(body) = serde_json::from_str::<Value>(&text) {
            let _ = openai::reply(&json!({"choices": [{"message": {"content": body, "tool_calls": [body]}}]}), BTreeSet::new());
            let _ = anthropic::reply(&json!({"content": [body]}), BTreeSet::new());
        }
    }
}

#[rstest]
#[case("nearby_objects", "nearby_objects")]
#[case("functions.nearby objects", "functions_nearby_objects")]
#[case("", "nameless")]
#[case("öffne", "_ffne")]
fn a_name_that_a_model_invented_can_be_sent_back(#[case] tool: &str, #[case] echoed: &str) {
    assert_eq!(super::super::echoed_name(tool), echoed);
    assert_eq!(super::super::echoed_name(&"x".repeat(100)).len(), 64);
}
