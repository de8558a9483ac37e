//! Recorded runs, played again without a network.

use std::fs;

use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider};
use coin_tests::{EpisodeBuilder, Program, small_house};
use tempfile::TempDir;

use super::{KEY, host};

/// The report as it was written, but for the line that tells the seconds.
fn without_seconds(report: &str) -> String {
    report
        .lines()
        .filter(|line| !line.trim_start().starts_with("\"seconds\":"))
        .collect::<Vec<_>>()
        .join("\n")
}

/// Byte for byte, faults and their notes included, with another number of conversations at once.
#[test]
fn a_tape_plays_a_run_again_byte_for_byte() {
    let folder = TempDir::new().unwrap();
    let tape = folder.path().join("tape.jsonl");
    let provider = ScriptedProvider::start(Script {
        faults: FaultPlan::share(
            0.2,
            vec![Fault::Prose, Fault::ScoresAsText, Fault::Empty, Fault::Status(400)],
        ),
        ..Script::default()
    });
    let arguments = ["--record", tape.to_str().unwrap(), "--json"];
    let recorded = host(&provider, &small_house(), &arguments).run().expect_code(0);
    let requests = provider.request_count();
    let replayed = Program::new("host")
        .arg("--episode")
        .arg(small_house())
        .args(["--model", &format!("replay:{}", tape.display()), "--json", "--concurrency", "1"])
        .env("OPENAI_BASE_URL", "http://127.0.0.1:1/v1")
        .run()
        .expect_code(0);
    assert_eq!(without_seconds(&replayed.stdout), without_seconds(&recorded.stdout));
    assert_eq!(provider.request_count(), requests, "nothing was asked again");
    let tape = fs::read_to_string(tape).unwrap();
    assert!(!tape.contains(KEY) && !tape.to_lowercase().contains("authorization"));
    assert!(recorded.stdout.contains("\"model\": \"openai:scripted\""));
}

#[test]
fn a_conversation_that_is_not_on_the_tape_is_told() {
    let folder = TempDir::new().unwrap();
    let tape = folder.path().join("tape.jsonl");
    let provider = super::faultless();
    let recorded = EpisodeBuilder::three_things().write();
    host(&provider, recorded.path(), &["--record", tape.to_str().unwrap()]).run().expect_code(0);
    let mut other = EpisodeBuilder::three_things().object("4", "umbrella", [20.0, 0.0, 0.5]);
    other.truth.as_mut().unwrap()["owners"]["4"] = serde_json::json!(["Mary"]);
    let other = other.write();
    Program::new("host")
        .arg("--episode")
        .arg(other.path())
        .args(["--model", &format!("replay:{}", tape.display())])
        .run()
        .expect_code(1)
        .expect_stderr(&["holds no reply", "umbrella", "--record"]);
}

#[test]
fn a_file_that_is_no_tape_is_told() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("report.json");
    fs::write(&file, "{\"episode\": \"small\"}\n").unwrap();
    Program::new("host")
        .arg("--episode")
        .arg(small_house())
        .args(["--model", &format!("replay:{}", file.display())])
        .run()
        .expect_code(2)
        .expect_stderr(&["report.json"]);
}

/// The tape would be emptied before its first word.
#[test]
fn a_tape_is_not_recorded_over_while_it_plays() {
    let folder = TempDir::new().unwrap();
    let tape = folder.path().join("tape.jsonl");
    let episode = EpisodeBuilder::three_things().write();
    let provider = super::faultless();
    host(&provider, episode.path(), &["--record", tape.to_str().unwrap()]).run().expect_code(0);
    let before = fs::read(&tape).unwrap();
    Program::new("host")
        .arg("--episode")
        .arg(episode.path())
        .args(["--model", &format!("replay:{}", tape.display()), "--record", tape.to_str().unwrap()])
        .run()
        .expect_code(2)
        .expect_stderr(&["the same file"]);
    assert_eq!(fs::read(&tape).unwrap(), before);
}

/// Nor is the file in which replies are kept: what was paid for would be gone.
#[test]
fn a_cache_is_not_recorded_over() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("replies.jsonl");
    let provider = super::faultless();
    let arguments = ["--cache", file.to_str().unwrap(), "--record", file.to_str().unwrap()];
    host(&provider, &small_house(), &arguments)
        .run()
        .expect_code(2)
        .expect_stderr(&["the same file", "--record"]);
    assert!(!file.exists() && provider.request_count() == 0);
}
