//! `get_usage_summary`.

use coin_tests::{EpisodeBuilder, Home};
use rstest::rstest;
use serde_json::{Value, json};

/// Four days of a marker: Bob uses it in three sessions, Mary in two, somebody unseen once.
fn used_marker() -> EpisodeBuilder {
    super::furnished()
        .caption("marker", "2025-01-16 08:00 Bob is using the Marker")
        .caption("marker", "2025-01-16 08:20 Bob is using the Marker")
        .caption("marker", "2025-01-16 08:41 Bob places the Marker")
        .caption("marker", "2025-01-17 10:00 Mary takes the Marker")
        .caption("marker", "2025-01-17 10:05 Bob is using the Marker")
        .caption("marker", "2025-01-17 10:10 Mary puts the Marker back")
        .caption("marker", "2025-01-18 12:00 Someone takes the Marker")
}

fn summary(arguments: Value) -> Value {
    Home::of(&used_marker()).server().ok("get_usage_summary", arguments)
}

#[test]
fn it_has_exactly_the_fields_of_the_contract() {
    // Bob: 08:00 and 08:20 are 20 minutes apart, one session; 08:41 is 21 minutes later, another; Mary's use cuts
    // the third off. His last use was 60 h 55 min before 23:00 on the 19th: 2.538 days. Mary's was 60 h 50 min.
    assert_eq!(
        summary(json!({"object_id": "marker", "as_of": "2025-01-19T23:00:00"})),
        json!({
            "object": {"id": "marker", "name": "Marker"},
            "as_of": "2025-01-19T23:00:00",
            "window_days": 365,
            "user_summary": [
                {
                    "user_id": "Bob",
                    "total_events": 4,
                    "sessions": 3,
                    "actions": {"use": 3, "place": 1},
                    "last_used_days_ago": 2.5,
                    "example_events": [
                        "2025-01-16 08:00 Bob is using the Marker",
                        "2025-01-16 08:20 Bob is using the Marker",
                        "2025-01-16 08:41 Bob places the Marker",
                        "2025-01-17 10:05 Bob is using the Marker",
                    ],
                },
                {
                    "user_id": "Mary",
                    "total_events": 2,
                    "sessions": 2,
                    "actions": {"take": 1, "place": 1},
                    "last_used_days_ago": 2.5,
                    "example_events": [
                        "2025-01-17 10:00 Mary takes the Marker",
                        "2025-01-17 10:10 Mary puts the Marker back",
                    ],
                },
            ],
            "unattributed_events": 1,
        })
    );
}

#[test]
fn as_of_is_by_default_the_moment_at_which_the_recording_ends() {
    assert_eq!(summary(json!({"object_id": "marker"}))["as_of"], "2025-01-19T23:00:00");
}

#[test]
fn as_of_hides_later_events_and_shows_those_of_the_same_moment() {
    let then = summary(json!({"object_id": "marker", "as_of": "2025-01-17T10:00:00"}));
    assert_eq!(then["as_of"], "2025-01-17T10:00:00");
    assert_eq!(then["unattributed_events"], 0);
    let users = then["user_summary"].as_array().unwrap();
    assert_eq!(users[0]["user_id"], "Bob");
    assert_eq!(users[0]["total_events"], 3);
    assert_eq!(users[0]["sessions"], 2);
    // 25 h 19 min: 1.055 days.
    assert_eq!(users[0]["last_used_days_ago"], 1.1);
    assert_eq!(users[1]["user_id"], "Mary");
    assert_eq!(users[1]["total_events"], 1);
    assert_eq!(users[1]["last_used_days_ago"], 0.0);
    assert_eq!(users.len(), 2);
}

#[test]
fn before_anything_happened_there_is_nothing() {
    let nothing = summary(json!({"object_id": "marker", "as_of": "2025-01-01T00:00:00"}));
    assert_eq!(nothing["user_summary"], json!([]));
    assert_eq!(nothing["unattributed_events"], 0);
}

#[rstest]
#[case(1, json!([]), 0)]
#[case(2, json!([]), 1)]
#[case(3, json!([["Mary", 2], ["Bob", 1]]), 1)]
#[case(4, json!([["Bob", 4], ["Mary", 2]]), 1)]
fn the_window_is_counted_back_from_as_of(
    #[case] window_days: u32,
    #[case] users: Value,
    #[case] unattributed: u32,
) {
    let seen = summary(json!({"object_id": "marker", "window_days": window_days}));
    let counts: Vec<Value> = seen["user_summary"]
        .as_array()
        .unwrap()
        .iter()
        .map(|user| json!([user["user_id"], user["total_events"]]))
        .collect();
    assert_eq!(json!(counts), users);
    assert_eq!(seen["unattributed_events"], unattributed);
    assert_eq!(seen["window_days"], window_days);
}

#[rstest]
#[case(0, json!([]))]
#[case(1, json!(["2025-01-17 10:05 Bob is using the Marker"]))]
#[case(2, json!(["2025-01-16 08:41 Bob places the Marker", "2025-01-17 10:05 Bob is using the Marker"]))]
fn examples_are_the_latest_ones_oldest_first(#[case] max_examples: u32, #[case] examples: Value) {
    let seen = summary(json!({"object_id": "marker", "max_examples": max_examples}));
    assert_eq!(seen["user_summary"][0]["example_events"], examples);
}

#[test]
fn by_default_there_are_five_examples() {
    let mut episode = super::furnished();
    for minute in 0..7 {
        episode = episode.caption("marker", &format!("2025-01-16 08:0{minute} Bob is using the Marker"));
    }
    let seen = Home::of(&episode).server().ok("get_usage_summary", json!({"object_id": "marker"}));
    let examples = seen["user_summary"][0]["example_events"].as_array().unwrap().clone();
    assert_eq!(examples.len(), 5);
    assert_eq!(examples[0], "2025-01-16 08:02 Bob is using the Marker");
    assert_eq!(examples[4], "2025-01-16 08:06 Bob is using the Marker");
}

#[test]
fn users_stand_by_events_and_then_by_name() {
    let episode = super::furnished()
        .caption("marker", "2025-01-16 08:00 Tom is using the Marker")
        .caption("marker", "2025-01-17 08:00 Mary is using the Marker")
        .caption("marker", "2025-01-18 08:00 Bob is using the Marker")
        .caption("marker", "2025-01-19 08:00 Mary is using the Marker");
    let seen = Home::of(&episode).server().ok("get_usage_summary", json!({"object_id": "marker"}));
    let order: Vec<&str> = seen["user_summary"]
        .as_array()
        .unwrap()
        .iter()
        .map(|user| user["user_id"].as_str().unwrap())
        .collect();
    assert_eq!(order, ["Mary", "Bob", "Tom"]);
}

#[test]
fn captions_need_not_come_in_the_order_of_time() {
    let mut episode = used_marker();
    let in_order = Home::of(&episode).server().ok("get_usage_summary", json!({"object_id": "marker"}));
    episode.captions.reverse();
    let reversed = Home::of(&episode).server().ok("get_usage_summary", json!({"object_id": "marker"}));
    assert_eq!(in_order, reversed);
}

#[test]
fn a_thing_that_nobody_touched_has_an_empty_summary() {
    let seen = Home::of(&used_marker()).server().ok("get_usage_summary", json!({"object_id": "table"}));
    assert_eq!(seen["object"], json!({"id": "table", "name": "Coffee Table"}));
    assert_eq!(seen["user_summary"], json!([]));
    assert_eq!(seen["unattributed_events"], 0);
}
