//! From the JSON of a call to the arguments of a tool.
//!
//! Models send `null` or `""` for what they mean to leave out, and numbers as texts. Where the meaning is plain
//! it is taken; anything else is refused with the field, what was given and what is expected. Nothing is ever
//! replaced by a default in silence.

use rmcp::model::JsonObject;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde::de::value::MapDeserializer;
use serde_json::{Error, Number, Value};
use serde_path_to_error::{Path, Segment};

use super::fields::QUOTED_CHARACTERS;
use super::{Tool, ToolError};
use crate::near_miss;

/// Reads the arguments of a tool.
pub(super) fn parse<T: Tool>(schema: &JsonObject, arguments: &JsonObject) -> Result<T::Arguments, ToolError> {
    let stated = stated(schema, arguments);
    if let Ok(arguments) = T::Arguments::deserialize(MapDeserializer::<_, Error>::new(stated.iter().copied()))
    {
        return Ok(arguments);
    }
    let mut value = object(&stated);
    let schema = Value::Object(schema.clone());
    convert(&mut value, &schema);
    serde_path_to_error::deserialize(&value).map_err(|source| ToolError::Arguments {
        tool: T::NAME,
        problem: explain(&schema, &value, source.path(), source.inner()),
        example: T::EXAMPLE,
    })
}

/// Reads one item of a list whose items are read one by one.
pub(crate) fn item<T: DeserializeOwned>(schema: &JsonObject, item: &Value) -> Result<T, String> {
    if let Ok(item) = T::deserialize(item) {
        return Ok(item);
    }
    let mut value = match item {
        Value::Object(members) => object(&stated(schema, members)),
        other => other.clone(),
    };
    let schema = Value::Object(schema.clone());
    convert(&mut value, &schema);
    serde_path_to_error::deserialize(&value).map_err(|source| {
        let problem = explain(&schema, &value, source.path(), source.inner());
        // Something that is no object has no field to name.
        problem.strip_prefix(": ").map(str::to_owned).unwrap_or(problem)
    })
}

/// The members of an object but for the optional ones whose value says that there is none.
fn stated<'a>(schema: &JsonObject, members: &'a JsonObject) -> Vec<(&'a str, &'a Value)> {
    let properties = schema.get("properties").and_then(Value::as_object);
    let required = required(schema);
    let is_left_out = |name: &str, value: &Value| {
        let empty = value.is_null() || value.as_str() == Some("");
        empty && properties.is_some_and(|known| known.contains_key(name)) && !required.contains(&name)
    };
    let members = members.iter().map(|(name, value)| (name.as_str(), value));
    members.filter(|&(name, value)| !is_left_out(name, value)).collect()
}

fn object(members: &[(&str, &Value)]) -> Value {
    Value::Object(members.iter().map(|&(name, value)| (name.to_owned(), value.clone())).collect())
}

/// Turns texts into the numbers and truth values that the schema asks for, and numbers into texts, where they
/// stand for them exactly.
fn convert(value: &mut Value, schema: &Value) {
    match (schema["type"].as_str(), &mut *value) {
        (Some("integer"), Value::String(text)) => {
            if let Ok(number) = text.trim().parse::<i64>() {
                *value = number.into();
            }
        }
        (Some("integer"), Value::Number(number)) => {
            let whole =
                number.as_f64().filter(|number| number.fract() == 0.0 && number.abs() < 2_f64.powi(53));
            if let Some(number) = whole {
                *value = (number as i64).into();
            }
        }
        (Some("number"), Value::String(text)) => {
            if let Some(number) = text.trim().parse().ok().and_then(Number::from_f64) {
                *value = number.into();
            }
        }
        (Some("boolean"), Value::String(text)) => match text.trim().to_lowercase().as_str() {
            "true" => *value = true.into(),
            "false" => *value = false.into(),
            _ => {}
        },
        (Some("string"), Value::Number(number)) => *value = number.to_string().into(),
        (Some("array"), Value::Array(items)) => {
            for item in items {
                convert(item, &schema["items"]);
            }
        }
        (Some("object"), Value::Object(members)) => {
            for (name, member) in members {
                if let Some(schema) = schema_of_member(schema, name) {
                    convert(member, schema);
                }
            }
        }
        _ => {}
    }
}

/// What is wrong at the end of a path: an unknown field, a missing one, or a value of the wrong kind.
fn explain(schema: &Value, arguments: &Value, path: &Path, problem: &Error) -> String {
    let mut schema = schema;
    let mut value = arguments;
    let mut name = String::new();
    for segment in path {
        match segment {
            Segment::Map { key } => {
                let Some(inner) = schema_of_member(schema, key) else { break };
                name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                (schema, value) = (inner, &value[key.as_str()]);
            }
            Segment::Seq { index } => {
                name = format!("{name}[{index}]");
                (schema, value) = (&schema["items"], &value[*index]);
            }
            _ => break,
        }
    }
    if let (Some(given), false) = (value.as_object(), schema["additionalProperties"].is_object()) {
        let none = JsonObject::new();
        let known = schema["properties"].as_object().unwrap_or(&none);
        let within = if name.is_empty() { String::new() } else { format!("{name}.") };
        if let Some(unknown) = given.keys().find(|key| !known.contains_key(*key)) {
            let fields: Vec<&str> = known.keys().map(String::as_str).collect();
            let hint = near_miss::hint(unknown, fields.iter().copied());
            let fields = if fields.is_empty() { "none".to_owned() } else { fields.join(", ") };
            return format!("{within}{unknown}: there is no such field.{hint} Fields: {fields}.");
        }
        let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        if let Some(missing) = required.into_iter().find(|key| !given.contains_key(*key)) {
            let meaning = known[missing]["description"].as_str().unwrap_or_default();
            return format!("{within}{missing}: it is missing and required. {meaning}");
        }
    }
    if is_of_kind(value, schema) {
        // The kind is right, so the type itself objects, and says why.
        return format!("{name}: {problem}.");
    }
    let given = shortened(&value.to_string());
    format!("{name}: {given} is given; {} is expected.", expected(schema))
}

/// The schema of a member of an object; `None` where there may be none of this name.
fn schema_of_member<'a>(schema: &'a Value, name: &str) -> Option<&'a Value> {
    schema["properties"].get(name).or(Some(&schema["additionalProperties"]).filter(|rest| rest.is_object()))
}

fn is_of_kind(value: &Value, schema: &Value) -> bool {
    match schema["type"].as_str() {
        Some("string") => value.is_string(),
        Some("boolean") => value.is_boolean(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        // A number of the wrong size or sign is not of the kind that the range in the schema tells.
        _ => false,
    }
}

fn expected(schema: &Value) -> String {
    let kind = match schema["type"].as_str() {
        Some("string") => "a text",
        Some("boolean") => "true or false",
        Some("array") => "a list",
        Some("object") => "an object",
        Some("integer") => "a whole number",
        _ => "a number",
    };
    match (&schema["minimum"], &schema["maximum"]) {
        (Value::Number(least), Value::Number(most)) => format!("{kind} from {least} to {most}"),
        _ => kind.to_owned(),
    }
}

fn shortened(json: &str) -> String {
    match json.char_indices().nth(QUOTED_CHARACTERS) {
        Some((end, _)) => format!("{}…", &json[..end]),
        None => json.to_owned(),
    }
}

fn required(schema: &JsonObject) -> Vec<&str> {
    let names = schema.get("required").and_then(Value::as_array);
    names.into_iter().flatten().filter_map(Value::as_str).collect()
}
