//! Short words for the values that tests are made of. The unit tests of the crate and its integration tests share
//! this file; neither uses all of it.
#![allow(dead_code)]

use coin::conformal::Level;
use coin::owners::OwnerSet;
use coin::roster::{Roster, UserIndex};
use coin_schemas::household::{Background, ObjectId, Score, UserName, Users};
use proptest::prelude::*;

pub(crate) fn user(place: usize) -> UserIndex {
    UserIndex::new(place).unwrap()
}

pub(crate) fn set(places: &[usize]) -> OwnerSet {
    places.iter().copied().map(user).collect()
}

pub(crate) fn places(set: OwnerSet) -> Vec<usize> {
    set.iter().map(UserIndex::place).collect()
}

pub(crate) fn scores(values: &[f64]) -> Vec<Score> {
    values.iter().map(|&value| Score::new(value).unwrap()).collect()
}

pub(crate) fn values(scores: &[Score]) -> Vec<f64> {
    scores.iter().map(|score| score.value()).collect()
}

pub(crate) fn level(value: f64) -> Level {
    Level::new(value).unwrap()
}

pub(crate) fn name(text: &str) -> UserName {
    UserName::new(text).unwrap()
}

pub(crate) fn id(text: &str) -> ObjectId {
    ObjectId::new(text).unwrap()
}

/// A household of these people, of whom nothing else is known.
pub(crate) fn roster(names: &[&str]) -> Roster {
    let users: Users = names.iter().map(|&text| (name(text), Background::default())).collect();
    Roster::new(&users).unwrap()
}

/// A household of `members` people called U00, U01 and so on.
pub(crate) fn roster_of(members: usize) -> Roster {
    let users: Users =
        (0..members).map(|place| (name(&format!("U{place:02}")), Background::default())).collect();
    Roster::new(&users).unwrap()
}

/// One score: half of them two decimals, as language models give them, the others anything.
pub(crate) fn any_score() -> impl Strategy<Value = Score> {
    prop_oneof![(0..=100_u32).prop_map(|hundredths| f64::from(hundredths) / 100.0), 0.0..=1.0_f64]
        .prop_map(|value| Score::new(value).unwrap())
}

/// Scores of a household of one of these sizes.
pub(crate) fn any_scores(members: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<Score>> {
    proptest::collection::vec(any_score(), members)
}

/// Any set of the first `members` people, the empty one among them.
pub(crate) fn any_set(members: usize) -> impl Strategy<Value = OwnerSet> {
    (0..1_u64 << members)
        .prop_map(move |bits| (0..members).filter(|place| bits >> place & 1 == 1).map(user).collect())
}

/// A household size, an order of its members and something about each: what a law of symmetry needs.
pub(crate) fn any_order(members: usize) -> impl Strategy<Value = Vec<usize>> {
    Just((0..members).collect::<Vec<usize>>()).prop_shuffle()
}

/// The set after its members moved: the one at place i goes to `order[i]`.
pub(crate) fn moved(set: OwnerSet, order: &[usize]) -> OwnerSet {
    set.iter().map(|member| user(order[member.place()])).collect()
}

/// Samples of a model that was told everything, from this many households.
pub(crate) fn provenance(model: &str, households: usize) -> coin::calibration::Provenance {
    coin::calibration::Provenance {
        model: model.to_owned(),
        episodes: (1..=households).map(|number| format!("home-{number}")).collect(),
        history: coin_schemas::calibration::History::Whole,
        withheld: std::collections::BTreeSet::new(),
        scoring: coin_schemas::report::Scoring::default(),
    }
}
