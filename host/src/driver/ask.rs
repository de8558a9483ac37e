//! One question: QUESTION-GENERATION, the person, UNDERSTAND-ANSWER, and the record of the answer.

use coin::agent::{Agent, Event, ObjectState};
use coin::dialogue::{
    Doubt, Reading, as_of_one_thing, read_joint_answer, word_confirmation, word_joint_question,
};
use coin::evidence::DOUBTFUL;
use coin::owners::OwnerSet;
use coin::roster::Roster;
use coin_schemas::events::LogEvent;
use coin_schemas::household::{ObjectId, Owners, Score, UserName};
use coin_schemas::model::{Task, TaskObject};
use coin_schemas::report::{AnswerStatus, QuestionReport, Stopped};
use coin_schemas::tools::{RecordAnswer, RecordAnswerResult, RetractAnswer, RetractAnswerResult};

use super::{DriveError, Driver, Run};
use crate::journal::{PastQuestion, Recorded};
use crate::model::ModelError;
use crate::person::{Candidate, PreviousAnswer, PutQuestion, Response, Understood};
use crate::steps::StepError;

/// What a person's reply comes to.
enum Reply {
    Read { reading: Reading, answer: String, answered_by: Option<UserName> },
    Declined,
    Undo,
    Ends(Stopped),
    NobodyLeft,
}

impl Run<'_> {
    /// Puts the open question about a thing, or about that and others, and says what became of it.
    pub(super) async fn ask(
        &mut self,
        mut object: ObjectId,
        mut also: Vec<ObjectId>,
    ) -> Result<Event, DriveError> {
        if let Some(event) = self.past_question(&object, &also).await? {
            return Ok(event);
        }
        loop {
            if self.driver.steps.is_out_of_budget() {
                return Ok(Event::Ended { stopped: Stopped::Budget });
            }
            let step = self.agent.questions() + 1;
            let (question, reply) = self.put(step, &object, &also).await?;
            match reply {
                Reply::Read { reading, answer, answered_by } => {
                    let ownership = self.driver.roster.ownership(reading.owners);
                    let status = match reading.is_unresolved() {
                        true => AnswerStatus::Unresolved,
                        false => AnswerStatus::Answered,
                    };
                    let question = QuestionReport { answer, answered_by, ownership, status, ..question };
                    self.driver.journal.answered(&question, reading.outside_household)?;
                    self.driver.record_answer(&question, reading.outside_household).await?;
                    return self.conclude(question, reading);
                }
                Reply::Declined => {
                    self.driver.journal.declined(&question)?;
                    return self.decline(question);
                }
                Reply::Undo => {
                    if let Some(before) = self.take_back().await? {
                        (object, also) = before;
                    }
                }
                Reply::Ends(stopped) => return Ok(Event::Ended { stopped }),
                Reply::NobodyLeft => {
                    self.driver.observer.observe(&LogEvent::NobodyLeft { object_id: object })?;
                    return Ok(Event::NobodyLeft);
                }
            }
        }
    }

    /// The question as an earlier part of the run put it, with what became of it.
    async fn past_question(
        &mut self,
        object: &ObjectId,
        also: &[ObjectId],
    ) -> Result<Option<Event>, DriveError> {
        let Some(past) = self.driver.journal.past_question(object, also) else { return Ok(None) };
        let (PastQuestion::Answered { question, .. } | PastQuestion::Declined { question }) = &past;
        self.driver.observer.observe(&LogEvent::QuestionRecalled {
            step: question.step,
            object_id: object.clone(),
            question: question.question.clone(),
            answer: question.answer.clone(),
        })?;
        self.driver.person.recall(object);
        match past {
            PastQuestion::Declined { question } => self.decline(question).map(Some),
            PastQuestion::Answered { question, recorded, owner_outside_household } => {
                if recorded == Recorded::Perhaps {
                    self.driver.record_answer(&question, owner_outside_household).await?;
                }
                let owners = question.ownership.iter().filter(|(_, owner)| **owner).map(|(name, _)| name);
                let owners = self
                    .driver
                    .roster
                    .owner_set(owners)
                    .map_err(|error| DriveError::Malformed(error.to_string()))?;
                let reading = Reading { owners, outside_household: owner_outside_household };
                self.conclude(question, reading).map(Some)
            }
        }
    }

    fn conclude(&mut self, question: QuestionReport, reading: Reading) -> Result<Event, DriveError> {
        self.driver.observer.observe(&LogEvent::AnswerRead {
            step: question.step,
            object_id: question.object_id.clone(),
            answer: question.answer.clone(),
            answered_by: question.answered_by.clone(),
            ownership: question.ownership.clone(),
            owner_outside_household: reading.outside_household,
            status: question.status,
        })?;
        self.open.push(self.agent.clone());
        self.questions.push(question);
        Ok(Event::Answered { reading })
    }

    fn decline(&mut self, question: QuestionReport) -> Result<Event, DriveError> {
        self.driver.observer.observe(&LogEvent::QuestionDeclined {
            step: question.step,
            object_id: question.object_id.clone(),
        })?;
        self.open.push(self.agent.clone());
        self.questions.push(question);
        Ok(Event::Declined)
    }

    /// Takes the last answer back, so that its question is open again. The thing that it is about, or `None` where
    /// there is no answer to take back.
    async fn take_back(&mut self) -> Result<Option<(ObjectId, Vec<ObjectId>)>, DriveError> {
        let (Some(agent), Some(question)) = (self.open.pop(), self.questions.pop()) else { return Ok(None) };
        self.driver.journal.undone()?;
        let after = std::mem::replace(&mut self.agent, agent);
        // The state before the question that is given up goes; that before the question that is put again stays.
        self.history.pop();
        if question.status == AnswerStatus::Answered {
            for object in question.objects() {
                let arguments = RetractAnswer { object_id: object.to_string() };
                let _: RetractAnswerResult = self.driver.server.call("retract_answer", &arguments).await?;
                // What it was to confirm stands again.
                let told = |earlier: &&QuestionReport| {
                    earlier.status == AnswerStatus::Answered && earlier.is_about(object)
                };
                if let Some(earlier) = self.questions.iter().rev().find(told) {
                    self.driver.record_answer_about(object, earlier, false).await?;
                }
            }
        }
        // What was inferred since rests on the answer.
        let believed = |agent: &Agent, object: &ObjectId| {
            agent.object(object).map(|state| state.distribution().cloned())
        };
        let changed: Vec<ObjectId> = self
            .driver
            .things
            .keys()
            .filter(|object| believed(&after, object) != believed(&self.agent, object))
            .cloned()
            .collect();
        self.driver.record(&self.agent, &changed).await?;
        self.driver.observer.observe(&LogEvent::AnswerUndone {
            step: question.step,
            object_id: question.object_id.clone(),
        })?;
        Ok(Some((question.object_id, question.also)))
    }

    /// Words the question, puts it, and reads what is said.
    async fn put(
        &mut self,
        step: usize,
        object: &ObjectId,
        also: &[ObjectId],
    ) -> Result<(QuestionReport, Reply), DriveError> {
        let thing = self.driver.thing(object)?.clone();
        let others =
            also.iter().map(|other| self.driver.thing(other).cloned()).collect::<Result<Vec<_>, _>>()?;
        let state = self.agent.object(object).cloned().unwrap_or_default();
        let roster = self.driver.roster;
        let scores = match state.scores() {
            Some(scores) => scores.to_vec(),
            None => vec![Score::ZERO; roster.len()],
        };
        let prediction_set =
            state.assessment().map_or(roster.everyone(), |assessment| assessment.prediction_set);
        let mut put = QuestionReport {
            step,
            object_id: object.clone(),
            also: also.to_vec(),
            question: String::new(),
            answer: String::new(),
            answered_by: None,
            ownership: self.driver.roster.ownership(OwnerSet::EMPTY),
            status: AnswerStatus::Unresolved,
            uncertainty_before: state.assessment().map_or(1.0, |assessment| assessment.uncertainty),
            prediction_set_before: roster.owners(prediction_set),
        };
        let stop = self.driver.stop.clone();
        let worded = tokio::select! {
            biased;
            () = stop.cancelled() => return Ok((put, Reply::Ends(Stopped::Interrupted))),
            worded = self.driver.word(&thing, &scores, &state, also.len()) => worded?,
        };
        let Some(question) = worded else { return Ok((put, Reply::Ends(Stopped::Budget))) };
        put.question.clone_from(&question);
        self.driver.observer.observe(&LogEvent::QuestionAsked {
            step,
            object_id: object.clone(),
            also: also.to_vec(),
            question: question.clone(),
        })?;
        let before = self.previous_answer();
        let remaining = remaining(&self.agent);
        let put_question = PutQuestion {
            step,
            object: &thing,
            also: &others,
            question: &question,
            candidates: &likeliest_first(roster, &scores),
            times_asked: state.times_asked(),
            before: before.as_ref(),
            remaining: Some(remaining),
        };
        let response = tokio::select! {
            biased;
            () = stop.cancelled() => Response::Stop,
            response = self.driver.person.ask(&put_question) => response?,
        };
        let of_all =
            |reading| if also.is_empty() { reading } else { read_joint_answer(reading, state.owners()) };
        let household: Owners = roster.names().cloned().collect();
        let in_words = response.in_words(&household).unwrap_or_default();
        let reply = match response {
            Response::Said { answer, answered_by } => {
                let heard = if also.is_empty() { answer.clone() } else { as_of_one_thing(&answer) };
                let reading = self.driver.read_answer(&question, &heard, answered_by.as_ref()).await?;
                Reply::Read { reading: of_all(reading), answer, answered_by }
            }
            Response::Chose { owners, owner_outside_household, answered_by } => {
                let owners =
                    roster.owner_set(&owners).map_err(|error| DriveError::Malformed(error.to_string()))?;
                // A thing that a member owns together with a stranger is that member's as far as the home goes.
                let outside_household = owner_outside_household && owners.is_empty();
                let reading = of_all(Reading { owners, outside_household });
                Reply::Read { reading, answer: in_words, answered_by }
            }
            Response::Declined => Reply::Declined,
            Response::Undo => Reply::Undo,
            Response::Stop => Reply::Ends(Stopped::Interrupted),
            Response::NobodyLeft => Reply::NobodyLeft,
        };
        Ok((put, reply))
    }

    fn previous_answer(&self) -> Option<PreviousAnswer> {
        let question = self.questions.last()?;
        let object = self.driver.things.get(&question.object_id)?.clone();
        let owners: Owners =
            question.ownership.iter().filter(|(_, owner)| **owner).map(|(name, _)| name.clone()).collect();
        let understood = match (question.status, question.answer.is_empty()) {
            (_, true) => Understood::PassedOver,
            (AnswerStatus::Unresolved, false) => Understood::Nobody,
            (AnswerStatus::Answered, false) => {
                Understood::Named { owner_outside_household: owners.is_empty(), owners }
            }
        };
        Some(PreviousAnswer { object, understood })
    }
}

impl Driver<'_> {
    async fn record_answer(
        &mut self,
        question: &QuestionReport,
        owner_outside_household: bool,
    ) -> Result<(), DriveError> {
        for object in question.objects() {
            self.record_answer_about(object, question, owner_outside_household).await?;
        }
        Ok(())
    }

    async fn record_answer_about(
        &mut self,
        object: &ObjectId,
        question: &QuestionReport,
        owner_outside_household: bool,
    ) -> Result<(), DriveError> {
        let arguments = RecordAnswer {
            object_id: object.to_string(),
            question: question.question.clone(),
            answer: question.answer.clone(),
            ownership: question.ownership.iter().map(|(name, &owner)| (name.to_string(), owner)).collect(),
            owner_outside_household,
            answered_by: question.answered_by.as_ref().map(UserName::to_string),
            as_of: Some(self.as_of.to_string()),
        };
        let recorded: RecordAnswerResult = self.server.call("record_answer", &arguments).await?;
        debug_assert_eq!(recorded.status, question.status);
        Ok(())
    }

    /// A question; `None` where no more tokens may be spent. Whether an answer was right, and whether several things belong to
    /// the same people, no model has to word.
    async fn word(
        &mut self,
        thing: &TaskObject,
        scores: &[Score],
        state: &ObjectState,
        others: usize,
    ) -> Result<Option<String>, DriveError> {
        if others > 0 {
            let (class, room) = (thing.class.as_str(), thing.room.as_deref());
            return Ok(Some(word_joint_question(self.roster, class, room, state.owners())));
        }
        let (Some(reading), Some(trust)) = (state.answer(), state.trust()) else {
            return self.word_question(thing, scores, state.times_asked()).await;
        };
        let doubt = if trust < DOUBTFUL { Doubt::Contradicted } else { Doubt::Unconfirmed };
        let described = (thing.class.as_str(), thing.room.as_deref(), thing.position.metres());
        Ok(Some(word_confirmation(self.roster, described, reading.owners, doubt)))
    }

    /// A question that a model cannot word is worded without one, so that a person can still be asked; `None` where no
    /// more tokens may be spent.
    async fn word_question(
        &mut self,
        thing: &TaskObject,
        scores: &[Score],
        times_asked: u32,
    ) -> Result<Option<String>, DriveError> {
        let task = Task::AskQuestion {
            household: self.roster.users(),
            object: thing.clone(),
            scores: self.roster.scores(scores),
            times_asked,
        };
        match self.steps.word_question(&task).await {
            Ok(question) => Ok(Some(question)),
            Err(error) if error.ends_run() => Err(error.into()),
            Err(StepError::Model(ModelError::OutOfBudget { .. })) => Ok(None),
            Err(error) => {
                tracing::warn!(%error, thing = %thing.id, "the model worded no question; the built-in wording is used");
                Ok(Some(coin::dialogue::word_question(&coin::dialogue::QuestionContext {
                    roster: self.roster,
                    class: thing.class.as_str(),
                    room: thing.room.as_deref(),
                    position: thing.position.metres(),
                    scores,
                    times_asked,
                })))
            }
        }
    }

    /// An answer that a model cannot read is read without one; what neither understands stays unresolved. What a person
    /// has said is read at once where the run is to stop.
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
        let read = tokio::select! {
            biased;
            () = self.stop.cancelled() => None,
            read = self.steps.read_answer(&task) => Some(read),
        };
        match read {
            Some(Ok(reading)) => return Ok(reading),
            Some(Err(error)) => {
                tracing::warn!(%error, "the model did not read the answer; the built-in reader is used");
            }
            None => {}
        }
        let speaker = answered_by.and_then(|name| self.roster.index_of(name.as_str()).ok());
        Ok(coin::dialogue::read_answer(self.roster, question, answer, speaker))
    }
}

/// How many things besides the one that is asked about the gate would ask about as things stand.
fn remaining(agent: &Agent) -> usize {
    let left = agent.settings().max_questions.saturating_sub(agent.questions());
    agent.unsettled().count().min(left).saturating_sub(1)
}

fn likeliest_first(roster: &Roster, scores: &[Score]) -> Vec<Candidate> {
    let mut ranked: Vec<Candidate> =
        roster.names().zip(scores).map(|(name, &score)| Candidate { name: name.clone(), score }).collect();
    ranked.sort_by(|left, right| {
        right.score.value().total_cmp(&left.score.value()).then_with(|| left.name.cmp(&right.name))
    });
    ranked
}
