//! One pass of LLM-INFER over the things that need it.

use coin::agent::{Agent, Event, Inference};
use coin_schemas::events::LogEvent;
use coin_schemas::household::ObjectId;
use coin_schemas::report::Stopped;
use futures::StreamExt;
use tokio::sync::Semaphore;

use super::{DriveError, Driver};
use crate::estimation::Estimate;

impl Driver<'_> {
    /// Has these things scored, several conversations at once. Results are taken in the order of the things, so that
    /// neither the log nor the report depends on which conversation ends first.
    pub(super) async fn infer(
        &mut self,
        pass: usize,
        objects: Vec<ObjectId>,
        agent: &Agent,
    ) -> Result<Vec<Event>, DriveError> {
        let answers = &agent.answers();
        self.observer.observe(&LogEvent::InferenceStarted { pass, objects: objects.clone() })?;
        let mut events = Vec::new();
        let mut waiting = Vec::new();
        for object in &objects {
            match self.journal.past_inference(object) {
                Some(inference) => {
                    self.estimation.remember(object, &inference);
                    events.push(self.note(object, inference, agent)?);
                }
                None => waiting.push(self.thing(object)?.clone()),
            }
        }
        let estimation = self.estimation;
        let batches: Vec<Vec<_>> = waiting.chunks(estimation.batch()).map(<[_]>::to_vec).collect();
        // All wait at once, and so many go on: a thing that takes long keeps nobody behind it from being judged.
        let (pieces, going_on) = (batches.len(), Semaphore::new(self.concurrency.max(1)));
        let mut results = futures::stream::iter(batches)
            .map(|things| {
                let going_on = &going_on;
                async move {
                    // Permits come in order: where one is refused, an error that ends the run is on its way.
                    let Ok(_permit) = going_on.acquire().await else { return (things, Vec::new()) };
                    let estimates = estimation.infer(&things.iter().collect::<Vec<_>>(), answers).await;
                    if estimates.iter().any(|estimate| estimate.outcome.is_err()) {
                        going_on.close();
                    }
                    (things, estimates)
                }
            })
            .buffered(pieces.max(1));
        let stop = self.stop.clone();
        // A pass that is complete is taken in whole; whoever asks next sees that the run is to stop.
        for _ in 0..pieces {
            let next = tokio::select! {
                biased;
                () = stop.cancelled() => {
                    events.push(Event::Ended { stopped: Stopped::Interrupted });
                    break;
                }
                next = results.next() => next,
            };
            let Some((things, estimates)) = next else { break };
            for (thing, Estimate { called, outcome }) in things.iter().zip(estimates) {
                for call in called {
                    self.observer.observe(&LogEvent::ToolCalled {
                        object_id: thing.id.clone(),
                        tool: call.tool,
                        is_error: call.is_error,
                    })?;
                }
                let inference = outcome?;
                // What was judged without the model for want of tokens is judged by it when the run goes on. What no
                // model is paid for is worked out again.
                if !(self.is_free() || self.steps.is_out_of_budget() && inference.problem.is_some()) {
                    self.journal.inferred(&thing.id, &inference, self.roster)?;
                }
                events.push(self.note(&thing.id, inference, agent)?);
            }
        }
        Ok(events)
    }

    /// Tells the observer what is new.
    fn note(&mut self, object: &ObjectId, inference: Inference, agent: &Agent) -> Result<Event, DriveError> {
        if !agent.object(object).is_none_or(|state| state.is_news(&inference)) {
            return Ok(Event::Inferred { object: object.clone(), inference });
        }
        if let Some(reason) = &inference.problem {
            self.observer
                .observe(&LogEvent::ModelFaltered { object_id: object.clone(), reason: reason.clone() })?;
        }
        let (owners, confidence) = inference.distribution.best();
        self.observer.observe(&LogEvent::ObjectInferred {
            object_id: object.clone(),
            scores: self.roster.scores(&inference.scores),
            owners: self.roster.owners(owners),
            confidence,
        })?;
        Ok(Event::Inferred { object: object.clone(), inference })
    }
}
