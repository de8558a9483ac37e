//! What each method is, as settings of the agent or as a baseline of its own.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

use coin::agent::{AgentSettings, QuestionChoice, Reinference};
use coin::baselines::{frequency, last_user};
use coin::calibration::{Thresholds, score_of};
use coin::owners::OwnerSet;
use coin::sharing::ShareThresholds;
use coin::usage::UsageEvent;
use coin_schemas::calibration::NonconformityScore;
use coin_schemas::experiment::Method;
use coin_schemas::household::ObjectId;
use coin_schemas::report::{Cost, Gate, Scoring, Withheld};

use super::{Calibrations, JudgedHome, actowl};
use crate::cli::default_levels;
use crate::client::ServerAddress;
use crate::course::{Course, drive};
use crate::driver::{Standing, Unobserved};
use crate::home::Home;
use crate::model::ChatModel;
use crate::person::{ErrorRate, SimulatedPerson};
use crate::run::{RunError, default_scoring};

/// What came of one run of one method.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MethodOutcome {
    /// The owner sets before the first question and after each one.
    pub(super) history: Vec<BTreeMap<ObjectId, OwnerSet>>,
    /// What it took.
    pub(super) cost: Cost,
}

/// How the agent is set for a method; `None` for the methods that are not the agent's.
struct Variant {
    gate: Gate,
    reinference: Reinference,
    withheld: &'static [Withheld],
    scorer: Scorer,
}

/// Who scores the things.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scorer {
    /// What suits the model: a language model together with the evidence model.
    Ours,
    /// The model alone.
    ModelAlone,
}

const COIN: Variant = Variant {
    gate: Gate::Risk,
    reinference: Reinference::AnsweredContext,
    withheld: &[],
    scorer: Scorer::Ours,
};

fn variant(method: Method) -> Option<Variant> {
    let the_papers = Variant { scorer: Scorer::ModelAlone, ..COIN };
    match method {
        Method::Coin => Some(COIN),
        Method::CoinPaper => {
            Some(Variant { gate: Gate::Paper, reinference: Reinference::EveryUnasked, ..the_papers })
        }
        Method::NlmapLlm => Some(Variant {
            gate: Gate::Never,
            withheld: &[Withheld::Background, Withheld::Usage],
            ..the_papers
        }),
        Method::NoQuestions => Some(Variant { gate: Gate::Never, ..COIN }),
        Method::NoBackground => Some(Variant { withheld: &[Withheld::Background], ..COIN }),
        Method::NoUsage => Some(Variant { withheld: &[Withheld::Usage], ..COIN }),
        Method::Actowl | Method::LastUser | Method::Frequency => None,
    }
}

/// What thresholds have to be made from to be those of a method.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CalibrationKind {
    /// What the model is not told.
    pub(super) withheld: BTreeSet<Withheld>,
    /// The score of prediction sets over members.
    pub(super) score: NonconformityScore,
    /// How the things are scored.
    pub(super) scoring: Scoring,
}

impl Variant {
    fn calibration(&self, model: &str) -> CalibrationKind {
        CalibrationKind {
            withheld: self.withheld.iter().copied().collect(),
            score: score_of(self.gate),
            scoring: match self.scorer {
                Scorer::Ours => default_scoring(model),
                Scorer::ModelAlone => Scoring::default(),
            },
        }
    }
}

/// The thresholds that a method compares with; `None` where it compares with none.
pub(super) fn calibration(method: Method, model: &str) -> Option<CalibrationKind> {
    let variant = variant(method).filter(|variant| variant.gate != Gate::Never)?;
    Some(variant.calibration(model))
}

/// Runs a method in a home of its own, from the captions to the last answer.
pub(super) async fn run(
    method: Method,
    judged: &JudgedHome,
    model: &dyn ChatModel,
    calibrations: &Calibrations,
    concurrency: usize,
    seed: u64,
) -> Result<MethodOutcome, RunError> {
    let started = Instant::now();
    let mut outcome = match (method, variant(method)) {
        (_, Some(variant)) => {
            agent(variant, judged, model, calibrations, concurrency, judged.person(seed)).await?
        }
        (Method::Actowl, None) => actowl::run(judged, model, seed).await?,
        (Method::Frequency, None) => heuristic(judged, frequency),
        (_, None) => heuristic(judged, last_user),
    };
    outcome.cost.seconds = started.elapsed().as_secs_f64();
    Ok(outcome)
}

/// Runs COIN with a gate, where people err in some of their answers.
pub(super) async fn with_gate(
    gate: Gate,
    wrong_answers: ErrorRate,
    judged: &JudgedHome,
    model: &dyn ChatModel,
    calibrations: &Calibrations,
    concurrency: usize,
    seed: u64,
) -> Result<MethodOutcome, RunError> {
    let person = judged.person(seed).erring(wrong_answers);
    agent(Variant { gate, ..COIN }, judged, model, calibrations, concurrency, person).await
}

async fn agent(
    variant: Variant,
    judged: &JudgedHome,
    model: &dyn ChatModel,
    calibrations: &Calibrations,
    concurrency: usize,
    person: SimulatedPerson,
) -> Result<MethodOutcome, RunError> {
    let kind = variant.calibration(model.name());
    let settings = AgentSettings {
        gate: variant.gate,
        thresholds: calibrations
            .get(&kind)
            .and_then(Option::as_ref)
            .map_or(Thresholds::Uncalibrated, Thresholds::from),
        risk: default_levels().risk,
        share: ShareThresholds::default(),
        max_questions: judged.loaded.episode.objects.len(),
        reinference: variant.reinference,
        choice: QuestionChoice::MostInformative,
        answers_per_pass: 1,
    };
    let course = Course::new(settings, kind.withheld, kind.scoring, concurrency);
    carried_out(judged, model, course, person).await
}

/// Runs the agent in a home of its own, from the captions to the last answer of a simulated person.
pub(super) async fn carried_out(
    judged: &JudgedHome,
    model: &dyn ChatModel,
    course: Course,
    mut person: SimulatedPerson,
) -> Result<MethodOutcome, RunError> {
    let home = Home::open(judged.loaded.clone(), None, &ServerAddress::InProcess).await?;
    let (outcome, cost) = drive(&home, course, model, &mut person, &mut Unobserved).await?;
    home.server.close().await;
    let owners = |standings: BTreeMap<ObjectId, Standing>| {
        standings.into_iter().map(|(object, standing)| (object, standing.owners)).collect()
    };
    Ok(MethodOutcome { history: outcome.history.into_iter().map(owners).collect(), cost })
}

/// A baseline that only looks at who used each thing, up to the episode's present.
fn heuristic(judged: &JudgedHome, owner: impl Fn(&[UsageEvent]) -> OwnerSet) -> MethodOutcome {
    let owners = judged.usage().into_iter().map(|(object, events)| (object, owner(&events))).collect();
    MethodOutcome { history: vec![owners], cost: Cost::default() }
}

impl JudgedHome {
    /// The people of the home, who know the truth.
    pub(super) fn person(&self, seed: u64) -> SimulatedPerson {
        SimulatedPerson::new(self.truth.clone(), self.loaded.episode.users.clone(), seed)
    }

    /// The events of every thing in time order, up to the episode's present.
    fn usage(&self) -> BTreeMap<ObjectId, Vec<UsageEvent>> {
        let mut events: BTreeMap<ObjectId, Vec<UsageEvent>> =
            self.loaded.episode.objects.iter().map(|object| (object.id.clone(), Vec::new())).collect();
        let lines = self.loaded.captions.iter().zip(&self.loaded.observations);
        for (line, observation) in lines.filter(|(_, seen)| seen.at <= self.loaded.episode.now) {
            if let Some(of_thing) = events.get_mut(&line.object_id) {
                of_thing.push(UsageEvent {
                    at_seconds: coin::captions::civil_seconds(observation.at),
                    actor: observation.actor,
                    action: observation.action,
                });
            }
        }
        // The sort is stable: sightings of one minute keep the order of the file.
        for of_thing in events.values_mut() {
            of_thing.sort_by_key(|event| event.at_seconds);
        }
        events
    }
}
