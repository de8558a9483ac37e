//! The results of an experiment: methods × episodes × trials, in figures.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::calibration::Calibration;
use crate::household::UsageType;
use crate::report::MetricsSummary;

/// `results.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExperimentResults {
    /// The episodes' names, in the order given.
    pub episodes: Vec<String>,
    /// How often every method went through every episode. Trial t of two methods meets the same people with the
    /// same words.
    pub trials: usize,
    /// The seed of the first trial; trial t has seed + t.
    pub seed: u64,
    /// The model that scored, worded and read.
    pub model: String,
    /// The thresholds that the gates compared with; `null` where the model has none and no guarantee holds.
    pub calibration: Option<Calibration>,
    /// What came of every method.
    pub methods: BTreeMap<Method, MethodResults>,
    /// Whether the methods differ by more than chance.
    pub tests: StatisticalTests,
    /// What somebody would reach who knew which things are wrong at once and asked about exactly those, if every
    /// answer settled its own thing only. Starts from what `no_questions` believes.
    pub oracle: Vec<StepSpread>,
    /// The Subset Accuracy whose reaching is the event of the Kaplan–Meier curves.
    pub target_accuracy: f64,
    /// How often the guarantees held on homes that were made for that purpose; empty where none were.
    pub coverage: Vec<Coverage>,
    /// What the terms of the evidence model are worth on fresh homes of some kinds; empty where none were made.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kinds: Vec<KindResults>,
    /// The program and version that wrote the file.
    pub created_with: String,
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// COIN with the gate of conformal risk control.
    Coin,
    /// COIN with the paper's gate and the paper's scheme of inference.
    CoinPaper,
    /// Active Ownership Learning: a generative model that asks where it expects to learn most.
    Actowl,
    /// The model with the map alone: no background, no usage, no question.
    NlmapLlm,
    /// Who used a thing last owns it.
    LastUser,
    /// Who used a thing most often owns it.
    Frequency,
    /// COIN that may not ask.
    NoQuestions,
    /// COIN that knows nothing of people but their names.
    NoBackground,
    /// COIN that has not seen who used what.
    NoUsage,
}

/// Mean and sample standard deviation over the runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The sample standard deviation; 0 for one run.
    pub sd: f64,
}

/// The paper's five metrics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MetricSpreads {
    /// Share of things whose owner set is exactly right.
    pub subset_accuracy: Spread,
    /// Mean overlap of owner sets.
    pub mean_jaccard: Spread,
    /// Right owner labels among those given.
    pub micro_precision: Spread,
    /// Right owner labels among the true ones.
    pub micro_recall: Spread,
    /// Harmonic mean of the two.
    pub micro_f1: Spread,
}

/// Subset Accuracy after a number of questions. A run that has stopped counts with its last value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepSpread {
    /// Questions so far.
    pub step: usize,
    /// The mean over the runs.
    pub mean: f64,
    /// The sample standard deviation over the runs.
    pub sd: f64,
}

/// A step of a Kaplan–Meier curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurvivalStep {
    /// Questions so far.
    pub step: usize,
    /// Estimated share of runs that have *not* reached the target by then.
    pub survival: f64,
    /// How many runs were still on their way just before.
    pub at_risk: usize,
    /// How many reached the target with this question.
    pub reached: usize,
    /// How many ended here without reaching it (censored).
    pub censored: usize,
}

/// A term that can be left out: of the evidence model, or of what is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Term {
    /// What common sense knows of the class and the people.
    Class,
    /// Whose the things beside it are, where a person said so.
    Place,
    /// Whose the things are that look like it, by as much as looks tell in this home.
    Looks,
    /// People who share a thing use it in turns.
    Turns,
    /// A thing may have had other owners before.
    ChangeOfHands,
    /// The habits of the home are learnt from all its things and answers.
    Habits,
    /// The question is chosen by how much doubt its answer leaves in the whole home, and not by how sure its thing is.
    BestQuestion,
}

/// Fresh homes of one kind, judged with every term of the evidence model and without each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KindResults {
    /// The kind of home.
    pub protocol: String,
    /// How many households were judged.
    pub households: usize,
    /// How many others of the same kind made the thresholds, anew for every row.
    pub calibrated_on: usize,
    /// How many things were judged.
    pub things: usize,
    /// The whole model first.
    pub terms: Vec<TermResult>,
    /// Subset Accuracy by question where everything is asked about, the least sure first.
    pub asked_on: Vec<StepSpread>,
    /// The same with the paper's gate and scheme.
    pub paper: Vec<StepSpread>,
    /// The same of somebody who asks about exactly what the whole model has wrong at once.
    pub oracle: Vec<StepSpread>,
}

/// What came of the model without a term.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TermResult {
    /// The term; `null` for the whole model.
    pub left_out: Option<Term>,
    /// Subset Accuracy before the first question.
    pub at_once: Spread,
    /// Subset Accuracy after the last.
    pub in_the_end: Spread,
    /// Questions.
    pub questions: Spread,
}

/// What came of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MethodResults {
    /// Over all things.
    pub overall: MetricSpreads,
    /// By usage type; empty where no truth says it.
    pub by_usage_type: BTreeMap<UsageType, MetricSpreads>,
    /// Questions asked.
    pub questions: Spread,
    /// Requests to the model.
    pub model_calls: Spread,
    /// Tokens sent and received, by the o200k tokenizer where the model itself counts none.
    pub tokens: Spread,
    /// Wall-clock time, in seconds; the one figure that differs between equal experiments.
    pub seconds: Spread,
    /// Subset Accuracy by question, from the state before the first.
    pub curve: Vec<StepSpread>,
    /// The same by usage type.
    pub curve_by_usage_type: BTreeMap<UsageType, Vec<StepSpread>>,
    /// Kaplan–Meier curve of reaching the target accuracy.
    pub survival: Vec<SurvivalStep>,
    /// Every run, episode by episode and trial by trial.
    pub runs: Vec<MethodRun>,
}

/// One run of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MethodRun {
    /// The episode's name.
    pub episode: String,
    /// The trial, from 0.
    pub trial: usize,
    /// The metrics at the end.
    pub overall: MetricsSummary,
    /// The metrics at the end by usage type.
    pub by_usage_type: BTreeMap<UsageType, MetricsSummary>,
    /// Questions asked.
    pub questions: usize,
    /// Requests to the model.
    pub model_calls: u64,
    /// Tokens sent and received.
    pub tokens: u64,
}

/// The metrics that are tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Share of things whose owner set is exactly right.
    SubsetAccuracy,
    /// Mean overlap of owner sets.
    MeanJaccard,
    /// Right owner labels among those given.
    MicroPrecision,
    /// Right owner labels among the true ones.
    MicroRecall,
    /// Harmonic mean of the two.
    MicroF1,
}

/// The paper's tests at the last step: Kruskal–Wallis over all methods, then Mann–Whitney U of each method
/// against `coin`, with Holm's correction over the comparisons of one metric.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StatisticalTests {
    /// The level below which a corrected p-value counts as significant.
    pub level: f64,
    /// Over all things.
    pub overall: BTreeMap<Metric, MetricTest>,
    /// By usage type.
    pub by_usage_type: BTreeMap<UsageType, BTreeMap<Metric, MetricTest>>,
}

/// The tests of one metric.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MetricTest {
    /// Kruskal–Wallis; `null` where all values are equal or there are fewer than two methods.
    pub kruskal_wallis: Option<KruskalWallis>,
    /// Every other method against `coin`.
    pub against_coin: BTreeMap<Method, MannWhitney>,
}

/// A Kruskal–Wallis test.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KruskalWallis {
    /// The statistic H, corrected for ties.
    pub h: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// The p-value by the χ² approximation.
    pub p: f64,
}

/// A two-sided Mann–Whitney U test.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MannWhitney {
    /// The statistic U of the other method.
    pub u: f64,
    /// The p-value.
    pub p: f64,
    /// The p-value after Holm's correction.
    pub p_holm: f64,
    /// Whether the corrected p-value is below the level.
    pub significant: bool,
}

/// A promise of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Guarantee {
    /// Γ(o) holds at least one true owner.
    AnyOwner,
    /// Γ(o) holds all true owners.
    AllOwners,
    /// The label-set prediction set holds the true owner set.
    OwnerSet,
    /// A thing is settled without a question *and* wrong (at most this often): what risk control promises of the
    /// state before the first question.
    SettledWrong,
    /// A thing is wrong when everything that was worth a question to the risk gate has been asked (at most this often).
    WrongInTheEnd,
    /// The same where one answer in twenty is wrong.
    WrongDespiteErrors,
    /// The same with the adaptive gate, where every answer is right.
    WrongAdapted,
    /// The same with the adaptive gate, where one answer in twenty is wrong.
    WrongAdaptedDespiteErrors,
}

impl Guarantee {
    /// Whether it is about what is wrong, which is promised to be rare, and not about what is right.
    pub fn is_loss(self) -> bool {
        match self {
            Self::AnyOwner | Self::AllOwners | Self::OwnerSet => false,
            Self::SettledWrong
            | Self::WrongInTheEnd
            | Self::WrongDespiteErrors
            | Self::WrongAdapted
            | Self::WrongAdaptedDespiteErrors => true,
        }
    }
}

/// How often a promise was kept on households that were used for nothing else.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coverage {
    /// The kind of home.
    pub protocol: String,
    /// What was promised.
    pub guarantee: Guarantee,
    /// The promised share: at least this for a prediction set, at most this for what is wrong.
    pub promised: f64,
    /// How many households were judged.
    pub households: usize,
    /// How many things they hold.
    pub things: usize,
    /// For how many of them it was so.
    pub count: usize,
    /// `count` in `things`.
    pub share: f64,
    /// Lower end of the exact binomial (Clopper–Pearson) 95 % interval of the share.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// The mean share over random splits of all homes of this kind into homes that thresholds are made from and homes
    /// that are judged. A promise is one about this mean; a single set of calibration homes may lie beside it. Only
    /// where the homes that were calibrated on are of the same kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub over_splits: Option<f64>,
    /// How many questions a home took, where it is about the state after them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub questions: Option<f64>,
}
