//! The end of a server that listens: what was asked is answered, and nothing is lost.

use std::thread;
use std::time::{Duration, Instant};

use coin_tests::{HttpConnection, HttpRequest, HttpServer};
use rusqlite::{Connection, TransactionBehavior};
use serde_json::json;

#[cfg(unix)]
#[test]
fn a_server_that_is_told_to_end_answers_what_is_under_way() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let mut idle = HttpConnection::open(server.address()).unwrap();
    let mut other = Connection::open(home.db()).unwrap();
    let lock = other.transaction_with_behavior(TransactionBehavior::Immediate).unwrap();
    let caption = json!({"object_id": "1", "caption": "2025-01-19 19:00 Bob takes the Marker"});
    let record = HttpRequest::call("record_usage", json!({"captions": [caption]}));
    let address = server.address();
    let asking = thread::spawn(move || record.send(address).content());
    thread::sleep(Duration::from_millis(300));
    server.terminate();
    thread::sleep(Duration::from_millis(300));
    lock.rollback().unwrap();
    let freed = Instant::now();
    assert_eq!(asking.join().unwrap()["recorded"], 1);
    assert_eq!(server.wait().code(), Some(0));
    assert!(freed.elapsed() < Duration::from_secs(3), "it took {:?} to end", freed.elapsed());
    assert!(idle.read().is_err());
    let summary =
        home.server().ok("get_usage_summary", json!({"object_id": "1", "as_of": "2025-01-20T00:00:00"}));
    assert_eq!(summary["user_summary"][0]["total_events"], 1);
}

#[cfg(unix)]
#[test]
fn a_stream_that_only_listens_does_not_hold_up_the_end() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let hello = HttpRequest::initialize().send(server.address());
    let session = hello.header("mcp-session-id").unwrap();
    let mut listening = HttpConnection::open(server.address()).unwrap();
    let request = HttpRequest::new("GET", "/mcp").header("Accept", "text/event-stream");
    listening.send(&request.header("Mcp-Session-Id", session)).unwrap();
    assert_eq!(listening.read_head().unwrap().status, 200);
    let started = Instant::now();
    server.terminate();
    assert_eq!(server.wait().code(), Some(0));
    assert!(started.elapsed() < Duration::from_secs(3), "it took {:?} to end", started.elapsed());
}

#[test]
fn a_database_serves_several_servers_side_by_side() {
    let home = super::home();
    let servers = [(); 3].map(|()| HttpServer::start(home.db()));
    for (number, server) in servers.iter().enumerate() {
        let caption = format!("2025-01-19 19:0{number} Bob takes the Marker");
        let captions = json!({"captions": [{"object_id": "1", "caption": caption}]});
        assert_eq!(
            HttpRequest::call("record_usage", captions).send(server.address()).content()["recorded"],
            1
        );
    }
    for server in &servers {
        let look =
            HttpRequest::call("get_usage_summary", json!({"object_id": "1", "as_of": "2025-01-20T00:00:00"}));
        assert_eq!(look.send(server.address()).content()["user_summary"][0]["total_events"], 3);
    }
}
