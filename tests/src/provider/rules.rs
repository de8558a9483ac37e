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
    let mut found = Vec::new();
    if headers.get("content-type").map(String::as_str) != Some("application/json") {
        found.push("content-type must be application/json".to_owned());
    }
    found.extend(schema(provider).iter_errors(body).map(|problem| {
        format!("{}: {}", problem.instance_path(), problem.to_string().chars().take(400).collect::<String>())
    }));
    match provider {
        Provider::OpenAi => openai::check(headers, body, &mut found),
        Provider::Anthropic => anthropic::check(headers, body, &mut found),
    }
    found
}

fn schema(provider: Provider) -> &'static Validator {
    static OPENAI: OnceLock<Validator> = OnceLock::new();
    static ANTHROPIC: OnceLock<Validator> = OnceLock::new();
    let (validator, name) = match provider {
        Provider::OpenAi => (&OPENAI, "openai.json"),
        Provider::Anthropic => (&ANTHROPIC, "anthropic.json"),
    };
    validator.get_or_init(|| {
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
