//! From runs to figures: means and spreads, curves, survival, tests.

use std::collections::{BTreeMap, BTreeSet};

use coin::metrics::{Judged, summarise};
use coin::owners::OwnerSet;
use coin::statistics::{Observation, Outcome, holm, kaplan_meier, kruskal_wallis, mann_whitney};
use coin_schemas::experiment::{
    MannWhitney, Method, MethodResults, MethodRun, Metric, MetricSpreads, MetricTest, StatisticalTests,
    StepSpread,
};
use coin_schemas::household::{ObjectId, UsageType};
use coin_schemas::report::MetricsSummary;

use super::methods::MethodOutcome;
use super::{JudgedHome, SIGNIFICANCE, TARGET_ACCURACY, spread};

/// A run and what it scored.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    pub(super) method: Method,
    pub(super) scored: Scored,
}

/// A run judged against the truth.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scored {
    pub(super) run: MethodRun,
    pub(super) seconds: f64,
    /// Subset Accuracy before the first question and after each one.
    pub(super) curve: Vec<f64>,
    pub(super) curve_by_usage_type: BTreeMap<UsageType, Vec<f64>>,
}

/// Judges every step of a run.
pub(super) fn score(outcome: &MethodOutcome, trial: usize, home: &JudgedHome) -> Scored {
    let truth = home.true_owners();
    let no_types = BTreeMap::new();
    let types = home.truth.usage_type.as_ref().unwrap_or(&no_types);
    let judge = |estimates: &BTreeMap<ObjectId, OwnerSet>, of_type: Option<UsageType>| -> MetricsSummary {
        let judged: Vec<Judged> = estimates
            .iter()
            .filter(|(object, _)| of_type.is_none() || types.get(*object).copied() == of_type)
            .filter_map(|(object, &estimate)| truth.get(object).map(|&truth| Judged { estimate, truth }))
            .collect();
        summarise(&judged)
    };
    let kinds: BTreeSet<UsageType> = types.values().copied().collect();
    let curve_of = |of_type| -> Vec<f64> {
        outcome.history.iter().map(|estimates| judge(estimates, of_type).subset_accuracy).collect()
    };
    let nothing = BTreeMap::new();
    let last = outcome.history.last().unwrap_or(&nothing);
    Scored {
        run: MethodRun {
            episode: home.loaded.episode.name.clone(),
            trial,
            overall: judge(last, None),
            by_usage_type: kinds.iter().map(|&kind| (kind, judge(last, Some(kind)))).collect(),
            questions: outcome.history.len().saturating_sub(1),
            model_calls: outcome.cost.model_calls,
            tokens: outcome.cost.prompt_tokens + outcome.cost.completion_tokens,
        },
        seconds: outcome.cost.seconds,
        curve: curve_of(None),
        curve_by_usage_type: kinds.iter().map(|&kind| (kind, curve_of(Some(kind)))).collect(),
    }
}

/// The figures of every method that ran.
pub(super) fn by_method(runs: &[Run]) -> BTreeMap<Method, MethodResults> {
    let methods: BTreeSet<Method> = runs.iter().map(|run| run.method).collect();
    methods
        .into_iter()
        .map(|method| {
            let scored: Vec<&Scored> =
                runs.iter().filter(|run| run.method == method).map(|run| &run.scored).collect();
            (method, results(&scored))
        })
        .collect()
}

fn results(scored: &[&Scored]) -> MethodResults {
    let of =
        |figure: &dyn Fn(&Scored) -> f64| spread(&scored.iter().map(|run| figure(run)).collect::<Vec<_>>());
    let kinds: BTreeSet<UsageType> =
        scored.iter().flat_map(|run| run.run.by_usage_type.keys().copied()).collect();
    let summaries_of = |kind: UsageType| -> Vec<&MetricsSummary> {
        scored.iter().filter_map(|run| run.run.by_usage_type.get(&kind)).collect()
    };
    let curves_of = |kind: UsageType| -> Vec<&[f64]> {
        scored.iter().filter_map(|run| run.curve_by_usage_type.get(&kind)).map(Vec::as_slice).collect()
    };
    MethodResults {
        overall: spreads(&scored.iter().map(|run| &run.run.overall).collect::<Vec<_>>()),
        by_usage_type: kinds.iter().map(|&kind| (kind, spreads(&summaries_of(kind)))).collect(),
        questions: of(&|run| run.run.questions as f64),
        model_calls: of(&|run| run.run.model_calls as f64),
        tokens: of(&|run| run.run.tokens as f64),
        seconds: of(&|run| run.seconds),
        curve: mean_curve(&scored.iter().map(|run| run.curve.as_slice()).collect::<Vec<_>>()),
        curve_by_usage_type: kinds.iter().map(|&kind| (kind, mean_curve(&curves_of(kind)))).collect(),
        survival: kaplan_meier(&scored.iter().map(|run| reaching(&run.curve)).collect::<Vec<_>>()),
        runs: scored.iter().map(|run| run.run.clone()).collect(),
    }
}

fn spreads(summaries: &[&MetricsSummary]) -> MetricSpreads {
    let of = |metric| spread(&summaries.iter().map(|summary| value(metric, summary)).collect::<Vec<_>>());
    MetricSpreads {
        subset_accuracy: of(Metric::SubsetAccuracy),
        mean_jaccard: of(Metric::MeanJaccard),
        micro_precision: of(Metric::MicroPrecision),
        micro_recall: of(Metric::MicroRecall),
        micro_f1: of(Metric::MicroF1),
    }
}

fn value(metric: Metric, summary: &MetricsSummary) -> f64 {
    match metric {
        Metric::SubsetAccuracy => summary.subset_accuracy,
        Metric::MeanJaccard => summary.mean_jaccard,
        Metric::MicroPrecision => summary.micro_precision,
        Metric::MicroRecall => summary.micro_recall,
        Metric::MicroF1 => summary.micro_f1,
    }
}

/// The mean at each step up to the longest run's last; a run that has stopped stays where it stopped.
pub(super) fn mean_curve(curves: &[&[f64]]) -> Vec<StepSpread> {
    let steps = curves.iter().map(|curve| curve.len()).max().unwrap_or(0);
    (0..steps)
        .map(|step| {
            let values: Vec<f64> =
                curves.iter().filter_map(|curve| curve.get(step).or(curve.last())).copied().collect();
            let at_step = spread(&values);
            StepSpread { step, mean: at_step.mean, sd: at_step.sd }
        })
        .collect()
}

/// When a run first reached the target; a run that never does is censored at its last question.
fn reaching(curve: &[f64]) -> Observation {
    match curve.iter().position(|&accuracy| accuracy >= TARGET_ACCURACY) {
        Some(step) => Observation { step, outcome: Outcome::Reached },
        None => Observation { step: curve.len().saturating_sub(1), outcome: Outcome::Censored },
    }
}

/// Asking exactly the wrong things first: one more thing is right with every question.
pub(super) fn oracle(runs: &[Run]) -> Vec<StepSpread> {
    let curves: Vec<Vec<f64>> = runs
        .iter()
        .filter(|run| run.method == Method::NoQuestions)
        .filter_map(|run| {
            let start = run.scored.curve.first()?;
            Some(wrong_ones_first(Some(*start), run.scored.run.overall.objects))
        })
        .collect();
    mean_curve(&curves.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// The curve of somebody who asks about exactly the wrong ones of so many things; empty where it is not known where it
/// starts.
pub(super) fn wrong_ones_first(start: Option<f64>, things: usize) -> Vec<f64> {
    let Some(start) = start else { return Vec::new() };
    let wrong = ((1.0 - start) * things as f64).round() as usize;
    (0..=wrong).map(|asked| 1.0 - (wrong - asked) as f64 / things.max(1) as f64).collect()
}

const METRICS: [Metric; 5] = [
    Metric::SubsetAccuracy,
    Metric::MeanJaccard,
    Metric::MicroPrecision,
    Metric::MicroRecall,
    Metric::MicroF1,
];

/// The paper's tests over everything and by usage type.
pub(super) fn tests(runs: &[Run]) -> StatisticalTests {
    let kinds: BTreeSet<UsageType> =
        runs.iter().flat_map(|run| run.scored.run.by_usage_type.keys().copied()).collect();
    let over = |summary: &dyn Fn(&MethodRun) -> Option<MetricsSummary>| {
        METRICS.into_iter().map(|metric| (metric, test(runs, metric, summary))).collect()
    };
    StatisticalTests {
        level: SIGNIFICANCE,
        overall: over(&|run| Some(run.overall.clone())),
        by_usage_type: kinds
            .into_iter()
            .map(|kind| (kind, over(&|run| run.by_usage_type.get(&kind).cloned())))
            .collect(),
    }
}

fn test(runs: &[Run], metric: Metric, summary: &dyn Fn(&MethodRun) -> Option<MetricsSummary>) -> MetricTest {
    let mut values: BTreeMap<Method, Vec<f64>> = BTreeMap::new();
    for run in runs {
        if let Some(summary) = summary(&run.scored.run) {
            values.entry(run.method).or_default().push(value(metric, &summary));
        }
    }
    let groups: Vec<&[f64]> = values.values().map(Vec::as_slice).collect();
    let against: Vec<(Method, coin::statistics::MannWhitney)> = match values.get(&Method::Coin) {
        Some(coin) => values
            .iter()
            .filter(|(method, _)| **method != Method::Coin)
            .map(|(&method, other)| (method, mann_whitney(other, coin)))
            .collect(),
        None => Vec::new(),
    };
    let corrected = holm(&against.iter().map(|(_, test)| test.p).collect::<Vec<_>>());
    MetricTest {
        kruskal_wallis: kruskal_wallis(&groups),
        against_coin: against
            .into_iter()
            .zip(corrected)
            .map(|((method, test), p_holm)| {
                let significant = p_holm < SIGNIFICANCE;
                (method, MannWhitney { u: test.u, p: test.p, p_holm, significant })
            })
            .collect(),
    }
}
