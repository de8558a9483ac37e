//! The command line: what may be typed, and what it means.

mod experiment;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use coin::calibration::{EMBEDDED_MODEL, Levels};
use coin::conformal::{InvalidLevel, Level};
use coin_schemas::calibration::{History, NonconformityScore};
use coin_schemas::report::{ContextSource, Estimator, Gate, Reinference, Scoring, Withheld};

pub use experiment::{ExperimentArguments, MethodArgument};

use crate::client::ServerAddress;
use crate::generate::{GenerateArguments, HomerArguments};
use crate::model::choice::ModelChoice;
use crate::model::metered::TokenBudget;
use crate::person::{Answers, ErrorRate};
use crate::run::{CONCURRENCY, default_scoring};

const EXAMPLES: &str = "\
Examples:
  host --episode fixtures/episodes/small-house
      Run a week of a home with a simulated person; no key, no service.
  host --episode HOME --html home.html
      A page with a plan of the home; it opens from disk.
  host --episode HOME --answers terminal --db home.db
      Answer yourself, and keep what was learnt.
  host --episode HOME --db home.db --answers terminal --resume
      Go on where you stopped.
  OPENAI_API_KEY=… host --episode HOME --model openai:gpt-4o-2024-11-20 --db home.db
      With a language model; OPENAI_BASE_URL names another server, such as Ollama's.
  host --episode HOME --json > report.json
      The report, and it alone, on standard output.
  host --episode HOME --server 'coin-server --db home.db'
      Use a server in its own process.
  host generate routine --protocol week --seed 7 --out HOME
      Make a household of your own.
  host experiment --episode fixtures/episodes/small-house --out RESULTS
      The paper's comparison, with tables and figures.

Exit status: 0 done; 1 failed; 2 wrong use or a refused file.";

/// Whose is this? Infers who owns the things of a home, and asks a person only when that is worth a question
#[derive(Debug, Parser)]
#[command(name = "host", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct CommandLine {
    /// What to do instead of running an episode.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// What to run.
    #[command(flatten)]
    pub run: RunArguments,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute thresholds on homes with known owners, for use on other homes
    Calibrate(CalibrateArguments),
    /// Find the thing that a person means, or ask back
    Ask(crate::ask::AskArguments),
    /// Compare COIN with the paper's baselines and ablations, in figures, tables and pages
    Experiment(ExperimentArguments),
    /// Make households with known owners
    #[command(subcommand)]
    Generate(GenerateCommand),
}

/// What can be generated.
#[derive(Debug, Subcommand)]
pub enum GenerateCommand {
    /// Households that live by our own routines
    Routine(GenerateArguments),
    /// Households that live by schedules sampled from the HOMER data set
    Homer(HomerArguments),
}

/// Arguments of `host --episode`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Folder of the episode (episode.json and the files that it names)
    #[arg(long, value_name = "DIR", required = true)]
    pub episode: Option<PathBuf>,
    /// Keep the database in this file; answers in it are not asked for again [default: in memory]
    #[arg(long, value_name = "FILE")]
    pub db: Option<PathBuf>,
    /// Go on where the last run with this --db ended, also after a crash: nothing is asked or paid for twice
    #[arg(long, requires = "db")]
    pub resume: bool,
    /// Where the tool server is: in-process, a command, or a URL
    #[arg(long, value_name = "in-process|CMD|URL", default_value = "in-process")]
    pub server: ServerAddress,
    /// Which model, and how it is used.
    #[command(flatten)]
    pub model: ModelArguments,
    /// How the scores are made.
    #[command(flatten)]
    pub scoring: ScoringArguments,
    /// Which rule decides what is asked
    #[arg(long, value_enum, default_value_t = GateArgument::Risk)]
    pub gate: GateArgument,
    /// Which share of the things the adaptive gate may leave wrong [default: 0.012]
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    pub risk: Option<Level>,
    /// Thresholds of the model, from `host calibrate` [default: those that come with the embedded model]
    #[arg(long, value_name = "FILE")]
    pub calibration: Option<PathBuf>,
    /// Use a calibration that was made for another model; no guarantee holds then
    #[arg(long, requires = "calibration")]
    pub force_calibration: bool,
    /// Which things are inferred again after an answer
    #[arg(long, value_enum, default_value_t = ReinferenceArgument::AnsweredContext)]
    pub reinference: ReinferenceArgument,
    /// Keep something from the model, to see what it is worth; may be given twice
    #[arg(long, value_enum, value_name = "WHAT")]
    pub without: Vec<WithheldArgument>,
    /// Who answers: simulated, terminal, or a file of answers (JSON Lines)
    #[arg(long, value_name = "simulated|terminal|FILE", default_value = "simulated")]
    pub answers: Answers,
    /// Ask at most this often [default: once for each thing]
    #[arg(long, value_name = "N")]
    pub max_questions: Option<usize>,
    /// Seed of the simulated person
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Let the simulated person be wrong in this share of the answers
    #[arg(long, value_name = "SHARE")]
    pub wrong_answers: Option<ErrorRate>,
    /// Write the report to this file (JSON)
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Write a page to this file: a plan of the home, the dialogue, and the evidence behind every conclusion
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Write what happens to this file as it happens (JSON Lines)
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
    /// Print the report as JSON instead of the tables
    #[arg(long)]
    pub json: bool,
    /// Say nothing while working
    #[arg(long)]
    pub quiet: bool,
}

impl RunArguments {
    /// # Errors
    /// If something is said of a gate or of people that are not there; the text says what goes together.
    pub fn check(&self) -> Result<(), String> {
        if self.risk.is_some() && self.gate != GateArgument::Adaptive {
            return Err("--risk is what the adaptive gate aims at; add --gate adaptive or leave it out (other gates go by \
                        their calibration: host calibrate --risk)"
                .to_owned());
        }
        if self.wrong_answers.is_some() && self.answers != Answers::Simulated {
            return Err("--wrong-answers is about simulated people; leave it out or add --answers simulated"
                .to_owned());
        }
        Ok(())
    }
}

/// Arguments of `host calibrate`.
#[derive(Debug, Args)]
pub struct CalibrateArguments {
    /// Folders of episodes with a truth file; homes that will be judged do not belong here
    #[arg(long, value_name = "DIR", required = true, num_args = 1..)]
    pub episode: Vec<PathBuf>,
    /// Write the calibration to this file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// How often a prediction set may miss
    #[arg(long, value_name = "LEVEL", default_value = DEFAULT_ALPHA, value_parser = level)]
    pub alpha: Level,
    /// Level of the paper's stopping threshold
    #[arg(long, value_name = "LEVEL", default_value = DEFAULT_ALPHA_CP, value_parser = level)]
    pub alpha_cp: Level,
    /// Share of wrong owner sets that is tolerated in the end
    #[arg(long, value_name = "LEVEL", default_value = DEFAULT_RISK, value_parser = level)]
    pub risk: Level,
    /// What a prediction set is to hold: at least one true owner (the paper's score), or all of them
    #[arg(long, value_enum, default_value_t = ScoreArgument::AllOwners)]
    pub score: ScoreArgument,
    /// Which part of the homes' history the model sees: all, or the days up to each episode's train_until. The
    /// paper calibrates on the first days of the home that it judges; the thresholds then know the very things
    /// that they are applied to, and no guarantee follows from them
    #[arg(long, value_enum, default_value_t = HistoryArgument::Whole)]
    pub history: HistoryArgument,
    /// Keep something from the model; the thresholds are for runs that keep the same from it
    #[arg(long, value_enum, value_name = "WHAT")]
    pub without: Vec<WithheldArgument>,
    /// Which model, and how it is used.
    #[command(flatten)]
    pub model: ModelArguments,
    /// How the scores are made.
    #[command(flatten)]
    pub scoring: ScoringArguments,
    /// Say nothing while working
    #[arg(long)]
    pub quiet: bool,
}

impl CalibrateArguments {
    /// The three levels.
    pub fn levels(&self) -> Levels {
        Levels { alpha: self.alpha, alpha_cp: self.alpha_cp, risk: self.risk }
    }
}

/// The paper's α and α_cp, and the share of wrong owner sets that it ends with.
const DEFAULT_ALPHA: &str = "0.2";
const DEFAULT_ALPHA_CP: &str = "0.05";
const DEFAULT_RISK: &str = "0.012";

/// The levels that are calibrated for where nobody says otherwise.
pub fn default_levels() -> Levels {
    let constant = |text| match level(text) {
        Ok(level) => level,
        Err(reason) => unreachable!("a constant of this module is a level: {reason}"),
    };
    Levels {
        alpha: constant(DEFAULT_ALPHA),
        alpha_cp: constant(DEFAULT_ALPHA_CP),
        risk: constant(DEFAULT_RISK),
    }
}

fn level(text: &str) -> Result<Level, String> {
    let value: f64 = text.parse().map_err(|_| format!("{text:?} is not a number"))?;
    Level::new(value).map_err(|error: InvalidLevel| error.to_string())
}

/// Which model runs, and how it is used.
#[derive(Debug, Args)]
pub struct ModelArguments {
    /// The model that scores, words and reads: embedded, openai:NAME (any server that speaks Chat Completions, at
    /// OPENAI_BASE_URL), anthropic:NAME, or replay:FILE
    #[arg(long, value_name = "MODEL", default_value = EMBEDDED_MODEL)]
    pub model: ModelChoice,
    /// How many conversations go on at once; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = CONCURRENCY, value_parser = at_least_one)]
    pub concurrency: usize,
    /// How long a provider may take for one request, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 120, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub timeout: u64,
    /// Spend at most so many tokens; what is left then is judged without the model [default: no limit]
    #[arg(long, value_name = "TOKENS")]
    pub budget: Option<TokenBudget>,
    /// Keep the replies of a language model in this file and take them from there, also after a crash [default: beside
    /// --db, where that is given]
    #[arg(long, value_name = "FILE")]
    pub cache: Option<PathBuf>,
    /// Write every exchange with the model to this file, to run it again with --model replay:FILE
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
}

/// How the scores of things are made.
#[derive(Debug, Args)]
pub struct ScoringArguments {
    /// What the scores are made from [default: fused with a language model, model with the embedded one]
    #[arg(long, value_enum, value_name = "ESTIMATOR")]
    pub estimator: Option<EstimatorArgument>,
    /// How the model comes by what it judges from
    #[arg(long, value_enum, default_value_t = ContextArgument::Tools)]
    pub context: ContextArgument,
    /// How many things the model scores in one call; more than one needs --context given
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_least_one)]
    pub batch: usize,
}

impl ScoringArguments {
    /// How scores are made with a model of this name.
    ///
    /// # Errors
    /// If the arguments do not go together; the text says what does.
    pub fn scoring(&self, model: &str) -> Result<Scoring, String> {
        let estimator = self.estimator.map_or(default_scoring(model).estimator, Into::into);
        let scoring = Scoring { estimator, context: self.context.into(), batch: self.batch };
        if model == EMBEDDED_MODEL && estimator == Estimator::Fused {
            return Err(format!(
                "--estimator fused joins a language model with the evidence model, and {EMBEDDED_MODEL} is the evidence \
                 model; leave it out or name a language model with --model"
            ));
        }
        if self.batch > 1 && scoring.context != ContextSource::Given {
            return Err(format!(
                "--batch {} scores several things from what stands in one prompt; add --context given",
                self.batch
            ));
        }
        Ok(scoring)
    }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("give a whole number from 1".to_owned()),
        Ok(number) => Ok(number),
    }
}

/// What scores are made from, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EstimatorArgument {
    /// The model alone, which sees the whole context (the paper's scheme)
    Model,
    /// The evidence model alone; the language model words questions and reads answers
    Evidence,
    /// One posterior: the model's common sense about class, people and place, and the evidence of the usage
    Fused,
}

impl From<EstimatorArgument> for Estimator {
    fn from(argument: EstimatorArgument) -> Self {
        match argument {
            EstimatorArgument::Model => Self::Model,
            EstimatorArgument::Evidence => Self::Evidence,
            EstimatorArgument::Fused => Self::Fused,
        }
    }
}

/// How a model comes by its context, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ContextArgument {
    /// It calls tools
    Tools,
    /// It finds everything in the prompt, which takes one call a thing
    Given,
}

impl From<ContextArgument> for ContextSource {
    fn from(argument: ContextArgument) -> Self {
        match argument {
            ContextArgument::Tools => Self::Tools,
            ContextArgument::Given => Self::Given,
        }
    }
}

/// A gate as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GateArgument {
    /// Keep the share of wrong owner sets under the calibrated risk (conformal risk control)
    Risk,
    /// The same with a threshold that the answers move: it keeps the share also in homes unlike those calibrated on
    Adaptive,
    /// Ask where more than one owner set is plausible (conformal prediction over owner sets)
    Set,
    /// The paper's: cp_s against q_cp
    Paper,
    /// Ask about everything
    Always,
    /// Ask nothing
    Never,
}

impl From<GateArgument> for Gate {
    fn from(argument: GateArgument) -> Self {
        match argument {
            GateArgument::Risk => Self::Risk,
            GateArgument::Adaptive => Self::Adaptive,
            GateArgument::Set => Self::Set,
            GateArgument::Paper => Self::Paper,
            GateArgument::Always => Self::Always,
            GateArgument::Never => Self::Never,
        }
    }
}

/// A nonconformity score as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ScoreArgument {
    /// At least one true owner
    AnyOwner,
    /// All true owners
    AllOwners,
}

impl From<ScoreArgument> for NonconformityScore {
    fn from(argument: ScoreArgument) -> Self {
        match argument {
            ScoreArgument::AnyOwner => Self::AnyOwner,
            ScoreArgument::AllOwners => Self::AllOwners,
        }
    }
}

/// Which things are inferred again after an answer, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ReinferenceArgument {
    /// Those that lie near or look like the thing that was answered
    AnsweredContext,
    /// Every thing that nobody was asked about (the paper's scheme)
    EveryUnasked,
}

impl From<ReinferenceArgument> for Reinference {
    fn from(argument: ReinferenceArgument) -> Self {
        match argument {
            ReinferenceArgument::AnsweredContext => Self::AnsweredContext,
            ReinferenceArgument::EveryUnasked => Self::EveryUnasked,
        }
    }
}

/// What is kept from the model, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum WithheldArgument {
    /// The people's roles and occupations
    Background,
    /// Who used what
    Usage,
}

impl From<WithheldArgument> for Withheld {
    fn from(argument: WithheldArgument) -> Self {
        match argument {
            WithheldArgument::Background => Self::Background,
            WithheldArgument::Usage => Self::Usage,
        }
    }
}

/// Which part of a history is seen, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum HistoryArgument {
    /// All of it
    Whole,
    /// The days up to train_until
    TrainingDays,
}

impl From<HistoryArgument> for History {
    fn from(argument: HistoryArgument) -> Self {
        match argument {
            HistoryArgument::Whole => Self::Whole,
            HistoryArgument::TrainingDays => Self::TrainingDays,
        }
    }
}
