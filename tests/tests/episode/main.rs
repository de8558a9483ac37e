//! `host` from the command line to the report: what the README promises, and what is refused.

mod alone;
mod asking_in_words;
mod experiment;
mod gates;
mod making;
mod pages;
mod people;
mod promises;
mod refused_episodes;
mod refused_use;
mod reports;
mod servers;
mod together;

use std::path::Path;

use coin_tests::Program;
use serde_json::Value;

/// `host --episode FOLDER`, with more arguments.
fn host(episode: &Path, arguments: &[&str]) -> Program {
    Program::new("host").arg("--episode").arg(episode).args(arguments)
}

/// The report of a run that must go well.
#[track_caller]
fn report(episode: &Path, arguments: &[&str]) -> Value {
    host(episode, arguments).args(["--json", "--quiet"]).run().expect_code(0).json()
}

/// The report without the one field that differs between equal runs.
fn without_seconds(mut report: Value) -> Value {
    report["cost"]["seconds"] = Value::Null;
    report
}

/// The same for a report's text.
fn lines_without_seconds(report: &str) -> Vec<&str> {
    let lines: Vec<&str> = report.lines().collect();
    let kept: Vec<&str> =
        lines.iter().copied().filter(|line| !line.trim_start().starts_with("\"seconds\":")).collect();
    assert_eq!(lines.len(), kept.len() + 1, "one line tells the seconds");
    kept
}

/// What a report says of one thing.
#[track_caller]
fn object<'a>(report: &'a Value, id: &str) -> &'a Value {
    let objects = report["objects"].as_array().unwrap();
    objects.iter().find(|object| object["id"] == id).unwrap_or_else(|| panic!("there is no object {id}"))
}

fn questions(report: &Value) -> &Vec<Value> {
    report["questions"].as_array().unwrap()
}
