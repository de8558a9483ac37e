//! D[o] of Algorithm 1: what the agent believes of one thing.

use std::sync::Arc;

use coin_schemas::household::Score;
use coin_schemas::model::RelatedObjects;
use coin_schemas::report::Gate;

use super::{AgentSettings, Inference, KNOWN_CONFIDENCE, Parts};
use crate::calibration::Assessment;
use crate::dialogue::Reading;
use crate::evidence::after_answer;
use crate::gate::MOST_TIMES_ASKED;
use crate::owners::{OwnerSet, OwnerSetDistribution};

/// A belief that moves by less than this is not told to anybody before the end of the run.
pub const NOTABLE: f64 = 0.005;

/// What is reliably known of a thing's owners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Known {
    /// The owners.
    pub owners: OwnerSet,
    /// How they are known.
    pub source: KnownSource,
}

/// How owners are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KnownSource {
    /// A person said so.
    Answered,
    /// A model concluded it with a probability of at least [`KNOWN_CONFIDENCE`].
    Inferred,
}

/// What is believed of one thing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ObjectState {
    /// Shared with earlier states of the agent, of which most beliefs are the same.
    belief: Option<Arc<Belief>>,
    /// Whether the belief has moved a little since it was last stored.
    unrecorded: bool,
    answer: Option<Reading>,
    /// What is thought of the thing when the answers are taken for evidence; `None` where nobody has answered, or nothing was
    /// thought of it before.
    weighed: Option<OwnerSetDistribution>,
    /// How sure one was before the answer, and whether that was right.
    claim: Option<(f64, bool)>,
    times_asked: u32,
    /// Whether a question about it and others has left it open.
    asked_alone: bool,
    closed_to_questions: bool,
    problem: Option<String>,
}

#[derive(Debug, Clone, PartialEq)]
struct Belief {
    inference: Inference,
    assessment: Assessment,
    owners: OwnerSet,
}

impl ObjectState {
    /// The score of every member; `None` before the first inference.
    pub fn scores(&self) -> Option<&[Score]> {
        self.belief.as_ref().map(|belief| belief.inference.scores.as_slice())
    }

    /// What was last inferred; `None` before the first inference.
    pub(super) fn inference(&self) -> Option<&Inference> {
        self.belief.as_ref().map(|belief| &belief.inference)
    }

    /// The probabilities of owner sets; `None` before the first inference.
    pub fn distribution(&self) -> Option<&OwnerSetDistribution> {
        self.belief.as_ref().map(|belief| &belief.inference.distribution)
    }

    /// What the gates make of the scores; `None` before the first inference.
    pub fn assessment(&self) -> Option<&Assessment> {
        self.belief.as_ref().map(|belief| &belief.assessment)
    }

    /// The answer that settled whose the thing is.
    pub fn answer(&self) -> Option<Reading> {
        self.answer
    }

    /// How probably the answer is right, as people err now and then and other evidence speaks for or against it; 1 where
    /// there is none. `None` where nobody has answered.
    pub fn trust(&self) -> Option<f64> {
        let reading = self.answer?;
        let weighed = self.weighed.as_ref().filter(|_| !reading.owners.is_empty());
        Some(weighed.map_or(1.0, |weighed| weighed.probability(reading.owners)))
    }

    /// The probability of the best owner set before the answer, and whether it was the one that the person named. `None`
    /// where nobody has answered, or nothing was thought of the thing before.
    pub(super) fn claim(&self) -> Option<(f64, bool)> {
        self.claim
    }

    /// The owners: answered ones, else the model's best set (with the paper's gate, the set of
    /// [`crate::sharing::owner_set`]), else nobody.
    pub fn owners(&self) -> OwnerSet {
        match (self.answer, &self.belief) {
            (Some(reading), _) => reading.owners,
            (None, Some(belief)) => belief.owners,
            (None, None) => OwnerSet::EMPTY,
        }
    }

    /// What the two parts of the belief say, where it was fused from two.
    pub fn parts(&self) -> Option<&Parts> {
        self.belief.as_ref().and_then(|belief| belief.inference.parts.as_ref())
    }

    /// How often a person was asked about the thing.
    pub fn times_asked(&self) -> u32 {
        self.times_asked
    }

    /// What went wrong when the thing was last inferred, and what was done about it.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// BUILD-KNOWN for this thing: the answered owners, else the most probable owner set where it is probable
    /// enough (also with the paper's gate, because the probability is that set's). A thing that nobody of the
    /// household owns is known as such.
    pub fn known(&self) -> Option<Known> {
        match (self.answer, &self.belief) {
            (Some(reading), _) => Some(Known { owners: reading.owners, source: KnownSource::Answered }),
            (None, Some(belief)) if belief.assessment.confidence >= KNOWN_CONFIDENCE => {
                Some(Known { owners: belief.assessment.owners, source: KnownSource::Inferred })
            }
            _ => None,
        }
    }

    pub(super) fn related(&self) -> &RelatedObjects {
        static NONE: RelatedObjects = RelatedObjects::new();
        self.belief.as_ref().map_or(&NONE, |belief| &belief.inference.related)
    }

    pub(super) fn was_inferred(&self) -> bool {
        self.belief.is_some() || self.problem.is_some()
    }

    /// Whether a person was asked about it, alone or together with other things.
    pub(super) fn was_asked(&self) -> bool {
        self.times_asked > 0 || self.asked_alone
    }

    pub(super) fn is_asked_alone(&mut self) {
        self.asked_alone = true;
    }

    pub(super) fn may_be_asked(&self) -> bool {
        !self.closed_to_questions && self.times_asked < MOST_TIMES_ASKED
    }

    pub(super) fn close_to_questions(&mut self) {
        self.times_asked += 1;
        self.closed_to_questions = true;
    }

    pub(super) fn apply_inference(&mut self, inference: Inference, settings: &AgentSettings) {
        let assessment =
            settings.thresholds.assess(&inference.scores, &inference.distribution, &settings.share);
        let owners = match settings.gate {
            Gate::Paper => crate::sharing::owner_set(&inference.scores, &settings.share),
            Gate::Risk | Gate::Adaptive | Gate::Set | Gate::Always | Gate::Never => assessment.owners,
        };
        self.problem.clone_from(&inference.problem);
        self.unrecorded = true;
        self.belief = Some(Arc::new(Belief { inference, assessment, owners }));
    }

    /// Whether a belief differs from the one there is by enough to tell anybody: in its best owner set, or in how sure that
    /// is by [`NOTABLE`].
    pub fn is_news(&self, inference: &Inference) -> bool {
        self.belief.as_ref().is_none_or(|belief| {
            let before = &belief.inference;
            let heard = |inference: &Inference| inference.parts.as_ref().map(|parts| parts.model.clone());
            if inference.problem != before.problem || heard(inference) != heard(before) {
                return true;
            }
            if inference.distribution == before.distribution {
                return false;
            }
            let (owners, confidence) = inference.distribution.best();
            let (owners_before, confidence_before) = before.distribution.best();
            owners != owners_before || (confidence - confidence_before).abs() >= NOTABLE
        })
    }

    /// Whether the belief is not stored as it is.
    pub(super) fn is_unrecorded(&self) -> bool {
        self.unrecorded
    }

    pub(super) fn is_recorded(&mut self) {
        self.unrecorded = false;
    }

    /// An earlier belief stays; the reader of the report learns that it could not be renewed.
    pub(super) fn apply_failure(&mut self, reason: String) {
        self.problem = Some(reason);
    }

    pub(super) fn apply_reading(&mut self, reading: Reading) {
        self.times_asked += 1;
        if reading.is_unresolved() {
            return;
        }
        if let Some(belief) = &self.belief {
            let Belief { inference, assessment, .. } = &**belief;
            if self.answer.is_none() {
                self.claim = Some((assessment.confidence, reading.owners == assessment.owners));
            }
            let before = self.weighed.as_ref().unwrap_or(&inference.distribution);
            self.weighed = Some(after_answer(before, reading.owners, inference.scores.len()));
        }
        self.answer = Some(reading);
    }
}
