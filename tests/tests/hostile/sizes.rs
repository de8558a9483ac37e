//! Messages that are too large: refused, and forgotten.

use coin_server::transport::MESSAGE_BYTES;
#[cfg(target_os = "linux")]
use coin_tests::resident_memory;
use coin_tests::{Era, HttpRequest, HttpServer, ServerProcess};
use serde_json::{Value, json};

/// A message of `bytes` bytes, as far as they go; it would record a caption.
fn large(bytes: usize) -> String {
    let captions = json!([{"object_id": "1", "caption": "a".repeat(bytes)}]);
    let call = json!({"name": "record_usage", "arguments": {"captions": captions}});
    json!({"jsonrpc": "2.0", "id": 77, "method": "tools/call", "params": call}).to_string()
}

#[cfg(target_os = "linux")]
const TOO_LARGE: usize = 20 << 20;

/// What a server may keep of what it refused, in KiB: as much as it keeps ready for two messages that it would take.
#[cfg(target_os = "linux")]
const KEPT: u64 = 40 << 10;

#[cfg(target_os = "linux")]
#[test]
fn a_line_of_twenty_megabytes_is_passed_over_with_a_note() {
    let home = super::home();
    let mut server = home.server();
    let line = large(TOO_LARGE);
    server.ok("list_users", json!({}));
    let before = resident_memory(server.process());
    for _ in 0..20 {
        server.send_line(&line);
    }
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
    let grown = resident_memory(server.process()).saturating_sub(before);
    assert!(grown < KEPT, "twenty lines of 20 MB left {grown} KiB behind");
    let notes = server.stderr().matches("exceeded the maximum line length").count();
    assert_eq!(notes, 20, "{}", server.stderr());
}

#[cfg(target_os = "linux")]
#[test]
fn a_line_that_never_ends_takes_no_memory() {
    let home = super::home();
    let mut server = ServerProcess::start_silent(["--db".as_ref(), home.db().as_os_str()], Era::Modern);
    server.ok("list_users", json!({}));
    let before = resident_memory(server.process());
    for _ in 0..100 {
        server.send_bytes(&[b'a'; 1 << 20]);
    }
    let grown = resident_memory(server.process()).saturating_sub(before);
    assert!(grown < KEPT, "an endless line takes {grown} KiB");
    server.send_bytes(b"\n");
    server.ok("list_users", json!({}));
}

#[cfg(target_os = "linux")]
#[test]
fn a_body_of_twenty_megabytes_is_refused() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let request = HttpRequest::post(large(TOO_LARGE));
    super::assert_serves(&server);
    let before = resident_memory(server.process());
    for _ in 0..20 {
        let response = request.send(server.address());
        assert_eq!(response.status, 413, "{response:?}");
        assert!(response.body.contains("16777216"), "{response:?}");
    }
    super::assert_serves(&server);
    let grown = resident_memory(server.process()).saturating_sub(before);
    assert!(grown < KEPT, "twenty bodies of 20 MB left {grown} KiB behind");
}

#[test]
fn a_body_of_unknown_length_is_refused_when_it_is_too_long() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let mut connection = coin_tests::HttpConnection::open(server.address()).unwrap();
    let head = HttpRequest::post("").head().replace("Content-Length: 0", "Transfer-Encoding: chunked");
    connection.write(head.as_bytes()).unwrap();
    let chunk = format!("100000\r\n{}\r\n", "a".repeat(1 << 20));
    for _ in 0..20 {
        connection.write(chunk.as_bytes()).unwrap();
    }
    connection.write(b"0\r\n\r\n").unwrap();
    assert_eq!(connection.read().unwrap().status, 413);
    super::assert_serves(&server);
}

/// The largest message that is read is not answered by a crash either.
#[test]
fn what_is_just_small_enough_is_read() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let empty = large(0).len();
    let response = HttpRequest::post(large(MESSAGE_BYTES - empty)).send(server.address());
    assert_eq!((response.status, &*response.body), (400, "Bad Request: Session ID is required"));
    let mut pipe = home.server();
    pipe.send_line(&large(MESSAGE_BYTES - empty - 1));
    let answer = pipe.wait(77).unwrap();
    assert_eq!(answer["structuredContent"]["recorded"], Value::from(0), "{answer:.300}");
}
