//! A run of the agent as a list of events, each with the effects that it has to have.

use coin::agent::{Agent, AgentSettings, Effect, Event, Inference, ObjectState, QuestionChoice, Reinference};
use coin::calibration::Thresholds;
use coin::conformal::Level;
use coin::dialogue::Reading;
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::sharing::ShareThresholds;
use coin_schemas::household::ObjectId;
use coin_schemas::report::{Gate, Stopped};

use crate::support::{id, scores, set};

/// Γ holds scores of at least .5; the paper's gate stops at cp_s ≤ .1, risk control at conf ≥ .8.
pub(crate) const CALIBRATED: Thresholds =
    Thresholds::Calibrated { q_alpha: 0.5, q_cp: 0.1, q_set: 0.5, lambda: 0.8 };

/// Scores that the paper's gate settles: Γ is the first member, cp_s = 0.
pub(crate) const SURE: &[f64] = &[1.0, 0.0];

/// Algorithm 1 as the paper has it, without a limit to the questions.
pub(crate) fn the_papers() -> AgentSettings {
    AgentSettings {
        gate: Gate::Paper,
        thresholds: CALIBRATED,
        risk: Level::new(0.012).unwrap(),
        share: ShareThresholds::default(),
        max_questions: usize::MAX,
        reinference: Reinference::EveryUnasked,
        choice: QuestionChoice::LeastSure,
        answers_per_pass: 1,
    }
}

pub(crate) fn with_gate(gate: Gate) -> AgentSettings {
    AgentSettings { gate, ..the_papers() }
}

pub(crate) fn ids(texts: &[&str]) -> Vec<ObjectId> {
    texts.iter().map(|&text| id(text)).collect()
}

pub(crate) fn infer(objects: &[&str]) -> Effect {
    Effect::Infer { objects: ids(objects) }
}

pub(crate) fn record(objects: &[&str]) -> Effect {
    Effect::Record { objects: ids(objects) }
}

pub(crate) fn ask(object: &str) -> Effect {
    Effect::Ask { object: id(object) }
}

pub(crate) fn ask_together(objects: &[&str]) -> Effect {
    Effect::AskTogether { objects: ids(objects) }
}

pub(crate) fn finish(stopped: Stopped) -> Effect {
    Effect::Finish { stopped }
}

/// What a model says that scores every member on its own and could see these things' owners.
pub(crate) fn inference(values: &[f64], related: &[&str]) -> Inference {
    let scores = scores(values);
    let distribution = OwnerSetDistribution::from_scores(&scores);
    Inference { scores, distribution, related: ids(related).into_iter().collect(), ..Inference::default() }
}

pub(crate) fn inferred(object: &str, values: &[f64]) -> Event {
    inferred_seeing(object, values, &[])
}

pub(crate) fn inferred_seeing(object: &str, values: &[f64], related: &[&str]) -> Event {
    Event::Inferred { object: id(object), inference: inference(values, related) }
}

pub(crate) fn failed(object: &str) -> Event {
    Event::InferenceFailed { object: id(object), reason: "the model is out of reach".to_owned() }
}

pub(crate) fn answered(reading: Reading) -> Event {
    Event::Answered { reading }
}

pub(crate) fn owned_by(places: &[usize]) -> Event {
    answered(Reading { owners: set(places), outside_household: false })
}

pub(crate) fn unresolved() -> Event {
    answered(Reading { owners: OwnerSet::EMPTY, outside_household: false })
}

pub(crate) fn owned_by_a_stranger() -> Event {
    answered(Reading { owners: OwnerSet::EMPTY, outside_household: true })
}

/// An agent under way.
#[derive(Clone)]
pub(crate) struct Run {
    pub(crate) agent: Agent,
}

impl Run {
    pub(crate) fn new(settings: AgentSettings, objects: &[&str]) -> Self {
        Self { agent: Agent::new(settings, ids(objects)) }
    }

    /// The same, where these things may be asked about at once.
    pub(crate) fn with_alike(settings: AgentSettings, objects: &[&str], alike: &[&[&str]]) -> Self {
        let alike = alike.iter().map(|group| ids(group)).collect();
        Self { agent: Agent::new(settings, ids(objects)).asking_together(alike) }
    }

    /// Starts a run; the first pass gives every thing these scores.
    pub(crate) fn after_first_pass(
        settings: AgentSettings,
        things: &[(&str, &[f64])],
    ) -> (Self, Vec<Effect>) {
        let objects: Vec<&str> = things.iter().map(|&(object, _)| object).collect();
        let mut run = Self::new(settings, &objects);
        run.handle(Event::Started);
        let effects = run.pass(things);
        (run, effects)
    }

    pub(crate) fn handle(&mut self, event: Event) -> Vec<Effect> {
        self.agent.handle(event).unwrap()
    }

    /// Gives the results of one pass and returns the effects of the last.
    pub(crate) fn pass(&mut self, things: &[(&str, &[f64])]) -> Vec<Effect> {
        let mut effects = Vec::new();
        for &(object, values) in things {
            assert_eq!(effects, [], "the pass was complete before {object}");
            effects = self.handle(inferred(object, values));
        }
        effects
    }

    pub(crate) fn thing(&self, object: &str) -> &ObjectState {
        self.agent.object(&id(object)).unwrap()
    }
}
