//! The protocol below the tools: both versions of it, malformed messages, and the end.

use std::time::Duration;

use coin_tests::{Era, Home, LEGACY_VERSION, MODERN_VERSION, Program, ServerProcess};
use rstest::rstest;
use serde_json::{Value, json};

fn unspoken(home: &Home) -> ServerProcess {
    ServerProcess::start_silent(["--db".as_ref(), home.db().as_os_str()], Era::Legacy)
}

#[test]
fn the_older_protocol_says_hello_first() {
    let home = super::furnished_home();
    let mut server = unspoken(&home);
    let result = server
        .request(
            "initialize",
            json!({
                "protocolVersion": LEGACY_VERSION,
                "capabilities": {},
                "clientInfo": {"name": "coin-tests", "version": "0"},
            }),
        )
        .unwrap();
    assert_eq!(result["protocolVersion"], LEGACY_VERSION);
    assert_eq!(result["serverInfo"]["name"], "coin-server");
    assert!(result["capabilities"]["tools"].is_object());
    assert!(result["instructions"].as_str().unwrap().contains("get_usage_summary"));
    server.notify("notifications/initialized");
    assert_eq!(server.request("ping", json!({})).unwrap(), json!({}));
}

#[test]
fn the_newer_protocol_can_be_discovered() {
    let home = super::furnished_home();
    let mut server = home.server_of(Era::Modern);
    let result = server.request("server/discover", json!({})).unwrap();
    let versions: Vec<&str> =
        result["supportedVersions"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert!(versions.contains(&MODERN_VERSION), "{result:#}");
    assert!(result["capabilities"]["tools"].is_object(), "{result:#}");
}

#[test]
fn the_newer_protocol_says_who_answers_and_how_long_lists_hold() {
    let home = super::furnished_home();
    let mut server = home.server_of(Era::Modern);
    let list = server.request("tools/list", json!({})).unwrap();
    assert!(list["ttlMs"].as_u64().is_some_and(|milliseconds| milliseconds > 0), "{:#}", list["ttlMs"]);
    assert_eq!(list["cacheScope"], "private");
    let result = server.request("tools/call", json!({"name": "list_users", "arguments": {}})).unwrap();
    assert_eq!(result["_meta"]["io.modelcontextprotocol/serverInfo"]["name"], "coin-server");
}

#[test]
fn a_version_that_nobody_speaks_is_refused() {
    let home = super::furnished_home();
    let mut server = unspoken(&home);
    let meta = json!({
        "io.modelcontextprotocol/protocolVersion": "2099-01-01",
        "io.modelcontextprotocol/clientCapabilities": {},
    });
    let id = server.send("tools/list", json!({"_meta": meta}));
    assert_eq!(server.wait(id).unwrap_err().code, -32022);
}

/// One call of every tool, in an order in which the later ones see the earlier ones.
fn one_of_each() -> Vec<(&'static str, Value)> {
    vec![
        ("list_users", json!({})),
        (
            "record_usage",
            json!({"captions": [
                {"object_id": "marker", "caption": "2025-01-19 19:00 Bob takes the Marker"},
                {"object_id": "nothing", "caption": "2025-01-19 19:00 Bob takes the Marker"},
            ]}),
        ),
        ("get_usage_summary", json!({"object_id": "marker"})),
        ("record_scores", json!({"object_id": "mug-red", "scores": {"Bob": 0.97, "Mary": 0.0, "Tom": 0.02}})),
        ("record_answer", super::answer("mug-blue", "Mary")),
        ("nearby_objects", json!({"object_id": "marker"})),
        ("similar_objects", json!({"object_id": "marker"})),
        ("find_object", json!({"query": "Mary's mug"})),
        ("find_object", json!({"query": "a mug", "speaker": "Zoe"})),
        ("retract_answer", json!({"object_id": "mug-blue"})),
        ("retract_answer", json!({"object_id": "mug-blue"})),
        ("list_objects", json!({"limit": 2})),
        ("get_usage_summary", json!({"object_id": "markr"})),
    ]
}

#[test]
fn both_protocols_give_the_same_answers() {
    let answers = |era| {
        let home = super::furnished_home();
        let mut server = home.server_of(era);
        one_of_each().into_iter().map(|(tool, arguments)| server.call(tool, arguments)).collect::<Vec<_>>()
    };
    assert_eq!(answers(Era::Legacy), answers(Era::Modern));
}

#[rstest]
#[case(json!({"name": "get_usage_sumary", "arguments": {"object_id": "marker"}}), "get_usage_summary")]
#[case(json!({"name": "", "arguments": {}}), "get_usage_summary")]
#[case(json!({"name": "list_users", "arguments": []}), "arguments")]
#[case(json!({"name": "list_users", "arguments": "{}"}), "arguments")]
#[case(json!({"name": "list_users", "arguments": 7}), "arguments")]
#[case(json!({"name": 7}), "name")]
#[case(json!({"arguments": {}}), "name")]
#[case(json!({}), "name")]
fn a_malformed_call_is_a_protocol_error_that_helps(
    #[case] parameters: Value,
    #[case] part: &str,
    #[values(Era::Legacy, Era::Modern)] era: Era,
) {
    let home = super::furnished_home();
    let mut server = home.server_of(era);
    let error = server.request("tools/call", parameters).unwrap_err();
    assert_eq!(error.code, -32602, "{}", error.message);
    assert!(error.message.contains(part), "{}", error.message);
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
}

#[rstest]
#[case(Era::Legacy)]
#[case(Era::Modern)]
fn a_cursor_that_was_never_given_is_refused(#[case] era: Era) {
    let mut server = super::furnished_home().server_of(era);
    assert_eq!(server.request("tools/list", json!({"cursor": "page-2"})).unwrap_err().code, -32602);
}

#[rstest]
#[case(Era::Legacy)]
#[case(Era::Modern)]
fn a_method_that_is_not_there_is_not_found(#[case] era: Era) {
    let mut server = super::furnished_home().server_of(era);
    assert_eq!(server.request("tools/delete", json!({})).unwrap_err().code, -32601);
}

#[test]
fn arguments_may_be_left_out_where_none_are_needed() {
    let mut server = super::furnished_home().server();
    let result = server.request("tools/call", json!({"name": "list_users"})).unwrap();
    assert_eq!(result["structuredContent"]["users"].as_array().unwrap().len(), 3);
}

#[rstest]
#[case::no_json("this is no JSON")]
#[case::cut_off("{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"tools/call\"")]
#[case::empty("")]
#[case::a_number("42")]
#[case::null("null")]
#[case::a_batch("[{\"jsonrpc\": \"2.0\", \"id\": 900, \"method\": \"ping\"}]")]
#[case::another_version("{\"jsonrpc\": \"1.0\", \"id\": 901, \"method\": \"ping\"}")]
#[case::no_method("{\"jsonrpc\": \"2.0\", \"id\": 902}")]
#[case::an_answer_to_nothing("{\"jsonrpc\": \"2.0\", \"id\": 903, \"result\": {}}")]
#[case::a_nul("{\"jsonrpc\": \"2.0\", \"id\": \"\0\", \"method\": \"ping\"}")]
#[case::deep(&"[".repeat(100_000))]
#[case::an_unknown_notification("{\"jsonrpc\": \"2.0\", \"method\": \"notifications/nonsense\"}")]
fn a_malformed_line_does_not_end_the_server(#[case] line: &str) {
    let mut server = super::furnished_home().server();
    server.send_line(line);
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
    assert!(!server.stderr().contains("panicked"), "{}", server.stderr());
}

#[test]
fn lines_that_are_no_text_do_not_end_the_server() {
    let home = super::furnished_home();
    let request = json!({
        "jsonrpc": "2.0",
        "id": 1,
        "method": "initialize",
        "params": {
            "protocolVersion": LEGACY_VERSION,
            "capabilities": {},
            "clientInfo": {"name": "coin-tests", "version": "0"},
        },
    });
    let mut input = request.to_string().into_bytes();
    input.extend(b"\n{\"jsonrpc\":\"2.0\",\"method\":\"notifications/initialized\"}\n");
    input.extend(b"\xff\xfe\x00 no text \xc3\x28\n");
    input.extend(b"{\"jsonrpc\":\"2.0\",\"id\":2,\"method\":\"ping\"}\n");
    let finished = Program::new("coin-server").arg("--db").arg(home.db()).input(input).run().expect_code(0);
    let answers: Vec<Value> =
        finished.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(answers.iter().any(|answer| answer["id"] == 2 && answer["result"] == json!({})), "{answers:?}");
}

#[test]
fn many_calls_may_be_under_way_at_once() {
    let home = super::furnished_home();
    let mut server = home.server();
    let sent: Vec<(u64, u64)> = (0..200)
        .map(|number| {
            let caption = format!("2025-01-19 {:02}:{:02} Bob takes the Marker", number / 60, number % 60);
            let captions = json!({"captions": [{"object_id": "marker", "caption": caption}]});
            let write = server.send("tools/call", json!({"name": "record_usage", "arguments": captions}));
            let look = json!({"name": "get_usage_summary", "arguments": {"object_id": "marker"}});
            (write, server.send("tools/call", look))
        })
        .collect();
    for (write, look) in sent {
        assert_eq!(server.wait(write).unwrap()["structuredContent"]["recorded"], 1);
        assert!(server.wait(look).unwrap()["structuredContent"]["object"].is_object());
    }
    let seen = server.ok("get_usage_summary", json!({"object_id": "marker"}));
    assert_eq!(seen["user_summary"][0]["total_events"], 200);
}

#[rstest]
#[case(Era::Legacy)]
#[case(Era::Modern)]
fn the_server_ends_well_when_its_input_ends(#[case] era: Era) {
    let mut server = super::furnished_home().server_of(era);
    server.ok("list_users", json!({}));
    let (status, stderr) = server.finish();
    assert_eq!(status.code(), Some(0), "{stderr}");
    assert_eq!(stderr, "");
}

#[test]
fn a_client_that_says_nothing_is_no_failure() {
    let home = super::furnished_home();
    let finished = Program::new("coin-server").arg("--db").arg(home.db()).run().expect_code(0);
    assert_eq!(finished.stdout, "");
    assert_eq!(finished.stderr, "");
}

#[test]
fn what_was_asked_before_the_input_ended_is_still_answered() {
    let home = super::furnished_home();
    let mut server = home.server();
    let call = json!({"name": "record_answer", "arguments": super::answer("marker", "Bob")});
    server.send("tools/call", call);
    let (status, stderr) = server.finish();
    assert_eq!(status.code(), Some(0), "{stderr}");
    let listed = home.server().ok("list_objects", json!({"settled": true}));
    assert_eq!(listed["total"], 1);
}

#[test]
fn nothing_is_said_that_was_not_asked_for() {
    let home = super::furnished_home();
    let mut server = home.server();
    server.ok("list_users", json!({}));
    assert!(server.next_message(Duration::from_millis(200)).is_none());
}
