//! The service as a client meets it: lines of JSON over a pipe.

use coin_schemas::tools::{ListUsers, ListUsersResult};
use rmcp::ServiceExt;
use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncWriteExt, BufReader, DuplexStream, Lines, ReadHalf, WriteHalf};

use super::*;
use crate::store::Access;
use crate::test_home;
use crate::tools::{Effect, Tool as HomeTool, ToolError};

/// A tool that only panics.
struct Panics;

impl HomeTool for Panics {
    const NAME: &'static str = "panics";
    const TITLE: &'static str = "Panics";
    const DESCRIPTION: &'static str = "Panics";
    const EXAMPLE: &'static str = "{}";
    const EFFECT: Effect = Effect::Records;
    type Arguments = ListUsers;
    type Output = ListUsersResult;

    fn call(store: &Store, _: ListUsers) -> Result<ListUsersResult, ToolError> {
        store.write(|_| panic!("a fault in a tool"))
    }
}

struct Client {
    output: WriteHalf<DuplexStream>,
    input: Lines<BufReader<ReadHalf<DuplexStream>>>,
    next_id: u64,
}

impl Client {
    /// Starts a service on one end of a pipe and holds the other.
    fn start() -> Self {
        let tools = Registry::new(&ToolSelection::all(), Access::ReadWrite).with::<Panics>();
        let service = CoinService::new(Arc::new(test_home::store()), tools);
        let (ours, theirs) = tokio::io::duplex(1 << 20);
        tokio::spawn(
            async move { service.serve(theirs).await?.waiting().await.map_err(anyhow::Error::from) },
        );
        let (input, output) = tokio::io::split(ours);
        Self { output, input: BufReader::new(input).lines(), next_id: 1 }
    }

    /// Starts a service and shakes hands with it as clients up to 2025 do.
    async fn initialized() -> Self {
        let mut client = Self::start();
        let answer = client
            .request(
                "initialize",
                json!({"protocolVersion": "2025-11-25", "capabilities": {}, "clientInfo": {"name": "test", "version": "0"}}),
            )
            .await;
        assert_eq!(answer["result"]["protocolVersion"], "2025-11-25");
        client.send(json!({"jsonrpc": "2.0", "method": "notifications/initialized"})).await;
        client
    }

    async fn send(&mut self, message: Value) {
        self.output.write_all(format!("{message}\n").as_bytes()).await.unwrap();
    }

    async fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.next_id;
        self.next_id += 1;
        self.send(json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params})).await;
        let line = self.input.next_line().await.unwrap().expect("the service closed the pipe");
        let answer: Value = serde_json::from_str(&line).unwrap();
        assert_eq!(answer["id"], id);
        answer
    }

    async fn call(&mut self, tool: &str, arguments: Value) -> Value {
        self.request("tools/call", json!({"name": tool, "arguments": arguments})).await
    }
}

#[tokio::test]
async fn a_result_is_the_same_json_as_structure_and_as_text() {
    let mut client = Client::initialized().await;
    let result = client.call("list_users", json!({})).await["result"].take();
    assert_eq!(result["isError"], false);
    let text: Value = serde_json::from_str(result["content"][0]["text"].as_str().unwrap()).unwrap();
    assert_eq!(text, result["structuredContent"]);
    assert_eq!(text["users"][0]["name"], "Bob");
}

#[tokio::test]
async fn arguments_may_be_left_out_where_none_are_needed() {
    let mut client = Client::initialized().await;
    let answer = client.request("tools/call", json!({"name": "list_users"})).await;
    assert_eq!(answer["result"]["isError"], false);
}

#[tokio::test]
async fn a_wrong_argument_is_a_result_that_the_model_sees() {
    let mut client = Client::initialized().await;
    let result = client.call("nearby_objects", json!({"object_id": "1", "k": 1000})).await["result"].take();
    assert_eq!(result["isError"], true);
    assert_eq!(result.get("structuredContent"), None);
    assert_eq!(result["content"][0]["text"], "k: 1000 is out of range; from 1 to 100 is allowed");
}

#[tokio::test]
async fn an_unknown_tool_is_a_protocol_error_with_a_near_miss() {
    let mut client = Client::initialized().await;
    let error = client.call("get_usage_sumary", json!({})).await["error"].take();
    assert_eq!(error["code"], -32602);
    assert!(error["message"].as_str().unwrap().contains("Did you mean \"get_usage_summary\"?"), "{error}");
}

#[tokio::test]
async fn a_tool_that_panics_is_answered_and_the_next_call_works() {
    let mut client = Client::initialized().await;
    let result = client.call("panics", json!({})).await["result"].take();
    assert_eq!(result["isError"], true);
    let after = client.call("list_users", json!({})).await;
    assert_eq!(after["result"]["isError"], false);
}

#[tokio::test]
async fn parameters_that_do_not_fit_are_invalid_and_not_unknown() {
    let mut client = Client::initialized().await;
    for params in
        [json!({"name": "list_users", "arguments": ["x"]}), json!({"arguments": {}}), json!({"name": 1})]
    {
        let answer = client.request("tools/call", params).await;
        assert_eq!(answer["error"]["code"], -32602, "{answer}");
    }
    let answer = client.request("tools/forget", json!({})).await;
    assert_eq!(answer["error"]["code"], -32601, "{answer}");
}

#[tokio::test]
async fn the_list_of_tools_has_one_page() {
    let mut client = Client::initialized().await;
    let list = client.request("tools/list", json!({})).await["result"].take();
    let names: Vec<&str> =
        list["tools"].as_array().unwrap().iter().map(|tool| tool["name"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 10, "{names:?}");
    assert!(names.is_sorted(), "{names:?}");
    assert_eq!(list.get("nextCursor"), None);
    let answer = client.request("tools/list", json!({"cursor": "2"})).await;
    assert_eq!(answer["error"]["code"], -32602);
}

#[tokio::test]
async fn clients_of_2026_are_served_without_a_handshake() {
    let mut client = Client::start();
    let meta = json!({
        "io.modelcontextprotocol/protocolVersion": "2026-07-28",
        "io.modelcontextprotocol/clientCapabilities": {},
        "io.modelcontextprotocol/clientInfo": {"name": "test", "version": "0"},
    });
    let list = client.request("tools/list", json!({"_meta": meta})).await["result"].take();
    assert_eq!(list["cacheScope"], "private");
    assert!(list["ttlMs"].as_u64().unwrap() > 0);
    assert_eq!(list["_meta"][SERVER_INFO_KEY]["name"], "coin-server");
    let call = json!({"name": "list_users", "arguments": {}, "_meta": meta});
    let result = client.request("tools/call", call).await["result"].take();
    assert_eq!(result["resultType"], "complete");
    assert_eq!(result["_meta"][SERVER_INFO_KEY]["name"], "coin-server");
}

#[tokio::test]
async fn many_calls_at_once_are_all_answered() {
    let mut client = Client::initialized().await;
    for id in 100..200 {
        let params = json!({"name": "get_usage_summary", "arguments": {"object_id": "1"}});
        client.send(json!({"jsonrpc": "2.0", "id": id, "method": "tools/call", "params": params})).await;
    }
    let mut ids = Vec::new();
    for _ in 100..200 {
        let line = client.input.next_line().await.unwrap().unwrap();
        let answer: Value = serde_json::from_str(&line).unwrap();
        assert_eq!(answer["result"]["isError"], false);
        ids.push(answer["id"].as_u64().unwrap());
    }
    ids.sort_unstable();
    assert_eq!(ids, (100..200).collect::<Vec<_>>());
}
