//! The driver: performs what the agent wants done and reports back what happened. All input and output of a run
//! goes through here; what to do next is decided by `coin::agent` alone.

use std::collections::BTreeMap;

use coin::agent::{Agent, Effect, Event, ObjectState, UnexpectedEvent};
use coin::dialogue::Reading;
use coin::owners::OwnerSet;
use coin::roster::Roster;
use coin_schemas::events::LogEvent;
use coin_schemas::household::{ObjectId, OwnershipBoolean, Score, Source, UserName};
use coin_schemas::model::{Task, TaskObject};
use coin_schemas::report::{AnswerStatus, QuestionReport, Stopped};
use coin_schemas::tools::{RecordAnswer, RecordAnswerResult, RecordScores, RecordScoresResult};
use futures::StreamExt;
use jiff::civil::DateTime;
use thiserror::Error;

use crate::client::{ServerError, ToolServer};
use crate::output::EventLogError;
use crate::person::{Candidate, Person, PersonError, PutQuestion, Response};
use crate::steps::{InferStep, StepError, Steps};

/// Why a run could not be carried through.
#[derive(Debug, Error)]
pub enum DriveError {
    /// The tool server failed.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// The person could not be reached.
    #[error(transparent)]
    Person(#[from] PersonError),
    /// A step on which everything after it rests came to nothing.
    #[error("the model gave nothing to go on with: {0}")]
    Step(#[from] StepError),
    /// The event log takes no more.
    #[error(transparent)]
    Log(#[from] EventLogError),
    /// The driver broke the agent's protocol, which is a fault of this program.
    #[error("the run went out of step: {0}; please report this")]
    OutOfStep(#[from] UnexpectedEvent),
    /// A value that the run made is not of its type, which is a fault of this program.
    #[error("the run made a malformed value: {0}; please report this")]
    Malformed(String),
}

/// Takes note of what happens in a run.
pub trait Observer: Send {
    /// Takes note of one event.
    fn observe(&mut self, event: &LogEvent) -> Result<(), EventLogError>;
}

/// Nobody takes note.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn observe(&mut self, _event: &LogEvent) -> Result<(), EventLogError> {
        Ok(())
    }
}

/// What a run works with. Its methods borrow it mutably even to read: a person and an observer may be sent to another
/// thread, but not be shared between two.
pub struct Driver<'a> {
    /// The three model-driven steps.
    pub steps: &'a Steps<'a>,
    /// The server in which beliefs and answers are stored.
    pub server: &'a ToolServer,
    /// The name under which scores are stored.
    pub model: &'a str,
    /// The household.
    pub roster: &'a Roster,
    /// The things.
    pub things: &'a BTreeMap<ObjectId, TaskObject>,
    /// The moment for which the question is put.
    pub as_of: DateTime,
    /// How many things are inferred at once.
    pub concurrency: usize,
    /// Who answers.
    pub person: &'a mut dyn Person,
    /// Who takes note.
    pub observer: &'a mut dyn Observer,
}

/// What is believed of a thing at one moment of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// The owners; empty where somebody outside the household owns it, or nothing is known.
    pub owners: OwnerSet,
    /// The probability of the best owner set; 1 where a person named the owners, 0 where nothing is known.
    pub confidence: f64,
    /// How the owners are known.
    pub source: Source,
}

impl From<&ObjectState> for Standing {
    fn from(state: &ObjectState) -> Self {
        let inferred = state.assessment().map_or(0.0, |assessment| assessment.confidence);
        let (confidence, source) = match state.answer() {
            Some(_) => (1.0, Source::Answer),
            None => (inferred, Source::Inferred),
        };
        Self { owners: state.owners(), confidence, source }
    }
}

/// What came of a run.
#[derive(Debug)]
pub struct Outcome {
    /// The agent, with what it believes of every thing.
    pub agent: Agent,
    /// Every question that was put, in order.
    pub questions: Vec<QuestionReport>,
    /// What was believed before the first question and after each one.
    pub history: Vec<BTreeMap<ObjectId, Standing>>,
    /// Why the run ended.
    pub stopped: Stopped,
}

impl Driver<'_> {
    /// Carries the agent from its start to its end.
    pub async fn run(mut self, mut agent: Agent) -> Result<Outcome, DriveError> {
        let mut questions = Vec::new();
        let mut history = Vec::new();
        let mut pass = 0;
        let mut effects = agent.handle(Event::Started)?;
        loop {
            let mut events = Vec::new();
            for effect in effects {
                match effect {
                    Effect::Infer { objects } => {
                        events.extend(self.infer(pass, objects).await?);
                        pass += 1;
                    }
                    Effect::Record { objects } => self.record(&agent, &objects).await?,
                    Effect::Ask { object } => {
                        history.push(self.standings(&agent));
                        debug_assert_eq!(history.len(), questions.len() + 1);
                        let (event, report) = self.ask(&agent, &object).await?;
                        events.push(event);
                        questions.extend(report);
                    }
                    Effect::Finish { stopped } => {
                        // Where nobody was left to ask, the state before the open question is the last one.
                        if history.len() == questions.len() {
                            history.push(self.standings(&agent));
                        }
                        return Ok(Outcome { agent, questions, history, stopped });
                    }
                }
            }
            effects = Vec::new();
            for event in events {
                effects.extend(agent.handle(event)?);
            }
        }
    }

    fn ownership(&self, owners: OwnerSet) -> OwnershipBoolean {
        self.roster.indices().map(|user| (self.roster.name(user).clone(), owners.contains(user))).collect()
    }

    fn standings(&self, agent: &Agent) -> BTreeMap<ObjectId, Standing> {
        let unknown = ObjectState::default();
        self.things
            .keys()
            .map(|object| (object.clone(), Standing::from(agent.object(object).unwrap_or(&unknown))))
            .collect()
    }

    async fn infer(&mut self, pass: usize, objects: Vec<ObjectId>) -> Result<Vec<Event>, DriveError> {
        self.observer.observe(&LogEvent::InferenceStarted { pass, objects: objects.clone() })?;
        let steps = self.steps;
        let things = self.things;
        let as_of = self.as_of;
        let household = steps.household();
        // Results are taken in the order of the things, so that neither the log nor the report depends on which
        // conversation ends first.
        let mut results = futures::stream::iter(objects)
            .map(|object| {
                let task = things.get(&object).map(|thing| Task::InferOwnership {
                    household: household.clone(),
                    object: thing.clone(),
                    as_of,
                });
                async move {
                    let step = match &task {
                        Some(task) => Some(steps.infer(task).await),
                        None => None,
                    };
                    (object, step)
                }
            })
            .buffered(self.concurrency.max(1));
        let mut events = Vec::new();
        while let Some((object, step)) = results.next().await {
            let Some(InferStep { called, outcome }) = step else {
                return Err(DriveError::Malformed(format!("thing {object} is not in the episode")));
            };
            for call in called {
                self.observer.observe(&LogEvent::ToolCalled {
                    object_id: object.clone(),
                    tool: call.tool,
                    is_error: call.is_error,
                })?;
            }
            match outcome {
                Ok(inference) => {
                    let (owners, confidence) = inference.distribution.best();
                    self.observer.observe(&LogEvent::ObjectInferred {
                        object_id: object.clone(),
                        scores: self.roster.scores(&inference.scores),
                        owners: self.roster.owners(owners),
                        confidence,
                    })?;
                    events.push(Event::Inferred { object, inference });
                }
                Err(StepError::Server(error)) => return Err(error.into()),
                Err(error) => {
                    let reason = error.to_string();
                    self.observer.observe(&LogEvent::InferenceFailed {
                        object_id: object.clone(),
                        reason: reason.clone(),
                    })?;
                    events.push(Event::InferenceFailed { object, reason });
                }
            }
        }
        Ok(events)
    }

    async fn record(&mut self, agent: &Agent, objects: &[ObjectId]) -> Result<(), DriveError> {
        for object in objects {
            let Some(state) = agent.object(object) else { continue };
            let (Some(scores), Some(distribution)) = (state.scores(), state.distribution()) else { continue };
            let arguments = RecordScores {
                object_id: object.to_string(),
                scores: self
                    .roster
                    .scores(scores)
                    .into_iter()
                    .map(|(name, score)| (name.to_string(), score.value()))
                    .collect(),
                owner_sets: Some(distribution.to_named(self.roster)),
                model: Some(self.model.to_owned()),
            };
            let _: RecordScoresResult = self.server.call("record_scores", &arguments).await?;
        }
        Ok(())
    }

    /// QUESTION-GENERATION, the person, UNDERSTAND-ANSWER, and the record of the answer.
    async fn ask(
        &mut self,
        agent: &Agent,
        object: &ObjectId,
    ) -> Result<(Event, Option<QuestionReport>), DriveError> {
        let thing = self
            .things
            .get(object)
            .ok_or_else(|| DriveError::Malformed(format!("thing {object} is not in the episode")))?;
        let state = agent.object(object).cloned().unwrap_or_default();
        let step = agent.questions() + 1;
        let scores = match state.scores() {
            Some(scores) => scores.to_vec(),
            None => vec![Score::ZERO; self.roster.len()],
        };
        let question = self.word_question(thing, &scores, state.times_asked()).await?;
        self.observer.observe(&LogEvent::QuestionAsked {
            step,
            object_id: object.clone(),
            question: question.clone(),
        })?;
        let put = QuestionReport {
            step,
            object_id: object.clone(),
            question: question.clone(),
            answer: String::new(),
            answered_by: None,
            ownership: self.ownership(OwnerSet::EMPTY),
            status: AnswerStatus::Unresolved,
            uncertainty_before: state.assessment().map_or(1.0, |assessment| assessment.uncertainty),
            prediction_set_before: self.roster.owners(
                state.assessment().map_or(self.roster.everyone(), |assessment| assessment.prediction_set),
            ),
        };
        let response = self
            .person
            .ask(&PutQuestion {
                step,
                object: thing,
                question: &question,
                candidates: &likeliest_first(self.roster, &scores),
                times_asked: state.times_asked(),
                before: None,
                remaining: None,
            })
            .await?;
        let members = self.roster.names().cloned().collect();
        let answer = response.in_words(&members).unwrap_or_default();
        let (reading, answered_by) = match response {
            Response::Said { answer, answered_by } => {
                (self.read_answer(&question, &answer, answered_by.as_ref()).await?, answered_by)
            }
            Response::Chose { owners, owner_outside_household, answered_by } => {
                let owners = self.roster.indices().filter(|&user| owners.contains(self.roster.name(user)));
                let reading =
                    Reading { owners: owners.collect(), outside_household: owner_outside_household };
                (reading, answered_by)
            }
            Response::Declined => {
                self.observer.observe(&LogEvent::QuestionDeclined { step, object_id: object.clone() })?;
                return Ok((Event::Declined, Some(put)));
            }
            Response::NobodyLeft | Response::Undo | Response::Stop => {
                self.observer.observe(&LogEvent::NobodyLeft { object_id: object.clone() })?;
                return Ok((Event::NobodyLeft, None));
            }
        };
        let ownership = self.ownership(reading.owners);
        let recorded: RecordAnswerResult = self
            .server
            .call(
                "record_answer",
                &RecordAnswer {
                    object_id: object.to_string(),
                    question: question.clone(),
                    answer: answer.clone(),
                    ownership: ownership.iter().map(|(name, &owner)| (name.to_string(), owner)).collect(),
                    owner_outside_household: reading.outside_household,
                    answered_by: answered_by.as_ref().map(UserName::to_string),
                    as_of: Some(self.as_of.to_string()),
                },
            )
            .await?;
        self.observer.observe(&LogEvent::AnswerRead {
            step,
            object_id: object.clone(),
            answer: answer.clone(),
            answered_by: answered_by.clone(),
            ownership: ownership.clone(),
            owner_outside_household: reading.outside_household,
            status: recorded.status,
        })?;
        let report = QuestionReport { answer, answered_by, ownership, status: recorded.status, ..put };
        debug_assert_eq!(recorded.status == AnswerStatus::Unresolved, reading.is_unresolved());
        Ok((Event::Answered { reading }, Some(report)))
    }

    /// A question that a model cannot word is worded without one, so that a person can still be asked.
    async fn word_question(
        &mut self,
        thing: &TaskObject,
        scores: &[Score],
        times_asked: u32,
    ) -> Result<String, DriveError> {
        let task = Task::AskQuestion {
            household: self.roster.users(),
            object: thing.clone(),
            scores: self.roster.scores(scores),
            times_asked,
        };
        match self.steps.word_question(&task).await {
            Ok(question) => Ok(question),
            Err(StepError::Server(error)) => Err(error.into()),
            Err(error) => {
                tracing::warn!(%error, thing = %thing.id, "the model worded no question; the built-in wording is used");
                Ok(coin::dialogue::word_question(&coin::dialogue::QuestionContext {
                    roster: self.roster,
                    class: thing.class.as_str(),
                    room: thing.room.as_deref(),
                    position: thing.position.metres(),
                    scores,
                    times_asked,
                }))
            }
        }
    }

    /// An answer that a model cannot read is read without one; what neither understands stays unresolved.
    async fn read_answer(
        &mut self,
        question: &str,
        answer: &str,
        answered_by: Option<&UserName>,
    ) -> Result<Reading, DriveError> {
        let task = Task::ReadAnswer {
            household: self.roster.users(),
            question: question.to_owned(),
            answer: answer.to_owned(),
            answered_by: answered_by.cloned(),
        };
        match self.steps.read_answer(&task).await {
            Ok(reading) => Ok(reading),
            Err(StepError::Server(error)) => Err(error.into()),
            Err(error) => {
                tracing::warn!(%error, "the model did not read the answer; the built-in reader is used");
                let speaker = answered_by.and_then(|name| self.roster.index_of(name.as_str()).ok());
                Ok(coin::dialogue::read_answer(self.roster, question, answer, speaker))
            }
        }
    }
}

fn likeliest_first(roster: &Roster, scores: &[Score]) -> Vec<Candidate> {
    let mut ranked: Vec<Candidate> =
        roster.names().zip(scores).map(|(name, &score)| Candidate { name: name.clone(), score }).collect();
    ranked.sort_by(|left, right| {
        right.score.value().total_cmp(&left.score.value()).then_with(|| left.name.cmp(&right.name))
    });
    ranked
}
