//! What the providers publish about requests: their schemas, and the rules that stand beside them in words.

mod anthropic;
mod openai;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use coin_host::model::provider::Provider;
use jsonschema::Validator;
use serde_json::Value;

use crate::repository::repository;

/// Everything that is wrong with a request.
pub(super) fn violations(
    provider: Provider,
    headers: &BTreeMap<String, String>,
    body: &Value,
) -> Vec<String> {
    static OPENAI: OnceLock<Validator> = OnceLock::new();
    static ANTHROPIC: OnceLock<Validator> = OnceLock::new();
    let mut found = general_violations(headers);
    match provider {
        Provider::OpenAi => {
            found.extend(schema_violations(&OPENAI, "openai.json", body));
            openai::check(headers, body, &mut found);
        }
        Provider::Anthropic => {
            found.extend(schema_violations(&ANTHROPIC, "anthropic.json", body));
            anthropic::check(headers, body, &mut found);
        }
    }
    found
}

/// Everything that is wrong with a request for an embedding, in OpenAI's form.
pub(super) fn embedding_violations(headers: &BTreeMap<String, String>, body: &Value) -> Vec<String> {
    static EMBEDDINGS: OnceLock<Validator> = OnceLock::new();
    let mut found = general_violations(headers);
    found.extend(schema_violations(&EMBEDDINGS, "openai-embeddings.json", body));
    openai::check_key(headers, &mut found);
    if body["input"].as_str().is_some_and(str::is_empty) {
        found.push("input must not be empty".to_owned());
    }
    found
}

fn general_violations(headers: &BTreeMap<String, String>) -> Vec<String> {
    let is_json = headers.get("content-type").map(String::as_str) == Some("application/json");
    if is_json { Vec::new() } else { vec!["content-type must be application/json".to_owned()] }
}

fn schema_violations(schema: &'static OnceLock<Validator>, name: &str, body: &Value) -> Vec<String> {
    let shown = |problem: jsonschema::ValidationError<'_>| {
        format!("{}: {}", problem.instance_path(), problem.to_string().chars().take(400).collect::<String>())
    };
    validator(schema, name).iter_errors(body).map(shown).collect()
}

fn validator(schema: &'static OnceLock<Validator>, name: &str) -> &'static Validator {
    schema.get_or_init(|| {
        let path = repository().join("tests/schemas").join(name);
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{} cannot be read: {error}", path.display()));
        let schema: Value = serde_json::from_str(&text).expect("the published schema is JSON");
        jsonschema::draft202012::new(&schema).expect("the published schema is a schema")
    })
}

/// Whether a text is a name as both providers want it.
fn is_name(text: &str, longest: usize) -> bool {
    let allowed = |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
    (1..=longest).contains(&text.len()) && text.chars().all(allowed)
}

/// Follows which tool calls are still to be answered.
#[derive(Debug, Default)]
struct Calls {
    seen: BTreeSet<String>,
    open: BTreeSet<String>,
}

impl Calls {
    fn call(&mut self, id: &str, name: &str, found: &mut Vec<String>) {
        if !self.seen.insert(id.to_owned()) {
            found.push(format!("the tool call id {id:?} comes twice"));
        }
        if !is_name(id, 64) {
            found.push(format!("{id:?} is no tool call id"));
        }
        if !is_name(name, 64) {
            found.push(format!("{name:?} is no name of a tool"));
        }
        self.open.insert(id.to_owned());
    }

    fn result(&mut self, id: &str, found: &mut Vec<String>) {
        if !self.open.remove(id) {
            found.push(format!("a result answers {id:?}, which was not called just before"));
        }
    }

    /// Other words than results follow, which may only be when all calls are answered.
    fn others_follow(&mut self, found: &mut Vec<String>) {
        if !self.open.is_empty() {
            found.push(format!("the tool calls {:?} are not answered", self.open));
            self.open.clear();
        }
    }
}
