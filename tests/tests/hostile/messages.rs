//! What is no message, over both transports. `a_malformed_line_does_not_end_the_server` of the contract tests says
//! that the server goes on; here it is said what is answered.

use std::time::Duration;

use coin_tests::{Era, HttpRequest, HttpServer, ServerProcess};
use rstest::rstest;
use serde_json::json;

/// The next thing that the server says is the answer to a call, and it is right.
#[track_caller]
fn assert_is_answered_next(pipe: &mut ServerProcess) {
    let call = pipe.send("tools/call", json!({"name": "list_users", "arguments": {}}));
    let answer = pipe.next_message(Duration::from_secs(10)).expect("it is answered");
    assert_eq!(answer["id"], call, "{answer}");
    assert_eq!(answer["result"]["structuredContent"]["users"].as_array().unwrap().len(), 3);
}

const PING: &str = r#"{"jsonrpc": "2.0", "id": 900, "method": "ping"}"#;

/// Nothing can be said to whoever sends no JSON, since an answer might be taken for the next message.
#[rstest]
#[case::words("this is no JSON".into())]
#[case::cut_off(r#"{"jsonrpc": "2.0", "id": 1, "method": "ping""#.into())]
#[case::two_in_one_line(format!("{PING}{PING}"))]
#[case::a_control_character("{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"pi\u{0}ng\"}".into())]
#[case::deep("[".repeat(100_000))]
#[case::deep_in_a_message(format!(r#"{{"jsonrpc": "2.0", "id": 1, "method": {}"#, r#"{"a":"#.repeat(100_000)))]
fn what_is_no_json_is_passed_over_on_a_pipe_and_refused_over_http(#[case] text: String) {
    let home = super::home();
    let mut pipe = home.server_of(Era::Modern);
    pipe.send_line(&text);
    assert_is_answered_next(&mut pipe);

    let server = HttpServer::start(home.db());
    assert_eq!(HttpRequest::post(text).send(server.address()).status, 415);
    super::assert_serves(&server);
}

#[rstest]
#[case::a_number("42".into())]
#[case::nothing("null".into())]
#[case::an_empty_batch("[]".into())]
#[case::a_batch(format!("[{PING}, {PING}]"))]
#[case::no_id(r#"{"jsonrpc": "2.0", "id": null, "method": "ping"}"#.into())]
#[case::an_id_of_another_kind(r#"{"jsonrpc": "2.0", "id": {"a": 1}, "method": "ping"}"#.into())]
#[case::another_version(r#"{"jsonrpc": "1.0", "id": 1, "method": "ping"}"#.into())]
#[case::no_method(r#"{"jsonrpc": "2.0", "id": 1}"#.into())]
#[case::a_method_of_another_kind(r#"{"jsonrpc": "2.0", "id": 1, "method": ["ping"]}"#.into())]
#[case::deep_but_whole(format!("{}{}", "[".repeat(100), "]".repeat(100)))]
fn what_is_no_message_is_an_invalid_request(#[case] text: String) {
    let home = super::home();
    let mut pipe = home.server_of(Era::Modern);
    pipe.send_line(&text);
    let answer = pipe.next_message(Duration::from_secs(10)).expect("it is answered");
    assert_eq!(answer["error"]["code"], -32600, "{answer}");
    assert!(answer["id"].is_null(), "{answer}");
    assert_eq!(pipe.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);

    let server = HttpServer::start(home.db());
    assert_eq!(HttpRequest::post(text).send(server.address()).status, 415);
    super::assert_serves(&server);
}

#[rstest]
#[case::of_2026(Era::Modern, "server/discover")]
#[case::of_2025(Era::Legacy, "ping")]
fn what_comes_before_the_version_is_settled_changes_nothing(#[case] era: Era, #[case] probe: &str) {
    let home = super::home();
    let mut pipe = ServerProcess::start_silent(["--db".as_ref(), home.db().as_os_str()], era);
    let early = [
        json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 1}}),
        json!({"jsonrpc": "2.0", "method": "notifications/initialized"}),
        json!({"jsonrpc": "2.0", "id": 7, "result": {}}),
        json!({"jsonrpc": "2.0", "id": 8, "error": {"code": -1, "message": "no"}}),
    ];
    for message in &early {
        pipe.send_line(&message.to_string());
    }
    pipe.request(probe, json!({})).expect("a probe is answered");
    for message in &early {
        pipe.send_line(&message.to_string());
    }
    if era == Era::Legacy {
        let hello = json!({
            "protocolVersion": "2025-11-25",
            "capabilities": {},
            "clientInfo": {"name": "test", "version": "0"},
        });
        pipe.request("initialize", hello).expect("initialize is answered");
        pipe.notify("notifications/initialized");
    }
    assert_is_answered_next(&mut pipe);
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let body = b"{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"\xff\xfe\"}".to_vec();
    assert_eq!(HttpRequest::post(body).send(server.address()).status, 415);
    super::assert_serves(&server);
}

#[rstest]
#[case::form(HttpRequest::post("a=1").header("Content-Type", "application/x-www-form-urlencoded"), 415)]
#[case::text(HttpRequest::post(PING).header("Content-Type", "text/plain"), 415)]
#[case::nothing_said(HttpRequest::post(PING).without("Content-Type"), 415)]
#[case::wants_a_page(HttpRequest::post(PING).header("Accept", "text/html"), 406)]
#[case::wants_no_stream(HttpRequest::post(PING).header("Accept", "application/json"), 406)]
#[case::another_method(HttpRequest::post(PING).method("PUT"), 405)]
#[case::a_made_up_method(HttpRequest::post(PING).method("BREW"), 405)]
#[case::before_a_page_asks(HttpRequest::new("OPTIONS", "/mcp"), 405)]
fn what_is_no_request_of_mcp_is_refused(#[case] request: HttpRequest, #[case] status: u16) {
    let home = super::home();
    let server = HttpServer::start(home.db());
    assert_eq!(request.send(server.address()).status, status);
    super::assert_serves(&server);
}

#[rstest]
#[case::no_http("\u{16}\u{3}\u{1}\u{2}\u{0}\u{1}\u{0}\u{1}\u{fc}\r\n\r\n", Some(400))]
#[case::old_http("GET /healthz HTTP/0.9\r\n\r\n", Some(400))]
#[case::two_lengths(
    "POST /mcp HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\na",
    Some(400)
)]
#[case::two_hosts("GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n", Some(403))]
#[case::a_header_in_a_header("GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: a\u{0}b\r\n\r\n", Some(400))]
fn what_is_hardly_http_is_refused(#[case] text: &str, #[case] status: Option<u16>) {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let mut connection = coin_tests::HttpConnection::open(server.address()).unwrap();
    connection.write(text.as_bytes()).unwrap();
    assert_eq!(connection.read_head().ok().map(|response| response.status), status);
    super::assert_serves(&server);
}

#[test]
fn a_head_without_end_is_refused() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let long = HttpRequest::new("GET", "/healthz").header("X-Long", &"a".repeat(1 << 20));
    let mut connection = coin_tests::HttpConnection::open(server.address()).unwrap();
    // The server may hang up before it was sent everything.
    connection.send(&long).ok();
    assert!(connection.read_head().map_or(true, |response| response.status == 431));
    let many = (0..1000).fold(HttpRequest::new("GET", "/healthz"), |request, number| {
        request.header(&format!("X-{number}"), "a")
    });
    assert_eq!(many.send(server.address()).status, 431);
    super::assert_serves(&server);
}
