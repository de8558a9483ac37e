//! A flood of clients of the older protocol that say hello and never come back.

use coin_tests::{HttpConnection, HttpRequest, HttpServer, resident_memory};
use serde_json::json;

/// As many sessions as a server keeps, so that further ones displace earlier ones.
const KEPT: usize = 256;

#[test]
fn a_flood_of_sessions_takes_no_more_memory_than_those_that_are_kept() {
    let home = super::home();
    let arguments = ["--http", "127.0.0.1:0", "--requests-per-second", "100000"];
    let server = HttpServer::start_with(home.db(), &arguments, &[]);
    let mut connection = HttpConnection::open(server.address()).unwrap();
    let mut open = || {
        let response = connection.exchange(&HttpRequest::initialize()).unwrap();
        assert_eq!(response.status, 200, "{response:?}");
        response.header("mcp-session-id").unwrap().to_owned()
    };
    let first = open();
    for _ in 0..2 * KEPT {
        open();
    }
    let before = resident_memory(server.process());
    for _ in 0..10 * KEPT {
        open();
    }
    let grown = resident_memory(server.process()).saturating_sub(before);
    // A session that is not given back takes a hundred KiB.
    assert!(grown < 16 << 10, "{} further sessions took {grown} KiB", 10 * KEPT);

    let ping =
        |session: &str| HttpRequest::in_session(session, "ping", json!({})).send(server.address()).status;
    assert_eq!((ping(&first), ping(&open())), (404, 200));
    super::assert_serves(&server);
    assert_eq!(server.stderr().lines().count(), 1, "a flood of clients fills the log");
}
