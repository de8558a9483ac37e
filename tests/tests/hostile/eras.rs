//! Clients that mix up the protocol versions.

use coin_tests::{Era, HttpRequest, HttpServer, LEGACY_VERSION, MODERN_VERSION};
use rstest::rstest;
use serde_json::{Value, json};

fn list() -> HttpRequest {
    HttpRequest::modern("tools/list", json!({}))
}

fn body(method: &str, parameters: &Value) -> String {
    json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters}).to_string()
}

fn version(version: &str) -> Value {
    json!({"_meta": {
        "io.modelcontextprotocol/protocolVersion": version,
        "io.modelcontextprotocol/clientCapabilities": {},
    }})
}

/// The status, and the code of the error where the body holds one.
fn verdict(request: &HttpRequest, server: &HttpServer) -> (u16, Option<i64>) {
    let response = request.send(server.address());
    let message: Value = serde_json::from_str(&response.body).unwrap_or_default();
    (response.status, message["error"]["code"].as_i64())
}

#[rstest]
#[case::header_of_the_older_version(list().header("MCP-Protocol-Version", LEGACY_VERSION), (400, Some(-32020)))]
#[case::no_header(list().without("MCP-Protocol-Version"), (400, Some(-32020)))]
#[case::another_method(list().header("Mcp-Method", "tools/call"), (400, Some(-32020)))]
#[case::another_tool(
    HttpRequest::call("list_users", json!({})).header("Mcp-Name", "list_objects"), (400, Some(-32020))
)]
#[case::a_version_that_nobody_speaks(
    HttpRequest::post(body("tools/list", &version("2099-01-01")))
        .header("MCP-Protocol-Version", "2099-01-01")
        .header("Mcp-Method", "tools/list"),
    (400, Some(-32022))
)]
#[case::no_metadata(
    HttpRequest::post(body("tools/list", &json!({})))
        .header("MCP-Protocol-Version", MODERN_VERSION)
        .header("Mcp-Method", "tools/list"),
    (400, Some(-32602))
)]
#[case::no_session(
    HttpRequest::post(body("tools/list", &json!({}))).header("MCP-Protocol-Version", LEGACY_VERSION), (400, None)
)]
#[case::a_made_up_session(HttpRequest::in_session("made-up", "ping", json!({})), (404, None))]
#[case::a_session_for_a_page(HttpRequest::in_session("../../etc/passwd", "ping", json!({})), (404, None))]
#[case::a_stream_of_no_session(
    HttpRequest::new("GET", "/mcp").header("Accept", "text/event-stream"), (400, None)
)]
#[case::a_stream_of_the_newer_version(
    HttpRequest::new("GET", "/mcp")
        .header("Accept", "text/event-stream")
        .header("MCP-Protocol-Version", MODERN_VERSION),
    (405, None)
)]
#[case::a_hello_that_contradicts_itself(
    HttpRequest::initialize().header("MCP-Protocol-Version", "2024-11-05"), (400, Some(-32600))
)]
#[case::an_answer_that_nobody_waits_for(
    HttpRequest::post(r#"{"jsonrpc": "2.0", "id": 7, "result": {}}"#)
        .header("MCP-Protocol-Version", MODERN_VERSION),
    (400, Some(-32600))
)]
fn a_request_of_the_wrong_version_is_refused(
    #[case] request: HttpRequest,
    #[case] expected: (u16, Option<i64>),
) {
    let home = super::home();
    let server = HttpServer::start(home.db());
    assert_eq!(verdict(&request, &server), expected);
    super::assert_serves(&server);
}

#[test]
fn a_pipe_bears_both_versions_one_after_the_other() {
    let home = super::home();
    let mut server = home.server_of(Era::Legacy);
    let error = server.request("tools/list", version("2099-01-01")).unwrap_err();
    assert_eq!(error.code, -32022, "{}", error.message);
    assert!(server.request("tools/list", version(MODERN_VERSION)).is_ok());
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
}
