//! Flags and files that are refused: exit status 2, and a message that says what is allowed.

use std::fs;

use coin_tests::{EpisodeBuilder, Program, repository};
use rstest::rstest;
use serde_json::{Value, json};

#[rstest]
#[case::nothing(&[], &["--episode"])]
#[case::unknown_flag(&["--episode", "x", "--gates", "risk"], &["--gates", "--gate"])]
#[case::unknown_gate(&["--episode", "x", "--gate", "sometimes"], &["sometimes", "risk", "never"])]
#[case::unknown_model(&["--episode", "x", "--model", "oracle"], &["oracle", "embedded"])]
#[case::a_negative_number(&["--episode", "x", "--max-questions=-1"], &["--max-questions", "-1"])]
#[case::a_number_in_words(&["--episode", "x", "--seed", "seven"], &["--seed", "seven"])]
#[case::a_risk_of_no_gate(&["--episode", "x", "--risk", "0.01"], &["--risk", "--gate adaptive"])]
#[case::a_share_above_one(&["--episode", "x", "--wrong-answers", "5"], &["--wrong-answers", "5", "0.05"])]
#[case::errors_of_real_people(
    &["--episode", "x", "--wrong-answers", "0.05", "--answers", "terminal"],
    &["--wrong-answers", "simulated"]
)]
#[case::no_value(&["--episode"], &["--episode"])]
#[case::no_server(&["--episode", "x", "--server", ""], &["--server"])]
#[case::an_unclosed_quote(&["--episode", "x", "--server", "coin-server --db 'x"], &["--server"])]
#[case::unknown_command(&["simulate"], &["simulate"])]
#[case::no_out(&["calibrate", "--episode", "x"], &["--out"])]
#[case::a_level_above_one(&["calibrate", "--episode", "x", "--out", "y", "--alpha", "1.5"], &["--alpha", "1.5"])]
#[case::unknown_protocol(&["generate", "routine", "--protocol", "decade", "--out", "x"], &["decade", "week"])]
fn wrong_flags_of_the_host(#[case] arguments: &[&str], #[case] parts: &[&str]) {
    let refused = Program::new("host").args(arguments).run().expect_code(2);
    assert_eq!(refused.stdout, "");
    refused.expect_stderr(parts);
}

#[rstest]
#[case::unknown_flag(&["--database", "x"], &["--database"])]
#[case::unknown_tool(&["--db", "x", "--tools", "get_usage_sumary"], &["get_usage_sumary", "get_usage_summary"])]
#[case::no_episode(&["import", "--db", "x"], &["--episode"])]
#[case::unknown_command(&["export"], &["export"])]
fn wrong_flags_of_the_server(#[case] arguments: &[&str], #[case] parts: &[&str]) {
    let refused = Program::new("coin-server").args(arguments).run().expect_code(2);
    assert_eq!(refused.stdout, "");
    refused.expect_stderr(parts);
}

fn embedded_calibration() -> Value {
    let text = fs::read(repository().join("fixtures/calibrations/embedded.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

fn run_with_calibration(text: &str) -> Program {
    let episode = EpisodeBuilder::three_things().file("calibration.json", text).write();
    let file = episode.join("calibration.json");
    let program = super::host(episode.path(), &["--calibration", file.to_str().unwrap()]);
    // The folder has to outlive the run.
    std::mem::forget(episode);
    program
}

#[test]
fn a_calibration_for_another_model_is_refused() {
    let mut calibration = embedded_calibration();
    calibration["model"] = json!("openai:gpt");
    run_with_calibration(&calibration.to_string())
        .run()
        .expect_code(2)
        .expect_stderr(&["openai:gpt", "embedded"]);
}

#[rstest]
#[case::no_json("q_alpha = 1", &["calibration.json"])]
#[case::unknown_key(r#"{"model": "embedded", "threshold": 1}"#, &["calibration.json", "threshold"])]
#[case::missing_key(r#"{"model": "embedded"}"#, &["calibration.json", "alpha"])]
fn a_malformed_calibration_is_refused(#[case] text: &str, #[case] parts: &[&str]) {
    run_with_calibration(text).run().expect_code(2).expect_stderr(parts);
}

#[test]
fn a_calibration_that_is_not_there_is_refused() {
    let episode = EpisodeBuilder::three_things().write();
    super::host(episode.path(), &["--calibration", "nowhere.json"])
        .run()
        .expect_code(2)
        .expect_stderr(&["nowhere.json"]);
}

#[rstest]
#[case("--report")]
#[case("--events")]
fn a_file_that_cannot_be_made_is_told_before_the_work_begins(#[case] flag: &str) {
    let episode = EpisodeBuilder::three_things().write();
    let file = episode.join("no/such/folder/file.json");
    let refused = super::host(episode.path(), &[flag, file.to_str().unwrap()]).run().expect_code(2);
    refused.expect_stderr(&["file.json"]);
    assert!(!refused.stderr.contains("Q1"), "nobody was asked: {}", refused.stderr);
    assert_eq!(refused.stdout, "");
}

#[test]
fn a_database_that_is_none_is_refused() {
    let episode = EpisodeBuilder::three_things().file("letter.txt", "Dear grandmother, ".repeat(100)).write();
    let file = episode.join("letter.txt");
    super::host(episode.path(), &["--db", file.to_str().unwrap()])
        .run()
        .expect_code(2)
        .expect_stderr(&["letter.txt", "not a SQLite database"]);
}

#[test]
fn a_failed_run_leaves_the_report_that_was_there() {
    let mut episode = EpisodeBuilder::three_things();
    episode.truth = None;
    let episode = episode.file("report.json", "the report of yesterday").write();
    let file = episode.join("report.json");
    super::host(episode.path(), &["--report", file.to_str().unwrap()]).run().expect_code(2);
    assert_eq!(fs::read_to_string(&file).unwrap(), "the report of yesterday");
}
