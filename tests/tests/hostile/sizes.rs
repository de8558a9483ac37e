//! Messages that are too large: refused, and forgotten.

use coin_server::transport::MESSAGE_BYTES;
#[cfg(target_os = "linux")]
use coin_server::transport::http::Limits;
#[cfg(target_os = "linux")]
use coin_tests::{Era, HttpConnection, HttpResponse, ServerProcess, resident_memory};
use coin_tests::{HttpRequest, HttpServer};
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

/// What a server may keep ready for bodies, in KiB: as much as all of them may take together.
#[cfg(target_os = "linux")]
fn ready() -> u64 {
    Limits::default().bodies_bytes as u64 >> 10
}

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

/// By how many KiB twenty bodies have a server grow; each is answered with the status expected.
#[cfg(target_os = "linux")]
fn growth(server: &HttpServer, send: impl Fn() -> HttpResponse, expected: u16) -> u64 {
    super::assert_serves(server);
    let before = resident_memory(server.process());
    for _ in 0..20 {
        let response = send();
        assert_eq!(response.status, expected, "{response:?}");
    }
    super::assert_serves(server);
    resident_memory(server.process()).saturating_sub(before)
}

#[cfg(target_os = "linux")]
#[test]
fn a_body_of_twenty_megabytes_is_refused() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let request = HttpRequest::post(large(TOO_LARGE));
    let send = || {
        let response = request.send(server.address());
        assert!(response.body.contains("16777216"), "{response:?}");
        response
    };
    let grown = growth(&server, send, 413);
    assert!(grown < KEPT, "twenty bodies of 20 MB left {grown} KiB behind");
}

#[cfg(target_os = "linux")]
#[test]
fn a_body_of_unknown_length_is_refused_when_it_is_too_long() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let head = HttpRequest::post("").head().replace("Content-Length: 0", "Transfer-Encoding: chunked");
    let chunk = format!("100000\r\n{}\r\n", "a".repeat(1 << 20));
    let send = || {
        let mut connection = HttpConnection::open(server.address()).unwrap();
        connection.write(head.as_bytes()).unwrap();
        for _ in 0..20 {
            connection.write(chunk.as_bytes()).unwrap();
        }
        connection.write(b"0\r\n\r\n").unwrap();
        connection.read().unwrap()
    };
    let grown = growth(&server, send, 413);
    assert!(grown < ready(), "twenty bodies of 20 MB left {grown} KiB behind");
}

/// What is worked on is forgotten as well, but for the memory that is kept ready for the next ones.
#[cfg(target_os = "linux")]
#[test]
fn bodies_that_are_just_small_enough_do_not_add_up() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let request = HttpRequest::post(large(MESSAGE_BYTES - large(0).len()));
    let send = || request.send(server.address());
    growth(&server, send, 400);
    let grown = growth(&server, send, 400);
    assert!(grown < ready(), "twenty more bodies of 16 MiB left {grown} KiB behind");
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
