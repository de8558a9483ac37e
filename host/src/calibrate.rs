//! `host calibrate`: thresholds from other homes than those that will be judged, and the file that keeps them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use coin::agent::{AgentSettings, Reinference};
use coin::calibration::{CalibrationError, CalibrationSample, Levels, Thresholds, calibrate};
use coin::sharing::ShareThresholds;
use coin_schemas::calibration::{Calibration, NonconformityScore};
use coin_schemas::report::Gate;
use thiserror::Error;

use crate::client::ServerAddress;
use crate::driver::Observer;
use crate::home::{self, Home};
use crate::model::ChatModel;
use crate::person::{Person, PersonError, PersonKind, PutQuestion, Response};
use crate::report::true_owners;
use crate::run::{RunError, drive};

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
         make one with `host calibrate --model {model} --episode DIR… --out FILE`"
    )]
    OtherModel {
        /// Whose it is.
        made_for: String,
        /// Which model runs.
        model: String,
    },
    /// The program's own calibration is damaged, which is a fault of this program.
    #[error("the built-in calibration cannot be read: {0}; please report this")]
    BuiltIn(serde_json::Error),
}

/// Reads a calibration file and checks its numbers.
pub fn read_calibration(path: &Path) -> Result<Calibration, CalibrationFileError> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| CalibrationFileError::Read { path: path.to_owned(), source })?;
    let calibration: Calibration = serde_json::from_str(&text)
        .map_err(|source| CalibrationFileError::Form { path: path.to_owned(), source })?;
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
    /// The episodes give no sample.
    #[error(transparent)]
    Samples(#[from] CalibrationError),
}

impl CalibrateError {
    /// Whether what was given is at fault.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Episode { source, .. } => source.is_refusal(),
            Self::Twice { .. } | Self::Samples(_) => true,
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
}

/// Lets the model score every thing of every home, without a question, and computes the thresholds.
pub async fn calibrate_on(
    settings: &CalibrateSettings,
    model: &dyn ChatModel,
    observer: &mut dyn Observer,
) -> Result<Calibration, CalibrateError> {
    let mut samples = Vec::new();
    let mut seen = BTreeSet::new();
    for episode in &settings.episodes {
        if !seen.insert(episode.canonicalize().unwrap_or_else(|_| episode.clone())) {
            return Err(CalibrateError::Twice { episode: episode.clone() });
        }
        let scored = score_home(episode, model, observer).await;
        samples.extend(scored.map_err(|source| CalibrateError::Episode {
            episode: episode.clone(),
            source: Box::new(source),
        })?);
    }
    Ok(calibrate(model.name(), &samples, seen.len(), settings.levels, settings.score)?)
}

async fn score_home(
    folder: &Path,
    model: &dyn ChatModel,
    observer: &mut dyn Observer,
) -> Result<Vec<CalibrationSample>, RunError> {
    let loaded = home::load(folder).await?;
    let truth = coin_server::episode::load_truth(folder, &loaded.episode)?
        .ok_or_else(|| RunError::NoTruth { episode: loaded.episode.name.clone() })?;
    let home = Home::open(loaded, None, &ServerAddress::InProcess).await?;
    let owners = true_owners(&truth, &home.roster)?;
    let agent_settings = AgentSettings {
        gate: Gate::Never,
        thresholds: Thresholds::Uncalibrated,
        share: ShareThresholds::default(),
        max_questions: 0,
        reinference: Reinference::AnsweredContext,
    };
    let (outcome, _) = drive(&home, agent_settings, model, &mut Nobody, observer).await?;
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
    home.server.close().await;
    Ok(samples)
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
