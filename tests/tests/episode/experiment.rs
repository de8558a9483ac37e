//! `host experiment` over the built program: what it writes, what it refuses, and the paper's figures.

use std::fs;
use std::path::Path;

use coin_tests::{Finished, Program, assert_conforms, fixture, published_schema, small_house};
use rstest::rstest;
use serde_json::Value;

fn experiment(episode: &Path, out: &Path, more: &[&str]) -> Finished {
    let program = Program::new("host").args(["experiment", "--episode"]).arg(episode).arg("--out").arg(out);
    program.args(more).run()
}

fn results(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("results.json")).unwrap()).unwrap()
}

#[test]
fn an_experiment_leaves_figures_tables_and_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let few = ["--methods", "coin,frequency,actowl", "--trials", "2", "--coverage-homes", "0", "--quiet"];
    experiment(&fixture("episodes/three-things"), &out, &few).expect_code(0);
    let found = results(&out);
    assert_conforms(&published_schema("experiment-results.schema.json"), &found, "results.json");
    let methods: Vec<&String> = found["methods"].as_object().unwrap().keys().collect();
    assert_eq!(methods, ["coin", "actowl", "frequency"]);
    for file in
        ["tables.md", "index.html", "figures/accuracy-by-question.svg", "figures/questions-and-accuracy.svg"]
    {
        assert!(out.join(file).is_file(), "{file} is missing");
    }
    // Once more into the same folder: the same figures, times aside.
    experiment(&fixture("episodes/three-things"), &out, &few).expect_code(0);
    let mut again = results(&out);
    let mut found = found;
    for results in [&mut found, &mut again] {
        for method in results["methods"].as_object_mut().unwrap().values_mut() {
            method["seconds"] = Value::Null;
        }
    }
    assert_eq!(found, again);
}

#[test]
fn a_folder_with_something_else_in_it_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.tex"), "a life's work").unwrap();
    experiment(&fixture("episodes/three-things"), folder.path(), &[])
        .expect_code(2)
        .expect_stderr(&["left alone"]);
}

#[test]
fn an_episode_without_truth_is_refused() {
    let mut episode = coin_tests::EpisodeBuilder::three_things();
    episode.truth = None;
    let folder = episode.write();
    let out = tempfile::tempdir().unwrap();
    experiment(folder.path(), &out.path().join("results"), &[]).expect_code(2).expect_stderr(&["truth"]);
}

/// The paper rounds a half up.
fn three_decimals(value: f64) -> String {
    format!("{:.3}", (value * 1e3).round() / 1e3)
}

const METRICS: [&str; 5] = ["subset_accuracy", "mean_jaccard", "micro_precision", "micro_recall", "micro_f1"];

/// Tables 2 and 4 to 6 of the paper.
#[rstest]
#[case::last_user("last_user", None, ["0.588", "0.721", "0.941", "0.582", "0.719"])]
#[case::frequency("frequency", None, ["0.647", "0.779", "1.000", "0.618", "0.764"])]
#[case::last_user("last_user", Some("temporary_sharing"), ["0.600", "0.700", "0.867", "0.591", "0.703"])]
#[case::frequency("frequency", Some("temporary_sharing"), ["0.733", "0.833", "1.000", "0.682", "0.811"])]
#[case::last_user("last_user", Some("single_user"), ["1.000"; 5])]
#[case::frequency("frequency", Some("single_user"), ["1.000"; 5])]
#[case::last_user("last_user", Some("multi_user_sharing"), ["0.111", "0.444", "1.000", "0.391", "0.563"])]
#[case::frequency("frequency", Some("multi_user_sharing"), ["0.111", "0.444", "1.000", "0.391", "0.563"])]
fn the_heuristics_get_the_papers_rows_in_an_experiment(
    #[case] method: &str,
    #[case] usage_type: Option<&str>,
    #[case] row: [&str; 5],
) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    experiment(
        &small_house(),
        &out,
        &["--methods", method, "--trials", "1", "--coverage-homes", "0", "--quiet"],
    )
    .expect_code(0);
    let found = results(&out);
    let of_method = &found["methods"][method];
    let spreads = usage_type.map_or(&of_method["overall"], |kind| &of_method["by_usage_type"][kind]);
    assert_eq!(METRICS.map(|metric| three_decimals(spreads[metric]["mean"].as_f64().unwrap())), row);
}
