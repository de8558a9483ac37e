//! JSON Schema checks (Draft 2020-12) by a validator that is none of ours.

use serde_json::Value;

use crate::repository::repository;

/// A schema that the project publishes under `schemas/schema`.
pub fn published_schema(name: &str) -> Value {
    let path = repository().join("schemas/schema").join(name);
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{} cannot be read: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{} is no JSON: {error}", path.display()))
}

/// Fails the test unless `instance` satisfies `schema`, and `schema` itself is one.
#[track_caller]
pub fn assert_conforms(schema: &Value, instance: &Value, what: &str) {
    if let Err(error) = jsonschema::draft202012::meta::validate(schema) {
        panic!("the schema of {what} is no JSON Schema of Draft 2020-12: {error}\n{schema:#}");
    }
    let validator = jsonschema::draft202012::new(schema)
        .unwrap_or_else(|error| panic!("the schema of {what} cannot be used: {error}\n{schema:#}"));
    let problems: Vec<String> = validator
        .iter_errors(instance)
        .map(|problem| format!("{}: {problem}", problem.instance_path()))
        .collect();
    assert!(problems.is_empty(), "{what} does not satisfy its schema: {problems:#?}\n{instance:#}");
}
