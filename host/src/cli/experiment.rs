//! What `host experiment` takes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use coin_schemas::experiment::Method;

use super::ModelArguments;
use crate::generate::Protocol;

/// Arguments of `host experiment`.
#[derive(Debug, Args)]
#[command(after_help = EXPERIMENT_EXAMPLES)]
pub struct ExperimentArguments {
    /// Folders of the episodes to judge, with a truth file each
    #[arg(long, value_name = "DIR", required = true, num_args = 1..)]
    pub episode: Vec<PathBuf>,
    /// Folders of other episodes to calibrate on, for every gate and ablation by itself [default: the calibrations that
    /// come with the model]
    #[arg(long, value_name = "DIR", num_args = 1..)]
    pub calibrate_on: Vec<PathBuf>,
    /// What to compare [default: everything]
    #[arg(long, value_enum, value_name = "METHOD", value_delimiter = ',', num_args = 1..)]
    pub methods: Vec<MethodArgument>,
    /// How often each method goes through each episode
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..))]
    pub trials: u64,
    /// The seed of the first trial; the same seed gives the same figures, times aside
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Homes of these kinds on which the guarantees are measured
    #[arg(long, value_enum, value_name = "PROTOCOL", value_delimiter = ',', num_args = 1.., default_value = "week")]
    pub coverage_protocols: Vec<Protocol>,
    /// How many homes of each kind; 0 measures nothing
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub coverage_homes: usize,
    /// Kinds of fresh homes, twelve of each, on which each term of the evidence model is left out
    #[arg(long, value_enum, value_name = "PROTOCOL", value_delimiter = ',', num_args = 1..)]
    pub terms: Vec<Protocol>,
    /// Write results.json, tables.md, figures and index.html to this folder
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Which model, and how it is used.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Say nothing while working
    #[arg(long)]
    pub quiet: bool,
}

const EXPERIMENT_EXAMPLES: &str = "\
Examples:
  host experiment --episode fixtures/episodes/small-house --out RESULTS
      All nine methods, ten trials; open RESULTS/index.html afterwards.
  host experiment --episode HOME1 HOME2 --methods coin,coin_paper,frequency --trials 3 --coverage-homes 0 --out RESULTS
      Some methods on homes of your own.
  host experiment --episode HOME --methods coin --trials 1 --coverage-homes 0 --terms borrowing office --out RESULTS
      What every term of the evidence is worth on fresh homes of two kinds, and the curve beside the oracle.";

/// A method as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum MethodArgument {
    /// COIN with conformal risk control
    Coin,
    /// COIN with the paper's gate and scheme of inference
    CoinPaper,
    /// Active Ownership Learning
    Actowl,
    /// The model with the map alone
    NlmapLlm,
    /// Who used it last
    LastUser,
    /// Who used it most often
    Frequency,
    /// COIN that may not ask
    NoQuestions,
    /// COIN without roles and occupations
    NoBackground,
    /// COIN without usage
    NoUsage,
}

impl From<MethodArgument> for Method {
    fn from(argument: MethodArgument) -> Self {
        match argument {
            MethodArgument::Coin => Self::Coin,
            MethodArgument::CoinPaper => Self::CoinPaper,
            MethodArgument::Actowl => Self::Actowl,
            MethodArgument::NlmapLlm => Self::NlmapLlm,
            MethodArgument::LastUser => Self::LastUser,
            MethodArgument::Frequency => Self::Frequency,
            MethodArgument::NoQuestions => Self::NoQuestions,
            MethodArgument::NoBackground => Self::NoBackground,
            MethodArgument::NoUsage => Self::NoUsage,
        }
    }
}
