//! The agent: Algorithm 1 of the paper as a state machine. Events go in, effects come out.
//!
//! There is no await, no clock and no randomness here; a test is a list of events. The driver performs the
//! effects and reports back. The results of one pass may arrive in any order: they are taken in together when
//! the pass is complete.

mod asking;
mod effect;
mod event;
mod state;

use std::collections::{BTreeMap, BTreeSet};

use coin_schemas::household::ObjectId;
pub use coin_schemas::report::Reinference;
use coin_schemas::report::{Gate, Stopped};
use thiserror::Error;

pub use effect::Effect;
pub use event::{Event, Inference, Parts};
pub use state::{Known, KnownSource, NOTABLE, ObjectState};

use crate::calibration::Thresholds;
use crate::conformal::Level;
use crate::dialogue::Reading;
use crate::gate::sort_ids;
use crate::owners::OwnerSet;
use crate::sharing::ShareThresholds;

/// BUILD-KNOWN: an inferred owner set counts as known from this probability on. Less would feed guesses back as
/// facts, which is how the paper's own failure, the cup given to Mary, came about.
pub const KNOWN_CONFIDENCE: f64 = 0.9;

/// Of several things that are worth a question, which one is asked about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QuestionChoice {
    /// The one that the gate puts first, as the paper has it.
    LeastSure,
    /// The one whose answer leaves least doubt about everything, of the few that the gate puts first.
    MostInformative,
}

/// The settings of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct AgentSettings {
    /// Which rule decides what is asked.
    pub gate: Gate,
    /// What the rule compares with.
    pub thresholds: Thresholds,
    /// ε of the adaptive gate: the share of all things that may be wrong in the end.
    pub risk: Level,
    /// DETECT-SHARE.
    pub share: ShareThresholds,
    /// Q_max.
    pub max_questions: usize,
    /// Which things are inferred again after an answer.
    pub reinference: Reinference,
    /// Which of the things that the gate finds worth a question is asked about.
    pub choice: QuestionChoice,
    /// So many answers are awaited before things are inferred again; 1 in the paper. One answer more changes little where
    /// there are thousands of things. No run ends with an answer that was not taken into account, but at Q_max.
    pub answers_per_pass: usize,
}

/// An event that does not belong to the state that the agent is in. It changes nothing.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnexpectedEvent {
    /// `Started` came twice.
    #[error("the run has already started")]
    AlreadyStarted,
    /// A result came for a thing that no inference is under way for.
    #[error("no inference of thing {object} is under way")]
    NotInferring {
        /// The thing.
        object: ObjectId,
    },
    /// What questions are worth was told although nobody wanted to know, or not for every one of them.
    #[error("what so many questions are worth was not to be worked out")]
    NotWeighing,
    /// An answer came although nobody was asked.
    #[error("no question is open")]
    NotAsking,
}

#[derive(Debug, Clone, PartialEq)]
enum Phase {
    Idle,
    Inferring {
        pending: BTreeSet<ObjectId>,
        finished: BTreeMap<ObjectId, Result<Inference, String>>,
    },
    Weighing {
        objects: Vec<ObjectId>,
    },
    /// Of one thing, or of several at once.
    Asking {
        objects: Vec<ObjectId>,
    },
    Finished,
}

/// Algorithm 1: infer, gate, ask, apply the answer, and again.
#[derive(Debug, Clone, PartialEq)]
pub struct Agent {
    settings: AgentSettings,
    objects: BTreeMap<ObjectId, ObjectState>,
    /// Things that a person would name in one word.
    alike: Vec<Vec<ObjectId>>,
    /// BUILD-KNOWN as the last pass saw it.
    known: BTreeMap<ObjectId, Known>,
    questions: usize,
    /// The questions since things were inferred last.
    questions_since_pass: usize,
    phase: Phase,
}

impl Agent {
    /// An agent for these things; duplicates count once.
    pub fn new(settings: AgentSettings, objects: impl IntoIterator<Item = ObjectId>) -> Self {
        let objects = objects.into_iter().map(|object| (object, ObjectState::default())).collect();
        Self {
            settings,
            objects,
            alike: Vec::new(),
            known: BTreeMap::new(),
            questions: 0,
            questions_since_pass: 0,
            phase: Phase::Idle,
        }
    }

    /// Lets several things be asked about at once, where a person would name them in one word, such as all mugs in the
    /// kitchen. The paper asks about one thing at a time.
    pub fn asking_together(self, alike: Vec<Vec<ObjectId>>) -> Self {
        Self { alike, ..self }
    }

    /// Takes over what a person answered before the run; a thing that is settled so is not asked about. Call it before
    /// `Started`. Unknown things are passed over. An unresolved answer counts as a question that was asked.
    pub fn remember_answer(&mut self, object: &ObjectId, reading: Reading) {
        if let Some(state) = self.objects.get_mut(object) {
            state.apply_reading(reading);
        }
    }

    /// The settings of the run.
    pub fn settings(&self) -> &AgentSettings {
        &self.settings
    }

    /// What is believed of a thing.
    pub fn object(&self, object: &ObjectId) -> Option<&ObjectState> {
        self.objects.get(object)
    }

    /// Whom people named as owners so far, by thing.
    pub fn answers(&self) -> BTreeMap<ObjectId, OwnerSet> {
        let answered = self.objects.iter().filter_map(|(object, state)| Some((object, state.answer()?)));
        answered.map(|(object, reading)| (object.clone(), reading.owners)).collect()
    }

    /// The number of questions that were put so far.
    pub fn questions(&self) -> usize {
        self.questions
    }

    /// Takes one event and says what is to be done. An unexpected event changes nothing.
    pub fn handle(&mut self, event: Event) -> Result<Vec<Effect>, UnexpectedEvent> {
        match event {
            Event::Started => match self.phase {
                Phase::Idle => Ok(self.start_pass()),
                _ => Err(UnexpectedEvent::AlreadyStarted),
            },
            Event::Inferred { object, inference } => self.take_result(object, Ok(inference)),
            Event::InferenceFailed { object, reason } => self.take_result(object, Err(reason)),
            Event::Weighed { doubt_left } => match &self.phase {
                Phase::Weighing { objects } if objects.len() == doubt_left.len() => {
                    let least =
                        doubt_left.iter().zip(objects).min_by(|left, right| left.0.total_cmp(right.0));
                    let object = least.map(|(_, object)| object.clone());
                    Ok(object.map_or(Vec::new(), |object| self.ask(object)))
                }
                _ => Err(UnexpectedEvent::NotWeighing),
            },
            Event::Answered { reading } => {
                let objects = self.open_question()?;
                Ok(self.apply_answer(&objects, reading))
            }
            Event::Declined => {
                let objects = self.open_question()?;
                self.questions += 1;
                for object in &objects {
                    if let Some(state) = self.objects.get_mut(object) {
                        state.close_to_questions();
                    }
                }
                Ok(self.after_question())
            }
            Event::NobodyLeft => {
                self.open_question()?;
                Ok(self.finish(Stopped::NothingLeftToAsk))
            }
            Event::Ended { stopped } => Ok(self.end(stopped)),
        }
    }

    /// Ends the run from wherever it is. The results of a pass that is not complete are taken in as they are.
    fn end(&mut self, stopped: Stopped) -> Vec<Effect> {
        let mut effects = Vec::new();
        match std::mem::replace(&mut self.phase, Phase::Finished) {
            Phase::Inferring { finished, .. } => effects.extend(self.take_in(finished)),
            Phase::Finished => return effects,
            Phase::Idle | Phase::Weighing { .. } | Phase::Asking { .. } => {}
        }
        effects.extend(self.finish(stopped));
        effects
    }

    fn open_question(&self) -> Result<Vec<ObjectId>, UnexpectedEvent> {
        match &self.phase {
            Phase::Asking { objects } => Ok(objects.clone()),
            _ => Err(UnexpectedEvent::NotAsking),
        }
    }

    /// Lines 4 to 7 of Algorithm 1: BUILD-KNOWN, then LLM-INFER for the things that need it.
    fn start_pass(&mut self) -> Vec<Effect> {
        self.questions_since_pass = 0;
        let known = self.build_known();
        let answered: BTreeSet<&ObjectId> = known
            .iter()
            .filter(|(_, known)| known.source == KnownSource::Answered)
            .filter(|(object, known)| self.known.get(*object) != Some(known))
            .map(|(object, _)| object)
            .collect();
        let mut objects: Vec<ObjectId> = self
            .objects
            .iter()
            .filter(|(_, state)| state.answer().is_none())
            .filter(|(_, state)| match self.settings.reinference {
                Reinference::EveryUnasked => true,
                Reinference::AnsweredContext => {
                    !state.was_inferred() || state.related().iter().any(|related| answered.contains(related))
                }
            })
            .map(|(object, _)| object.clone())
            .collect();
        sort_ids(&mut objects);
        self.known = known;
        if objects.is_empty() {
            return self.ask_or_finish();
        }
        self.phase =
            Phase::Inferring { pending: objects.iter().cloned().collect(), finished: BTreeMap::new() };
        vec![Effect::Infer { objects }]
    }

    /// BUILD-KNOWN: answered owners, and inferred ones of at least [`KNOWN_CONFIDENCE`].
    fn build_known(&self) -> BTreeMap<ObjectId, Known> {
        self.objects
            .iter()
            .filter_map(|(object, state)| state.known().map(|known| (object.clone(), known)))
            .collect()
    }

    fn take_result(
        &mut self,
        object: ObjectId,
        result: Result<Inference, String>,
    ) -> Result<Vec<Effect>, UnexpectedEvent> {
        let Phase::Inferring { pending, finished } = &mut self.phase else {
            return Err(UnexpectedEvent::NotInferring { object });
        };
        if !pending.remove(&object) {
            return Err(UnexpectedEvent::NotInferring { object });
        }
        finished.insert(object, result);
        if !pending.is_empty() {
            return Ok(Vec::new());
        }
        let finished = std::mem::take(finished);
        let mut effects = self.take_in(finished);
        effects.extend(self.ask_or_finish());
        Ok(effects)
    }

    /// Takes in the results of a pass.
    fn take_in(&mut self, finished: BTreeMap<ObjectId, Result<Inference, String>>) -> Vec<Effect> {
        let mut recorded: Vec<ObjectId> = Vec::new();
        for (object, result) in finished {
            let Some(state) = self.objects.get_mut(&object) else { continue };
            match result {
                Ok(inference) if state.inference() == Some(&inference) => {}
                Ok(inference) => {
                    let is_news = state.is_news(&inference);
                    state.apply_inference(inference, &self.settings);
                    if is_news {
                        state.is_recorded();
                        recorded.push(object);
                    }
                }
                Err(reason) => state.apply_failure(reason),
            }
        }
        sort_ids(&mut recorded);
        match recorded.is_empty() {
            true => Vec::new(),
            false => vec![Effect::Record { objects: recorded }],
        }
    }

    /// Ends the run, unless an answer has not been taken into account.
    fn finish_up_to_date(&mut self, stopped: Stopped) -> Vec<Effect> {
        match self.questions_since_pass {
            0 => self.finish(stopped),
            _ => self.start_pass(),
        }
    }

    /// APPLY-ANSWER and the counter, lines 19 and 20 of Algorithm 1.
    fn apply_answer(&mut self, objects: &[ObjectId], reading: Reading) -> Vec<Effect> {
        self.questions += 1;
        for object in objects {
            let Some(state) = self.objects.get_mut(object) else { continue };
            match objects.len() > 1 && reading.is_unresolved() {
                true => state.is_asked_alone(),
                false => state.apply_reading(reading),
            }
        }
        self.after_question()
    }

    /// Lines 21 to 24 of Algorithm 1: stop at Q_max without another inference, else go round again.
    fn after_question(&mut self) -> Vec<Effect> {
        if self.questions >= self.settings.max_questions {
            return self.finish(Stopped::MaxQuestions);
        }
        self.questions_since_pass += 1;
        if self.questions_since_pass < self.settings.answers_per_pass {
            return self.ask_or_finish();
        }
        self.start_pass()
    }

    /// Has the beliefs stored that moved too little to be stored before, and ends the run.
    fn finish(&mut self, stopped: Stopped) -> Vec<Effect> {
        self.phase = Phase::Finished;
        let unrecorded = self.objects.iter_mut().filter(|(_, state)| state.is_unrecorded());
        let mut objects: Vec<ObjectId> = unrecorded
            .map(|(object, state)| {
                state.is_recorded();
                object.clone()
            })
            .collect();
        sort_ids(&mut objects);
        let record = (!objects.is_empty()).then_some(Effect::Record { objects });
        record.into_iter().chain([Effect::Finish { stopped }]).collect()
    }
}
