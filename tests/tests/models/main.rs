//! `host` with language models, from the command line to the report, against a scripted provider that holds every
//! request against the schema that the real provider publishes.

mod economy;
mod faults;
mod interrupted;
mod secrets;
mod tapes;
mod terminal;

use std::path::Path;

use coin_tests::provider::{KEY, Script, ScriptedProvider};
use coin_tests::{EpisodeBuilder, Program};
use serde_json::Value;

/// `host --episode FOLDER --model openai:scripted` with this provider, and more arguments.
fn host(provider: &ScriptedProvider, episode: &Path, arguments: &[&str]) -> Program {
    provider.host().arg("--episode").arg(episode).args(["--model", "openai:scripted"]).args(arguments)
}

/// The report of a run that must go well.
#[track_caller]
fn report(provider: &ScriptedProvider, episode: &Path, arguments: &[&str]) -> Value {
    host(provider, episode, arguments).args(["--json", "--quiet"]).run().expect_code(0).json()
}

/// A provider that makes no mistakes and knows the key.
fn faultless() -> ScriptedProvider {
    ScriptedProvider::start(Script { key: Some(KEY.to_owned()), ..Script::default() })
}

/// Bob's marker, Mary's mug and everybody's kettle, seen so seldom that a model is asked about each.
fn seldom_seen() -> EpisodeBuilder {
    let mut episode = EpisodeBuilder::new()
        .object("1", "marker", [0.0, 0.0, 0.8])
        .object("2", "mug", [4.0, 0.0, 0.8])
        .object("3", "kettle", [8.0, 0.0, 0.8]);
    for (id, class, who) in [
        ("1", "Marker", ["Bob", "Bob", "Bob", "Mary"]),
        ("2", "Mug", ["Mary", "Mary", "Tom", "Mary"]),
        ("3", "Kettle", ["Bob", "Mary", "Tom", "Mary"]),
    ] {
        for (day, user) in who.iter().enumerate() {
            let line = format!("2025-01-{} 08:00 {user} is using the {class}", 15 + day);
            episode = episode.caption(id, &line);
        }
    }
    episode.truth = Some(serde_json::json!({
        "owners": {"1": ["Bob"], "2": ["Mary"], "3": ["Bob", "Mary", "Tom"]},
    }));
    episode
}

fn subset_accuracy(report: &Value) -> f64 {
    report["metrics"]["overall"]["subset_accuracy"].as_f64().unwrap()
}

fn count(report: &Value, what: &str) -> u64 {
    report["cost"][what].as_u64().unwrap()
}

fn tokens(report: &Value) -> u64 {
    count(report, "prompt_tokens") + count(report, "completion_tokens")
}

fn questions(report: &Value) -> &Vec<Value> {
    report["questions"].as_array().unwrap()
}

/// The things that were asked about, in order.
fn asked(report: &Value) -> Vec<&str> {
    questions(report).iter().map(|question| question["object_id"].as_str().unwrap()).collect()
}

/// The report without what may differ between equal runs.
fn without_cost(mut report: Value) -> Value {
    report["cost"] = Value::Null;
    report
}
