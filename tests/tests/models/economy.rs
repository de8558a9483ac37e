//! What a language model costs: calls and tokens, against the paper's scheme on the same home.

use std::time::Duration;

use coin_tests::provider::{Script, ScriptedProvider};
use coin_tests::small_house;
use rstest::rstest;
use serde_json::Value;
use tempfile::TempDir;

use super::{count, faultless, host, questions, report, subset_accuracy, tokens, without_cost};

/// The paper's scheme: the model alone, its gate, and every unasked thing inferred again after every answer. One call
/// holds the whole context, as the paper's prompt does.
fn the_papers_scheme() -> Value {
    let provider = faultless();
    let report = report(
        &provider,
        &small_house(),
        &["--estimator", "model", "--context", "given", "--gate", "paper", "--reinference", "every-unasked"],
    );
    provider.assert_no_violations();
    report
}

/// Of the paper's calls and tokens on this very home, at most a tenth where the context is given, and at most a fifth
/// where the model fetches it.
#[rstest]
#[case::given(&["--context", "given"], 10)]
#[case::given_in_batches(&["--context", "given", "--batch", "8"], 10)]
#[case::tools(&["--context", "tools"], 5)]
#[case::evidence(&["--estimator", "evidence"], 10)]
fn it_takes_a_fraction_of_the_papers_calls_and_tokens(#[case] arguments: &[&str], #[case] part: u64) {
    let paper = the_papers_scheme();
    let provider = faultless();
    let folder = TempDir::new().unwrap();
    // The evidence model's thresholds are those that the program brings along.
    let calibration = match arguments.contains(&"evidence") {
        true => Vec::new(),
        false => {
            let file = provider.calibration(folder.path(), arguments);
            vec!["--calibration".to_owned(), file.to_str().unwrap().to_owned()]
        }
    };
    let calibration: Vec<&str> = calibration.iter().map(String::as_str).collect();
    let ours = report(&provider, &small_house(), &[arguments, &calibration].concat());
    // Where the evidence scores and nobody is asked, there is nothing to say to a model.
    if provider.request_count() > 0 {
        provider.assert_no_violations();
    }
    println!(
        "{arguments:?}: {} questions, {:.3}, {} calls, {} tokens; the paper's scheme {} questions, {:.3}, {} calls, {} tokens",
        questions(&ours).len(),
        subset_accuracy(&ours),
        count(&ours, "model_calls"),
        tokens(&ours),
        questions(&paper).len(),
        subset_accuracy(&paper),
        count(&paper, "model_calls"),
        tokens(&paper),
    );
    assert!(subset_accuracy(&ours) >= subset_accuracy(&paper));
    assert!(count(&ours, "model_calls") * part <= count(&paper, "model_calls"));
    assert!(tokens(&ours) * part <= tokens(&paper));
}

/// Conversations go on side by side, and the report does not show in which order they ended.
#[test]
fn the_report_does_not_depend_on_concurrency() {
    let slow = || {
        let script = Script { delay: Duration::from_millis(30), ..Script::default() };
        ScriptedProvider::start(script)
    };
    let (one, many) = (slow(), slow());
    let alone = report(&one, &small_house(), &["--concurrency", "1"]);
    let together = report(&many, &small_house(), &["--concurrency", "7"]);
    assert_eq!(one.most_at_once(), 1);
    assert!((3..=7).contains(&many.most_at_once()), "{}", many.most_at_once());
    let without_seconds = |mut report: Value| {
        report["cost"]["seconds"] = Value::Null;
        report
    };
    assert_eq!(without_seconds(alone), without_seconds(together));
}

#[test]
fn a_kept_reply_is_not_paid_for_again() {
    let provider = faultless();
    let folder = TempDir::new().unwrap();
    let cache = folder.path().join("replies.jsonl");
    let arguments = ["--cache", cache.to_str().unwrap()];
    let first = report(&provider, &small_house(), &arguments);
    let requests = provider.request_count();
    assert_eq!(count(&first, "model_calls"), requests as u64);
    let second = report(&provider, &small_house(), &arguments);
    assert_eq!(provider.request_count(), requests);
    assert_eq!(count(&second, "remembered_replies"), requests as u64);
    assert_eq!((count(&second, "model_calls"), tokens(&second)), (0, 0));
    assert_eq!(without_cost(first), without_cost(second));
}

#[test]
fn a_budget_ends_a_run_politely() {
    let provider = faultless();
    let folder = TempDir::new().unwrap();
    let db = folder.path().join("home.db");
    let db = db.to_str().unwrap();
    let whole = super::report(&provider, &small_house(), &[]);
    let limit = tokens(&whole) / 2;
    let finished = host(&provider, &small_house(), &["--budget", &limit.to_string(), "--json", "--db", db])
        .run()
        .expect_code(0);
    let report = finished.json();
    assert_eq!(report["stopped"], "budget");
    assert!(tokens(&report) <= limit + 4 * 200, "{} tokens", tokens(&report));
    assert!(tokens(&report) > limit / 2, "{} tokens", tokens(&report));
    finished.expect_stderr(&[&format!("the budget of {limit} tokens is spent")]);
    // What the model was not asked about is judged all the same, and the report says how.
    let objects = report["objects"].as_array().unwrap();
    let without_model = objects.iter().filter(|object| object["problem"].is_string());
    assert!(without_model.clone().count() > 1);
    for object in without_model {
        assert!(object["confidence"].as_f64().unwrap() > 0.0);
        assert!(object["problem"].as_str().unwrap().contains("judged by the evidence alone"), "{object}");
    }
    finished.expect_stderr(&["--resume", db]);
    // With more to spend the run goes on to where it would have come without a budget.
    let resumed = super::report(&provider, &small_house(), &["--db", db, "--resume"]);
    assert_eq!(without_cost(resumed), without_cost(whole));
}

/// Thresholds of a model are not made from scores that another one stood in with.
#[test]
fn a_budget_that_is_spent_ends_a_calibration() {
    let provider = faultless();
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("calibration.json");
    provider
        .host()
        .args(["calibrate", "--quiet", "--model", "openai:scripted", "--budget", "5_000", "--out"])
        .arg(&file)
        .arg("--episode")
        .arg(small_house())
        .run()
        .expect_code(1)
        .expect_stderr(&["the budget was spent", "--budget"]);
    assert!(!file.exists());
}
