//! A person is asked through the client, in both protocols.

use super::*;

/// What a client of 2026 says of itself with every request.
fn meta(capabilities: &Value) -> Value {
    json!({
        "io.modelcontextprotocol/protocolVersion": "2026-07-28",
        "io.modelcontextprotocol/clientCapabilities": capabilities,
        "io.modelcontextprotocol/clientInfo": {"name": "test", "version": "0"},
    })
}

fn call(arguments: &Value) -> Value {
    json!({"name": "ask_owner", "arguments": arguments, "_meta": meta(&json!({"elicitation": {"form": {}}}))})
}

/// The same call with what a person made of the form.
fn again(first: &Value, form: &Value, response: &Value) -> Value {
    let mut call = first.clone();
    call["requestState"] = form["requestState"].clone();
    call["inputResponses"] = json!({"whose_is_this": response});
    call
}

fn accepted(owner: &str) -> Value {
    json!({"action": "accept", "content": {"owner": owner}})
}

async fn form(client: &mut Client, first: &Value) -> Value {
    let form = client.request("tools/call", first.clone()).await["result"].take();
    assert_eq!(form["resultType"], "input_required", "{form}");
    form
}

#[tokio::test]
async fn a_client_of_2026_shows_the_form_between_two_calls() {
    let mut client = Client::start();
    let first = call(&json!({"object_id": "sofa"}));
    let mut form = form(&mut client, &first).await;
    let second = again(&first, &form, &accepted("Bob and Mary"));
    assert!(form["requestState"].take().as_str().unwrap().len() > 40);
    form["_meta"].take();
    insta::assert_json_snapshot!(form);
    let result = client.request("tools/call", second).await["result"].take();
    assert_eq!(result["resultType"], "complete");
    assert_eq!(result["structuredContent"]["owners"], json!(["Bob", "Mary"]));
    assert_eq!(result["structuredContent"]["status"], "answered");
}

#[tokio::test]
async fn declining_and_putting_away_are_results_and_remembered() {
    let mut client = Client::start();
    for (object, action, status) in [("sofa", "decline", "declined"), ("key", "cancel", "cancelled")] {
        let first = call(&json!({"object_id": object}));
        let form = form(&mut client, &first).await;
        let second = again(&first, &form, &json!({"action": action}));
        let result = client.request("tools/call", second).await["result"].take();
        assert_eq!(
            (&result["isError"], &result["structuredContent"]["status"]),
            (&json!(false), &json!(status))
        );
    }
    let declined = client.request("tools/call", call(&json!({"object_id": "sofa"}))).await["result"].take();
    assert_eq!(declined["structuredContent"]["status"], "declined", "it is not asked again");
}

#[tokio::test]
async fn a_form_that_was_altered_or_belongs_elsewhere_or_has_counted_is_refused() {
    let mut client = Client::start();
    let first = call(&json!({"object_id": "sofa"}));
    let form = form(&mut client, &first).await;
    let sealed = form["requestState"].as_str().unwrap().to_owned();
    let middle = sealed.len() / 2;
    let other = if sealed.as_bytes()[middle] == b'A' { "B" } else { "A" };
    let altered = format!("{}{other}{}", &sealed[..middle], &sealed[middle + 1..]);
    let elsewhere = again(&call(&json!({"object_id": "key"})), &form, &accepted("Bob"));
    let mut wrong = vec![elsewhere];
    for state in [altered.as_str(), "", "rs1.x", "\u{0}", &"A".repeat(100_000)] {
        wrong.push(again(&first, &json!({"requestState": state}), &accepted("Bob")));
    }
    for request in wrong {
        let answer = client.request("tools/call", request).await;
        assert_eq!(answer["error"]["code"], -32602, "{answer}");
    }
    let second = again(&first, &form, &accepted("Bob"));
    let result = client.request("tools/call", second.clone()).await;
    assert_eq!(result["result"]["structuredContent"]["status"], "answered");
    let repeated = client.request("tools/call", second).await;
    assert_eq!(repeated["error"]["code"], -32602, "{repeated}");
    assert!(repeated["error"]["message"].as_str().unwrap().contains("counts once"), "{repeated}");
}

#[tokio::test]
async fn a_state_where_no_form_was_ever_made_is_refused_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    let store = Store::open(&path, Access::ReadWrite).unwrap();
    store.import(&test_home::episode()).unwrap();
    let mut client = Client::start_on(store);
    let request =
        again(&call(&json!({"object_id": "sofa"})), &json!({"requestState": "rs1.x.y"}), &accepted("Bob"));
    let answer = client.request("tools/call", request).await;
    assert_eq!(answer["error"]["code"], -32602, "{answer}");
    let looking = Store::open(&path, Access::ReadOnly).unwrap();
    let key = looking.read(|reader| Ok::<_, crate::store::StoreError>(reader.form_key()?.is_some())).unwrap();
    assert!(!key, "looking at a state makes no key");
    let mut unasked = json!({"name": "list_users", "requestState": "rs1.x.y", "_meta": meta(&json!({}))});
    unasked["arguments"] = json!({});
    let result = client.request("tools/call", unasked).await["result"].take();
    assert_eq!(result["isError"], false, "a tool that asks nobody does not mind: {result}");
}

#[tokio::test]
async fn an_older_client_that_gives_up_ends_its_form() {
    let mut client = Client::with_capabilities(json!({"elicitation": {}})).await;
    let params = json!({"name": "ask_owner", "arguments": {"object_id": "sofa"}});
    client.send(json!({"jsonrpc": "2.0", "id": 50, "method": "tools/call", "params": params})).await;
    let asked = client.next_message().await;
    assert_eq!(asked["method"], "elicitation/create");
    client
        .send(json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 50}}))
        .await;
    let told = client.call("whose_is", json!({"object_id": "sofa"})).await;
    assert_eq!(told["result"]["structuredContent"]["source"], "inferred");
    client.send(json!({"jsonrpc": "2.0", "id": asked["id"], "result": accepted("Bob")})).await;
    let told = client.call("whose_is", json!({"object_id": "sofa"})).await;
    assert_eq!(told["result"]["structuredContent"]["source"], "inferred", "nobody waits for the answer");
}

#[tokio::test]
async fn a_form_that_comes_back_empty_is_shown_again() {
    let mut client = Client::start();
    let first = call(&json!({"object_id": "sofa"}));
    let form = form(&mut client, &first).await;
    for response in [json!({"action": "accept"}), json!("Bob"), json!({"action": "perhaps"})] {
        let result = client.request("tools/call", again(&first, &form, &response)).await["result"].take();
        assert_eq!(result["resultType"], "input_required");
    }
    let mut unasked = first.clone();
    unasked["inputResponses"] = json!({"whose_is_this": accepted("Bob")});
    let result = client.request("tools/call", unasked).await["result"].take();
    assert_eq!(result["resultType"], "input_required", "an answer to no form counts for nothing");
}

#[tokio::test]
async fn another_server_of_the_home_takes_the_form_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    Store::open(&path, Access::ReadWrite).unwrap().import(&test_home::episode()).unwrap();
    let mut one = Client::start_on(Store::open(&path, Access::ReadWrite).unwrap());
    let mut other = Client::start_on(Store::open(&path, Access::ReadWrite).unwrap());
    let first = call(&json!({"object_id": "sofa"}));
    let form = form(&mut one, &first).await;
    let result = other.request("tools/call", again(&first, &form, &accepted("Bob"))).await["result"].take();
    assert_eq!(result["structuredContent"]["status"], "answered");
    let repeated = one.request("tools/call", again(&first, &form, &accepted("Mary"))).await;
    assert_eq!(repeated["error"]["code"], -32602, "what counted there does not count here");
}

#[tokio::test]
async fn an_older_client_shows_the_form_during_the_call() {
    for capability in [json!({}), json!({"form": {}})] {
        let mut client = Client::with_capabilities(json!({"elicitation": capability})).await;
        client.replies.push_back(accepted("Mary"));
        let result = client.call("ask_owner", json!({"object_id": "sofa"})).await["result"].take();
        assert_eq!(result["structuredContent"]["owners"], json!(["Mary"]), "{result}");
        let asked = &client.asked[0];
        assert_eq!(asked["method"], "elicitation/create");
        assert_eq!(asked["params"]["requestedSchema"]["required"], json!(["owner"]));
        for (action, status) in [("decline", "declined"), ("cancel", "cancelled")] {
            client.replies.push_back(json!({"action": action}));
            let object = if action == "decline" { "key" } else { "cup-a" };
            let result = client.call("ask_owner", json!({"object_id": object})).await["result"].take();
            assert_eq!(result["structuredContent"]["status"], status);
        }
    }
}

#[tokio::test]
async fn a_client_that_shows_no_forms_is_told_what_to_do_instead() {
    let mut older = Client::initialized().await;
    let mut links_only = Client::with_capabilities(json!({"elicitation": {"url": {}}})).await;
    let told = older.call("ask_owner", json!({"object_id": "sofa"})).await["result"].take();
    assert_eq!(told, links_only.call("ask_owner", json!({"object_id": "sofa"})).await["result"].take());
    assert_eq!(told["isError"], true);
    assert!(told["content"][0]["text"].as_str().unwrap().contains("Ask in the chat"), "{told}");
    let mut newer = Client::start();
    let mut without = call(&json!({"object_id": "sofa"}));
    without["_meta"] = meta(&json!({}));
    let result = newer.request("tools/call", without.clone()).await["result"].take();
    assert_eq!(result["content"], told["content"]);
    without["arguments"]["owner"] = json!("Tom's");
    let result = newer.request("tools/call", without).await["result"].take();
    assert_eq!(result["structuredContent"]["owners"], json!(["Tom"]));
}
