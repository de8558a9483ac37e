//! JSON with one line for each item, so that a person can read a conversation and see what changed between two.

use serde_json::Value;

/// How deep objects are broken into lines: the slots of a task, and the items of a slot.
const BROKEN_LEVELS: usize = 2;

/// Writes JSON with every slot on a line and every item of a slot or a list on a line of its own.
pub(crate) fn json_in_lines(value: &Value) -> String {
    let mut text = String::new();
    write(&mut text, value, 0);
    text
}

fn write(text: &mut String, value: &Value, depth: usize) {
    match value {
        Value::Object(fields) => {
            text.push('{');
            for (place, (name, field)) in fields.iter().enumerate() {
                if place > 0 {
                    text.push(',');
                }
                if depth < BROKEN_LEVELS && place + depth > 0 {
                    text.push('\n');
                }
                text.push_str(&Value::from(name.as_str()).to_string());
                text.push(':');
                write(text, field, depth + 1);
            }
            text.push('}');
        }
        Value::Array(items) if items.iter().any(Value::is_object) => {
            text.push('[');
            for (place, item) in items.iter().enumerate() {
                text.push_str(if place > 0 { ",\n" } else { "\n" });
                text.push_str(&item.to_string());
            }
            text.push(']');
        }
        _ => text.push_str(&value.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    #[test]
    fn every_item_of_a_slot_has_its_line() {
        let task = json!({
            "task": "infer",
            "household": {"Bob": {"role": "father"}, "Mary": {}},
            "object": {"id": "3", "position": [1.0, 2.0, 3.0]},
            "context": {"nearby_objects": [{"id": "1", "name": "mug"}, {"id": "2", "name": "pen"}], "none": []},
        });
        insta::assert_snapshot!(json_in_lines(&task), @r#"
        {"task":"infer",
        "household":{
        "Bob":{"role":"father"},
        "Mary":{}},
        "object":{
        "id":"3",
        "position":[1.0,2.0,3.0]},
        "context":{
        "nearby_objects":[
        {"id":"1","name":"mug"},
        {"id":"2","name":"pen"}],
        "none":[]}}
        "#);
    }

    fn any_json() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            Just(Value::Null),
            any::<bool>().prop_map(Value::from),
            any::<i64>().prop_map(Value::from),
            ".{0,12}".prop_map(Value::from),
        ];
        leaf.prop_recursive(5, 40, 5, |inner| {
            prop_oneof![
                proptest::collection::vec(inner.clone(), 0..5).prop_map(Value::from),
                proptest::collection::btree_map(".{0,6}", inner, 0..5)
                    .prop_map(|fields| Value::Object(fields.into_iter().collect())),
            ]
        })
    }

    proptest! {
        #[test]
        fn the_same_json_is_read_back(value in any_json()) {
            prop_assert_eq!(serde_json::from_str::<Value>(&json_in_lines(&value)).unwrap(), value);
        }
    }
}
