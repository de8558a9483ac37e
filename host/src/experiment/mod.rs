//! `host experiment`: the paper's Sections 5 and 6. Methods × episodes × trials, in parallel, and what came of them
//! in figures, tables and pages.

mod actowl;
mod coverage;
mod kinds;
mod methods;
mod published;
mod summary;
mod tables;
#[cfg(test)]
mod tests;
mod write;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use coin::calibration::{CalibrationError, EMBEDDED_MODEL, Levels, embedded_calibration};
use coin::owners::OwnerSet;
use coin::statistics::mean_and_deviation;
use coin_schemas::calibration::{Calibration, History, NonconformityScore};
use coin_schemas::episode::Truth;
use coin_schemas::experiment::{ExperimentResults, Method};
use coin_schemas::household::ObjectId;
use coin_server::episode::{EpisodeError, LoadedEpisode};
use thiserror::Error;

use crate::calibrate::{CalibrateError, CalibrateSettings, CalibrationFileError, calibrate_on};
use crate::generate::{self, Protocol};
use crate::home::{self, HomeError};
use crate::model::ChatModel;
use crate::model::metered::Metered;
use crate::parallel;
use crate::run::{RunError, default_scoring};
use methods::CalibrationKind;

pub use tables::{summary, tables};
pub use write::{WriteError, check_folder, write};

/// The Subset Accuracy whose reaching the Kaplan–Meier curves show.
pub const TARGET_ACCURACY: f64 = 0.95;

/// The level of the tests, the paper's.
pub const SIGNIFICANCE: f64 = 0.05;

/// What to compare, on what.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentSettings {
    /// Folders of the episodes to judge, with a truth file each.
    pub episodes: Vec<PathBuf>,
    /// Folders of other episodes to calibrate every variant of the model on; empty takes the calibrations that come
    /// with the model.
    pub calibrate_on: Vec<PathBuf>,
    /// The levels of that calibration.
    pub levels: Levels,
    /// The methods.
    pub methods: BTreeSet<Method>,
    /// How often each method goes through each episode.
    pub trials: usize,
    /// The seed of the first trial.
    pub seed: u64,
    /// How many conversations go on at once in each home.
    pub concurrency: usize,
    /// On which homes the guarantees are measured.
    pub coverage: Vec<CoverageHomes>,
    /// On which homes every term of the evidence model is left out.
    pub kinds: Vec<CoverageHomes>,
}

/// Homes that are made to measure how often the guarantees hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoverageHomes {
    /// Their kind.
    pub protocol: Protocol,
    /// How many.
    pub households: usize,
}

/// Why an experiment came to nothing.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// An episode is refused.
    #[error("{}: {source}", episode.display())]
    Episode {
        /// Its folder.
        episode: PathBuf,
        /// Why.
        source: Box<RunError>,
    },
    /// An episode is given twice, or judged and calibrated on.
    #[error("{} is given twice; a home is judged once, and never by thresholds that were made from it", episode.display())]
    Twice {
        /// Its folder.
        episode: PathBuf,
    },
    /// The calibration failed.
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    /// The built-in calibration is damaged.
    #[error(transparent)]
    Calibration(#[from] CalibrationFileError),
    /// There is no place for the homes on which the guarantees are measured.
    #[error("the homes on which the guarantees are measured cannot be made: {0}")]
    Folder(#[from] std::io::Error),
    /// Nor can they be written.
    #[error("the homes on which the guarantees are measured cannot be made: {0}")]
    Write(#[from] generate::WriteError),
    /// They cannot be calibrated on.
    #[error(transparent)]
    Samples(#[from] CalibrationError),
}

impl ExperimentError {
    /// Whether what was given is at fault.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Episode { source, .. } => source.is_refusal(),
            Self::Calibrate(error) => error.is_refusal(),
            Self::Twice { .. } => true,
            Self::Calibration(_) | Self::Folder(_) | Self::Write(_) | Self::Samples(_) => false,
        }
    }
}

/// What an experiment tells while it works.
pub trait Progress {
    /// A part of the work begins, of so many pieces.
    fn begin(&mut self, pieces: usize, what: &'static str);
    /// One piece is done.
    fn step(&mut self);
    /// The part is done.
    fn end(&mut self);
}

/// A home that is judged: what everybody may see, and the truth that only the person and the scorer see.
#[derive(Debug, Clone)]
struct JudgedHome {
    folder: PathBuf,
    loaded: LoadedEpisode,
    truth: Truth,
}

/// The thresholds of the model as it is, with the paper's score, and of its ablations.
type Calibrations = BTreeMap<CalibrationKind, Option<Calibration>>;

/// Carries an experiment through.
pub async fn run(
    settings: &ExperimentSettings,
    model: Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<ExperimentResults, ExperimentError> {
    let homes = load(settings).await?;
    let model: Arc<dyn ChatModel> = Arc::new(Metered::new(model));
    let calibrations = Arc::new(calibrations(settings, &model, progress).await?);

    let mut jobs = Vec::new();
    for home in &homes {
        for trial in 0..settings.trials {
            for &method in &settings.methods {
                let (home, model, concurrency) = (Arc::clone(home), Arc::clone(&model), settings.concurrency);
                let calibrations = Arc::clone(&calibrations);
                let seed = settings.seed.wrapping_add(trial as u64);
                jobs.push(async move {
                    let outcome =
                        methods::run(method, &home, model.as_ref(), &calibrations, concurrency, seed)
                            .await
                            .map_err(|source| ExperimentError::Episode {
                            episode: home.folder.clone(),
                            source: Box::new(source),
                        })?;
                    Ok::<_, ExperimentError>(summary::Run {
                        method,
                        scored: summary::score(&outcome, trial, &home),
                    })
                });
            }
        }
    }
    progress.begin(jobs.len(), "runs");
    let runs = parallel::in_order(jobs, || progress.step()).await?;
    progress.end();

    let coverage = coverage::measure(settings, &model, progress).await?;
    let kinds = kinds::measure(settings, &model, &calibrations, progress).await?;
    let calibration = calibrations.get(&default_kind(model.name())).cloned().flatten();
    Ok(ExperimentResults {
        episodes: homes.iter().map(|home| home.loaded.episode.name.clone()).collect(),
        trials: settings.trials,
        seed: settings.seed,
        model: model.name().to_owned(),
        calibration,
        methods: summary::by_method(&runs),
        tests: summary::tests(&runs),
        oracle: summary::oracle(&runs),
        target_accuracy: TARGET_ACCURACY,
        coverage,
        kinds,
        created_with: concat!("coin-host ", env!("CARGO_PKG_VERSION")).to_owned(),
    })
}

async fn load(settings: &ExperimentSettings) -> Result<Vec<Arc<JudgedHome>>, ExperimentError> {
    let mut seen = BTreeSet::new();
    for folder in settings.episodes.iter().chain(&settings.calibrate_on) {
        if !seen.insert(folder.canonicalize().unwrap_or_else(|_| folder.clone())) {
            return Err(ExperimentError::Twice { episode: folder.clone() });
        }
    }
    let mut homes = Vec::new();
    for folder in &settings.episodes {
        homes.push(Arc::new(load_home(folder).await?));
    }
    Ok(homes)
}

async fn load_home(folder: &Path) -> Result<JudgedHome, ExperimentError> {
    let refused =
        |source: RunError| ExperimentError::Episode { episode: folder.to_owned(), source: Box::new(source) };
    let loaded = home::load(folder).await.map_err(|error: HomeError| refused(error.into()))?;
    let truth = coin_server::episode::load_truth(folder, &loaded.episode)
        .map_err(|error: EpisodeError| refused(error.into()))?
        .ok_or_else(|| refused(RunError::NoTruth { episode: loaded.episode.name.clone() }))?;
    Ok(JudgedHome { folder: folder.to_owned(), loaded, truth })
}

impl JudgedHome {
    /// The truth as owner sets. The loader has refused owners who are not of the household.
    fn true_owners(&self) -> BTreeMap<&ObjectId, OwnerSet> {
        let owners = self.truth.owners.iter();
        owners
            .filter_map(|(object, owners)| Some((object, self.loaded.roster.owner_set(owners).ok()?)))
            .collect()
    }
}

/// The thresholds of the default gate.
fn default_kind(model: &str) -> CalibrationKind {
    let (withheld, scoring) = (BTreeSet::new(), default_scoring(model));
    CalibrationKind { withheld, score: NonconformityScore::AllOwners, scoring }
}

/// One calibration for each kind that the methods need, so that an ablation is judged by thresholds of its own.
async fn calibrations(
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Calibrations, ExperimentError> {
    let mut kinds: BTreeSet<CalibrationKind> =
        settings.methods.iter().filter_map(|&method| methods::calibration(method, model.name())).collect();
    kinds.insert(default_kind(model.name()));
    if !settings.kinds.is_empty() {
        kinds.extend(methods::calibration(Method::CoinPaper, model.name()));
    }
    let mut calibrations = Calibrations::new();
    for kind in kinds {
        let calibration = match (settings.calibrate_on.is_empty(), model.name()) {
            (true, EMBEDDED_MODEL) => embedded_calibration(kind.scoring, kind.score, &kind.withheld)
                .map_err(CalibrationFileError::BuiltIn)?,
            (true, _) => None,
            (false, _) => {
                progress.begin(settings.calibrate_on.len(), "homes calibrated on");
                let settings = CalibrateSettings {
                    episodes: settings.calibrate_on.clone(),
                    levels: settings.levels,
                    score: kind.score,
                    history: History::Whole,
                    withheld: kind.withheld.clone(),
                    scoring: kind.scoring,
                    concurrency: settings.concurrency,
                };
                let made = calibrate_on(&settings, model, || progress.step()).await?;
                progress.end();
                Some(made)
            }
        };
        calibrations.insert(kind, calibration);
    }
    Ok(calibrations)
}

/// Mean and sample standard deviation.
fn spread(values: &[f64]) -> coin_schemas::experiment::Spread {
    let (mean, sd) = mean_and_deviation(values);
    coin_schemas::experiment::Spread { mean, sd }
}
