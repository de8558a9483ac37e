//! What has been concluded of things in this run, and from what.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use coin::agent::Inference;
use coin_schemas::household::{ObjectId, Score};
use coin_schemas::model::GivenContext;
use coin_schemas::report::Reinference;

use crate::steps::SeenResult;

/// What a conclusion was drawn from. The same basis would lead to the same conversation.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Basis {
    /// The results that the model fetched.
    Results(Vec<SeenResult>),
    /// The context that it was given.
    Context(GivenContext),
}

/// A model's common sense about a thing, and what was made good in it.
pub(super) type Heard = (Vec<Score>, Option<String>);

/// What is kept of things.
#[derive(Debug, Default)]
pub(super) struct Memory {
    forgets: bool,
    things: Mutex<BTreeMap<ObjectId, (Basis, Inference)>>,
    opinions: Mutex<BTreeMap<ObjectId, Heard>>,
}

impl Memory {
    /// A memory of a run with this scheme. In the paper's scheme it keeps nothing.
    pub(super) fn of(reinference: Reinference) -> Self {
        Self { forgets: reinference == Reinference::EveryUnasked, ..Self::default() }
    }

    pub(super) fn keep(&self, thing: &ObjectId, basis: Basis, inference: &Inference) {
        if !self.forgets {
            let mut things = self.things.lock().unwrap_or_else(PoisonError::into_inner);
            things.insert(thing.clone(), (basis, inference.clone()));
        }
    }

    pub(super) fn of_thing(&self, thing: &ObjectId) -> Option<(Basis, Inference)> {
        self.things.lock().unwrap_or_else(PoisonError::into_inner).get(thing).cloned()
    }

    pub(super) fn keep_opinion(&self, thing: &ObjectId, scores: &[Score], remark: Option<String>) {
        let mut opinions = self.opinions.lock().unwrap_or_else(PoisonError::into_inner);
        opinions.insert(thing.clone(), (scores.to_vec(), remark));
    }

    /// A model's common sense about a thing. It rests on nothing that an answer changes.
    pub(super) fn opinion(&self, thing: &ObjectId) -> Option<Heard> {
        self.opinions.lock().unwrap_or_else(PoisonError::into_inner).get(thing).cloned()
    }
}
