//! Resources, prompts and completion.

use rstest::rstest;

use super::*;

async fn read(client: &mut Client, uri: &str) -> Value {
    let answer = client.request("resources/read", json!({"uri": uri})).await;
    let content = &answer["result"]["contents"][0];
    assert_eq!(content["uri"], uri, "{answer}");
    assert_eq!(content["mimeType"], "application/json");
    serde_json::from_str(content["text"].as_str().unwrap()).unwrap()
}

#[tokio::test]
async fn every_resource_that_is_listed_can_be_read() {
    let mut client = Client::initialized().await;
    let listed = client.request("resources/list", json!({})).await["result"].take();
    let uris: Vec<&str> = listed["resources"]
        .as_array()
        .unwrap()
        .iter()
        .map(|resource| resource["uri"].as_str().unwrap())
        .collect();
    assert_eq!(uris.len(), 7);
    assert_eq!(uris[..3], ["coin://household", "coin://objects", "coin://objects/1"]);
    for uri in uris {
        read(&mut client, uri).await;
    }
    assert_eq!(read(&mut client, "coin://household").await["users"][0]["name"], "Bob");
    assert_eq!(read(&mut client, "coin://objects").await["total"], 5);
    assert_eq!(read(&mut client, "coin://objects/1").await["owners"], json!(["Bob"]));
}

#[tokio::test]
async fn a_history_tells_what_was_seen_and_said() {
    let mut client = Client::initialized().await;
    let said = json!({"object_id": "1", "question": "Whose?", "answer": "Mine.", "ownership": {"Tom": true}, "answered_by": "Tom"});
    client.call("record_answer", said).await;
    client.call("retract_answer", json!({"object_id": "1"})).await;
    insta::assert_json_snapshot!(read(&mut client, "coin://objects/1/history").await);
}

#[tokio::test]
async fn a_long_list_comes_in_pages() {
    let mut episode = test_home::episode();
    let thing = episode.episode.objects[0].clone();
    episode.features = None;
    for number in 0..240 {
        let mut thing = thing.clone();
        thing.id = coin_schemas::household::ObjectId::new(format!("thing/{number:03}")).unwrap();
        episode.episode.objects.push(thing);
    }
    let store = Store::open_in_memory().unwrap();
    store.import(&episode).unwrap();
    let mut client = Client::start_on(store);
    client.initialize(json!({})).await;
    let (mut cursor, mut uris, mut pages) = (Value::Null, Vec::new(), 0);
    loop {
        let params = if cursor.is_null() { json!({}) } else { json!({"cursor": cursor}) };
        let page = client.request("resources/list", params).await["result"].take();
        uris.extend(
            page["resources"].as_array().unwrap().iter().map(|one| one["uri"].as_str().unwrap().to_owned()),
        );
        pages += 1;
        cursor = page["nextCursor"].clone();
        if cursor.is_null() {
            break;
        }
    }
    assert_eq!((uris.len(), pages), (247, 3));
    let mut once = uris.clone();
    once.sort();
    once.dedup();
    assert_eq!(once.len(), uris.len());
    assert!(uris.contains(&"coin://objects/thing%2F007".to_owned()));
    read(&mut client, "coin://objects/thing%2F007").await;
}

#[rstest]
#[case("coin://objects/99")]
#[case("coin://objects/..%2F..%2Fetc%2Fpasswd")]
#[case("coin://objects/../../etc/passwd")]
#[case("coin://objects/%00")]
#[case("coin://objects/1/captions")]
#[case("coin://")]
#[case("file:///etc/passwd")]
#[tokio::test]
async fn what_is_not_there_is_said_to_be_missing(#[case] uri: &str) {
    let mut client = Client::initialized().await;
    let error = client.request("resources/read", json!({"uri": uri})).await["error"].take();
    assert_eq!(error["code"], -32002, "{error}");
    let modern = json!({"uri": uri, "_meta": {
        "io.modelcontextprotocol/protocolVersion": "2026-07-28",
        "io.modelcontextprotocol/clientCapabilities": {},
    }});
    let error = Client::start().request("resources/read", modern).await["error"].take();
    assert_eq!(error["code"], -32602, "{error}");
}

#[rstest]
#[case("tools/list")]
#[case("resources/list")]
#[case("resources/templates/list")]
#[case("prompts/list")]
#[tokio::test]
async fn a_cursor_that_nobody_gave_is_refused(#[case] method: &str) {
    let mut client = Client::initialized().await;
    for cursor in ["2", "after-zz", "after-f", "\u{0}"] {
        let answer = client.request(method, json!({"cursor": cursor})).await;
        assert_eq!(answer["error"]["code"], -32602, "{method} {cursor:?}: {answer}");
    }
}

#[tokio::test]
async fn lists_and_documents_say_how_long_they_keep_and_for_whom() {
    let mut client = Client::start();
    let meta = json!({
        "io.modelcontextprotocol/protocolVersion": "2026-07-28",
        "io.modelcontextprotocol/clientCapabilities": {},
    });
    for (method, params) in [
        ("tools/list", json!({})),
        ("prompts/list", json!({})),
        ("resources/list", json!({})),
        ("resources/templates/list", json!({})),
        ("resources/read", json!({"uri": "coin://household"})),
        ("server/discover", json!({})),
    ] {
        let mut params = params;
        params["_meta"] = meta.clone();
        let result = client.request(method, params).await["result"].take();
        assert!(result["ttlMs"].is_u64(), "{method}: {result}");
        assert_eq!(result["cacheScope"], "private", "{method}: {result}");
    }
}

#[tokio::test]
async fn prompts_name_their_arguments() {
    let mut client = Client::initialized().await;
    let listed = client.request("prompts/list", json!({})).await["result"].take();
    insta::assert_json_snapshot!(listed);
}

/// Every word of what a client is told that looks like the name of a tool.
fn tools_named(text: &str) -> Vec<String> {
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    let all = Registry::new(&ToolSelection::all(), Access::ReadWrite);
    words.filter(|word| all.get(word).is_some()).map(str::to_owned).collect()
}

#[rstest]
#[case("all", Access::ReadWrite)]
#[case("all", Access::ReadOnly)]
#[case("core", Access::ReadWrite)]
#[case("list_users", Access::ReadWrite)]
#[tokio::test]
async fn no_client_is_told_to_call_what_is_not_offered(#[case] selection: &str, #[case] access: Access) {
    let selection: ToolSelection = selection.parse().unwrap();
    let offered: Vec<String> = Registry::new(&selection, access)
        .definitions()
        .into_iter()
        .map(|tool| tool.name.into_owned())
        .collect();
    let mut client = Client::start_with(test_home::store(), Registry::new(&selection, access));
    let hello = json!({"protocolVersion": "2025-11-25", "capabilities": {}, "clientInfo": {"name": "test", "version": "0"}});
    let said = client.request("initialize", hello).await["result"]["instructions"].take();
    client.send(json!({"jsonrpc": "2.0", "method": "notifications/initialized"})).await;
    let mut texts = vec![said.as_str().unwrap().to_owned()];
    assert!(texts[0].starts_with("COIN knows"), "{}", texts[0]);
    let prompts = client.request("prompts/list", json!({})).await["result"]["prompts"].take();
    for prompt in prompts.as_array().unwrap() {
        let arguments = json!({"object_id": "1", "question": "Whose?", "answer": "Bob's."});
        let got =
            client.request("prompts/get", json!({"name": prompt["name"], "arguments": arguments})).await;
        texts.push(got["result"]["messages"][0]["content"]["text"].as_str().unwrap().to_owned());
    }
    for tool in texts.iter().flat_map(|text| tools_named(text)) {
        assert!(offered.contains(&tool), "{tool} is not offered: {texts:?}");
    }
    if offered.len() == 13 {
        assert_eq!(texts.len(), 5, "all prompts are listed where all tools are offered");
    }
}

#[rstest]
#[case("infer_ownership", json!({"object_id": "1"}))]
#[case("ask_question", json!({"object_id": "1"}))]
#[case("read_answer", json!({"question": "Whose is the marker?", "answer": "Mine and Bob's.", "answered_by": "Tom"}))]
#[case("settle_household", json!({}))]
#[tokio::test]
async fn a_prompt_carries_what_it_needs(#[case] name: &str, #[case] arguments: Value) {
    let mut client = Client::initialized().await;
    let result =
        client.request("prompts/get", json!({"name": name, "arguments": arguments})).await["result"].take();
    let message = &result["messages"][0];
    assert_eq!(message["role"], "user");
    insta::assert_snapshot!(format!("prompt_{name}"), message["content"]["text"].as_str().unwrap());
}

#[rstest]
#[case(json!({"name": "infer_owner"}), "Did you mean \"infer_ownership\"?")]
#[case(json!({"name": "infer_ownership"}), "arguments.object_id: it is missing")]
#[case(json!({"name": "infer_ownership", "arguments": {"object_id": "99"}}), "there is no object \"99\"")]
#[case(json!({"name": "infer_ownership", "arguments": {"object_id": 3}}), "a text is expected")]
#[case(json!({"name": "read_answer", "arguments": {"question": "?", "answer": "x", "answered_by": "Zoe"}}), "\"Zoe\" is no member")]
#[tokio::test]
async fn a_wrong_prompt_is_refused(#[case] params: Value, #[case] problem: &str) {
    let mut client = Client::initialized().await;
    let error = client.request("prompts/get", params).await["error"].take();
    assert_eq!(error["code"], -32602);
    assert!(error["message"].as_str().unwrap().contains(problem), "{error}");
}

#[rstest]
#[case(json!({"type": "ref/prompt", "name": "infer_ownership"}), "object_id", "mar", json!(["1", "2"]))]
#[case(json!({"type": "ref/prompt", "name": "ask_question"}), "object_id", "c", json!(["cup-a"]))]
#[case(json!({"type": "ref/prompt", "name": "ask_question"}), "object_id", "CUP", json!(["cup-a"]))]
#[case(json!({"type": "ref/resource", "uri": "coin://objects/{object_id}"}), "object_id", "", json!(["1", "2", "cup-a", "key", "sofa"]))]
#[case(json!({"type": "ref/prompt", "name": "read_answer"}), "answered_by", "m", json!(["Mary"]))]
#[case(json!({"type": "ref/prompt", "name": "read_answer"}), "answer", "m", json!([]))]
#[tokio::test]
async fn what_is_typed_is_completed(
    #[case] reference: Value,
    #[case] argument: &str,
    #[case] typed: &str,
    #[case] expected: Value,
) {
    let mut client = Client::initialized().await;
    let params = json!({"ref": reference, "argument": {"name": argument, "value": typed}});
    let result = client.request("completion/complete", params).await["result"].take();
    assert_eq!(result["completion"]["values"], expected);
    assert_eq!(result["completion"]["hasMore"], false);
}

#[tokio::test]
async fn completion_of_what_is_not_there_is_refused() {
    let mut client = Client::initialized().await;
    for reference in
        [json!({"type": "ref/prompt", "name": "x"}), json!({"type": "ref/resource", "uri": "coin://x"})]
    {
        let params = json!({"ref": reference, "argument": {"name": "object_id", "value": ""}});
        assert_eq!(client.request("completion/complete", params).await["error"]["code"], -32602);
    }
}
