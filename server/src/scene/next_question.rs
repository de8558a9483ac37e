//! Which question is worth asking.

use std::collections::BTreeMap;

use coin::dialogue::{QuestionContext, word_question};
use coin::gate::{Candidate, first_to_ask};
use coin_schemas::household::ObjectId;
use coin_schemas::report::Gate;

use super::{Judgement, Moment, Scene};
use crate::store::{Belief, OpenQuestions, StoreError, StoredObject};

/// What is to be asked.
pub(crate) struct Next<'a> {
    /// How many things are not settled.
    pub(crate) unsettled: u64,
    /// The thing to ask about and what is held of it; `None` where no question is worth asking.
    pub(crate) ask: Option<(&'a StoredObject, Judgement)>,
}

impl Scene<'_> {
    /// The thing about which the gate asks first; one whose answer is outdated may be it. What a person would not tell is passed over, and what was asked about
    /// in vain comes after what was not.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn next_question(&self) -> Result<Next<'_>, StoreError> {
        let beliefs = self.beliefs()?;
        self.weigh_all()?;
        let questions = self.reader.open_questions()?;
        let mut unsettled: BTreeMap<&ObjectId, (&StoredObject, Judgement)> = BTreeMap::new();
        for object in self.objects()? {
            self.reader.go_on()?;
            if matches!(beliefs.get(&object.key), Some(Belief::Answered { .. }))
                && !self.is_reopened(object)?
            {
                continue;
            }
            let judgement = self.judge(object, Moment::Present)?;
            if !judgement.is_settled() {
                unsettled.insert(&object.id, (object, judgement));
            }
        }
        let candidates = unsettled.iter().filter_map(|(id, (object, judgement))| {
            let open = questions.get(&object.key).copied().unwrap_or_default();
            let assessment = Some(&judgement.assessment);
            (!open.declined).then_some(Candidate { object: id, times_asked: open.asked, assessment })
        });
        let first = first_to_ask(Gate::Risk, candidates).cloned();
        let count = unsettled.len() as u64;
        Ok(Next { unsettled: count, ask: first.and_then(|id| unsettled.remove(&id)) })
    }

    /// The question about a thing, in words for a person.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn question(
        &self,
        object: &StoredObject,
        judgement: &Judgement,
    ) -> Result<String, StoreError> {
        let open = self.open_question(object)?;
        Ok(word_question(&QuestionContext {
            roster: self.household.roster(),
            class: object.class.as_str(),
            room: object.room.as_deref(),
            position: object.position.metres(),
            scores: &judgement.scores,
            times_asked: open.asked,
        }))
    }

    /// Whether somebody would not tell whose a thing is.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn is_declined(&self, object: &StoredObject) -> Result<bool, StoreError> {
        Ok(self.open_question(object)?.declined)
    }

    fn open_question(&self, object: &StoredObject) -> Result<OpenQuestions, StoreError> {
        Ok(self.reader.open_questions()?.get(&object.key).copied().unwrap_or_default())
    }
}
