//! What callers get wrong, and what they are told.

use std::fmt::Write as _;

use rstest::rstest;
use serde_json::json;

use super::*;
use crate::test_home;

#[test]
fn wrong_arguments_are_explained() {
    let store = test_home::store();
    let wrong = [
        ("get_usage_summary", json!({})),
        ("get_usage_summary", json!({"object_id": null})),
        ("get_usage_summary", json!({"object_id": ""})),
        ("get_usage_summary", json!({"objectid": "1"})),
        ("get_usage_summary", json!({"object_id": ["1"]})),
        ("get_usage_summary", json!({"object_id": "3"})),
        ("get_usage_summary", json!({"object_id": "Marker"})),
        ("get_usage_summary", json!({"object_id": "cup"})),
        ("get_usage_summary", json!({"object_id": "1' OR '1'='1"})),
        ("get_usage_summary", json!({"object_id": "x".repeat(10_000)})),
        ("get_usage_summary", json!({"object_id": "1", "window_days": 0})),
        ("get_usage_summary", json!({"object_id": "1", "window_days": 36_501})),
        ("get_usage_summary", json!({"object_id": "1", "window_days": -1})),
        ("get_usage_summary", json!({"object_id": "1", "window_days": 1.5})),
        ("get_usage_summary", json!({"object_id": "1", "window_days": "a week"})),
        ("get_usage_summary", json!({"object_id": "1", "max_examples": 51})),
        ("get_usage_summary", json!({"object_id": "1", "as_of": "yesterday"})),
        ("get_usage_summary", json!({"object_id": "1", "as_of": "2025-01-19T19:00:00Z"})),
        ("get_usage_summary", json!({"object_id": "1", "as_of": "2025-02-30T19:00:00"})),
        ("get_usage_summary", json!({"object_id": "1", "as_of": 1737313200})),
        ("nearby_objects", json!({"object_id": "1", "k": 0})),
        ("nearby_objects", json!({"object_id": "1", "k": 4_000_000_000_u32})),
        ("nearby_objects", json!({"object_id": "1", "k": 1e300})),
        ("nearby_objects", json!({"object_id": "1", "sigma": 0})),
        ("nearby_objects", json!({"object_id": "1", "sigma": "NaN"})),
        ("nearby_objects", json!({"object_id": "1", "gamma": -0.5})),
        ("nearby_objects", json!({"object_id": "1", "min_weight": 1.5})),
        ("similar_objects", json!({"object_id": "1", "k": 101})),
        ("list_users", json!({"name": "Bob"})),
        ("list_objects", json!({"limit": 501})),
        ("list_objects", json!({"settled": "maybe"})),
        ("list_objects", json!({"owner": "bob"})),
        ("list_objects", json!({"cursor": "page 2"})),
        ("list_objects", json!({"cursor": "after-zz"})),
        ("list_objects", json!({"cursor": "after-ff"})),
        ("record_answer", json!({"object_id": "1", "question": "?", "answer": "!"})),
        (
            "record_answer",
            json!({"object_id": "1", "question": "?", "answer": "!", "ownership": {"Bobby": true}}),
        ),
        ("record_answer", json!({"object_id": "1", "question": "?", "answer": "!", "ownership": {"Bob": 1}})),
        ("record_answer", json!({"object_id": "1", "question": "?", "answer": "!", "ownership": ["Bob"]})),
        (
            "record_answer",
            json!({"object_id": "1", "question": "?", "answer": "!", "ownership": {}, "answered_by": "Zoe"}),
        ),
        (
            "record_answer",
            json!({"object_id": "1", "question": "?", "answer": "x".repeat(2_001), "ownership": {}}),
        ),
        ("record_scores", json!({"object_id": "1", "scores": {"Bob": 0.5}})),
        ("record_scores", json!({"object_id": "1", "scores": {"Bob": 0.5, "Mary": 1.5, "Tom": 0}})),
        ("record_scores", json!({"object_id": "1", "scores": {"Bob": 0.5, "Mary": "high", "Tom": 0}})),
        ("record_scores", json!({"object_id": "1", "scores": {"Bob": 0.5, "Mary": 0, "Tom": 0, "Ann": 1}})),
        (
            "record_scores",
            json!({"object_id": "1", "scores": {"Bob": 1, "Mary": 0, "Tom": 0},
            "owner_sets": [{"owners": ["Bob"], "probability": 0.5}]}),
        ),
        (
            "record_scores",
            json!({"object_id": "1", "scores": {"Bob": 1, "Mary": 0, "Tom": 0},
            "owner_sets": [{"owners": ["Ann"], "probability": 1.0}]}),
        ),
        ("record_usage", json!({"captions": [{"object_id": "1"}]})),
        ("record_usage", json!({"captions": "2025-01-19 19:00 Bob takes the Marker"})),
    ];
    let mut table = String::new();
    for (tool, arguments) in wrong {
        let mut given = arguments.to_string();
        given.truncate(150);
        writeln!(table, "{tool} {given}\n    {}", refused(&store, tool, arguments)).unwrap();
    }
    insta::assert_snapshot!(table);
}

#[rstest]
#[case(json!({"object_id": 1}))]
#[case(json!({"object_id": "1", "window_days": "365"}))]
#[case(json!({"object_id": "1", "window_days": 365.0}))]
#[case(json!({"object_id": "1", "as_of": null, "max_examples": null}))]
#[case(json!({"object_id": "1", "as_of": ""}))]
#[case(json!({"object_id": "1", "as_of": "2025-01-19 23:00"}))]
fn a_plain_meaning_in_another_form_is_taken(#[case] arguments: Value) {
    let store = test_home::store();
    assert_eq!(
        done(&store, "get_usage_summary", arguments),
        done(&store, "get_usage_summary", json!({"object_id": "1"}))
    );
}

#[test]
fn nested_numbers_and_truth_values_may_be_texts() {
    let store = test_home::store();
    let scores = json!({"object_id": 1, "scores": {"Bob": "0.97", "Mary": "0", "Tom": 0}});
    assert_eq!(done(&store, "record_scores", scores)["owners"], json!(["Bob"]));
    let answer = json!({"object_id": "1", "question": "?", "answer": "!", "ownership": {"Mary": "true"}});
    assert_eq!(done(&store, "record_answer", answer)["owners"], json!(["Mary"]));
    assert_eq!(done(&store, "list_objects", json!({"settled": "true"}))["total"], 1);
}

#[test]
fn a_refused_call_changes_nothing() {
    let store = test_home::store();
    let before = done(&store, "list_objects", json!({}));
    refused(&store, "record_scores", json!({"object_id": "1", "scores": {"Bob": 1, "Mary": 0, "Tom": 7}}));
    let half =
        json!({"object_id": "1", "question": "?", "answer": "!", "ownership": {"Bob": true, "Zoe": true}});
    refused(&store, "record_answer", half);
    assert_eq!(done(&store, "list_objects", json!({})), before);
}
