//! How the scores of things are made: by the model alone, by the evidence model alone, or as one posterior of both.
//!
//! A thing whose context did not change is not judged anew by a language model. Where the model fails on a thing, the
//! evidence model stands in, and the belief says so.

mod home;
mod memory;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Inference, Parts};
use coin::calibration::UNCALIBRATED_CONFIDENCE;
use coin::evidence::EvidenceParameters;
use coin::owners::OwnerSetDistribution;
use coin::roster::RosterError;
use coin_schemas::household::ObjectId;
use coin_schemas::model::{GivenContext, Task, TaskObject, ThingInContext};
use coin_schemas::report::{ContextSource, Estimator, Reinference, Withheld};
use jiff::civil::DateTime;

use crate::client::ServerError;
use crate::evidence::{context, related, surroundings};
use crate::model::{ModelError, ToolArguments};
use crate::steps::{CalledTool, InferStep, Scored, StepError, Steps};
use home::SeenHome;
use memory::{Basis, Memory};

pub use home::Answers;

/// How many captions of each person a model finds in the prompt, as many as it is shown by default when it asks.
const EXAMPLES_IN_THE_PROMPT: u32 = 5;

/// A model is not asked about a thing whose best owner set keeps at least this probability whatever it says: even
/// without a calibration nobody would be asked about it.
const DECIDED: f64 = UNCALIBRATED_CONFIDENCE;

/// What came of one thing.
#[derive(Debug)]
pub struct Estimate {
    /// The tools that the model called for it.
    pub called: Vec<CalledTool>,
    /// What is believed of it; an error where the run has to end.
    pub outcome: Result<Inference, StepError>,
}

/// Makes the scores of a run.
pub struct Estimation<'a> {
    steps: &'a Steps<'a>,
    withheld: BTreeSet<Withheld>,
    as_of: DateTime,
    home: SeenHome<'a>,
    memory: Memory,
}

impl<'a> Estimation<'a> {
    /// Scores of these things of a home, in a run in which these steps are taken, as of this moment. The paper's scheme of
    /// inferring every thing again asks the model every time, so that its price can be told.
    ///
    /// # Errors
    /// If the household cannot be told without what is withheld, which is a fault of this program.
    pub fn new(
        steps: &'a Steps<'a>,
        things: &'a BTreeMap<ObjectId, TaskObject>,
        withheld: BTreeSet<Withheld>,
        as_of: DateTime,
        reinference: Reinference,
        parameters: EvidenceParameters,
    ) -> Result<Self, RosterError> {
        Ok(Self {
            home: SeenHome::new(steps, things, withheld.clone(), as_of, parameters)?,
            steps,
            withheld,
            as_of,
            memory: Memory::of(reinference),
        })
    }

    /// How many things are judged at once: in one conversation, or without any.
    pub fn batch(&self) -> usize {
        match self.steps.scoring().estimator {
            Estimator::Evidence => usize::MAX,
            Estimator::Model | Estimator::Fused => self.steps.scoring().batch.max(1),
        }
    }

    /// Takes over what an earlier part of the run concluded, so that the model is not asked for it again.
    pub fn remember(&self, object: &ObjectId, inference: &Inference) {
        if let Some(Parts { model: Some(scores), .. }) = &inference.parts {
            self.memory.keep_opinion(object, scores, inference.problem.clone());
        }
    }

    /// Scores these things, of which there are at most [`Self::batch`], in the order given, with the answers so far.
    pub async fn infer(&self, things: &[&TaskObject], answers: &Answers) -> Vec<Estimate> {
        match (self.steps.scoring().estimator, self.steps.scoring().context) {
            (Estimator::Evidence, _) => match self.home.with(answers).await {
                Ok(home) => things
                    .iter()
                    .map(|thing| home.by_evidence(&thing.id).map(|belief| self.inference(belief)).into())
                    .collect(),
                Err(error) => {
                    let ids = things.iter().map(|thing| thing.id.clone()).collect();
                    in_order(things, for_all(ids, error), BTreeMap::new())
                }
            },
            (Estimator::Model, ContextSource::Tools) => {
                let mut estimates = Vec::with_capacity(things.len());
                for thing in things {
                    estimates.push(self.by_model_with_tools(thing, answers).await);
                }
                estimates
            }
            (Estimator::Model, ContextSource::Given) => self.by_model_with_context(things, answers).await,
            (Estimator::Fused, _) => self.fused(things, answers).await,
        }
    }

    /// The doubt that is expected to be left in the home after an answer about each of these things, which the evidence model
    /// tells. Nothing below this probability of its best owner set is settled.
    ///
    /// # Errors
    /// If a thing is not in the home, or the server fails.
    pub async fn doubt_left(
        &self,
        things: &[ObjectId],
        answers: &Answers,
        settled_from: f64,
    ) -> Result<Vec<f64>, StepError> {
        self.home.doubt_left(things, answers, settled_from).await
    }

    /// The evidence model by itself, with the file of classes for common sense.
    async fn by_evidence(&self, thing: &TaskObject, answers: &Answers) -> Result<Inference, StepError> {
        Ok(self.inference(self.home.with(answers).await?.by_evidence(&thing.id)?))
    }

    async fn context(&self, thing: &TaskObject, examples: u32) -> Result<GivenContext, ServerError> {
        context(self.steps.server(), &thing.id, self.as_of, &self.withheld, examples).await
    }

    fn inference(&self, distribution: OwnerSetDistribution) -> Inference {
        let scores = distribution.marginals(self.home.roster().len());
        Inference { scores, distribution, ..Inference::default() }
    }

    fn task(&self, thing: &TaskObject, context: Option<GivenContext>) -> Task {
        Task::InferOwnership {
            household: self.steps.household().clone(),
            as_of: self.as_of,
            object: thing.clone(),
            context,
        }
    }

    /// The paper's LLM-INFER: the model fetches the context and scores alone.
    async fn by_model_with_tools(&self, thing: &TaskObject, answers: &Answers) -> Estimate {
        match self.unchanged(thing).await {
            Ok(Some(inference)) => return Ok(inference).into(),
            Ok(None) => {}
            Err(error) => return Err(error.into()).into(),
        }
        let InferStep { called, seen, related, outcome } = self.steps.infer(&self.task(thing, None)).await;
        let outcome = match outcome {
            Ok(scored) => {
                let inference = Inference { related, ..by_model_alone(scored) };
                self.memory.keep(&thing.id, Basis::Results(seen), &inference);
                Ok(inference)
            }
            Err(error) => self.stand_in(thing, answers, error).await,
        };
        Estimate { called, outcome }
    }

    /// What was concluded before, where every tool still gives the results that it was concluded from.
    async fn unchanged(&self, thing: &TaskObject) -> Result<Option<Inference>, ServerError> {
        let Some((Basis::Results(seen), inference)) = self.memory.of_thing(&thing.id) else {
            return Ok(None);
        };
        for result in seen {
            let ToolArguments::Object(arguments) = result.call.arguments else {
                return Ok(None);
            };
            let now = self.steps.server().call_raw(&result.call.tool, arguments).await?;
            if now.is_error || now.text != result.text {
                return Ok(None);
            }
        }
        Ok(Some(inference))
    }

    /// The model finds the context in the prompt and scores alone.
    async fn by_model_with_context(&self, things: &[&TaskObject], answers: &Answers) -> Vec<Estimate> {
        let mut known = BTreeMap::new();
        let mut asked = Vec::new();
        for thing in things {
            let context = match self.context(thing, EXAMPLES_IN_THE_PROMPT).await {
                Ok(context) => context,
                Err(error) => {
                    known.insert(thing.id.clone(), Err(error.into()));
                    continue;
                }
            };
            match self.memory.of_thing(&thing.id) {
                Some((Basis::Context(before), inference)) if before == context => {
                    known.insert(thing.id.clone(), Ok(inference));
                }
                _ => asked.push(ThingInContext { object: (*thing).clone(), context }),
            }
        }
        let mut scored = self.ask_about(&asked).await;
        for ThingInContext { object, context } in asked {
            let outcome = match scored.remove(&object.id) {
                Some(Ok(scored)) => {
                    let inference = Inference { related: related(&context), ..by_model_alone(scored) };
                    self.memory.keep(&object.id, Basis::Context(context), &inference);
                    Ok(inference)
                }
                Some(Err(error)) => self.stand_in(&object, answers, error).await,
                None => self.stand_in(&object, answers, not_asked()).await,
            };
            known.insert(object.id, outcome);
        }
        in_order(things, known, BTreeMap::new())
    }

    /// One conversation about these things. An error concerns all of them.
    async fn ask_about(&self, things: &[ThingInContext]) -> BTreeMap<ObjectId, Result<Scored, StepError>> {
        match things {
            [] => BTreeMap::new(),
            [ThingInContext { object, context }] => {
                let step = self.steps.infer(&self.task(object, Some(context.clone()))).await;
                [(object.id.clone(), step.outcome)].into()
            }
            _ => {
                let ids: Vec<ObjectId> = things.iter().map(|thing| thing.object.id.clone()).collect();
                let task = Task::InferSeveral {
                    household: self.steps.household().clone(),
                    as_of: self.as_of,
                    things: things.to_vec(),
                };
                match self.steps.infer_several(&task, &ids).await.outcome {
                    Ok(scored) => scored.into_iter().map(|(id, scored)| (id, Ok(scored))).collect(),
                    Err(error) => for_all(ids, error),
                }
            }
        }
    }

    /// The model's common sense, heard once for each thing, and the evidence as it is now, in one posterior. Where no
    /// opinion could unsettle what the evidence says the model is not asked.
    async fn fused(&self, things: &[&TaskObject], answers: &Answers) -> Vec<Estimate> {
        let (called, mut failures) = self.hear(things, answers).await;
        let mut known = BTreeMap::new();
        for thing in things {
            let outcome = match failures.remove(&thing.id) {
                Some(error) => self.stand_in(thing, answers, error).await,
                None => self.fuse(thing, answers).await,
            };
            known.insert(thing.id.clone(), outcome);
        }
        in_order(things, known, called)
    }

    /// Has the model say what common sense says of the things that it has not spoken of yet and whose owners its word
    /// could unsettle. The tools that it called, and where it failed.
    async fn hear(
        &self,
        things: &[&TaskObject],
        answers: &Answers,
    ) -> (BTreeMap<ObjectId, Vec<CalledTool>>, BTreeMap<ObjectId, StepError>) {
        let (mut called, mut failures) = (BTreeMap::new(), BTreeMap::new());
        let mut unheard: Vec<&TaskObject> = Vec::new();
        for thing in things {
            if self.memory.opinion(&thing.id).is_some() {
                continue;
            }
            let least = self.home.with(answers).await.and_then(|home| home.least_confidence(&thing.id));
            match least {
                Ok(confidence) if confidence >= DECIDED => {}
                Ok(_) => unheard.push(thing),
                Err(error) => {
                    failures.insert(thing.id.clone(), error);
                }
            }
        }
        let outcomes: BTreeMap<ObjectId, Result<Scored, StepError>> = match self.steps.scoring().context {
            ContextSource::Tools => {
                let mut outcomes = BTreeMap::new();
                for thing in unheard {
                    let step = self.steps.infer(&self.task(thing, None)).await;
                    called.insert(thing.id.clone(), step.called);
                    outcomes.insert(thing.id.clone(), step.outcome);
                }
                outcomes
            }
            ContextSource::Given => {
                let mut told = Vec::new();
                for thing in unheard {
                    match surroundings(self.steps.server(), &thing.id).await {
                        Ok(context) => told.push(ThingInContext { object: thing.clone(), context }),
                        Err(error) => {
                            failures.insert(thing.id.clone(), error.into());
                        }
                    }
                }
                self.ask_about(&told).await
            }
        };
        for (id, outcome) in outcomes {
            match outcome {
                Ok(Scored { scores, remark, .. }) => self.memory.keep_opinion(&id, &scores, remark),
                Err(error) => {
                    failures.insert(id, error);
                }
            }
        }
        (called, failures)
    }

    async fn fuse(&self, thing: &TaskObject, answers: &Answers) -> Result<Inference, StepError> {
        let (opinion, remark) = self.memory.opinion(&thing.id).unzip();
        let home = self.home.with(answers).await?;
        let fused = match &opinion {
            Some(scores) => home.with_opinion(&thing.id, Some(scores))?,
            None => home.by_evidence(&thing.id)?,
        };
        let evidence = home.with_opinion(&thing.id, None)?;
        let parts = Parts { model: opinion, evidence: evidence.marginals(self.home.roster().len()) };
        Ok(Inference { parts: Some(parts), problem: remark.flatten(), ..self.inference(fused) })
    }

    /// The evidence model speaks where the model failed, unless nothing can go on.
    async fn stand_in(
        &self,
        thing: &TaskObject,
        answers: &Answers,
        error: StepError,
    ) -> Result<Inference, StepError> {
        if error.ends_run() {
            return Err(error);
        }
        let by_evidence = self.by_evidence(thing, answers).await?;
        let problem = match error {
            StepError::Model(ModelError::OutOfBudget { .. }) => {
                format!("{error}; judged by the evidence alone")
            }
            error => format!("the model failed: {error}; judged by the evidence alone"),
        };
        let parts = match self.steps.scoring().estimator {
            Estimator::Fused => Some(Parts { model: None, evidence: by_evidence.scores.clone() }),
            Estimator::Model | Estimator::Evidence => None,
        };
        Ok(Inference { parts, problem: Some(problem), ..by_evidence })
    }
}

impl From<Result<Inference, StepError>> for Estimate {
    fn from(outcome: Result<Inference, StepError>) -> Self {
        Self { called: Vec::new(), outcome }
    }
}

fn by_model_alone(scored: Scored) -> Inference {
    let Scored { scores, distribution, remark } = scored;
    Inference { scores, distribution, problem: remark, ..Inference::default() }
}

fn not_asked() -> StepError {
    StepError::Unusable { reason: "the model said nothing of this thing".to_owned() }
}

/// The same error for each of several things.
fn for_all<T>(things: Vec<ObjectId>, error: StepError) -> BTreeMap<ObjectId, Result<T, StepError>> {
    let again = |error: &StepError| match error {
        StepError::Model(error) => StepError::Model(error.clone()),
        error => StepError::Unusable { reason: error.to_string() },
    };
    let mut errors: BTreeMap<ObjectId, Result<T, StepError>> =
        things.iter().skip(1).map(|thing| (thing.clone(), Err(again(&error)))).collect();
    // The first keeps the error itself, so that a server that is gone ends the run.
    errors.extend(things.into_iter().next().map(|thing| (thing, Err(error))));
    errors
}

fn in_order(
    things: &[&TaskObject],
    mut outcomes: BTreeMap<ObjectId, Result<Inference, StepError>>,
    mut called: BTreeMap<ObjectId, Vec<CalledTool>>,
) -> Vec<Estimate> {
    things
        .iter()
        .map(|thing| Estimate {
            called: called.remove(&thing.id).unwrap_or_default(),
            outcome: outcomes.remove(&thing.id).unwrap_or_else(|| Err(not_asked())),
        })
        .collect()
}
