//! `record_answer`.

use coin_tests::{Home, ServerProcess};
use rusqlite::Connection;
use serde_json::{Value, json};

/// What `list_objects` says of the marker.
fn belief(server: &mut ServerProcess) -> Value {
    let listed = server.ok("list_objects", json!({"class": "marker"}));
    listed["objects"][0].clone()
}

/// How many answers the history of the home holds.
fn history(home: &Home) -> i64 {
    let database = Connection::open(home.db()).unwrap();
    database.query_row("SELECT count(*) FROM answers", [], |row| row.get(0)).unwrap()
}

#[test]
fn it_has_exactly_the_fields_of_the_contract() {
    let mut server = super::furnished_home().server();
    assert_eq!(
        server.ok(
            "record_answer",
            json!({
                "object_id": "marker",
                "question": "Is this marker yours, Bob?",
                "answer": "Mine and Tom's.",
                "ownership": {"Bob": true, "Mary": false, "Tom": true},
                "owner_outside_household": false,
                "answered_by": "Bob",
                "as_of": "2025-01-19T20:00:00",
            }),
        ),
        json!({
            "object": {"id": "marker", "name": "Marker"},
            "owners": ["Bob", "Tom"],
            "scores": {"Bob": 1.0, "Mary": 0.0, "Tom": 1.0},
            "status": "answered",
        })
    );
}

#[test]
fn users_who_are_left_out_own_nothing_and_the_belief_is_settled() {
    let mut server = super::furnished_home().server();
    let result = server.ok("record_answer", super::answer("marker", "Mary"));
    assert_eq!(result["owners"], json!(["Mary"]));
    assert_eq!(result["scores"], json!({"Bob": 0.0, "Mary": 1.0, "Tom": 0.0}));
    let listed = belief(&mut server);
    assert_eq!(listed["owners"], json!(["Mary"]));
    assert_eq!(listed["confidence"], 1.0);
    assert_eq!(listed["settled"], true);
    assert_eq!(listed["source"], "answer");
}

#[test]
fn an_answer_that_names_nobody_is_kept_and_settles_nothing() {
    let home = super::furnished_home();
    let mut server = home.server();
    let before = belief(&mut server);
    let mut arguments = super::answer("marker", "Bob");
    arguments["answer"] = json!("I don't know.");
    arguments["ownership"] = json!({"Bob": false});
    let result = server.ok("record_answer", arguments);
    assert_eq!(result["status"], "unresolved");
    assert_eq!(result["owners"], json!([]));
    assert_eq!(belief(&mut server), before);
    assert_eq!(before["settled"], false);
    assert_eq!(history(&home), 1);
}

#[test]
fn somebody_outside_the_household_is_an_answer() {
    let mut server = super::furnished_home().server();
    let mut arguments = super::answer("marker", "Bob");
    arguments["answer"] = json!("It belongs to the neighbours.");
    arguments["ownership"] = json!({});
    arguments["owner_outside_household"] = json!(true);
    let result = server.ok("record_answer", arguments);
    assert_eq!(result["status"], "answered");
    assert_eq!(result["owners"], json!([]));
    assert_eq!(result["scores"], json!({"Bob": 0.0, "Mary": 0.0, "Tom": 0.0}));
    let listed = belief(&mut server);
    assert_eq!(listed["owners"], json!([]));
    assert_eq!(listed["settled"], true);
    assert_eq!(listed["source"], "answer");
}

#[test]
fn the_same_call_twice_leaves_one_answer() {
    let home = super::furnished_home();
    let mut server = home.server();
    let first = server.ok("record_answer", super::answer("marker", "Bob"));
    let second = server.ok("record_answer", super::answer("marker", "Bob"));
    assert_eq!(first, second);
    assert_eq!(history(&home), 1);
}

#[test]
fn an_unresolved_answer_is_not_kept_twice_either() {
    let home = super::furnished_home();
    let mut server = home.server();
    let mut arguments = super::answer("marker", "Bob");
    arguments["ownership"] = json!({});
    server.ok("record_answer", arguments.clone());
    server.ok("record_answer", arguments);
    assert_eq!(history(&home), 1);
}

#[test]
fn a_new_answer_replaces_the_belief_and_the_history_keeps_both() {
    let home = super::furnished_home();
    let mut server = home.server();
    server.ok("record_answer", super::answer("marker", "Bob"));
    server.ok("record_answer", super::answer("marker", "Mary"));
    assert_eq!(belief(&mut server)["owners"], json!(["Mary"]));
    assert_eq!(history(&home), 2);
}

#[test]
fn an_answer_outweighs_any_inference() {
    let mut server = super::furnished_home().server();
    server.ok("record_answer", super::answer("marker", "Bob"));
    server.ok(
        "record_scores",
        json!({"object_id": "marker", "scores": {"Bob": 0.01, "Mary": 0.99, "Tom": 0.01}}),
    );
    let listed = belief(&mut server);
    assert_eq!(listed["owners"], json!(["Bob"]));
    assert_eq!(listed["source"], "answer");
}

#[test]
fn another_server_on_the_same_file_sees_the_answer() {
    let home = super::furnished_home();
    let mut one = home.server();
    let mut other = home.server();
    assert_eq!(belief(&mut other)["settled"], false);
    one.ok("record_answer", super::answer("marker", "Tom"));
    assert_eq!(belief(&mut other)["owners"], json!(["Tom"]));
}
