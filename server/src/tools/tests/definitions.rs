//! The definitions as they stand, and laws that hold for all of them.

use rmcp::model::Tool;
use rstest::rstest;
use serde_json::Value;

use super::*;

fn definitions() -> Vec<Tool> {
    registry().definitions()
}

/// Calls `check` with every schema and schema within it, and its path.
fn walk(path: &str, schema: &Value, check: &mut impl FnMut(&str, &Value)) {
    check(path, schema);
    for (name, property) in schema["properties"].as_object().into_iter().flatten() {
        walk(&format!("{path}.{name}"), property, check);
    }
    for key in ["items", "additionalProperties"] {
        if schema[key].is_object() {
            walk(&format!("{path}.{key}"), &schema[key], check);
        }
    }
}

fn walk_all(mut check: impl FnMut(&str, &Value)) {
    for tool in definitions() {
        let input = Value::Object((*tool.input_schema).clone());
        walk(&format!("{} input", tool.name), &input, &mut check);
        let output = Value::Object((*tool.output_schema.unwrap()).clone());
        walk(&format!("{} output", tool.name), &output, &mut check);
    }
}

fn sorted(value: Value) -> Value {
    match value {
        Value::Object(members) => {
            let mut members: Vec<_> = members.into_iter().map(|(key, value)| (key, sorted(value))).collect();
            members.sort_by(|left, right| left.0.cmp(&right.0));
            Value::Object(members.into_iter().collect())
        }
        Value::Array(items) => items.into_iter().map(sorted).collect(),
        other => other,
    }
}

#[rstest]
#[case("add_user")]
#[case("ask_owner")]
#[case("find_object")]
#[case("get_usage_summary")]
#[case("list_objects")]
#[case("list_users")]
#[case("nearby_objects")]
#[case("next_question")]
#[case("observe_objects")]
#[case("record_answer")]
#[case("record_scores")]
#[case("record_usage")]
#[case("retract_answer")]
#[case("similar_objects")]
#[case("whose_is")]
fn the_definition_is_as_committed(#[case] name: &str) {
    let definition = registry().definition(name).unwrap();
    let definition = sorted(serde_json::to_value(definition).unwrap());
    insta::assert_json_snapshot!(format!("tool_{name}"), definition);
}

#[test]
fn there_is_a_snapshot_of_every_tool() {
    let names: Vec<String> = definitions().into_iter().map(|tool| tool.name.into_owned()).collect();
    assert_eq!(
        names,
        [
            "add_user",
            "ask_owner",
            "find_object",
            "get_usage_summary",
            "list_objects",
            "list_users",
            "nearby_objects",
            "next_question",
            "observe_objects",
            "record_answer",
            "record_scores",
            "record_usage",
            "retract_answer",
            "similar_objects",
            "whose_is"
        ]
    );
}

#[test]
fn names_are_short_and_plain() {
    for tool in definitions() {
        let plain = tool.name.chars().all(|letter| matches!(letter, 'a'..='z' | '0'..='9' | '_'));
        assert!(plain && (1..=40).contains(&tool.name.len()), "{}", tool.name);
    }
}

/// Whether a tool changes what is known of the home.
fn records(tool: &str) -> bool {
    tool.starts_with("record_")
        || ["add_user", "ask_owner", "observe_objects", "retract_answer"].contains(&tool)
}

#[test]
fn every_tool_has_a_title_a_description_and_all_hints() {
    for tool in definitions() {
        assert!(tool.title.is_some_and(|title| !title.is_empty()), "{}", tool.name);
        assert!(tool.description.is_some_and(|text| (80..=900).contains(&text.len())), "{}", tool.name);
        let hints = tool.annotations.unwrap();
        let records = records(&tool.name);
        assert_eq!(hints.read_only_hint, Some(!records), "{}", tool.name);
        assert_eq!(hints.destructive_hint, Some(false), "{}", tool.name);
        assert_eq!(hints.idempotent_hint, Some(tool.name != "ask_owner"), "{}", tool.name);
        assert_eq!(hints.open_world_hint, Some(false), "{}", tool.name);
    }
}

#[test]
fn descriptions_are_one_flowing_text() {
    for tool in definitions() {
        let text = tool.description.unwrap();
        assert!(!text.contains("  ") && !text.contains('\n'), "{}: {text:?}", tool.name);
    }
}

#[test]
fn roots_are_objects_without_combinators() {
    for tool in definitions() {
        for schema in [&tool.input_schema, tool.output_schema.as_ref().unwrap()] {
            assert_eq!(schema["type"], "object", "{}", tool.name);
            for combinator in ["anyOf", "oneOf", "allOf", "not", "if", "$ref", "$defs", "enum"] {
                assert!(!schema.contains_key(combinator), "{}: {combinator}", tool.name);
            }
        }
    }
}

#[test]
fn inputs_take_no_other_fields() {
    for tool in definitions() {
        assert_eq!(tool.input_schema["additionalProperties"], false, "{}", tool.name);
    }
}

#[test]
fn numbers_have_no_format_and_types_are_single() {
    walk_all(|path, schema| {
        assert!(schema.get("format").is_none() || schema["type"] == "string", "{path}");
        assert!(!schema["type"].is_array(), "{path}: {}", schema["type"]);
        assert!(schema.get("$ref").is_none(), "{path}");
        assert_ne!(schema.get("default"), Some(&Value::Null), "{path}");
    });
}

#[test]
fn every_argument_is_described_and_no_result() {
    walk_all(|path, schema| {
        if path.contains(" output") {
            assert!(schema.get("description").is_none(), "{path}");
            return;
        }
        for (name, property) in schema["properties"].as_object().into_iter().flatten() {
            let text = property["description"].as_str().unwrap_or_default();
            assert!(text.len() >= 7 && !text.contains('\n'), "{path}.{name}: {text:?}");
        }
    });
}

#[test]
fn examples_are_accepted_by_their_tools() {
    let store = crate::test_home::store();
    for tool in definitions() {
        let example = refused_example(&tool.name);
        let message = call(&store, &tool.name, example).err().map(|error| error.to_string());
        // The examples name an object that this home does not have; nothing else may be wrong with them.
        assert!(
            message.as_ref().is_none_or(|message| message.starts_with("object_id: there is no object \"3\"")),
            "{}: {message:?}",
            tool.name
        );
    }
}

/// The example as the tool's own message gives it.
fn refused_example(tool: &str) -> Value {
    let store = crate::test_home::store();
    let message = refused(&store, tool, serde_json::json!({"no such field": 1}));
    let (_, example) = message.split_once(&format!("Example: {tool} ")).unwrap();
    serde_json::from_str(example).unwrap()
}

#[test]
fn the_whole_list_is_small() {
    let list = serde_json::to_string(&definitions()).unwrap();
    assert!(list.len() < 26_000, "{} bytes", list.len());
}

#[test]
fn a_server_that_may_not_write_offers_no_tool_that_records() {
    let registry = Registry::new(&ToolSelection::all(), Access::ReadOnly);
    assert!(!registry.definitions().iter().any(|tool| records(&tool.name)));
    assert_eq!(registry.definitions().len(), 8);
}

#[test]
fn tools_can_be_selected() {
    let names = |selection: &str| -> Vec<String> {
        Registry::new(&selection.parse().unwrap(), Access::ReadWrite)
            .definitions()
            .into_iter()
            .map(|tool| tool.name.into_owned())
            .collect()
    };
    assert_eq!(names("list_users, list_objects"), ["list_objects", "list_users"]);
    assert_eq!(names("core"), ["get_usage_summary", "nearby_objects", "record_answer", "similar_objects"]);
    assert_eq!(names("all").len(), 15);
    insta::assert_snapshot!("list_user".parse::<ToolSelection>().unwrap_err(), @r#"there is no tool "list_user". Did you mean "list_users" or "list_objects"? The tools are add_user, ask_owner, find_object, get_usage_summary, list_objects, list_users, nearby_objects, next_question, observe_objects, record_answer, record_scores, record_usage, retract_answer, similar_objects, whose_is."#);
}
