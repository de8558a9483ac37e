//! Several processes on one file.

use std::thread;
use std::time::{Duration, Instant};

use coin_tests::Home;
use rusqlite::{Connection, TransactionBehavior};
use serde_json::json;

const CALLS: usize = 150;
const CAPTIONS_A_CALL: usize = 20;

#[test]
fn two_servers_that_write_at_once_lose_nothing() {
    let home = Home::of(&super::furnished());
    thread::scope(|scope| {
        for writer in 0..2 {
            let home = &home;
            scope.spawn(move || {
                let mut server = home.server();
                for call in 0..CALLS {
                    let first = (writer * CALLS + call) * CAPTIONS_A_CALL;
                    let captions: Vec<_> = (first..first + CAPTIONS_A_CALL).map(super::caption).collect();
                    let result = server.ok("record_usage", json!({"captions": captions}));
                    assert_eq!(result["recorded"], CAPTIONS_A_CALL);
                    // A reader in between must not be turned away either.
                    server.ok("get_usage_summary", json!({"object_id": "1"}));
                }
            });
        }
    });
    assert_eq!(super::count(&home.db(), "usage_events"), 2 * CALLS * CAPTIONS_A_CALL);
    super::assert_sound(&home.db());
}

#[test]
fn servers_that_start_at_once_on_a_new_file_all_come_up() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("new.db");
    thread::scope(|scope| {
        for _ in 0..6 {
            let db = &db;
            scope.spawn(move || {
                let (status, stderr) = super::serve(db).finish();
                assert_eq!(status.code(), Some(0), "{stderr}");
            });
        }
    });
    super::assert_sound(&db);
}

#[test]
fn two_imports_at_once_leave_one_home() {
    let episode = super::furnished().caption("1", "2025-01-19 08:00 Bob takes the Marker").write();
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("home.db");
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| super::import(episode.path(), &db).run().expect_code(0));
        }
    });
    assert_eq!((super::count(&db, "objects"), super::count(&db, "usage_events")), (3, 1));
}

#[test]
fn a_lock_that_somebody_else_holds_is_waited_for_and_then_told() {
    let home = Home::of(&super::furnished());
    let mut server = home.server();
    let mut other = Connection::open(home.db()).unwrap();
    let lock = other.transaction_with_behavior(TransactionBehavior::Exclusive).unwrap();

    let started = Instant::now();
    let captions = json!({"captions": [super::caption(0)]});
    let text = server.refused("record_usage", captions.clone(), &["locked", "again"]);
    let waited = started.elapsed();
    assert!(waited > Duration::from_secs(2), "it gave up after {waited:?}: {text}");
    assert!(waited < Duration::from_secs(15), "it waited for {waited:?}: {text}");

    // Whoever only looks is not held up by a writer.
    server.ok("get_usage_summary", json!({"object_id": "1"}));

    lock.rollback().unwrap();
    assert_eq!(server.ok("record_usage", captions)["recorded"], 1);
}

#[test]
fn a_lock_that_is_given_back_in_time_is_no_failure() {
    let home = Home::of(&super::furnished());
    let mut server = home.server();
    let mut other = Connection::open(home.db()).unwrap();
    let lock = other.transaction_with_behavior(TransactionBehavior::Immediate).unwrap();
    let call = json!({"name": "record_usage", "arguments": {"captions": [super::caption(0)]}});
    let id = server.send("tools/call", call);
    thread::sleep(Duration::from_millis(700));
    lock.rollback().unwrap();
    assert_eq!(server.wait(id).unwrap()["structuredContent"]["recorded"], 1);
}

#[test]
fn a_server_starts_while_another_process_writes() {
    let home = Home::of(&super::furnished());
    let mut other = Connection::open(home.db()).unwrap();
    let lock = other.transaction_with_behavior(TransactionBehavior::Immediate).unwrap();
    let mut server = home.server();
    assert_eq!(server.ok("list_objects", json!({}))["total"], 3);
    drop(lock);
}
