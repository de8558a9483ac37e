//! `retract_answer`.

use std::thread;

use coin_tests::{Home, ServerProcess};
use rusqlite::Connection;
use serde_json::{Value, json};

const MARKER: &str = "marker";

fn belief(server: &mut ServerProcess) -> Value {
    server.ok("list_objects", json!({"class": MARKER}))["objects"][0].clone()
}

/// The words of every answer that the home keeps, and whether it was taken back.
fn history(home: &Home) -> Vec<(String, bool)> {
    let database = Connection::open(home.db()).unwrap();
    let mut statement =
        database.prepare("SELECT answer, retracted_at IS NOT NULL FROM answers ORDER BY sequence").unwrap();
    let rows = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).unwrap();
    rows.map(Result::unwrap).collect()
}

fn scores() -> Value {
    json!({"object_id": MARKER, "scores": {"Bob": 0.0, "Mary": 1.0, "Tom": 0.0}})
}

#[test]
fn it_has_exactly_the_fields_of_the_contract() {
    let mut server = super::furnished_home().server();
    server.ok("record_answer", super::answer(MARKER, "Bob"));
    assert_eq!(
        server.ok("retract_answer", json!({"object_id": MARKER})),
        json!({
            "object": {"id": "marker", "name": "Marker"},
            "owners": [],
            "confidence": 0.0,
            "settled": false,
        })
    );
    server.ok("record_scores", scores());
    server.ok("record_answer", super::answer(MARKER, "Bob"));
    assert_eq!(
        server.ok("retract_answer", json!({"object_id": MARKER})),
        json!({
            "object": {"id": "marker", "name": "Marker"},
            "owners": ["Mary"],
            "confidence": 1.0,
            "settled": true,
            "source": "inferred",
        })
    );
}

#[test]
fn what_was_believed_without_the_answer_is_believed_again_and_the_history_keeps_it() {
    let home = super::furnished_home();
    let mut server = home.server();
    server.ok("record_scores", scores());
    let before = belief(&mut server);
    server.ok("record_answer", super::answer(MARKER, "Tom"));
    server.ok("record_answer", super::answer(MARKER, "Bob"));
    server.ok("retract_answer", json!({"object_id": MARKER}));
    assert_eq!(belief(&mut server), before, "Tom's answer does not count again");
    let told = [("It is Tom's.", false), ("It is Bob's.", true)];
    assert_eq!(history(&home), told.map(|(words, back)| (words.to_owned(), back)));
}

#[test]
fn an_answer_that_was_not_given_cannot_be_taken_back() {
    let home = super::furnished_home();
    let mut server = home.server();
    let nothing = ["object_id", "no answer to take back", "\"marker\""];
    server.refused("retract_answer", json!({"object_id": MARKER}), &nothing);
    server.ok("record_answer", super::answer(MARKER, "Bob"));
    server.ok("retract_answer", json!({"object_id": MARKER}));
    server.refused("retract_answer", json!({"object_id": MARKER}), &nothing);
    assert_eq!(history(&home).len(), 1);
}

#[test]
fn the_right_answer_can_follow_even_if_it_is_the_same() {
    let home = super::furnished_home();
    let mut server = home.server();
    for _ in 0..2 {
        server.ok("record_answer", super::answer(MARKER, "Bob"));
        assert_eq!(belief(&mut server)["owners"], json!(["Bob"]));
        server.ok("retract_answer", json!({"object_id": MARKER}));
        assert_eq!(belief(&mut server)["owners"], json!([]));
    }
    server.ok("record_answer", super::answer(MARKER, "Mary"));
    assert_eq!(belief(&mut server)["owners"], json!(["Mary"]));
    assert_eq!(history(&home).into_iter().map(|(_, back)| back).collect::<Vec<_>>(), [true, true, false]);
}

#[test]
fn neighbours_do_not_show_it_any_more() {
    let mut server = super::furnished_home().server();
    let before = server.ok("nearby_objects", json!({"object_id": "mug-red"}));
    server.ok("record_answer", super::answer(MARKER, "Bob"));
    assert_ne!(server.ok("nearby_objects", json!({"object_id": "mug-red"})), before);
    server.ok("retract_answer", json!({"object_id": MARKER}));
    assert_eq!(server.ok("nearby_objects", json!({"object_id": "mug-red"})), before);
}

#[test]
fn of_several_servers_one_takes_an_answer_back() {
    const SERVERS: usize = 4;
    let home = super::furnished_home();
    home.server().ok("record_answer", super::answer(MARKER, "Bob"));
    let succeeded = thread::scope(|scope| {
        let calls: Vec<_> = (0..SERVERS)
            .map(|_| {
                scope.spawn(|| !home.server().call("retract_answer", json!({"object_id": MARKER})).is_error)
            })
            .collect();
        calls.into_iter().map(|call| call.join().unwrap()).filter(|succeeded| *succeeded).count()
    });
    assert_eq!(succeeded, 1);
    assert_eq!(history(&home), [("It is Bob's.".to_owned(), true)]);
}
