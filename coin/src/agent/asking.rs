//! What the agent would ask about, and what it asks about next.

use std::collections::BTreeSet;

use coin_schemas::household::ObjectId;
use coin_schemas::report::{Gate, Stopped};

use super::{Agent, AgentSettings, Effect, ObjectState, Phase, QuestionChoice};
use crate::evidence::DOUBTFUL;
use crate::gate::{
    AdaptedThreshold, Alike, AlikeStanding, Candidate, Held, TrackRecord, asked_together, first_few_to_ask,
    first_to_ask, wants_to_ask,
};

/// What so many questions are worth is worked out before one is put. Others are less in doubt themselves, and what an answer
/// tells of other things is little beside what it tells of its own.
const MOST_WEIGHED: usize = 8;

impl Agent {
    /// The things that the gate would have asked about: those that nobody has answered about and that it does not settle, and
    /// those of which an answer is to be confirmed.
    pub fn unsettled(&self) -> impl Iterator<Item = (&ObjectId, &ObjectState)> {
        let AgentSettings { gate, thresholds, .. } = &self.settings;
        let adapted = self.adapted_threshold();
        self.objects.iter().filter(move |(_, state)| match (state.trust(), state.assessment()) {
            // What was said twice stands.
            (Some(_), _) if !state.may_be_asked() => false,
            (Some(trust), _) => match gate {
                // The paper takes every answer as it is.
                Gate::Paper | Gate::Never => false,
                Gate::Risk | Gate::Adaptive | Gate::Set | Gate::Always => {
                    trust < DOUBTFUL || adapted.is_some_and(|adapted| !adapted.settles_answer(trust))
                }
            },
            (None, None) => *gate != Gate::Never,
            (None, Some(assessment)) => {
                wants_to_ask(*gate, thresholds, assessment)
                    || adapted.is_some_and(|adapted| !adapted.settles(assessment.confidence))
            }
        })
    }

    /// How what was thought of things fared against the answers about them.
    pub fn track_record(&self) -> TrackRecord {
        let mut record = TrackRecord::default();
        for (confidence, agrees) in self.objects.values().filter_map(ObjectState::claim) {
            record.add(confidence, agrees);
        }
        record
    }

    /// The threshold of the adaptive gate, as the answers so far have it; `None` with another gate. What nobody can be asked
    /// about any more is not counted.
    pub fn adapted_threshold(&self) -> Option<AdaptedThreshold> {
        let AgentSettings { gate, risk, .. } = self.settings;
        let open = self.objects.values().filter(|state| state.may_be_asked());
        let held = open.filter_map(|state| match state.trust() {
            Some(trust) => Some(Held::Answered { trust }),
            None => Some(Held::Inferred { confidence: state.assessment()?.confidence }),
        });
        (gate == Gate::Adaptive)
            .then(|| AdaptedThreshold::new(held, self.objects.len(), risk, self.track_record()))
    }

    /// Lines 13 to 17 of Algorithm 1: stop where the gate finds nothing to ask, else ask about the least sure.
    /// Things that were asked about less often come first.
    pub(super) fn ask_or_finish(&mut self) -> Vec<Effect> {
        let gate = self.settings.gate;
        let unsettled: Vec<(&ObjectId, &ObjectState)> = self.unsettled().collect();
        if unsettled.is_empty() {
            return self.finish_up_to_date(Stopped::Confident);
        }
        if self.questions >= self.settings.max_questions {
            return self.finish(Stopped::MaxQuestions);
        }
        let candidates = unsettled.iter().filter(|(_, state)| state.may_be_asked()).map(|(object, state)| {
            Candidate { object, times_asked: state.times_asked(), assessment: state.assessment() }
        });
        match self.settings.choice {
            QuestionChoice::LeastSure => match first_to_ask(gate, candidates).cloned() {
                Some(object) => self.ask(object),
                None => self.finish_up_to_date(Stopped::NothingLeftToAsk),
            },
            QuestionChoice::MostInformative => {
                let few = first_few_to_ask(gate, candidates, MOST_WEIGHED);
                let Some(first) = few.first() else {
                    return self.finish_up_to_date(Stopped::NothingLeftToAsk);
                };
                let comparable = few.iter().filter(|other| {
                    other.times_asked == first.times_asked
                        && other.assessment.is_some() == first.assessment.is_some()
                });
                let objects: Vec<ObjectId> = comparable.map(|candidate| candidate.object.clone()).collect();
                match objects.as_slice() {
                    [only] => self.ask(only.clone()),
                    _ => {
                        self.phase = Phase::Weighing { objects: objects.clone() };
                        vec![Effect::Weigh { objects }]
                    }
                }
            }
        }
    }

    pub(super) fn ask(&mut self, object: ObjectId) -> Vec<Effect> {
        if let Some(objects) = self.asked_together(&object) {
            self.phase = Phase::Asking { objects: objects.clone() };
            return vec![Effect::AskTogether { objects }];
        }
        self.phase = Phase::Asking { objects: vec![object.clone()] };
        vec![Effect::Ask { object }]
    }

    /// This thing with others that may be asked about in the same question; `None` where it is better asked about alone.
    fn asked_together(&self, object: &ObjectId) -> Option<Vec<ObjectId>> {
        let group = self.alike.iter().find(|group| group.contains(object))?;
        let unsettled: BTreeSet<&ObjectId> = self.unsettled().map(|(object, _)| object).collect();
        let alike: Option<Vec<Alike<'_>>> = group
            .iter()
            .map(|object| {
                let state = self.objects.get(object)?;
                let standing = match unsettled.contains(object) {
                    false => AlikeStanding::Settled,
                    true if state.was_asked() => AlikeStanding::Asked,
                    true => AlikeStanding::Open { confidence: state.assessment()?.confidence },
                };
                Some(Alike { object, owners: state.owners(), standing })
            })
            .collect();
        let mut together: Vec<ObjectId> = asked_together(&alike?)?.into_iter().cloned().collect();
        let first = together.iter().position(|other| other == object)?;
        together.swap(0, first);
        Some(together)
    }

    /// From which probability of its best owner set on a thing is settled without an answer by the gates that go by it.
    pub fn settled_from(&self) -> f64 {
        let adapted = self.adapted_threshold().map_or(0.0, |adapted| adapted.lambda());
        self.settings.thresholds.lambda().max(adapted)
    }
}
