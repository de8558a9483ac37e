//! One episode from its folder to its report.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

use coin::agent::{AgentSettings, QuestionChoice, Reinference};
use coin::calibration::{EMBEDDED_MODEL, EMBEDDED_SCORING, Thresholds, embedded_calibration, score_of};
use coin::conformal::Level;
use coin::roster::RosterError;
use coin::sharing::ShareThresholds;
use coin_schemas::calibration::Calibration;
use coin_schemas::episode::{Episode, Truth};
use coin_schemas::events::LogEvent;
use coin_schemas::household::ObjectId;
use coin_schemas::journal::{JOURNAL_VERSION, JournalHeading};
use coin_schemas::report::{Estimator, Gate, Parameters, Report, Scoring, Withheld};
use coin_server::episode::{EpisodeError, LoadedEpisode};
use thiserror::Error;
use tokio_util::sync::CancellationToken;

use crate::calibrate::{CalibrationFileError, scored_by};
use crate::client::{ServerAddress, ServerError};
use crate::course::{Course, drive};
use crate::driver::{DriveError, Observer, Outcome, Standing};
use crate::evidence::{self, Evidence};
use crate::home::{self, Home, HomeError};
use crate::journal::{Beginning, Journal, JournalError};
use crate::model::ChatModel;
use crate::pages::episode::Belief;
use crate::person::{
    Answers, ErrorRate, Person, PersonError, PersonKind, ScriptError, ScriptedPerson, SimulatedPerson,
    TerminalPerson,
};
use crate::report::{self, Circumstances};

/// How many conversations go on at once where nobody says otherwise.
pub const CONCURRENCY: usize = 4;

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
    /// ε of the adaptive gate.
    pub risk: Level,
    /// The thresholds; `None` takes those that come with the program, where it has some for the model.
    pub calibration: Option<Calibration>,
    /// Who answers.
    pub answers: Answers,
    /// Q_max; `None` is one question a thing.
    pub max_questions: Option<usize>,
    /// The seed of the simulated person.
    pub seed: u64,
    /// The share of the simulated person's answers that are wrong.
    pub wrong_answers: ErrorRate,
    /// Which things are inferred again after an answer.
    pub reinference: Reinference,
    /// What the model is not told.
    pub withheld: BTreeSet<Withheld>,
    /// What to do with the calibration of another model.
    pub foreign_calibration: ForeignCalibration,
    /// How the scores are made.
    pub scoring: Scoring,
    /// How many conversations go on at once.
    pub concurrency: usize,
    /// Whether an earlier run with the same database goes on.
    pub beginning: Beginning,
    /// Whether the evidence about every thing is fetched in the end.
    pub evidence: EvidenceKept,
}

/// How scores are made where nobody says otherwise: a language model's are fused with the evidence; without one the
/// evidence speaks alone.
pub fn default_scoring(model: &str) -> Scoring {
    match model {
        EMBEDDED_MODEL => EMBEDDED_SCORING,
        _ => Scoring { estimator: Estimator::Fused, ..Scoring::default() },
    }
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
    /// Not every thing was scored by the model that is calibrated.
    #[error(
        "the budget was spent before the model had scored every thing, and thresholds of its scores cannot be made from \
         others; give a larger --budget (with --cache FILE nothing is paid for twice)"
    )]
    ScoredWithoutTheModel,
    /// The journal of the run is refused.
    #[error(transparent)]
    Journal(#[from] JournalError),
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
            Self::Home(HomeError::Server(_))
            | Self::Server(_)
            | Self::Drive(_)
            | Self::Person(_)
            | Self::ScoredWithoutTheModel
            | Self::Journal(JournalError::File { .. } | JournalError::Locked { .. }) => false,
            Self::Home(_)
            | Self::Truth(_)
            | Self::NoTruth { .. }
            | Self::Calibration(_)
            | Self::Script(_)
            | Self::Journal(_)
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
    stop: CancellationToken,
) -> Result<RunResult, RunError> {
    let started = Instant::now();
    // Everything that was given is checked before the first of it is imported.
    let scoring = settings.scoring;
    let calibration = calibration_for(settings, model.name())?;
    let loaded = home::load(&settings.episode).await?;
    let truth = coin_server::episode::load_truth(&settings.episode, &loaded.episode)?;
    let mut person = person(settings, &loaded, truth.as_ref())?;
    let home = Home::open(loaded, settings.db.clone(), &settings.server).await?;
    let agent_settings = AgentSettings {
        gate: settings.gate,
        thresholds: calibration.as_ref().map_or(Thresholds::Uncalibrated, Thresholds::from),
        risk: settings.risk,
        share: ShareThresholds::default(),
        max_questions: settings.max_questions.unwrap_or(home.things.len()),
        reinference: settings.reinference,
        choice: QuestionChoice::MostInformative,
        answers_per_pass: 1,
    };
    let parameters = Parameters {
        wrong_answers: wrong_answers(settings),
        ..report::parameters(&agent_settings, person.kind(), &settings.withheld, scoring)
    };
    let mut course =
        Course::new(agent_settings, settings.withheld.clone(), scoring, settings.concurrency).until(stop);
    if let Some(db) = &settings.db {
        let mut heading = heading(settings, &home, model.name(), calibration.as_ref(), person.kind());
        let journal = Journal::open(db, settings.beginning, &mut heading, &home.roster)?;
        course = course.going_on(journal, &heading);
    }

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
    let (outcome, mut cost) = drive(&home, course, model, person.as_mut(), observer).await?;
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

/// As the report has it: only where somebody is simulated and errs.
fn wrong_answers(settings: &RunSettings) -> Option<f64> {
    let rate = settings.wrong_answers;
    (settings.answers == Answers::Simulated && rate != ErrorRate::NONE).then(|| rate.value())
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

/// What a journal has to agree on with the run that goes on.
fn heading(
    settings: &RunSettings,
    home: &Home,
    model: &str,
    calibration: Option<&Calibration>,
    person: PersonKind,
) -> JournalHeading {
    JournalHeading {
        version: JOURNAL_VERSION,
        episode: home.episode.name.clone(),
        now: home.episode.now,
        users: home.roster.names().cloned().collect(),
        objects: home.things.keys().cloned().collect(),
        answered: home
            .answered
            .iter()
            .map(|(object, &owners)| (object.clone(), home.roster.owners(owners)))
            .collect(),
        model: model.to_owned(),
        gate: settings.gate,
        lambda: calibration.map(|calibration| calibration.lambda),
        risk: (settings.gate == Gate::Adaptive).then(|| settings.risk.value()),
        seed: settings.seed,
        reinference: settings.reinference,
        withheld: settings.withheld.iter().copied().collect(),
        scoring: settings.scoring,
        answers: person.as_str().to_owned(),
    }
}

/// The calibration that was handed in, which must be the model's own and of a model that was told as much, or the one
/// of the program that goes with the gate.
fn calibration_for(settings: &RunSettings, model: &str) -> Result<Option<Calibration>, CalibrationFileError> {
    let (model, scoring) = scored_by(model, settings.scoring);
    let Some(calibration) = &settings.calibration else {
        return match model {
            EMBEDDED_MODEL => embedded_calibration(scoring, score_of(settings.gate), &settings.withheld)
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
        if calibration.scoring != scoring {
            return Err(CalibrationFileError::ScoredOtherwise {
                calibration: calibration.scoring,
                run: scoring,
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
            Box::new(SimulatedPerson::new(truth, users, settings.seed).erring(settings.wrong_answers))
        }
        Answers::Terminal => Box::new(TerminalPerson::at_the_prompt()?),
        Answers::Scripted(file) => Box::new(scripted(file, &loaded.episode)?),
    })
}

fn scripted(file: &Path, episode: &Episode) -> Result<ScriptedPerson, ScriptError> {
    let things: BTreeSet<ObjectId> = episode.objects.iter().map(|object| object.id.clone()).collect();
    ScriptedPerson::from_file(file, &things, &episode.users)
}
