//! Bad arguments: a tool result with `isError` that names the field, what was given, what is allowed and near
//! misses. Never a protocol error, never a panic, never a default in place of what was meant.

use coin_tests::ServerProcess;
use rstest::rstest;
use serde_json::{Map, Value, json};

/// Arguments that every tool accepts in the furnished home.
fn good_arguments(tool: &str) -> Value {
    match tool {
        "find_object" => json!({"query": "a mug"}),
        "list_objects" | "list_users" => json!({}),
        "record_answer" => super::answer("marker", "Bob"),
        "record_scores" => json!({"object_id": "marker", "scores": {"Bob": 0.9, "Mary": 0.1, "Tom": 0.0}}),
        "record_usage" => json!({"captions": []}),
        _ => json!({"object_id": "marker"}),
    }
}

fn changed(tool: &str, changes: Value) -> Value {
    let mut arguments = good_arguments(tool);
    let Value::Object(changes) = changes else { panic!("changes are an object") };
    arguments.as_object_mut().unwrap().extend(changes);
    arguments
}

const WITH_AN_OBJECT: [&str; 6] = [
    "get_usage_summary",
    "nearby_objects",
    "similar_objects",
    "record_answer",
    "record_scores",
    "retract_answer",
];

#[test]
fn an_unknown_object_is_answered_with_near_misses() {
    let mut server = super::furnished_home().server();
    for tool in WITH_AN_OBJECT {
        server.refused(
            tool,
            changed(tool, json!({"object_id": "markr"})),
            &["object_id", "\"markr\"", "\"marker\""],
        );
        server.refused(
            tool,
            changed(tool, json!({"object_id": "Mug"})),
            &["object_id", "mug-blue", "mug-red"],
        );
        server.refused(
            tool,
            changed(tool, json!({"object_id": "§§§"})),
            &["object_id", "§§§", "list_objects"],
        );
    }
}

#[test]
fn sql_in_an_id_is_an_unknown_id() {
    let mut server = super::furnished_home().server();
    for id in ["marker'; DROP TABLE objects; --", "' OR '1'='1", "marker\" OR \"\"=\"", "%", "marker\0"] {
        for tool in WITH_AN_OBJECT {
            server.refused(tool, changed(tool, json!({"object_id": id})), &["object_id"]);
        }
    }
    assert_eq!(server.ok("list_objects", json!({}))["total"], 4);
}

#[rstest]
#[case("get_usage_summary", json!({"window_days": 0}), &["window_days", "0", "1", "36500"])]
#[case("get_usage_summary", json!({"window_days": 36_501}), &["window_days", "36501", "36500"])]
#[case("get_usage_summary", json!({"window_days": -1}), &["window_days", "-1"])]
#[case("get_usage_summary", json!({"window_days": 1.5}), &["window_days", "1.5"])]
#[case("get_usage_summary", json!({"window_days": 1e300}), &["window_days", "1e+300", "36500"])]
#[case("get_usage_summary", json!({"window_days": u64::MAX}), &["window_days", "18446744073709551615"])]
#[case("get_usage_summary", json!({"window_days": "a year"}), &["window_days", "a year"])]
#[case("get_usage_summary", json!({"window_days": [365]}), &["window_days"])]
#[case("get_usage_summary", json!({"window_days": true}), &["window_days", "true"])]
#[case("get_usage_summary", json!({"max_examples": 51}), &["max_examples", "51", "50"])]
#[case("get_usage_summary", json!({"max_examples": -1}), &["max_examples", "-1"])]
#[case("get_usage_summary", json!({"as_of": "yesterday"}), &["as_of", "yesterday", "2025-01-19T19:00:00"])]
#[case("get_usage_summary", json!({"as_of": "2025-02-30T00:00:00"}), &["as_of", "2025-02-30T00:00:00"])]
#[case("get_usage_summary", json!({"as_of": "2025-01-19T19:00:00Z"}), &["as_of", "Z", "time zone"])]
#[case("get_usage_summary", json!({"as_of": "2025-01-19T25:00:00"}), &["as_of", "25:00"])]
#[case("get_usage_summary", json!({"as_of": {}}), &["as_of"])]
#[case("get_usage_summary", json!({"object_id": ["marker"]}), &["object_id"])]
#[case("get_usage_summary", json!({"object_id": null}), &["object_id"])]
#[case("get_usage_summary", json!({"object": "marker"}), &["object", "object_id"])]
#[case("get_usage_summary", json!({"windowdays": 7}), &["windowdays", "window_days"])]
#[case("find_object", json!({"speaker": "Bobby"}), &["speaker", "Bobby", "\"Bob\"", "Mary"])]
#[case("find_object", json!({"query": "x".repeat(2001)}), &["query", "2001", "2000"])]
#[case("find_object", json!({"query": null}), &["query"])]
#[case("find_object", json!({"k": 0}), &["k", "0", "100"])]
#[case("find_object", json!({"query_embedding": [0.1, 0.2, 0.3]}), &["query_embedding", "3 numbers", "512"])]
#[case("find_object", json!({"query_embedding": vec![0.0; 512]}), &["query_embedding", "all numbers are 0", "512"])]
#[case("find_object", json!({"query_embedding": vec![1e200; 512]}), &["query_embedding", "too large"])]
#[case("find_object", json!({"query_embedding": vec!["NaN"; 512]}), &["query_embedding"])]
#[case("nearby_objects", json!({"k": 0}), &["k", "0", "1", "100"])]
#[case("nearby_objects", json!({"k": 101}), &["k", "101", "100"])]
#[case("nearby_objects", json!({"k": 1_000_000_000_000_u64}), &["k", "1000000000000"])]
#[case("nearby_objects", json!({"k": -5}), &["k", "-5"])]
#[case("nearby_objects", json!({"sigma": 0}), &["sigma", "0", "0.001", "1000"])]
#[case("nearby_objects", json!({"sigma": -0.5}), &["sigma", "-0.5"])]
#[case("nearby_objects", json!({"sigma": 1e9}), &["sigma", "1000000000", "1000"])]
#[case("nearby_objects", json!({"sigma": "NaN"}), &["sigma", "NaN"])]
#[case("nearby_objects", json!({"gamma": -1}), &["gamma", "-1", "1000"])]
#[case("nearby_objects", json!({"min_weight": 1.5}), &["min_weight", "1.5", "1"])]
#[case("nearby_objects", json!({"min_weight": -0.1}), &["min_weight", "-0.1"])]
#[case("similar_objects", json!({"k": 0}), &["k", "0", "100"])]
#[case("similar_objects", json!({"k": 101}), &["k", "101", "100"])]
#[case("record_answer", json!({"ownership": {"Bobb": true}}), &["ownership", "Bobb", "\"Bob\"", "Mary"])]
#[case("record_answer", json!({"ownership": {"Bob": "perhaps"}}), &["ownership", "Bob", "perhaps"])]
#[case("record_answer", json!({"ownership": "Bob"}), &["ownership", "Bob"])]
#[case("record_answer", json!({"answered_by": "Nobody"}), &["answered_by", "Nobody", "Bob, Mary, Tom"])]
#[case("record_answer", json!({"as_of": "noon"}), &["as_of", "noon"])]
#[case("record_answer", json!({"answer": "x".repeat(2_001)}), &["answer", "2001", "2000"])]
#[case("record_answer", json!({"question": "x".repeat(2_001)}), &["question", "2001", "2000"])]
#[case("record_answer", json!({"owner": "Bob"}), &["owner", "ownership"])]
#[case("record_scores", json!({"scores": {"Bob": 1.2, "Mary": 0, "Tom": 0}}), &["scores", "Bob", "1.2", "0", "1"])]
#[case("record_scores", json!({"scores": {"Bob": -0.1, "Mary": 0, "Tom": 0}}), &["scores", "Bob", "-0.1"])]
#[case("record_scores", json!({"scores": {"Bob": 1, "Mary": 0}}), &["scores", "Tom"])]
#[case("record_scores", json!({"scores": {"Bob": 1, "Mary": 0, "Tom": 0, "Tim": 0}}), &["scores", "Tim", "Tom"])]
#[case("record_scores", json!({"scores": {"Bob": "high", "Mary": 0, "Tom": 0}}), &["scores", "Bob", "high"])]
#[case("record_scores", json!({"scores": {"Bob": null, "Mary": 0, "Tom": 0}}), &["scores", "Bob"])]
#[case("record_scores", json!({"scores": {}}), &["scores"])]
#[case("record_scores", json!({"owner_sets": []}), &["owner_sets"])]
#[case("record_scores", json!({"owner_sets": [{"owners": ["Bob"], "probability": 0.5}]}), &["owner_sets", "0.5"])]
#[case("record_scores", json!({"owner_sets": [{"owners": ["Bob"], "probability": 2}]}), &["owner_sets", "2"])]
#[case("record_scores", json!({"owner_sets": [{"owners": ["Zoe"], "probability": 1}]}), &["owner_sets", "Zoe"])]
#[case("record_scores", json!({"owner_sets": [{"owners": [], "probability": 1}]}), &["owner_sets"])]
#[case("record_scores", json!({"model": "m".repeat(201)}), &["model", "201", "200"])]
#[case("record_usage", json!({"captions": "2025-01-19 19:00 Bob takes the Marker"}), &["captions"])]
#[case("record_usage", json!({"captions": ["2025-01-19 19:00 Bob takes the Marker"]}), &["captions"])]
#[case("record_usage", json!({"captions": [{"object_id": "marker"}]}), &["captions", "caption"])]
#[case("record_usage", json!({"captions": [{"id": "marker", "caption": "x"}]}), &["captions", "id", "object_id"])]
#[case("list_objects", json!({"limit": 0}), &["limit", "0", "500"])]
#[case("list_objects", json!({"limit": 501}), &["limit", "501", "500"])]
#[case("list_objects", json!({"limit": -1}), &["limit", "-1"])]
#[case("list_objects", json!({"owner": "Bobby"}), &["owner", "Bobby", "\"Bob\"", "Mary"])]
#[case("list_objects", json!({"settled": "sometimes"}), &["settled", "sometimes"])]
#[case("list_objects", json!({"cursor": "page 2"}), &["cursor", "page 2", "next_cursor"])]
#[case("list_objects", json!({"cursor": "after-6"}), &["cursor", "after-6"])]
#[case("list_objects", json!({"cursor": "after-ff"}), &["cursor", "after-ff"])]
#[case("list_objects", json!({"clas": "mug"}), &["clas", "class"])]
#[case("list_users", json!({"name": "Bob"}), &["name"])]
fn a_bad_value_is_refused_by_name(#[case] tool: &str, #[case] changes: Value, #[case] parts: &[&str]) {
    let mut server = super::furnished_home().server();
    let before = server.ok("list_objects", json!({}));
    server.refused(tool, changed(tool, changes), parts);
    assert_eq!(server.ok("list_objects", json!({})), before, "a refused call changes nothing");
}

#[test]
fn a_missing_value_is_refused_by_name() {
    let mut server = super::furnished_home().server();
    for tool in WITH_AN_OBJECT.into_iter().chain(["record_usage"]) {
        let required = server.tool(tool)["inputSchema"]["required"].as_array().unwrap().clone();
        for name in required {
            let name = name.as_str().unwrap();
            let mut arguments = good_arguments(tool);
            arguments.as_object_mut().unwrap().remove(name);
            server.refused(tool, arguments, &[name]);
        }
    }
}

/// Models send numbers as texts and `null` or `""` for what they leave out. Where the meaning is plain it is taken.
#[rstest]
#[case("nearby_objects", json!({"k": "1"}), json!({"k": 1}))]
#[case("nearby_objects", json!({"k": 1.0}), json!({"k": 1}))]
#[case("nearby_objects", json!({"sigma": "1.0"}), json!({"sigma": 1.0}))]
#[case("get_usage_summary", json!({"as_of": "", "window_days": null}), json!({}))]
#[case("list_objects", json!({"class": null, "settled": "false", "cursor": ""}), json!({"settled": false}))]
fn what_models_get_slightly_wrong_is_understood(
    #[case] tool: &str,
    #[case] given: Value,
    #[case] meant: Value,
) {
    let mut server = super::furnished_home().server();
    let understood = server.ok(tool, changed(tool, given));
    assert_eq!(understood, server.ok(tool, changed(tool, meant)));
}

/// Values that stand for every way in which a value can be odd.
fn odd_values() -> Vec<Value> {
    let mut nested = json!(null);
    for _ in 0..100 {
        nested = json!([nested]);
    }
    vec![
        json!(null),
        json!(true),
        json!(0),
        json!(-1),
        json!(-0.0),
        json!(0.1),
        json!(i64::MIN),
        json!(u64::MAX),
        json!(1e308),
        json!(5e-324),
        json!(""),
        json!(" "),
        json!("\0"),
        json!("\u{202e}\u{feff}\u{10ffff}👩‍👩‍👧"),
        json!("0x10"),
        json!("1e5"),
        json!("-9223372036854775809"),
        json!("%s%n{}{0}$(reboot)`reboot`"),
        json!("../../etc/passwd"),
        json!("9999-12-31T23:59:59.999999999"),
        json!("-009999-01-01T00:00:00"),
        json!("x".repeat(1_000_000)),
        json!([]),
        json!([null]),
        json!(vec!["Bob"; 1_000]),
        json!({}),
        json!({"": null}),
        json!({"Bob": {"Bob": {"Bob": true}}}),
        json!([{"object_id": null, "caption": 7}]),
        json!([{"owners": ["Bob", "Bob"], "probability": -1}]),
        json!([{"object_id": "marker", "caption": "9999-12-31 23:59:59 Bob takes the Marker"}]),
        json!([{"object_id": "marker", "caption": "-9999-01-01 00:00 Bob takes the Marker"}]),
        nested,
    ]
}

/// Calls a tool with an odd value in one place. The server must answer as a tool does, whatever it thinks of it.
fn try_odd(server: &mut ServerProcess, tool: &str, arguments: Value) {
    let answer = server.call(tool, arguments);
    if answer.is_error {
        assert!(answer.text.len() < 10_000, "a refusal repeats {} bytes", answer.text.len());
        assert!(!answer.text.contains("fault in the server"), "{tool} panicked: {}", server.stderr());
    }
}

#[test]
fn no_value_of_any_argument_makes_the_server_panic() {
    let mut server = super::furnished_home().server();
    for tool in server.tools() {
        let name = tool["name"].as_str().unwrap().to_owned();
        let none = Map::new();
        let properties = tool["inputSchema"].get("properties").and_then(Value::as_object).unwrap_or(&none);
        for argument in properties.keys() {
            for odd in odd_values() {
                let mut arguments = good_arguments(&name);
                arguments[argument] = odd;
                try_odd(&mut server, &name, arguments);
            }
        }
        for odd in odd_values() {
            let mut arguments = good_arguments(&name);
            arguments["surprise"] = odd;
            try_odd(&mut server, &name, arguments);
        }
    }
    assert!(!server.stderr().contains("panicked"), "{}", server.stderr());
    assert_eq!(server.ok("list_users", json!({}))["users"].as_array().unwrap().len(), 3);
}
