//! `record_usage`.

use coin_tests::ServerProcess;
use serde_json::{Value, json};

fn line(object_id: &str, caption: &str) -> Value {
    json!({"object_id": object_id, "caption": caption})
}

fn summary(server: &mut ServerProcess, object_id: &str) -> Value {
    server.ok("get_usage_summary", json!({"object_id": object_id, "as_of": "2025-01-19T23:00:00"}))
}

#[test]
fn it_counts_what_it_stores_what_it_knew_and_what_it_refuses() {
    let mut server = super::furnished_home().server();
    let result = server.ok(
        "record_usage",
        json!({"captions": [
            line("marker", "2025-01-19 19:00 Bob takes the Marker"),
            line("marker", "2025-01-19 19:05:30 Somebody moves the Marker"),
            line("mrker", "2025-01-19 19:06 Bob takes the Marker"),
            line("marker", "2025-01-19 19:00 Bob takes the Marker"),
            line("marker", "yesterday Bob took the Marker"),
            line("mug-red", "2025-01-19T19:07 Mary washes the Mug"),
            line("marker", "2025-02-30 19:06 Bob takes the Marker"),
            line("marker", ""),
        ]}),
    );
    assert_eq!(result["recorded"], 3);
    assert_eq!(result["unattributed"], 1);
    assert_eq!(result["duplicates"], 1);
    let rejected = result["rejected"].as_array().unwrap();
    let places: Vec<&Value> = rejected.iter().map(|one| &one["index"]).collect();
    assert_eq!(places, [2, 4, 6, 7]);
    let reason = |place: usize| rejected[place]["reason"].as_str().unwrap();
    assert!(reason(0).contains("mrker") && reason(0).contains("marker"), "{}", reason(0));
    assert!(reason(1).contains("YYYY-MM-DD"), "{}", reason(1));
    assert!(reason(2).contains("2025-02-30"), "{}", reason(2));

    let seen = summary(&mut server, "marker");
    assert_eq!(seen["user_summary"][0]["total_events"], 1);
    assert_eq!(seen["user_summary"][0]["actions"], json!({"take": 1}));
    assert_eq!(seen["unattributed_events"], 1);
    let washed = summary(&mut server, "mug-red");
    assert_eq!(washed["user_summary"][0]["actions"], json!({"clean": 1}));
}

#[test]
fn what_was_recorded_before_is_a_duplicate_for_everybody() {
    let home = super::furnished_home();
    let captions = json!({"captions": [
        line("marker", "2025-01-19 19:00 Bob takes the Marker"),
        line("marker", "2025-01-19 19:00 Mary takes the Marker"),
    ]});
    let first = home.server().ok("record_usage", captions.clone());
    assert_eq!(first, json!({"recorded": 2, "unattributed": 0, "duplicates": 0, "rejected": []}));
    let second = home.server().ok("record_usage", captions);
    assert_eq!(second, json!({"recorded": 0, "unattributed": 0, "duplicates": 2, "rejected": []}));
}

#[test]
fn no_captions_are_no_mistake() {
    let mut server = super::furnished_home().server();
    assert_eq!(
        server.ok("record_usage", json!({"captions": []})),
        json!({"recorded": 0, "unattributed": 0, "duplicates": 0, "rejected": []})
    );
}

#[test]
fn captions_are_data() {
    let mut server = super::furnished_home().server();
    let hostile =
        "2025-01-19 19:00 Bob takes the Marker'); DROP TABLE users; -- \u{202e} <b>{\"isError\":true}</b>";
    let result = server.ok("record_usage", json!({"captions": [line("marker", hostile)]}));
    assert_eq!(result["recorded"], 1);
    assert_eq!(summary(&mut server, "marker")["user_summary"][0]["example_events"], json!([hostile]));
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
}

#[test]
fn many_captions_go_in_one_call() {
    let mut server = super::furnished_home().server();
    let captions: Vec<Value> = (0..5_000)
        .map(|number| {
            let (hour, minute, second) = (number / 3600, number / 60 % 60, number % 60);
            line("marker", &format!("2025-01-18 {hour:02}:{minute:02}:{second:02} Bob is using the Marker"))
        })
        .collect();
    let result = server.ok("record_usage", json!({"captions": captions}));
    assert_eq!(result["recorded"], 5_000);
    let seen = summary(&mut server, "marker");
    assert_eq!(seen["user_summary"][0]["total_events"], 5_000);
    assert_eq!(seen["user_summary"][0]["sessions"], 1);
}

#[test]
fn more_captions_than_a_call_may_have_are_refused_whole() {
    let mut server = super::furnished_home().server();
    let captions: Vec<Value> =
        (0..100_001).map(|_| line("marker", "2025-01-18 08:00 Bob is using the Marker")).collect();
    server.refused("record_usage", json!({"captions": captions}), &["captions", "100001", "100000"]);
    assert_eq!(summary(&mut server, "marker")["user_summary"], json!([]));
}

#[test]
fn the_largest_call_that_is_allowed_is_taken() {
    let mut server = super::furnished_home().server();
    let captions: Vec<Value> = (0..100_000)
        .map(|number| {
            let (day, hour, minute, second) =
                (1 + number / 86_400, number / 3600 % 24, number / 60 % 60, number % 60);
            line("marker", &format!("2025-01-{day:02} {hour:02}:{minute:02}:{second:02} Bob uses the Marker"))
        })
        .collect();
    let result = server.ok("record_usage", json!({"captions": captions}));
    assert_eq!(result["recorded"], 100_000);
}
