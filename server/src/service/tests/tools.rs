//! Calls of tools, and the list of them.

use super::*;

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
    for (method, params) in [
        ("resources/read", json!({})),
        ("prompts/get", json!({"name": 1})),
        ("completion/complete", json!({})),
    ] {
        let answer = client.request(method, params).await;
        assert_eq!(answer["error"]["code"], -32602, "{method}: {answer}");
        assert!(answer["error"]["message"].as_str().unwrap().starts_with(method), "{answer}");
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
    assert_eq!(names.len(), 17, "{names:?}");
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
