//! Who takes note of a run: the event log in a file, and the story on the terminal. Both are made from the same
//! events.

use std::collections::BTreeMap;

use coin_schemas::events::LogEvent;
use coin_schemas::household::{ClassLabel, ObjectId, Owners, UserName};
use coin_schemas::report::AnswerStatus;

use crate::driver::Observer;
use crate::output::narration::{AnswerRead, Belief};
use crate::output::{Changed, EventLog, EventLogError, Narration};

/// Writes the event log and tells the story.
pub struct Chronicle {
    log: Option<EventLog>,
    narration: Narration,
    classes: BTreeMap<ObjectId, ClassLabel>,
    beliefs: BTreeMap<ObjectId, (Owners, f64)>,
    /// Whom people named.
    said: BTreeMap<ObjectId, Vec<Owners>>,
    inferring: bool,
    /// An answer is told once the pass after it has shown what it changed.
    untold: Option<UntoldAnswer>,
}

struct UntoldAnswer {
    step: usize,
    answer: String,
    answered_by: Option<UserName>,
    owners: Owners,
    status: AnswerStatus,
    before: Option<(Owners, f64)>,
    said_before: Option<Owners>,
    changed: Vec<Changed>,
}

impl Chronicle {
    /// Nothing has happened yet.
    pub fn new(log: Option<EventLog>, narration: Narration) -> Self {
        Self {
            log,
            narration,
            classes: BTreeMap::new(),
            beliefs: BTreeMap::new(),
            said: BTreeMap::new(),
            inferring: false,
            untold: None,
        }
    }

    fn tell(&mut self, event: &LogEvent) {
        match event {
            LogEvent::RunStarted { episode, users, objects, .. } => {
                self.classes.clone_from(objects);
                self.narration.run_started(episode, users, objects.len());
            }
            LogEvent::InferenceStarted { pass, objects } => {
                self.inferring = true;
                self.narration.inference_started(*pass, objects.len());
            }
            LogEvent::ToolCalled { .. } => {}
            LogEvent::ObjectInferred { object_id, owners, confidence, .. } => {
                self.narration.object_inferred();
                let before = self.beliefs.insert(object_id.clone(), (owners.clone(), *confidence));
                self.note_change(object_id, before, owners);
            }
            LogEvent::ModelFaltered { object_id, reason } => {
                if let Some(class) = self.classes.get(object_id) {
                    self.narration.model_faltered(object_id, class, reason);
                }
            }
            LogEvent::QuestionAsked { step, question, .. } => {
                self.end_of_pass();
                self.narration.question_asked(*step, question);
            }
            LogEvent::QuestionRecalled { step, question, answer, .. } => {
                self.end_of_pass();
                self.narration.question_recalled(*step, question, answer);
            }
            LogEvent::AnswerRead { step, object_id, answer, answered_by, ownership, status, .. } => {
                let named = ownership.iter().filter(|(_, owner)| **owner);
                let owners: Owners = named.map(|(name, _)| name.clone()).collect();
                let said_before = match status {
                    AnswerStatus::Answered => {
                        let said = self.said.entry(object_id.clone()).or_default();
                        said.push(owners.clone());
                        said.iter().nth_back(1).cloned()
                    }
                    AnswerStatus::Unresolved => None,
                };
                self.untold = Some(UntoldAnswer {
                    step: *step,
                    answer: answer.clone(),
                    answered_by: answered_by.clone(),
                    owners,
                    said_before,
                    status: *status,
                    before: self.beliefs.get(object_id).cloned(),
                    changed: Vec::new(),
                });
            }
            LogEvent::QuestionDeclined { .. } => self.narration.declined(),
            LogEvent::AnswerUndone { step, object_id } => {
                self.said.entry(object_id.clone()).or_default().pop();
                self.untold = None;
                self.narration.answer_undone(*step);
            }
            LogEvent::NobodyLeft { .. } => self.narration.nobody_left(),
            LogEvent::RunFinished { .. } => self.end_of_pass(),
        }
    }

    fn note_change(&mut self, object: &ObjectId, before: Option<(Owners, f64)>, after: &Owners) {
        let (Some(untold), Some((before, _)), Some(class)) =
            (&mut self.untold, before, self.classes.get(object))
        else {
            return;
        };
        if before != *after {
            untold.changed.push(Changed {
                object_id: object.clone(),
                class: class.clone(),
                before,
                after: after.clone(),
            });
        }
    }

    fn end_of_pass(&mut self) {
        if std::mem::take(&mut self.inferring) {
            self.narration.inference_finished();
        }
        if let Some(untold) = self.untold.take() {
            self.narration.answer_read(&AnswerRead {
                step: untold.step,
                answer: &untold.answer,
                answered_by: untold.answered_by.as_ref(),
                owners: &untold.owners,
                status: untold.status,
                before: untold
                    .before
                    .as_ref()
                    .map(|(owners, confidence)| Belief { owners, confidence: *confidence }),
                said_before: untold.said_before.as_ref(),
                changed: &untold.changed,
            });
        }
    }
}

impl Observer for Chronicle {
    fn observe(&mut self, event: &LogEvent) -> Result<(), EventLogError> {
        if let Some(log) = &mut self.log {
            log.write(event)?;
        }
        self.tell(event);
        Ok(())
    }
}
