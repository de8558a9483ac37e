//! What the README promises of its main command, and what the job demands of it.

use coin_tests::{Program, fixture, small_house};
use serde_json::Value;

#[test]
fn the_main_command_prints_who_owns_what_and_how_good_that_is() {
    let finished = super::host(&small_house(), &[]).run().expect_code(0);
    let text = &finished.stdout;
    for person in ["Bob", "Mary", "Tom", "office worker"] {
        assert!(text.contains(person), "{person} lives there: {text}");
    }
    let description: Value =
        serde_json::from_slice(&std::fs::read(small_house().join("episode.json")).unwrap()).unwrap();
    for object in description["objects"].as_array().unwrap() {
        let (id, class) = (object["id"].as_str().unwrap(), object["class"].as_str().unwrap());
        let row = text.lines().find(|line| {
            let mut words = line.split_whitespace();
            words.next() == Some(id) && line.contains(class)
        });
        assert!(row.is_some(), "thing {id}, a {class}, has a row: {text}");
    }
    for figure in ["accuracy", "questions", "model calls", "tool calls"] {
        assert!(text.contains(figure), "{figure} is told: {text}");
    }
    // Each question is told on the way, with its answer.
    let report = super::report(&small_house(), &[]);
    for question in super::questions(&report) {
        let answer = question["answer"].as_str().unwrap();
        assert!(finished.stderr.contains(answer), "{answer:?} is told: {}", finished.stderr);
    }
}

#[test]
fn a_small_house_is_settled_with_few_questions() {
    let report = super::report(&small_house(), &[]);
    let overall = &report["metrics"]["overall"];
    assert_eq!(overall["objects"], 34);
    let accuracy = overall["subset_accuracy"].as_f64().unwrap();
    assert!(accuracy >= 0.988, "Subset Accuracy is {accuracy}");
    let asked = report["metrics"]["questions"].as_u64().unwrap();
    assert!(asked <= 8, "{asked} questions were asked");
    assert_eq!(report["stopped"], "confident");
    assert!(report["calibration"].is_object(), "a guarantee holds");
}

#[test]
fn the_other_fixture_runs_too() {
    let report = super::report(&fixture("episodes/three-things"), &[]);
    assert_eq!(report["objects"].as_array().unwrap().len(), 3);
    assert_eq!(report["metrics"]["overall"]["subset_accuracy"], 1.0);
}

#[test]
fn nobody_is_needed_who_reads_along() {
    let finished = super::host(&small_house(), &["--quiet"]).run().expect_code(0);
    assert_eq!(finished.stderr, "");
    assert!(finished.stdout.contains("accuracy"));
}

#[test]
fn text_without_a_terminal_has_no_colours() {
    let finished = super::host(&fixture("episodes/three-things"), &[]).run().expect_code(0);
    assert!(!finished.stdout.contains('\u{1b}'), "{}", finished.stdout);
    assert!(!finished.stderr.contains('\u{1b}'), "{}", finished.stderr);
}

#[test]
fn help_and_version_are_there() {
    for program in ["host", "coin-server"] {
        let help = Program::new(program).arg("--help").run().expect_code(0);
        assert!(help.stdout.contains("--db") && help.stdout.contains("Exit status"), "{}", help.stdout);
        let version = Program::new(program).arg("--version").run().expect_code(0);
        assert!(version.stdout.contains("0."), "{}", version.stdout);
    }
}
