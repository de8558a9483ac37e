//! How the scores of things are made: by the model alone, by the evidence model alone, or as one posterior of both.
//!
//! A thing whose context did not change is not judged anew by a language model. Where the model fails on a thing, the
//! evidence model stands in, and the belief says so.

mod memory;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Inference, Parts};
use coin::calibration::UNCALIBRATED_CONFIDENCE;
use coin::common_sense::expect;
use coin::evidence::{EvidenceParameters, Opinion, WeighedContext};
use coin::owners::OwnerSetDistribution;
use coin::roster::{Roster, RosterError};
use coin_schemas::household::{ObjectId, Score};
use coin_schemas::model::{GivenContext, Task, TaskObject, ThingInContext};
use coin_schemas::report::{ContextSource, Estimator, Reinference, Withheld};
use jiff::civil::DateTime;

use crate::client::ServerError;
use crate::evidence::{context, related, surroundings};
use crate::model::{ModelError, ToolArguments};
use crate::steps::{CalledTool, InferStep, Scored, StepError, Steps};
use memory::{Basis, Memory};

/// How many captions of each person a model finds in the prompt, as many as it is shown by default when it asks.
const EXAMPLES_IN_THE_PROMPT: u32 = 5;

/// A model is not asked about a thing whose best owner set keeps at least this probability whatever it says: even
/// without a calibration nobody would be asked about it.
const DECIDED: f64 = UNCALIBRATED_CONFIDENCE;

/// The evidence model counts sessions and reads no captions.
const NO_EXAMPLES: u32 = 0;

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
    /// The household as the evidence model is told of it.
    told: Roster,
    as_of: DateTime,
    parameters: EvidenceParameters,
    memory: Memory,
}

impl<'a> Estimation<'a> {
    /// Scores of a run in which these steps are taken, as of this moment. The paper's scheme of inferring every thing
    /// again asks the model every time, so that its price can be told.
    ///
    /// # Errors
    /// If the household cannot be told without what is withheld, which is a fault of this program.
    pub fn new(
        steps: &'a Steps<'a>,
        withheld: BTreeSet<Withheld>,
        as_of: DateTime,
        reinference: Reinference,
    ) -> Result<Self, RosterError> {
        Ok(Self {
            told: Roster::new(steps.household())?,
            steps,
            withheld,
            as_of,
            parameters: EvidenceParameters::default(),
            memory: Memory::of(reinference),
        })
    }

    /// How many things are judged in one conversation.
    pub fn batch(&self) -> usize {
        self.steps.scoring().batch.max(1)
    }

    /// Takes over what an earlier part of the run concluded, so that the model is not asked for it again.
    pub fn remember(&self, object: &ObjectId, inference: &Inference) {
        if let Some(Parts { model: Some(scores), .. }) = &inference.parts {
            self.memory.keep_opinion(object, scores, inference.problem.clone());
        }
    }

    /// Scores these things, of which there are at most [`Self::batch`], in the order given.
    pub async fn infer(&self, things: &[&TaskObject]) -> Vec<Estimate> {
        match (self.steps.scoring().estimator, self.steps.scoring().context) {
            (Estimator::Evidence, _) => {
                let mut estimates = Vec::with_capacity(things.len());
                for thing in things {
                    estimates.push(self.by_evidence(thing).await.into());
                }
                estimates
            }
            (Estimator::Model, ContextSource::Tools) => {
                let mut estimates = Vec::with_capacity(things.len());
                for thing in things {
                    estimates.push(self.by_model_with_tools(thing).await);
                }
                estimates
            }
            (Estimator::Model, ContextSource::Given) => self.by_model_with_context(things).await,
            (Estimator::Fused, _) => self.fused(things).await,
        }
    }

    /// The evidence model by itself, with the file of classes for common sense.
    async fn by_evidence(&self, thing: &TaskObject) -> Result<Inference, StepError> {
        let context = self.context(thing, NO_EXAMPLES).await?;
        let distribution = self.weigh(thing, &context, None)?;
        Ok(self.inference(distribution, &context))
    }

    async fn context(&self, thing: &TaskObject, examples: u32) -> Result<GivenContext, ServerError> {
        context(self.steps.server(), &thing.id, self.as_of, &self.withheld, examples).await
    }

    /// The posterior of the evidence, with a model's common sense in place of the file's where there is one.
    fn weigh(
        &self,
        thing: &TaskObject,
        context: &GivenContext,
        opinion: Option<&[Score]>,
    ) -> Result<OwnerSetDistribution, StepError> {
        let expectation = expect(thing.class.as_str(), &self.told);
        let opinion = match opinion {
            Some(scores) => Opinion::OfModel(scores),
            None => Opinion::from(expectation.as_ref()),
        };
        Ok(self.weighed(thing, context)?.posterior(opinion, &self.parameters))
    }

    fn weighed(&self, thing: &TaskObject, context: &GivenContext) -> Result<WeighedContext, StepError> {
        WeighedContext::new(&self.told, &thing.class, context)
            .map_err(|error| StepError::Unusable { reason: error.to_string() })
    }

    fn inference(&self, distribution: OwnerSetDistribution, context: &GivenContext) -> Inference {
        Inference {
            scores: distribution.marginals(self.told.len()),
            distribution,
            related: related(context),
            ..Inference::default()
        }
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
    async fn by_model_with_tools(&self, thing: &TaskObject) -> Estimate {
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
            Err(error) => self.stand_in(thing, error).await,
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
    async fn by_model_with_context(&self, things: &[&TaskObject]) -> Vec<Estimate> {
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
                Some(Err(error)) => self.stand_in(&object, error).await,
                None => self.stand_in(&object, not_asked()).await,
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
    async fn fused(&self, things: &[&TaskObject]) -> Vec<Estimate> {
        let mut known = BTreeMap::new();
        let mut weighed: Vec<ThingInContext> = Vec::new();
        for thing in things {
            match self.context(thing, NO_EXAMPLES).await {
                Ok(context) => weighed.push(ThingInContext { object: (*thing).clone(), context }),
                Err(error) => {
                    known.insert(thing.id.clone(), Err(error.into()));
                }
            }
        }
        let (called, mut failures) = self.hear(&weighed).await;
        for ThingInContext { object, context } in &weighed {
            let outcome = match failures.remove(&object.id) {
                Some(error) => self.stand_in(object, error).await,
                None => self.fuse(object, context),
            };
            known.insert(object.id.clone(), outcome);
        }
        in_order(things, known, called)
    }

    /// Has the model say what common sense says of the things that it has not spoken of yet and whose owners its word
    /// could unsettle. The tools that it called, and where it failed.
    async fn hear(
        &self,
        things: &[ThingInContext],
    ) -> (BTreeMap<ObjectId, Vec<CalledTool>>, BTreeMap<ObjectId, StepError>) {
        let unheard = things.iter().filter(|thing| {
            self.memory.opinion(&thing.object.id).is_none() && !self.is_decided(&thing.object, &thing.context)
        });
        let mut called = BTreeMap::new();
        let outcomes: BTreeMap<ObjectId, Result<Scored, StepError>> = match self.steps.scoring().context {
            ContextSource::Tools => {
                let mut outcomes = BTreeMap::new();
                for ThingInContext { object, .. } in unheard {
                    let step = self.steps.infer(&self.task(object, None)).await;
                    called.insert(object.id.clone(), step.called);
                    outcomes.insert(object.id.clone(), step.outcome);
                }
                outcomes
            }
            ContextSource::Given => {
                let told = |thing: &ThingInContext| ThingInContext {
                    object: thing.object.clone(),
                    context: surroundings(&thing.context),
                };
                self.ask_about(&unheard.map(told).collect::<Vec<_>>()).await
            }
        };
        let mut failures = BTreeMap::new();
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

    /// Whether the evidence settles a thing whatever a model says. What cannot be told here fails where it is weighed.
    fn is_decided(&self, thing: &TaskObject, context: &GivenContext) -> bool {
        self.weighed(thing, context)
            .is_ok_and(|weighed| weighed.least_confidence(&self.parameters) >= DECIDED)
    }

    fn fuse(&self, thing: &TaskObject, context: &GivenContext) -> Result<Inference, StepError> {
        let (opinion, remark) = self.memory.opinion(&thing.id).unzip();
        let fused = self.weigh(thing, context, opinion.as_deref())?;
        let evidence = self.weighed(thing, context)?.posterior(Opinion::None, &self.parameters);
        let parts = Parts { model: opinion, evidence: evidence.marginals(self.told.len()) };
        Ok(Inference { parts: Some(parts), problem: remark.flatten(), ..self.inference(fused, context) })
    }

    /// The evidence model speaks where the model failed, unless nothing can go on.
    async fn stand_in(&self, thing: &TaskObject, error: StepError) -> Result<Inference, StepError> {
        if error.ends_run() {
            return Err(error);
        }
        let by_evidence = self.by_evidence(thing).await?;
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
