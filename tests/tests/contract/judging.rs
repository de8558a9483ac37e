//! `whose_is`, `next_question`, `ask_owner` and `add_user`, in both protocols.

use coin_tests::{EpisodeBuilder, Era, Home};
use rstest::rstest;
use serde_json::{Value, json};

/// The furnished home after Bob has used the marker on ten days, and everybody the table.
fn lived_in() -> EpisodeBuilder {
    (1..=10).fold(super::furnished(), |episode, day| {
        episode
            .caption("marker", &format!("2025-01-{day:02} 08:00 Bob takes the Marker"))
            .caption("table", &format!("2025-01-{day:02} 09:00 Bob uses the Coffee Table"))
            .caption("table", &format!("2025-01-{day:02} 10:00 Mary uses the Coffee Table"))
            .caption("table", &format!("2025-01-{day:02} 11:00 Tom uses the Coffee Table"))
    })
}

fn probability(value: &Value) -> f64 {
    let probability = value.as_f64().unwrap();
    assert!((0.0..=1.0).contains(&probability), "{value}");
    probability
}

#[rstest]
fn whose_is_tells_owners_confidence_and_grounds(#[values(Era::Legacy, Era::Modern)] era: Era) {
    let home = Home::of(&lived_in());
    let mut server = home.server_of(era);
    let marker = server.ok("whose_is", json!({"object_id": "marker"}));
    assert_eq!(marker["object"], json!({"id": "marker", "name": "Marker"}));
    assert_eq!((&marker["owners"], &marker["settled"]), (&json!(["Bob"]), &json!(true)));
    assert_eq!(marker["source"], "inferred");
    assert!(probability(&marker["confidence"]) > 0.9, "{marker}");
    assert!(probability(&marker["scores"]["Bob"]) > probability(&marker["scores"]["Mary"]));
    assert_eq!(marker["prediction_set"], json!(["Bob"]));
    let usage = &marker["evidence"]["usage"];
    assert_eq!((&usage[0]["user_id"], &usage[0]["sessions"]), (&json!("Bob"), &json!(10)));
    let explanation = marker["explanation"].as_str().unwrap();
    assert_eq!(explanation.matches(". ").count(), 1, "two sentences: {explanation}");
    assert!(explanation.contains("Bob used it in 10 sessions"), "{explanation}");
    let table = server.ok("whose_is", json!({"object_id": "table"}));
    assert_eq!(table["owners"], json!(["Bob", "Mary", "Tom"]));
}

#[test]
fn what_was_seen_later_is_hidden_from_the_past() {
    let home = Home::of(&lived_in());
    let mut server = home.server();
    let before = server.ok("whose_is", json!({"object_id": "marker", "as_of": "2025-01-02T12:00:00"}));
    assert_eq!(before["evidence"]["usage"][0]["sessions"], 2);
    let now = server.ok("whose_is", json!({"object_id": "marker"}));
    assert!(probability(&before["confidence"]) < probability(&now["confidence"]));
}

#[rstest]
fn a_home_is_settled_by_its_own_questions(#[values(Era::Legacy, Era::Modern)] era: Era) {
    let home = Home::of(&lived_in());
    let mut server = home.server_of(era);
    let mut asked = Vec::new();
    loop {
        assert!(asked.len() <= 4, "it asks for ever: {asked:?}");
        let next = server.ok("next_question", json!({}));
        if next["done"] == true {
            assert_eq!(next, json!({"done": true, "unsettled": 0}));
            break;
        }
        let id = next["object"]["id"].as_str().unwrap().to_owned();
        assert!(next["question"].as_str().unwrap().ends_with('?'), "{next}");
        assert!(!next["candidates"].as_array().unwrap().is_empty(), "{next}");
        let result = server.ok("ask_owner", json!({"object_id": id, "owner": "That is Mary's."}));
        assert_eq!((&result["status"], &result["owners"]), (&json!("answered"), &json!(["Mary"])));
        assert_eq!(result["question"], next["question"]);
        asked.push(id);
    }
    asked.sort();
    assert_eq!(asked, ["mug-blue", "mug-red"], "nobody has used the mugs");
    let last = server.ok("ask_owner", json!({}));
    assert_eq!(last["status"], "nothing_to_ask");
}

#[rstest]
fn a_client_that_shows_no_form_learns_what_to_do(#[values(Era::Legacy, Era::Modern)] era: Era) {
    let home = Home::of(&lived_in());
    let mut server = home.server_of(era);
    let question = server.ok("next_question", json!({}))["question"].as_str().unwrap().to_owned();
    server.refused("ask_owner", json!({}), &["Ask in the chat", &question, "object_id \"mug-", "owner"]);
    server.refused("ask_owner", json!({"object_id": "mug"}), &["object_id", "\"mug-blue\", \"mug-red\""]);
}

#[test]
fn the_answer_of_a_person_is_read_as_it_was_meant() {
    let home = super::furnished_home();
    let mut server = home.server();
    for (words, status, owners) in [
        ("Bob and Mary share it.", "answered", json!(["Bob", "Mary"])),
        ("No idea, sorry.", "unresolved", json!([])),
        ("It belongs to a guest.", "answered", json!([])),
        ("everybody's", "answered", json!(["Bob", "Mary", "Tom"])),
    ] {
        let result = server.ok("ask_owner", json!({"object_id": "mug-red", "owner": words}));
        assert_eq!((&result["status"], &result["owners"]), (&json!(status), &owners), "{words}");
        assert_eq!(result["owner_outside_household"], words.contains("guest"));
    }
    let told = server.ok("whose_is", json!({"object_id": "mug-red"}));
    assert_eq!(told["evidence"]["answer"]["answer"], "everybody's");
}

#[test]
fn somebody_who_joins_changes_nothing_about_older_things() {
    let home = Home::of(&lived_in());
    let mut server = home.server();
    let before = server.ok("whose_is", json!({"object_id": "marker"}));
    server.ok("record_answer", super::answer("mug-red", "Mary"));
    let result = server.ok("add_user", json!({"name": "Ann", "role": "flatmate"}));
    assert_eq!(result["users"][0], json!({"name": "Ann", "role": "flatmate"}));
    let after = server.ok("whose_is", json!({"object_id": "marker"}));
    assert_eq!((&after["owners"], &after["settled"]), (&before["owners"], &before["settled"]));
    assert_eq!(after["scores"]["Ann"], 0.0);
    assert_eq!(server.ok("whose_is", json!({"object_id": "mug-red"}))["source"], "answer");
    let table = server.ok("whose_is", json!({"object_id": "table"}));
    assert!(probability(&table["scores"]["Ann"]) > 0.0, "everybody's table may be Ann's too: {table}");
}

#[test]
fn a_home_begins_with_its_people() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("home.db");
    let mut server = coin_tests::ServerProcess::start(["--db", db.to_str().unwrap()], Era::Legacy);
    server.refused("next_question", json!({}), &["nobody lives in this home yet", "add_user"]);
    server.ok("add_user", json!({"name": "Bob"}));
    assert_eq!(server.ok("next_question", json!({})), json!({"done": true, "unsettled": 0}));
}
