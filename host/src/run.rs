//! One episode from its folder to its report.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

use coin::agent::{Agent, AgentSettings, Reinference};
use coin::calibration::{EMBEDDED_MODEL, Thresholds, embedded_calibration, score_of};
use coin::dialogue::Reading;
use coin::roster::RosterError;
use coin::sharing::ShareThresholds;
use coin::space::Neighbourhood;
use coin_schemas::calibration::Calibration;
use coin_schemas::episode::{Episode, Truth};
use coin_schemas::events::LogEvent;
use coin_schemas::household::ObjectId;
use coin_schemas::report::{Gate, Parameters, Report, Withheld};
use coin_schemas::tools::{DEFAULT_K, DEFAULT_WINDOW_DAYS};
use coin_server::episode::{EpisodeError, LoadedEpisode};
use thiserror::Error;

use crate::calibrate::CalibrationFileError;
use crate::client::{ServerAddress, ServerError};
use crate::driver::{DriveError, Driver, Observer, Outcome, Standing};
use crate::evidence::{self, Evidence};
use crate::home::{self, Home, HomeError};
use crate::model::ChatModel;
use crate::pages::episode::Belief;
use crate::person::{
    Person, PersonError, PersonKind, ScriptError, ScriptedPerson, SimulatedPerson, TerminalPerson,
};
use crate::report::{self, Circumstances};
use crate::steps::Steps;

/// How many things are inferred at once.
const CONCURRENCY: usize = 4;

/// Who answers the questions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answers {
    /// A simulated person, who knows the truth of the episode.
    Simulated,
    /// The person at the terminal.
    Terminal,
    /// A file of answers.
    Scripted(PathBuf),
}

impl std::str::FromStr for Answers {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "simulated" => Self::Simulated,
            "terminal" => Self::Terminal,
            file => Self::Scripted(PathBuf::from(file)),
        })
    }
}

/// The settings of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSettings {
    /// The episode's folder.
    pub episode: PathBuf,
    /// Where the database of the server in this process is kept; in memory if nowhere.
    pub db: Option<PathBuf>,
    /// Where the tool server is.
    pub server: ServerAddress,
    /// Which rule decides what is asked.
    pub gate: Gate,
    /// The thresholds; `None` takes those that come with the program, where it has some for the model.
    pub calibration: Option<Calibration>,
    /// Who answers.
    pub answers: Answers,
    /// Q_max; `None` is one question a thing.
    pub max_questions: Option<usize>,
    /// The seed of the simulated person.
    pub seed: u64,
    /// Which things are inferred again after an answer.
    pub reinference: Reinference,
    /// What the model is not told.
    pub withheld: BTreeSet<Withheld>,
    /// What to do with the calibration of another model.
    pub foreign_calibration: ForeignCalibration,
    /// Whether the evidence about every thing is fetched in the end.
    pub evidence: EvidenceKept,
}

/// Whether a run keeps what a page shows of each thing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum EvidenceKept {
    /// Nobody looks at it.
    #[default]
    None,
    /// It is fetched from the server when the run is over.
    All,
}

/// What to do with a calibration that was made for another model, whose scores mean something else.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum ForeignCalibration {
    /// Refuse it.
    #[default]
    Refused,
    /// Use it; no guarantee holds.
    Used,
}

/// Why a run came to nothing.
#[derive(Debug, Error)]
pub enum RunError {
    /// The home is refused.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// The truth is refused.
    #[error(transparent)]
    Truth(#[from] EpisodeError),
    /// The simulated person knows nothing.
    #[error(
        "the episode {episode:?} has no truth file, so nobody can be simulated; \
         answer yourself with --answers terminal or give a file with --answers FILE.jsonl"
    )]
    NoTruth {
        /// The episode's name.
        episode: String,
    },
    /// The calibration is refused.
    #[error(transparent)]
    Calibration(#[from] CalibrationFileError),
    /// The file of answers is refused.
    #[error(transparent)]
    Script(#[from] ScriptError),
    /// The person at the terminal cannot be reached.
    #[error(transparent)]
    Person(#[from] PersonError),
    /// The server failed.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// The run failed.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The truth names people who are not of the household.
    #[error("the truth does not fit the household: {0}")]
    Roster(#[from] RosterError),
}

impl RunError {
    /// Whether what was given is at fault, so that the same call will fail again.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Home(HomeError::Server(_)) | Self::Server(_) | Self::Drive(_) | Self::Person(_) => false,
            Self::Home(_)
            | Self::Truth(_)
            | Self::NoTruth { .. }
            | Self::Calibration(_)
            | Self::Script(_)
            | Self::Roster(_) => true,
        }
    }
}

/// What a run leaves behind.
#[derive(Debug)]
pub struct RunResult {
    /// The report.
    pub report: Report,
    /// The home; it holds no truth.
    pub episode: Episode,
    /// What was believed before the first question and after each one.
    pub history: Vec<BTreeMap<ObjectId, Belief>>,
    /// What the server tells of every thing in the end, where it was to be kept.
    pub evidence: BTreeMap<ObjectId, Evidence>,
}

/// Carries one episode through.
pub async fn run_episode(
    settings: &RunSettings,
    model: &dyn ChatModel,
    observer: &mut dyn Observer,
) -> Result<RunResult, RunError> {
    let started = Instant::now();
    // Everything that was given is checked before the first of it is imported.
    let calibration = calibration_for(settings, model.name())?;
    let loaded = home::load(&settings.episode).await?;
    let truth = coin_server::episode::load_truth(&settings.episode, &loaded.episode)?;
    let mut person = person(settings, &loaded, truth.as_ref())?;
    let home = Home::open(loaded, settings.db.clone(), &settings.server).await?;
    let agent_settings = AgentSettings {
        gate: settings.gate,
        thresholds: calibration.as_ref().map_or(Thresholds::Uncalibrated, Thresholds::from),
        share: ShareThresholds::default(),
        max_questions: settings.max_questions.unwrap_or(home.things.len()),
        reinference: settings.reinference,
    };
    let parameters = parameters(&agent_settings, person.kind(), &settings.withheld);

    observer
        .observe(&LogEvent::RunStarted {
            episode: home.episode.name.clone(),
            model: model.name().to_owned(),
            gate: settings.gate,
            seed: settings.seed,
            users: home.roster.users(),
            objects: home.things.iter().map(|(id, thing)| (id.clone(), thing.class.clone())).collect(),
        })
        .map_err(DriveError::from)?;
    let (outcome, mut cost) =
        drive(&home, agent_settings, &settings.withheld, model, person.as_mut(), observer).await?;
    cost.seconds = started.elapsed().as_secs_f64();
    let report = report::build(
        &outcome,
        Circumstances {
            episode: &home.episode,
            roster: &home.roster,
            truth: truth.as_ref(),
            model: model.name(),
            seed: settings.seed,
            parameters,
            calibration: calibration.as_ref(),
            cost,
        },
    )?;
    observer
        .observe(&LogEvent::RunFinished { stopped: report.stopped, metrics: report.metrics.clone() })
        .map_err(DriveError::from)?;
    let evidence = match settings.evidence {
        EvidenceKept::None => BTreeMap::new(),
        EvidenceKept::All => evidence::collect(&home.server, home.things.keys(), home.episode.now).await?,
    };
    let history = beliefs(&outcome, &home);
    home.server.close().await;
    Ok(RunResult { report, episode: home.episode, history, evidence })
}

fn beliefs(outcome: &Outcome, home: &Home) -> Vec<BTreeMap<ObjectId, Belief>> {
    let named = |standing: &Standing| Belief {
        owners: home.roster.owners(standing.owners),
        confidence: standing.confidence,
        source: standing.source,
    };
    let of_step = |standings: &BTreeMap<ObjectId, Standing>| {
        standings.iter().map(|(object, standing)| (object.clone(), named(standing))).collect()
    };
    outcome.history.iter().map(of_step).collect()
}

/// Runs the agent in a home and says what it cost, without the time.
pub(crate) async fn drive(
    home: &Home,
    agent_settings: AgentSettings,
    withheld: &BTreeSet<Withheld>,
    model: &dyn ChatModel,
    person: &mut dyn Person,
    observer: &mut dyn Observer,
) -> Result<(Outcome, coin_schemas::report::Cost), DriveError> {
    let mut agent = Agent::new(agent_settings, home.things.keys().cloned());
    for (object, &owners) in &home.answered {
        agent.remember_answer(object, Reading { owners, outside_household: owners.is_empty() });
    }
    let steps = Steps::new(model, &home.server, &home.roster, withheld);
    let driver = Driver {
        steps: &steps,
        server: &home.server,
        model: model.name(),
        roster: &home.roster,
        things: &home.things,
        as_of: home.episode.now,
        concurrency: CONCURRENCY,
        person,
        observer,
    };
    let outcome = driver.run(agent).await?;
    Ok((outcome, steps.cost()))
}

/// The calibration that was handed in, which must be the model's own and of a model that was told as much, or the one
/// of the program that goes with the gate.
fn calibration_for(settings: &RunSettings, model: &str) -> Result<Option<Calibration>, CalibrationFileError> {
    let Some(calibration) = &settings.calibration else {
        return match model {
            EMBEDDED_MODEL => embedded_calibration(score_of(settings.gate), &settings.withheld)
                .map_err(CalibrationFileError::BuiltIn),
            _ => Ok(None),
        };
    };
    if settings.foreign_calibration == ForeignCalibration::Refused {
        if calibration.model != model {
            return Err(CalibrationFileError::OtherModel {
                made_for: calibration.model.clone(),
                model: model.to_owned(),
            });
        }
        if calibration.withheld != settings.withheld {
            return Err(CalibrationFileError::ToldOtherwise {
                calibration: calibration.withheld.clone(),
                run: settings.withheld.clone(),
            });
        }
    }
    Ok(Some(calibration.clone()))
}

fn person(
    settings: &RunSettings,
    loaded: &LoadedEpisode,
    truth: Option<&Truth>,
) -> Result<Box<dyn Person>, RunError> {
    let users = loaded.episode.users.clone();
    Ok(match &settings.answers {
        Answers::Simulated => {
            let truth =
                truth.cloned().ok_or_else(|| RunError::NoTruth { episode: loaded.episode.name.clone() })?;
            Box::new(SimulatedPerson::new(truth, users, settings.seed))
        }
        Answers::Terminal => Box::new(TerminalPerson::at_the_prompt()?),
        Answers::Scripted(file) => Box::new(scripted(file, &loaded.episode)?),
    })
}

fn scripted(file: &Path, episode: &Episode) -> Result<ScriptedPerson, ScriptError> {
    let things: BTreeSet<ObjectId> = episode.objects.iter().map(|object| object.id.clone()).collect();
    ScriptedPerson::from_file(file, &things, &episode.users)
}

fn parameters(agent: &AgentSettings, person: PersonKind, withheld: &BTreeSet<Withheld>) -> Parameters {
    let Neighbourhood { k, sigma, gamma, .. } = Neighbourhood::default();
    Parameters {
        k_near: k,
        k_sim: DEFAULT_K as usize,
        sigma,
        gamma,
        window_days: DEFAULT_WINDOW_DAYS,
        epsilon_min: agent.share.least_score,
        epsilon_in: agent.share.largest_spread,
        epsilon_out: agent.share.least_gap,
        max_questions: agent.max_questions,
        reinference: agent.reinference,
        withheld: withheld.clone(),
        answers: person.as_str().to_owned(),
    }
}
