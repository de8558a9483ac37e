//! What `tools/list` says, as laws over all tools.

use coin_tests::{Era, ServerProcess, assert_conforms};
use rstest::rstest;
use serde_json::{Value, json};

/// The tools of this version and whether they only look.
const TOOLS: [(&str, bool); 15] = [
    ("add_user", false),
    ("ask_owner", false),
    ("find_object", true),
    ("get_usage_summary", true),
    ("list_objects", true),
    ("list_users", true),
    ("nearby_objects", true),
    ("next_question", true),
    ("observe_objects", false),
    ("record_answer", false),
    ("record_scores", false),
    ("record_usage", false),
    ("retract_answer", false),
    ("similar_objects", true),
    ("whose_is", true),
];

fn tools() -> Vec<Value> {
    super::furnished_home().server().tools()
}

fn names(tools: &[Value]) -> Vec<String> {
    tools.iter().map(|tool| tool["name"].as_str().unwrap().to_owned()).collect()
}

/// Calls `look` on every schema within a schema.
fn walk(schema: &Value, look: &mut impl FnMut(&Value)) {
    look(schema);
    match schema {
        Value::Object(members) => members.values().for_each(|member| walk(member, look)),
        Value::Array(items) => items.iter().for_each(|item| walk(item, look)),
        _ => {}
    }
}

#[rstest]
#[case(Era::Legacy)]
#[case(Era::Modern)]
fn the_list_is_the_same_in_both_protocols_and_stands_by_name(#[case] era: Era) {
    let tools = super::furnished_home().server_of(era).tools();
    assert_eq!(names(&tools), TOOLS.map(|(name, _)| name));
}

#[test]
fn every_tool_says_all_four_hints() {
    for tool in tools() {
        let hints = &tool["annotations"];
        let (_, only_looks) = TOOLS.iter().find(|(name, _)| tool["name"] == *name).unwrap();
        assert_eq!(hints["readOnlyHint"], *only_looks, "{}", tool["name"]);
        assert_eq!(hints["destructiveHint"], false, "{}", tool["name"]);
        assert_eq!(hints["idempotentHint"], tool["name"] != "ask_owner", "{}", tool["name"]);
        assert_eq!(hints["openWorldHint"], false, "{}", tool["name"]);
    }
}

#[test]
fn every_tool_has_a_title_and_a_description() {
    for tool in tools() {
        assert!(tool["title"].as_str().unwrap().len() > 5, "{tool:#}");
        assert!(tool["description"].as_str().unwrap().len() > 40, "{tool:#}");
    }
}

#[test]
fn every_schema_is_one_and_its_root_is_a_plain_object() {
    for tool in tools() {
        for key in ["inputSchema", "outputSchema"] {
            let schema = &tool[key];
            jsonschema::draft202012::meta::validate(schema)
                .unwrap_or_else(|error| panic!("{key} of {}: {error}", tool["name"]));
            assert_eq!(schema["type"], "object", "{key} of {}", tool["name"]);
            for combinator in ["anyOf", "oneOf", "allOf"] {
                assert!(schema.get(combinator).is_none(), "{key} of {} has {combinator}", tool["name"]);
            }
        }
        assert_eq!(tool["inputSchema"]["additionalProperties"], false, "{}", tool["name"]);
    }
}

#[test]
fn no_schema_has_what_clients_stumble_over() {
    for tool in tools() {
        for key in ["inputSchema", "outputSchema"] {
            walk(&tool[key], &mut |schema| {
                if matches!(schema["type"].as_str(), Some("integer" | "number")) {
                    assert!(schema.get("format").is_none(), "{key} of {}: {schema}", tool["name"]);
                }
                assert!(!schema["type"].is_array(), "{key} of {} has several types: {schema}", tool["name"]);
                let reference = schema.get("$ref").and_then(Value::as_str).unwrap_or("#");
                assert!(reference.starts_with('#'), "{key} of {} refers abroad: {schema}", tool["name"]);
            });
        }
        // Some hosts silently drop tools whose schema is longer.
        assert!(tool["inputSchema"].to_string().len() < 16_384, "{}", tool["name"]);
    }
}

#[test]
fn every_argument_is_described() {
    for tool in tools() {
        let Some(properties) = tool["inputSchema"].get("properties").and_then(Value::as_object) else {
            assert!(["list_users", "next_question"].contains(&tool["name"].as_str().unwrap()), "{tool}");
            continue;
        };
        for (name, property) in properties {
            assert!(
                property["description"].as_str().is_some_and(|text| text.len() > 10),
                "{name} of {} has no description",
                tool["name"]
            );
        }
    }
}

#[test]
fn the_defaults_of_the_contract_are_advertised() {
    let tools = tools();
    let default = |tool: &str, argument: &str| {
        let tool = tools.iter().find(|one| one["name"] == tool).unwrap();
        tool["inputSchema"]["properties"][argument]["default"].clone()
    };
    assert_eq!(default("get_usage_summary", "window_days"), 365);
    assert_eq!(default("get_usage_summary", "max_examples"), 5);
    assert_eq!(default("nearby_objects", "k"), 5);
    assert_eq!(default("nearby_objects", "sigma"), 0.5);
    assert_eq!(default("nearby_objects", "gamma"), 1.0);
    assert_eq!(default("nearby_objects", "min_weight"), 0.01);
    assert_eq!(default("similar_objects", "k"), 5);
    assert_eq!(default("find_object", "k"), 5);
    assert_eq!(default("record_answer", "owner_outside_household"), false);
    assert_eq!(default("list_objects", "limit"), 50);
}

#[test]
fn the_schemas_are_those_that_the_project_publishes() {
    for tool in tools() {
        let name = tool["name"].as_str().unwrap().replace('_', "-");
        let published = coin_tests::published_schema(&format!("{name}.arguments.schema.json"));
        let keys = |schema: &Value| {
            schema.get("properties").and_then(Value::as_object).map(|properties| {
                let mut keys: Vec<String> = properties.keys().cloned().collect();
                keys.sort();
                keys
            })
        };
        assert_eq!(keys(&published), keys(&tool["inputSchema"]), "{name}");
        assert_eq!(published.get("required"), tool["inputSchema"].get("required"), "{name}");
    }
}

#[test]
fn results_satisfy_the_published_schemas_too() {
    let mut server = super::furnished_home().server();
    for (tool, arguments) in [
        ("get_usage_summary", json!({"object_id": "marker"})),
        ("nearby_objects", json!({"object_id": "marker"})),
        ("similar_objects", json!({"object_id": "marker"})),
        ("record_answer", super::answer("marker", "Bob")),
        ("retract_answer", json!({"object_id": "marker"})),
        ("record_usage", json!({"captions": [{"object_id": "marker", "caption": "soon"}]})),
        ("record_scores", json!({"object_id": "marker", "scores": {"Bob": 1, "Mary": 0, "Tom": 0}})),
        ("list_objects", json!({"limit": 1})),
        ("list_users", json!({})),
        ("whose_is", json!({"object_id": "marker"})),
        ("find_object", json!({"query": "my marker", "speaker": "Bob"})),
        ("next_question", json!({})),
        ("ask_owner", json!({"object_id": "marker", "owner": "Bob's"})),
        ("add_user", json!({"name": "Ann"})),
    ] {
        let result = server.ok(tool, arguments);
        let schema = coin_tests::published_schema(&format!("{}.result.schema.json", tool.replace('_', "-")));
        assert_conforms(&schema, &result, tool);
    }
}

fn selected(arguments: &[&str]) -> Vec<String> {
    let home = super::furnished_home();
    let db = home.db();
    let mut all = vec!["--db", db.to_str().unwrap()];
    all.extend(arguments);
    names(&ServerProcess::start(all, Era::Legacy).tools())
}

#[test]
fn fewer_tools_can_be_offered() {
    assert_eq!(
        selected(&["--tools", "core"]),
        ["get_usage_summary", "nearby_objects", "record_answer", "similar_objects"]
    );
    assert_eq!(selected(&["--tools", "list_users,list_objects"]), ["list_objects", "list_users"]);
}

#[test]
fn a_read_only_server_offers_only_tools_that_look() {
    let looking: Vec<&str> =
        TOOLS.iter().filter(|(_, only_looks)| *only_looks).map(|(name, _)| *name).collect();
    assert_eq!(selected(&["--read-only"]), looking);
}

#[test]
fn a_tool_that_is_not_offered_cannot_be_called() {
    let home = super::furnished_home();
    let db = home.db();
    let mut server = ServerProcess::start(["--db", db.to_str().unwrap(), "--read-only"], Era::Legacy);
    let error = server
        .request("tools/call", json!({"name": "record_answer", "arguments": super::answer("marker", "Bob")}))
        .unwrap_err();
    assert_eq!(error.code, -32602);
    assert_eq!(server.ok("list_objects", json!({"settled": true}))["total"], 0);
}
