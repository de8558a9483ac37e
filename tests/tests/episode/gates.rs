//! `--gate`, `--max-questions` and `--seed`.

use coin_tests::{EpisodeBuilder, small_house};
use rstest::rstest;
use serde_json::Value;

fn accuracy(report: &Value) -> f64 {
    report["metrics"]["overall"]["subset_accuracy"].as_f64().unwrap()
}

#[test]
fn never_asks_nothing() {
    let report = super::report(&small_house(), &["--gate", "never"]);
    assert_eq!(report["gate"], "never");
    assert_eq!(super::questions(&report).len(), 0);
    assert_eq!(report["curve"].as_array().unwrap().len(), 1);
    assert!(report["objects"].as_array().unwrap().iter().all(|object| object["source"] == "inferred"));
}

#[test]
fn always_asks_about_everything_and_ends_without_a_mistake() {
    let report = super::report(&small_house(), &["--gate", "always"]);
    let mut asked: Vec<&str> =
        super::questions(&report).iter().map(|question| question["object_id"].as_str().unwrap()).collect();
    asked.sort_unstable();
    asked.dedup();
    assert_eq!(asked.len(), 34);
    assert_eq!(accuracy(&report), 1.0);
    assert!(report["objects"].as_array().unwrap().iter().all(|object| object["source"] == "answer"));
}

#[rstest]
#[case("risk")]
#[case("adaptive")]
#[case("set")]
#[case("paper")]
fn every_other_gate_asks_what_it_needs(#[case] gate: &str) {
    let report = super::report(&small_house(), &["--gate", gate]);
    assert_eq!(report["gate"], gate);
    assert_eq!(report["stopped"], "confident");
    let asked = super::questions(&report);
    assert!(asked.len() < 34, "{gate} asked about everything");
    let at_first = report["curve"][0]["subset_accuracy"].as_f64().unwrap();
    assert!(accuracy(&report) >= at_first, "questions made it worse");
    if gate == "paper" {
        let threshold = report["calibration"]["q_cp"].as_f64().unwrap();
        for question in asked {
            assert!(question["uncertainty_before"].as_f64().unwrap() > threshold, "{question:#}");
        }
        for object in report["objects"].as_array().unwrap() {
            assert!(object["uncertainty"].as_f64().unwrap() <= threshold, "{object:#}");
        }
    }
    if gate == "adaptive" {
        assert_eq!(report["parameters"]["risk"], 0.012);
        let threshold = report["adapted"]["lambda"].as_f64().unwrap();
        assert!(threshold >= report["calibration"]["lambda"].as_f64().unwrap());
        for object in report["objects"].as_array().unwrap() {
            assert!(object["confidence"].as_f64().unwrap() >= threshold, "{object:#}");
        }
    }
    if gate == "risk" {
        let threshold = report["calibration"]["lambda"].as_f64().unwrap();
        for object in report["objects"].as_array().unwrap() {
            assert!(object["confidence"].as_f64().unwrap() >= threshold, "{object:#}");
        }
    }
}

#[rstest]
#[case(0)]
#[case(2)]
fn no_more_questions_are_asked_than_allowed(#[case] most: usize) {
    let limit = most.to_string();
    let report = super::report(&small_house(), &["--gate", "always", "--max-questions", &limit]);
    assert_eq!(super::questions(&report).len(), most);
    assert_eq!(report["stopped"], "max_questions");
    assert_eq!(report["parameters"]["max_questions"], most);
}

#[test]
fn the_seed_changes_the_words_and_not_the_owners() {
    let episode = EpisodeBuilder::three_things().write();
    let runs: Vec<Value> = ["1", "2", "3", "4"]
        .iter()
        .map(|seed| super::report(episode.path(), &["--gate", "always", "--seed", seed]))
        .collect();
    let answers = |report: &Value| -> Vec<String> {
        super::questions(report).iter().map(|question| question["answer"].to_string()).collect()
    };
    assert!(runs[1..].iter().any(|run| answers(run) != answers(&runs[0])), "every seed gives the same words");
    for (run, seed) in runs.iter().zip(1..) {
        assert_eq!(run["seed"], seed);
        assert_eq!(accuracy(run), 1.0);
    }
}

#[test]
fn only_things_that_see_an_answer_are_inferred_again() {
    // The three things lie metres apart and have no features, so that no answer says anything of another thing.
    let episode = EpisodeBuilder::three_things().write();
    let folder = tempfile::tempdir().unwrap();
    let events = folder.path().join("events.jsonl");
    super::host(episode.path(), &["--estimator", "model", "--gate", "always", "--quiet", "--events"])
        .arg(&events)
        .run()
        .expect_code(0);
    let inferred = std::fs::read_to_string(&events)
        .unwrap()
        .lines()
        .filter(|line| line.contains("\"object_inferred\""))
        .count();
    assert_eq!(inferred, 3);
}

/// The paper's scheme infers every unasked thing again after every answer.
#[test]
fn the_papers_scheme_of_inference_can_be_had() {
    let calls = |scheme: &str| {
        let report = super::report(
            &small_house(),
            &["--estimator", "model", "--gate", "paper", "--reinference", scheme],
        );
        assert_eq!(report["parameters"]["reinference"], scheme.replace('-', "_"));
        (report["metrics"]["questions"].as_u64().unwrap(), report["cost"]["model_calls"].as_u64().unwrap())
    };
    let (asked, every) = calls("every-unasked");
    // Two turns a thing: 34 things before the first question, 33 before the second, and so on to the last pass.
    let things: u64 = (0..=asked).map(|step| 34 - step).sum();
    let steps = 2 * asked;
    assert_eq!(every, 2 * things + steps);
    let (_, answered) = calls("answered-context");
    assert!(answered < every / 2, "{answered} against {every}");
}
