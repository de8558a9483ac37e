//! `record_scores`.

use rstest::rstest;
use serde_json::{Value, json};

fn scored(scores: Value, owner_sets: Value) -> Value {
    let mut arguments = json!({"object_id": "marker", "scores": scores});
    if !owner_sets.is_null() {
        arguments["owner_sets"] = owner_sets;
    }
    super::furnished_home().server().ok("record_scores", arguments)
}

/// ∏ s over the set · ∏ (1 − s) over the others, normalised over the sets that are not empty.
fn probability_of(owners: &[bool; 3], scores: &[f64; 3]) -> f64 {
    let product = |set: usize| -> f64 {
        (0..3).map(|user| if set & (1 << user) == 0 { 1.0 - scores[user] } else { scores[user] }).product()
    };
    let wanted = (0..3).filter(|&user| owners[user]).map(|user| 1 << user).sum();
    let all: f64 = (1..8).map(product).sum();
    product(wanted) / all
}

#[track_caller]
fn assert_close(given: &Value, expected: f64) {
    let given = given.as_f64().unwrap();
    assert!((given - expected).abs() < 1e-4, "{given} is not {expected}");
}

#[test]
fn one_clear_owner_is_settled() {
    let result = scored(json!({"Bob": 0.99, "Mary": 0.01, "Tom": 0.01}), Value::Null);
    assert_eq!(result["object"], json!({"id": "marker", "name": "Marker"}));
    assert_eq!(result["owners"], json!(["Bob"]));
    assert_eq!(result["shared"], false);
    assert_eq!(result["settled"], true);
    assert_close(&result["confidence"], probability_of(&[true, false, false], &[0.99, 0.01, 0.01]));
}

#[test]
fn close_high_scores_make_a_thing_shared() {
    // DETECT-SHARE: both at least .80, within .08 of one another, at least .20 above the third.
    let result = scored(json!({"Bob": 0.95, "Mary": 0.92, "Tom": 0.05}), Value::Null);
    assert_eq!(result["owners"], json!(["Bob", "Mary"]));
    assert_eq!(result["shared"], true);
    assert_close(&result["confidence"], probability_of(&[true, true, false], &[0.95, 0.92, 0.05]));
}

#[rstest]
#[case(json!({"Bob": 0.5, "Mary": 0.5, "Tom": 0.5}))]
#[case(json!({"Bob": 0.6, "Mary": 0.3, "Tom": 0.1}))]
fn doubt_is_not_settled(#[case] scores: Value) {
    assert_eq!(scored(scores, Value::Null)["settled"], false);
}

#[test]
fn without_a_calibration_nobody_is_excluded() {
    let result = scored(json!({"Bob": 0.9, "Mary": 0.1, "Tom": 0.2}), Value::Null);
    assert_eq!(result["prediction_set"], json!(["Bob", "Mary", "Tom"]));
    // One minus the mean score of the plausible owners.
    assert_close(&result["uncertainty"], 0.6);
}

#[test]
fn owner_sets_speak_for_themselves() {
    let result = scored(
        json!({"Bob": 0.9, "Mary": 0.8, "Tom": 0.1}),
        json!([
            {"owners": ["Bob"], "probability": 0.2},
            {"owners": ["Bob", "Mary"], "probability": 0.7},
            {"owners": ["Tom", "Mary"], "probability": 0.1},
        ]),
    );
    assert_eq!(result["owners"], json!(["Bob", "Mary"]));
    assert_close(&result["confidence"], 0.7);
}

#[test]
fn the_embedded_model_has_a_calibration_of_its_own() {
    let result = super::furnished_home().server().ok(
        "record_scores",
        json!({
            "object_id": "marker",
            "scores": {"Bob": 1.0, "Mary": 0.0, "Tom": 0.0},
            "owner_sets": [{"owners": ["Bob"], "probability": 1.0}],
            "model": "embedded",
        }),
    );
    // Whatever its threshold is, it excludes somebody with a score of 0 and leaves no doubt of a 1.
    assert_eq!(result["prediction_set"], json!(["Bob"]));
    assert_close(&result["uncertainty"], 0.0);
    assert_eq!(result["settled"], true);
}

#[test]
fn what_was_concluded_is_listed_and_replaced_by_the_next_conclusion() {
    let mut server = super::furnished_home().server();
    for (owner, scores) in [
        ("Bob", json!({"Bob": 0.99, "Mary": 0.01, "Tom": 0.01})),
        ("Tom", json!({"Bob": 0.01, "Mary": 0.01, "Tom": 0.99})),
    ] {
        server.ok("record_scores", json!({"object_id": "marker", "scores": scores}));
        let listed = server.ok("list_objects", json!({"class": "marker"}))["objects"][0].clone();
        assert_eq!(listed["owners"], json!([owner]));
        assert_eq!(listed["source"], "inferred");
        assert_eq!(listed["settled"], true);
    }
}

#[test]
fn where_a_person_has_answered_the_answer_is_the_belief() {
    let mut server = super::furnished_home().server();
    server.ok("record_answer", super::answer("marker", "Mary"));
    let result = server
        .ok("record_scores", json!({"object_id": "marker", "scores": {"Bob": 0.9, "Mary": 0.1, "Tom": 0.1}}));
    assert_eq!(result["owners"], json!(["Mary"]));
    assert_eq!(result["confidence"], 1.0);
    assert_eq!(result["settled"], true);
}
