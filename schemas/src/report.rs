//! The report of one episode: what was concluded, what was asked, and what it cost.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::calibration::Calibration;
use crate::household::{ClassLabel, ObjectId, Owners, OwnershipBoolean, Scores, Source, UsageType, UserName};

/// The whole report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// The episode's name.
    pub episode: String,
    /// The model that scored, worded and read.
    pub model: String,
    /// The gate that chose the questions.
    pub gate: Gate,
    /// The seed of the simulated person.
    pub seed: u64,
    /// Every other setting that the result depends on.
    pub parameters: Parameters,
    /// The thresholds that were used; `null` where the model has none and no guarantee holds.
    pub calibration: Option<Calibration>,
    /// Where the adaptive gate ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "AdaptedThreshold")]
    pub adapted: Option<AdaptedThreshold>,
    /// How many things are expected to be wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ExpectedWrong")]
    pub expected_wrong: Option<ExpectedWrong>,
    /// Every thing, in the episode's order.
    pub objects: Vec<ObjectReport>,
    /// Every question, in the order asked.
    pub questions: Vec<QuestionReport>,
    /// Accuracy before the first question and after each one; only where the truth is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<CurvePoint>")]
    pub curve: Option<Vec<CurvePoint>>,
    /// The result in figures.
    pub metrics: MetricsReport,
    /// What the run took.
    pub cost: Cost,
    /// Why it ended.
    pub stopped: Stopped,
}

/// How many things are expected to be wrong in the end, by the probabilities that the run goes by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedWrong {
    /// Of those that nobody has answered about: Σ (1 − confidence).
    pub inferred: f64,
    /// Of the others, as one answer in twenty is wrong and what else is known speaks for or against it.
    pub answered: f64,
}

/// What the answers made of the threshold of the adaptive gate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AdaptedThreshold {
    /// From which probability of its best owner set on a thing is settled in the end; absent where nothing is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub lambda: Option<f64>,
    /// How many answers were to differ from what was thought most probable, by how sure one was.
    pub expected_errors: f64,
    /// How many did.
    pub errors: usize,
    /// By what factor errors are held to be more frequent than they seem.
    pub factor: f64,
}

/// Which rule decides what is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gate {
    /// Conformal risk control on the share of wrong owner sets (the default).
    Risk,
    /// The same with a threshold that the answers move, so that the share is kept in a home unlike those calibrated on.
    Adaptive,
    /// Conformal prediction over owner sets: ask where more than one set remains.
    Set,
    /// The paper's: cp_s against q_cp.
    Paper,
    /// Ask about everything.
    Always,
    /// Ask nothing.
    Never,
}

/// What a model is not told, so that its worth can be measured (the paper's ablations).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Withheld {
    /// The roles and occupations of the people.
    Background,
    /// Who used a thing.
    Usage,
}

/// What the scores of things are made from.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// The model alone, which sees the whole context (the paper's scheme; the embedded model is the evidence model).
    #[default]
    Model,
    /// The evidence model alone; a language model words questions and reads answers.
    Evidence,
    /// One posterior of both: a language model says what common sense makes of the class, the people and the place,
    /// the evidence model what the usage and the answers about other things say.
    Fused,
}

/// How a model comes by what it judges from.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum ContextSource {
    /// It fetches it by tool calls.
    #[default]
    Tools,
    /// It finds it in the prompt.
    Given,
}

/// How the scores of things are made. Thresholds hold for scores that are made in the same way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scoring {
    /// What they are made from.
    pub estimator: Estimator,
    /// How the model comes by what it judges from.
    pub context: ContextSource,
    /// How many things the model scores in one call.
    #[schemars(range(min = 1))]
    pub batch: usize,
}

impl Default for Scoring {
    fn default() -> Self {
        Self { estimator: Estimator::default(), context: ContextSource::default(), batch: 1 }
    }
}

impl Scoring {
    /// Whether scores are made as the paper has it, which files leave unsaid.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Which things are inferred again after an answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reinference {
    /// Those that can see a thing whose owners a person has named since. What a model concluded of a neighbour is no
    /// news: it rests on evidence that was there before, and a guess that sets off the next one is how errors
    /// travel. A thing that no model could score sees nothing and is left to the questions.
    #[default]
    AnsweredContext,
    /// Every thing that nobody was asked about, as the paper's Algorithm 1 has it.
    EveryUnasked,
}

/// The settings that a result depends on, beside model, gate and seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Number of neighbours, K_near.
    pub k_near: usize,
    /// Number of look-alikes, K_sim.
    pub k_sim: usize,
    /// Scale of the Gaussian weight of a neighbour, in metres.
    pub sigma: f64,
    /// Factor on the vertical axis.
    pub gamma: f64,
    /// How far back usage counts, in days.
    pub window_days: u32,
    /// DETECT-SHARE: the least score of a shared owner, ε_min.
    pub epsilon_min: f64,
    /// DETECT-SHARE: the largest spread among shared owners, ε_in.
    pub epsilon_in: f64,
    /// DETECT-SHARE: the least gap to the others, ε_out.
    pub epsilon_out: f64,
    /// The largest number of questions, Q_max.
    pub max_questions: usize,
    /// What the adaptive gate lets be wrong in the end: a share of all things.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub risk: Option<f64>,
    /// Which things are inferred again after an answer.
    #[serde(default)]
    pub reinference: Reinference,
    /// What the model was not told.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub withheld: BTreeSet<Withheld>,
    /// How the scores were made.
    #[serde(default, skip_serializing_if = "Scoring::is_default")]
    pub scoring: Scoring,
    /// Who answered: `simulated`, `terminal` or `scripted`.
    pub answers: String,
    /// Which share of the simulated person's answers was wrong on purpose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrong_answers: Option<f64>,
}

/// What is concluded about one thing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectReport {
    /// The thing.
    pub id: ObjectId,
    /// Its class label.
    pub class: ClassLabel,
    /// The score of every member of the household.
    pub scores: Scores,
    /// The owners; empty where somebody outside the household owns it.
    pub owners: Owners,
    /// Whether a person said so or a model concluded it.
    pub source: Source,
    /// The plausible owners Γ(o).
    pub prediction_set: Owners,
    /// The paper's uncertainty cp_s(o).
    pub uncertainty: f64,
    /// The probability of the best owner set; 1 where a person answered.
    pub confidence: f64,
    /// Whether DETECT-SHARE holds the thing to be shared.
    pub shared: bool,
    /// The two parts that the scores were fused from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ScoreParts")]
    pub parts: Option<ScoreParts>,
    /// The model failed on this thing or had to be corrected, and this is what was done about it. A confidence of 0 says
    /// that nothing else could score the thing either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub problem: Option<String>,
    /// The true owners, where known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Owners")]
    pub truth: Option<Owners>,
}

/// What each part of a fused score says by itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScoreParts {
    /// What the language model makes of the class, the people and the place; absent where it failed, or was not asked
    /// because no opinion could have unsettled what the evidence says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Scores")]
    pub model: Option<Scores>,
    /// What the evidence model makes of the usage and of the answers about other things.
    pub evidence: Scores,
}

/// What became of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AnswerStatus {
    /// It settled whose the thing is.
    Answered,
    /// It did not; somebody else may be asked.
    Unresolved,
}

/// One question and its answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuestionReport {
    /// The number of the question, from 1.
    pub step: usize,
    /// The thing that it is about.
    pub object_id: ObjectId,
    /// Other things that it is about as well.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<ObjectId>,
    /// The question as it was put.
    pub question: String,
    /// The answer as it was given.
    pub answer: String,
    /// Who gave it, where known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "UserName")]
    pub answered_by: Option<UserName>,
    /// How the answer was read.
    pub ownership: OwnershipBoolean,
    /// What became of it.
    pub status: AnswerStatus,
    /// cp_s before the question.
    pub uncertainty_before: f64,
    /// Γ before the question.
    pub prediction_set_before: Owners,
}

impl QuestionReport {
    /// All things that the question is about.
    pub fn objects(&self) -> impl Iterator<Item = &ObjectId> {
        std::iter::once(&self.object_id).chain(&self.also)
    }

    /// Whether the question is about a thing, alone or among others.
    pub fn is_about(&self, object: &ObjectId) -> bool {
        self.objects().any(|other| other == object)
    }
}

/// Accuracy after a number of questions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurvePoint {
    /// Questions so far.
    pub step: usize,
    /// Share of things whose owner set is exactly right.
    pub subset_accuracy: f64,
    /// Mean overlap of owner sets.
    pub mean_jaccard: f64,
    /// Micro-averaged F1 over owner labels.
    pub micro_f1: f64,
}

/// The paper's metrics (Appendix E) over a set of things.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MetricsSummary {
    /// How many things were judged.
    pub objects: usize,
    /// Share of things whose owner set is exactly right.
    pub subset_accuracy: f64,
    /// Mean overlap of owner sets; two empty sets overlap fully.
    pub mean_jaccard: f64,
    /// Right owner labels among those given; 0 where none was given.
    pub micro_precision: f64,
    /// Right owner labels among the true ones; 0 where there is none.
    pub micro_recall: f64,
    /// Harmonic mean of the two; 0 where both are 0.
    pub micro_f1: f64,
}

/// The result in figures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MetricsReport {
    /// Over all things; only where the truth is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "MetricsSummary")]
    pub overall: Option<MetricsSummary>,
    /// By usage type; only where the truth says it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "BTreeMap<UsageType, MetricsSummary>")]
    pub by_usage_type: Option<BTreeMap<UsageType, MetricsSummary>>,
    /// How many questions were asked.
    pub questions: usize,
}

/// What a run took.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Requests to the model.
    pub model_calls: u64,
    /// Tool calls that the model made.
    pub tool_calls: u64,
    /// Replies that were taken from the cache in place of a request.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub remembered_replies: u64,
    /// Tokens sent to a language model; the embedded model uses none.
    pub prompt_tokens: u64,
    /// Tokens received from a language model; the embedded model uses none.
    pub completion_tokens: u64,
    /// Wall-clock time, in seconds. The one field that differs between equal runs.
    pub seconds: f64,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Stopped {
    /// The gate finds everything settled.
    Confident,
    /// Q_max questions were asked.
    MaxQuestions,
    /// Something is unsettled, but nobody can or will say more about it.
    NothingLeftToAsk,
    /// The tokens that could be spent were spent.
    Budget,
    /// The person who answers ended it for now, or the program was told to stop.
    Interrupted,
}
