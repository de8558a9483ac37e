//! `host calibrate`: thresholds from other homes than those that will be judged, and the file that keeps them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use coin::agent::{AgentSettings, QuestionChoice, Reinference};
use coin::calibration::{
    CalibrationError, CalibrationSample, EMBEDDED_MODEL, EMBEDDED_SCORING, Levels, Provenance, Thresholds,
    calibrate,
};
use coin::evidence::EvidenceParameters;
use coin::sharing::ShareThresholds;
use coin_schemas::calibration::{CALIBRATION_VERSION, Calibration, History, NonconformityScore};
use coin_schemas::episode::Truth;
use coin_schemas::report::{ContextSource, Estimator, Gate, Scoring, Stopped, Withheld};
use coin_server::episode::LoadedEpisode;
use thiserror::Error;

use crate::cli::default_levels;
use crate::client::ServerAddress;
use crate::course::{Course, drive};
use crate::driver::Unobserved;
use crate::home::{self, Home};
use crate::model::ChatModel;
use crate::parallel;
use crate::person::{Person, PersonError, PersonKind, PutQuestion, Response};
use crate::report::true_owners;
use crate::run::RunError;

/// Why a calibration file is refused.
#[derive(Debug, Error)]
pub enum CalibrationFileError {
    /// It cannot be read.
    #[error("cannot read the calibration {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// It is no calibration.
    #[error("{} is no calibration file: {source}; `host calibrate` writes one", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        source: serde_json::Error,
    },
    /// A number in it cannot be.
    #[error("{} is no calibration file: {field} is {given}, expected {expected}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The field.
        field: &'static str,
        /// What stands there.
        given: f64,
        /// What may stand there.
        expected: &'static str,
    },
    /// It was made for another model.
    #[error(
        "the calibration was made for the model {made_for:?}, not for {model:?}, whose scores mean something else; \
         make one with `host calibrate --model {model} --episode DIR… --out FILE`, or use it all the same with \
         --force-calibration"
    )]
    OtherModel {
        /// Whose it is.
        made_for: String,
        /// Which model runs.
        model: String,
    },
    /// It was made while the model knew more or less than it does now.
    #[error(
        "the calibration was made with {} and the run is with {}, so the scores mean something else; make one with \
         `host calibrate` and the same --without, or use it all the same with --force-calibration",
        told(calibration),
        told(run)
    )]
    ToldOtherwise {
        /// What was withheld then.
        calibration: BTreeSet<Withheld>,
        /// What is withheld now.
        run: BTreeSet<Withheld>,
    },
    /// It was made from scores of another kind.
    #[error(
        "the calibration was made with {} and the run scores with {}, which mean something else; make one with \
         `host calibrate` and the same --estimator, --context and --batch, or use it all the same with \
         --force-calibration",
        in_words(calibration),
        in_words(run)
    )]
    ScoredOtherwise {
        /// How the scores were made then.
        calibration: Scoring,
        /// How they are made now.
        run: Scoring,
    },
    /// It was written by a later program.
    #[error(
        "{} has version {given} of the form, and this program reads version {CALIBRATION_VERSION}; \
         make it again with `host calibrate`",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        given: u32,
    },
    /// The program's own calibration is damaged, which is a fault of this program.
    #[error("the built-in calibration cannot be read: {0}; please report this")]
    BuiltIn(serde_json::Error),
}

fn told(withheld: &BTreeSet<Withheld>) -> &'static str {
    match (withheld.contains(&Withheld::Background), withheld.contains(&Withheld::Usage)) {
        (false, false) => "nothing withheld",
        (true, false) => "the people's background withheld",
        (false, true) => "usage withheld",
        (true, true) => "background and usage withheld",
    }
}

fn in_words(scoring: &Scoring) -> String {
    let estimator = match scoring.estimator {
        Estimator::Model => "model",
        Estimator::Evidence => "evidence",
        Estimator::Fused => "fused",
    };
    let context = match scoring.context {
        ContextSource::Tools => "tools",
        ContextSource::Given => "given",
    };
    format!("--estimator {estimator} --context {context} --batch {}", scoring.batch)
}

/// Whose scores a run makes, as thresholds have it: those of the evidence model are the embedded model's, whatever
/// language model words the questions.
pub fn scored_by(model: &str, scoring: Scoring) -> (&str, Scoring) {
    match scoring.estimator {
        Estimator::Evidence => (EMBEDDED_MODEL, EMBEDDED_SCORING),
        Estimator::Model | Estimator::Fused => (model, scoring),
    }
}

/// Reads a calibration file and checks its numbers.
pub fn read_calibration(path: &Path) -> Result<Calibration, CalibrationFileError> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| CalibrationFileError::Read { path: path.to_owned(), source })?;
    let calibration: Calibration = serde_json::from_str(&text)
        .map_err(|source| CalibrationFileError::Form { path: path.to_owned(), source })?;
    if calibration.version != CALIBRATION_VERSION {
        return Err(CalibrationFileError::Version { path: path.to_owned(), given: calibration.version });
    }
    let Calibration { alpha, alpha_cp, risk, q_alpha, q_cp, q_set, lambda, .. } = calibration;
    for (field, given) in [("alpha", alpha), ("alpha_cp", alpha_cp), ("risk", risk)] {
        if !(given > 0.0 && given < 1.0) {
            let expected = "a level strictly between 0 and 1";
            return Err(CalibrationFileError::Value { path: path.to_owned(), field, given, expected });
        }
    }
    for (field, given) in [("q_alpha", q_alpha), ("q_cp", q_cp), ("q_set", q_set)] {
        if !(0.0..=1.0).contains(&given) {
            let expected = "a threshold between 0 and 1";
            return Err(CalibrationFileError::Value { path: path.to_owned(), field, given, expected });
        }
    }
    if !(lambda.is_finite() && lambda >= 0.0) {
        let expected = "a number of at least 0";
        return Err(CalibrationFileError::Value {
            path: path.to_owned(),
            field: "lambda",
            given: lambda,
            expected,
        });
    }
    Ok(calibration)
}

/// Why there is no calibration.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// An episode could not be run.
    #[error("{}: {source}", episode.display())]
    Episode {
        /// The episode's folder.
        episode: PathBuf,
        /// Why.
        source: Box<RunError>,
    },
    /// The same folder is given twice; its things would count twice.
    #[error("{} is given twice; every home counts once", episode.display())]
    Twice {
        /// The episode's folder.
        episode: PathBuf,
    },
    /// An episode is not split in time.
    #[error(
        "{} has no train_until, so it has no training days; name the moment in its episode.json, or calibrate on whole \
         histories of other homes",
        episode.display()
    )]
    NoTrainingDays {
        /// The episode's folder.
        episode: PathBuf,
    },
    /// The episodes give no sample.
    #[error(transparent)]
    Samples(#[from] CalibrationError),
}

impl CalibrateError {
    /// Whether what was given is at fault.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Episode { source, .. } => source.is_refusal(),
            Self::Twice { .. } | Self::NoTrainingDays { .. } | Self::Samples(_) => true,
        }
    }
}

/// What to calibrate.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrateSettings {
    /// Folders of episodes with a truth file.
    pub episodes: Vec<PathBuf>,
    /// α, α_cp and ε.
    pub levels: Levels,
    /// The nonconformity score of prediction sets over members.
    pub score: NonconformityScore,
    /// Which part of the episodes' history is scored.
    pub history: History,
    /// What the model is not told.
    pub withheld: BTreeSet<Withheld>,
    /// How the scores are made.
    pub scoring: Scoring,
    /// How many conversations go on at once in each home.
    pub concurrency: usize,
}

/// How homes are scored.
#[derive(Debug, Clone, PartialEq)]
pub struct HomeScoring {
    /// Which part of their history the model sees.
    pub history: History,
    /// What it is not told.
    pub withheld: BTreeSet<Withheld>,
    /// How the scores are made.
    pub scoring: Scoring,
    /// The terms of the evidence model.
    pub parameters: EvidenceParameters,
    /// How many conversations go on at once in each home.
    pub concurrency: usize,
}

/// A home whose every thing the model has scored once, without a question.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoredHome {
    /// The episode's name.
    pub name: String,
    /// The things with their scores and true owners, in the order of their ids.
    pub samples: Vec<CalibrationSample>,
}

/// Lets the model score every thing of every home, without a question, and computes the thresholds. `scored` hears
/// of every home that is done.
pub async fn calibrate_on(
    settings: &CalibrateSettings,
    model: &Arc<dyn ChatModel>,
    scored: impl FnMut(),
) -> Result<Calibration, CalibrateError> {
    let scoring = HomeScoring {
        history: settings.history,
        withheld: settings.withheld.clone(),
        scoring: settings.scoring,
        parameters: EvidenceParameters::default(),
        concurrency: settings.concurrency,
    };
    let homes = score_homes(&settings.episodes, &scoring, model, scored).await?;
    let samples: Vec<CalibrationSample> =
        homes.iter().flat_map(|home| home.samples.iter().cloned()).collect();
    let (scored_by, scoring) = scored_by(model.name(), settings.scoring);
    let provenance = Provenance {
        model: scored_by.to_owned(),
        episodes: homes.into_iter().map(|home| home.name).collect(),
        history: settings.history,
        withheld: settings.withheld.clone(),
        scoring,
    };
    Ok(calibrate(provenance, &samples, settings.levels, settings.score)?)
}

/// Lets the model score every thing of every home, in the order given.
pub async fn score_homes(
    episodes: &[PathBuf],
    how: &HomeScoring,
    model: &Arc<dyn ChatModel>,
    scored: impl FnMut(),
) -> Result<Vec<ScoredHome>, CalibrateError> {
    let mut seen = BTreeSet::new();
    for episode in episodes {
        if !seen.insert(episode.canonicalize().unwrap_or_else(|_| episode.clone())) {
            return Err(CalibrateError::Twice { episode: episode.clone() });
        }
    }
    let jobs = episodes.iter().cloned().map(|episode| {
        let (model, how) = (Arc::clone(model), how.clone());
        async move { score_home(&episode, &how, model.as_ref()).await }
    });
    parallel::in_order(jobs, scored).await
}

async fn score_home(
    folder: &Path,
    how: &HomeScoring,
    model: &dyn ChatModel,
) -> Result<ScoredHome, CalibrateError> {
    let refused =
        |source: RunError| CalibrateError::Episode { episode: folder.to_owned(), source: Box::new(source) };
    let mut loaded = home::load(folder).await.map_err(|error| refused(error.into()))?;
    let truth = coin_server::episode::load_truth(folder, &loaded.episode)
        .map_err(|error| refused(error.into()))?
        .ok_or_else(|| refused(RunError::NoTruth { episode: loaded.episode.name.clone() }))?;
    if how.history == History::TrainingDays {
        let until = loaded
            .episode
            .train_until
            .ok_or_else(|| CalibrateError::NoTrainingDays { episode: folder.to_owned() })?;
        loaded = loaded.as_it_stood(until);
    }
    score_loaded(loaded, &truth, how, model).await.map_err(refused)
}

async fn score_loaded(
    loaded: LoadedEpisode,
    truth: &Truth,
    how: &HomeScoring,
    model: &dyn ChatModel,
) -> Result<ScoredHome, RunError> {
    let home = Home::open(loaded, None, &ServerAddress::InProcess).await?;
    let owners = true_owners(truth, &home.roster)?;
    let agent_settings = AgentSettings {
        gate: Gate::Never,
        thresholds: Thresholds::Uncalibrated,
        risk: default_levels().risk,
        share: ShareThresholds::default(),
        max_questions: 0,
        reinference: Reinference::AnsweredContext,
        choice: QuestionChoice::LeastSure,
        answers_per_pass: 1,
    };
    let course = Course::new(agent_settings, how.withheld.clone(), how.scoring, how.concurrency)
        .with_parameters(how.parameters);
    let (outcome, _) = drive(&home, course, model, &mut Nobody, &mut Unobserved).await?;
    if outcome.stopped == Stopped::Budget {
        return Err(RunError::ScoredWithoutTheModel);
    }
    let samples = owners
        .into_iter()
        .filter_map(|(object, owners)| {
            let state = outcome.agent.object(&object)?;
            Some(CalibrationSample {
                scores: state.scores()?.to_vec(),
                distribution: state.distribution()?.clone(),
                owners,
            })
        })
        .collect();
    let name = home.episode.name.clone();
    home.server.close().await;
    Ok(ScoredHome { name, samples })
}

/// Calibration asks nobody.
struct Nobody;

#[async_trait::async_trait]
impl Person for Nobody {
    fn kind(&self) -> PersonKind {
        PersonKind::Scripted
    }

    async fn ask(&mut self, _question: &PutQuestion<'_>) -> Result<Response, PersonError> {
        Ok(Response::NobodyLeft)
    }
}
