//! The driver: performs what the agent wants done and reports back what happened. All input and output of a run
//! goes through here; what to do next is decided by `coin::agent` alone.

mod ask;
mod infer;

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Agent, Effect, Event, ObjectState, UnexpectedEvent};
use coin::owners::OwnerSet;
use coin::roster::Roster;
use coin_schemas::events::LogEvent;
use coin_schemas::household::{ObjectId, Source};
use coin_schemas::model::TaskObject;
use coin_schemas::report::{Estimator, QuestionReport, Stopped};
use coin_schemas::tools::{RecordScores, RecordScoresResult};
use futures::{StreamExt, TryStreamExt};
use jiff::civil::DateTime;
use thiserror::Error;
use tokio_util::sync::CancellationToken;

use crate::client::{ServerError, ToolServer};
use crate::estimation::Estimation;
use crate::journal::{Journal, JournalError};
use crate::model::ModelError;
use crate::output::EventLogError;
use crate::person::{Person, PersonError};
use crate::steps::{StepError, Steps};

/// Owner sets that are less probable are not stored. A household of eight has 255, nearly all of them next to impossible.
const WORTH_STORING: f64 = 1e-6;

/// How many beliefs are on their way to the server at once.
const STORED_AT_ONCE: usize = 16;

/// Why a run could not be carried through.
#[derive(Debug, Error)]
pub enum DriveError {
    /// The tool server failed.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// The person could not be reached.
    #[error(transparent)]
    Person(#[from] PersonError),
    /// The model cannot be used at all.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A step on which everything after it rests came to nothing.
    #[error("the model gave nothing to go on with: {reason}")]
    Step {
        /// What was wrong.
        reason: String,
    },
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
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

impl From<StepError> for DriveError {
    fn from(error: StepError) -> Self {
        match error {
            StepError::Server(error) => Self::Server(error),
            StepError::Model(error) => Self::Model(error),
            StepError::Unusable { reason } => Self::Step { reason },
        }
    }
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
    /// What makes the scores.
    pub estimation: &'a Estimation<'a>,
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
    /// How many conversations go on at once.
    pub concurrency: usize,
    /// Who answers.
    pub person: &'a mut dyn Person,
    /// Who takes note.
    pub observer: &'a mut dyn Observer,
    /// What is kept for a run that goes on later, and what an earlier one left.
    pub journal: Journal,
    /// Ends the run from outside.
    pub stop: CancellationToken,
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

/// A run under way.
struct Run<'a> {
    driver: Driver<'a>,
    agent: Agent,
    questions: Vec<QuestionReport>,
    history: Vec<BTreeMap<ObjectId, Standing>>,
    /// The agent as it was when each question was open, so that an answer can be taken back.
    open: Vec<Agent>,
    /// The things whose beliefs are to be stored when the run ends.
    unstored: BTreeSet<ObjectId>,
}

impl<'a> Driver<'a> {
    /// Carries the agent from its start to its end.
    pub async fn run(self, agent: Agent) -> Result<Outcome, DriveError> {
        let run = Run {
            driver: self,
            agent,
            questions: Vec::new(),
            history: Vec::new(),
            open: Vec::new(),
            unstored: BTreeSet::new(),
        };
        run.finish().await
    }
}

impl Run<'_> {
    async fn finish(mut self) -> Result<Outcome, DriveError> {
        let mut pass = 0;
        let mut effects = self.agent.handle(Event::Started)?;
        loop {
            let mut events = Vec::new();
            for effect in effects {
                match effect {
                    Effect::Infer { objects } => {
                        events.extend(self.driver.infer(pass, objects, &self.agent).await?);
                        pass += 1;
                    }
                    // What no model was paid for is worked out again wherever it is needed, and stored in the end.
                    Effect::Record { objects } if self.driver.is_free() => self.unstored.extend(objects),
                    Effect::Record { objects } => self.driver.record(&self.agent, &objects).await?,
                    Effect::Weigh { objects } => {
                        let (answers, from) = (self.agent.answers(), self.agent.settled_from());
                        let doubt_left = self.driver.estimation.doubt_left(&objects, &answers, from).await?;
                        events.push(Event::Weighed { doubt_left });
                    }
                    Effect::Ask { object } => {
                        let standings = self.driver.standings(&self.agent);
                        self.history.push(standings);
                        debug_assert_eq!(self.history.len(), self.questions.len() + 1);
                        events.push(self.ask(object, Vec::new()).await?);
                    }
                    Effect::AskTogether { objects } => {
                        let standings = self.driver.standings(&self.agent);
                        self.history.push(standings);
                        let mut objects = objects.into_iter();
                        let first = objects
                            .next()
                            .ok_or_else(|| DriveError::Malformed("a question about nothing".to_owned()))?;
                        events.push(self.ask(first, objects.collect()).await?);
                    }
                    Effect::Finish { stopped } => {
                        let mut unstored = std::mem::take(&mut self.unstored);
                        // What a person said stands by itself.
                        unstored.retain(|object| {
                            self.agent.object(object).is_some_and(|state| state.answer().is_none())
                        });
                        let unstored: Vec<ObjectId> = unstored.into_iter().collect();
                        self.driver.record(&self.agent, &unstored).await?;
                        // Where nobody was left to ask, the state before the open question is the last one.
                        if self.history.len() == self.questions.len() {
                            let standings = self.driver.standings(&self.agent);
                            self.history.push(standings);
                        }
                        // Confidence without the model, for want of tokens, is no end of its own.
                        let stopped = match stopped {
                            Stopped::Confident if self.driver.steps.is_out_of_budget() => Stopped::Budget,
                            stopped => stopped,
                        };
                        let Self { agent, questions, history, .. } = self;
                        return Ok(Outcome { agent, questions, history, stopped });
                    }
                }
            }
            effects = Vec::new();
            for event in events {
                effects.extend(self.agent.handle(event)?);
            }
        }
    }
}

impl Driver<'_> {
    /// Whether scores are made without a model that is paid for.
    fn is_free(&self) -> bool {
        self.steps.scoring().estimator == Estimator::Evidence
    }

    fn standings(&self, agent: &Agent) -> BTreeMap<ObjectId, Standing> {
        let unknown = ObjectState::default();
        self.things
            .keys()
            .map(|object| (object.clone(), Standing::from(agent.object(object).unwrap_or(&unknown))))
            .collect()
    }

    fn thing(&self, object: &ObjectId) -> Result<&TaskObject, DriveError> {
        self.things
            .get(object)
            .ok_or_else(|| DriveError::Malformed(format!("thing {object} is not in the episode")))
    }

    async fn record(&mut self, agent: &Agent, objects: &[ObjectId]) -> Result<(), DriveError> {
        let beliefs = objects.iter().filter_map(|object| {
            let state = agent.object(object)?;
            let (scores, distribution) = (state.scores()?, state.distribution()?);
            let scores = self.roster.scores(scores).into_iter();
            Some(RecordScores {
                object_id: object.to_string(),
                scores: scores.map(|(name, score)| (name.to_string(), score.value())).collect(),
                owner_sets: Some(distribution.likely(self.roster, WORTH_STORING)),
                model: Some(self.model.to_owned()),
            })
        });
        let beliefs: Vec<RecordScores> = beliefs.collect();
        let server = self.server;
        futures::stream::iter(beliefs)
            .map(|belief| async move { server.call::<_, RecordScoresResult>("record_scores", &belief).await })
            .buffered(STORED_AT_ONCE)
            .try_for_each(|_| async { Ok(()) })
            .await?;
        Ok(())
    }
}
