//! An experiment end to end on a small home, and the arithmetic of its figures.

use std::path::Path;

use coin::calibration::EMBEDDED_MODEL;
use coin_schemas::household::UsageType;
use coin_schemas::report::MetricsSummary;
use tempfile::TempDir;

use super::summary::{Run, Scored, by_method, oracle, tests as test_all};
use super::*;
use crate::cli::default_levels;
use crate::model::embedded::EmbeddedModel;

struct Silent;

impl Progress for Silent {
    fn begin(&mut self, _pieces: usize, _what: &'static str) {}
    fn step(&mut self) {}
    fn end(&mut self) {}
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes").join(name)
}

const ALL: [Method; 9] = [
    Method::Coin,
    Method::CoinPaper,
    Method::Actowl,
    Method::NlmapLlm,
    Method::LastUser,
    Method::Frequency,
    Method::NoQuestions,
    Method::NoBackground,
    Method::NoUsage,
];

fn settings(episodes: Vec<PathBuf>, methods: &[Method]) -> ExperimentSettings {
    ExperimentSettings {
        episodes,
        calibrate_on: Vec::new(),
        levels: default_levels(),
        methods: methods.iter().copied().collect(),
        trials: 2,
        seed: 5,
        concurrency: 4,
        coverage: Vec::new(),
        kinds: Vec::new(),
    }
}

async fn results(settings: &ExperimentSettings) -> ExperimentResults {
    run(settings, Arc::new(EmbeddedModel::default()), &mut Silent).await.unwrap()
}

/// Without the times, which alone may differ.
fn timeless(mut results: ExperimentResults) -> ExperimentResults {
    for method in results.methods.values_mut() {
        method.seconds = spread(&[]);
    }
    results
}

#[tokio::test(flavor = "multi_thread")]
async fn nine_methods_run_and_the_same_seed_gives_the_same() {
    let settings = settings(vec![fixture("three-things")], &ALL);
    let first = timeless(results(&settings).await);
    assert_eq!(first.methods.keys().copied().collect::<Vec<_>>(), ALL);
    assert_eq!(first.model, EMBEDDED_MODEL);
    for (method, of) in &first.methods {
        assert_eq!(of.runs.len(), 2);
        let asks =
            !matches!(method, Method::NlmapLlm | Method::LastUser | Method::Frequency | Method::NoQuestions);
        assert!(asks || of.questions.mean == 0.0, "{method:?} asks");
        // The evidence speaks without a model, which is needed only to put questions.
        let scored_by_a_model = matches!(method, Method::CoinPaper | Method::NlmapLlm | Method::Actowl);
        let asked = of.questions.mean > 0.0;
        let spoken = scored_by_a_model || asked;
        assert_eq!(of.tokens.mean > 0.0, spoken, "{method:?} takes {} tokens", of.tokens.mean);
        assert_eq!(of.model_calls.mean > 0.0, spoken);
    }
    assert_eq!(first, timeless(results(&settings).await));

    let folder = TempDir::new().unwrap();
    let out = folder.path().join("results");
    write(&first, &out).unwrap();
    let read: ExperimentResults =
        serde_json::from_slice(&std::fs::read(out.join("results.json")).unwrap()).unwrap();
    assert_eq!(read, first);
    for name in ["tables.md", "index.html", "figures/accuracy-by-question.svg", "figures/ablation.svg"] {
        assert!(out.join(name).is_file(), "{name} is missing");
    }
    write(&first, &out).unwrap();
    assert!(matches!(write(&first, folder.path()), Err(WriteError::NotAnExperiment { .. })));
}

#[tokio::test]
async fn a_home_is_not_judged_by_its_own_thresholds() {
    let mut settings = settings(vec![fixture("three-things")], &[Method::Coin]);
    settings.calibrate_on = vec![fixture("three-things")];
    let refused = run(&settings, Arc::new(EmbeddedModel::default()), &mut Silent).await.unwrap_err();
    assert!(refused.is_refusal() && refused.to_string().contains("given twice"), "{refused}");
}

fn a_run(method: Method, trial: usize, curve: &[f64]) -> Run {
    let last = *curve.last().unwrap();
    let summary = MetricsSummary {
        objects: 10,
        subset_accuracy: last,
        mean_jaccard: last,
        micro_precision: 1.0,
        micro_recall: last,
        micro_f1: last,
    };
    Run {
        method,
        scored: Scored {
            run: coin_schemas::experiment::MethodRun {
                episode: "home".to_owned(),
                trial,
                overall: summary.clone(),
                by_usage_type: [(UsageType::SingleUser, summary)].into(),
                questions: curve.len() - 1,
                model_calls: 7,
                tokens: 70,
            },
            seconds: 0.5,
            curve: curve.to_vec(),
            curve_by_usage_type: [(UsageType::SingleUser, curve.to_vec())].into(),
        },
    }
}

/// A run that has stopped counts with its last value: at step 2 the mean of 1.0 and 0.9 is 0.95.
#[test]
fn curves_go_on_where_runs_have_stopped() {
    let runs = [a_run(Method::Coin, 0, &[0.8, 1.0]), a_run(Method::Coin, 1, &[0.6, 0.7, 0.9])];
    let results = by_method(&runs);
    let curve = &results[&Method::Coin].curve;
    let means: Vec<f64> = curve.iter().map(|step| step.mean).collect();
    assert!(
        means.iter().zip([0.7, 0.85, 0.95]).all(|(found, expected)| (found - expected).abs() < 1e-12),
        "{means:?}"
    );
    assert!((curve[0].sd - 0.1 * 2.0_f64.sqrt()).abs() < 1e-12);
    // One run reaches 0.95 with its first question, the other ends after two without.
    let survival: Vec<(usize, f64, usize, usize)> = results[&Method::Coin]
        .survival
        .iter()
        .map(|step| (step.step, step.survival, step.reached, step.censored))
        .collect();
    assert_eq!(survival, [(1, 0.5, 1, 0), (2, 0.5, 0, 1)]);
}

#[test]
fn the_oracle_settles_one_wrong_thing_with_every_question() {
    let curve: Vec<f64> =
        oracle(&[a_run(Method::NoQuestions, 0, &[0.8])]).into_iter().map(|step| step.mean).collect();
    assert_eq!(curve, [0.8, 0.9, 1.0]);
    assert!(oracle(&[a_run(Method::Coin, 0, &[0.8])]).is_empty());
}

#[test]
fn methods_that_differ_are_told_apart_and_equal_ones_are_not() {
    let trials = |method, accuracy: f64| (0..10).map(move |trial| a_run(method, trial, &[accuracy]));
    let runs: Vec<Run> = trials(Method::Coin, 1.0)
        .chain(trials(Method::LastUser, 0.6))
        .chain(trials(Method::NoBackground, 1.0))
        .collect();
    let tests = test_all(&runs);
    let accuracy = &tests.overall[&coin_schemas::experiment::Metric::SubsetAccuracy];
    assert!(accuracy.kruskal_wallis.unwrap().p < 0.001);
    assert!(accuracy.against_coin[&Method::LastUser].significant);
    assert_eq!(accuracy.against_coin[&Method::NoBackground].p_holm, 1.0);
    let precision = &tests.overall[&coin_schemas::experiment::Metric::MicroPrecision];
    assert_eq!(precision.kruskal_wallis, None, "all values are equal");
    assert!(tests.by_usage_type.contains_key(&UsageType::SingleUser));
}
