//! The probability that a thing belongs to whom a request names.
//!
//! The map keeps one score for each member. As in [`OwnerSetDistribution::from_scores`](crate::owners), the scores
//! count as independent: s_u is the probability that u is among the owners.

use std::collections::HashMap;

use coin_schemas::household::Score;

use super::STEP;
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// Whose thing is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnerReference {
    /// Anybody's: the request names nobody.
    Anybody,
    /// "my", "Mary's", "Bob and Mary's", "everybody's": all of these own it, perhaps with others.
    Members(OwnerSet),
    /// "my daughter's", where there are two: one of these owns it.
    OneOf(OwnerSet),
    /// "our": the speaker owns it with somebody; of an unknown speaker, several own it.
    Ours(Option<UserIndex>),
    /// "the neighbour's": nobody of the household owns it.
    Outside,
    /// "my", and nobody knows who speaks.
    Speaker,
    /// Somebody whom the household does not know.
    Unknown,
}

/// What the scores say of a reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ownership {
    /// The probability that the reference is true of the thing, 0…1.
    pub(super) probability: f64,
    /// The expected fit of the reference, 0…1, at most the probability: a thing that others own too is called "my"
    /// one step less readily than one of the speaker's alone.
    pub(super) fit: f64,
}

/// The owners' scores of the things that were asked about, each asked for once.
pub(super) struct KnownOwners<F> {
    ask: F,
    known: HashMap<usize, Vec<Score>>,
}

impl<F> KnownOwners<F> {
    pub(super) fn new(ask: F) -> Self {
        Self { ask, known: HashMap::new() }
    }

    /// The scores of the thing at this place of the map.
    pub(super) fn of<E>(&mut self, thing: usize) -> Result<&[Score], E>
    where
        F: FnMut(usize) -> Result<Vec<Score>, E>,
    {
        if !self.known.contains_key(&thing) {
            let scores = (self.ask)(thing)?;
            self.known.insert(thing, scores);
        }
        Ok(self.known.get(&thing).map_or(&[], Vec::as_slice))
    }

    /// What was asked for so far.
    pub(super) fn known(&self) -> &HashMap<usize, Vec<Score>> {
        &self.known
    }
}

impl OwnerReference {
    /// Whether a thing's owners decide if the reference is true of it.
    pub(super) fn depends_on_owners(self) -> bool {
        !matches!(self, Self::Anybody | Self::Speaker | Self::Unknown)
    }

    /// What the scores, in the order of the roster, say of the reference; `None` where it is not known whom it
    /// means.
    ///
    /// With p(R ⊆ S) = ∏_{u∈R} s_u and p(S = R) = p(R ⊆ S) · ∏_{u∉R} (1 − s_u), members R have the fit
    /// STEP · p(R ⊆ S) + (1 − STEP) · p(S = R).
    pub(super) fn ownership(self, scores: &[Score]) -> Option<Ownership> {
        let probability = match self {
            Self::Anybody => 1.0,
            Self::Members(members) => {
                let all = product(scores, |user, score| if members.contains(user) { score } else { 1.0 });
                let nobody_else =
                    product(scores, |user, score| if members.contains(user) { 1.0 } else { 1.0 - score });
                let fit = STEP * all + (1.0 - STEP) * all * nobody_else;
                return Some(Ownership { probability: all, fit });
            }
            Self::OneOf(members) => {
                1.0 - product(scores, |user, score| if members.contains(user) { 1.0 - score } else { 1.0 })
            }
            Self::Ours(Some(speaker)) => {
                let own = scores.get(speaker.place()).map_or(0.0, |score| score.value());
                own * (1.0 - product(scores, |user, score| if user == speaker { 1.0 } else { 1.0 - score }))
            }
            Self::Ours(None) => several(scores),
            Self::Outside => product(scores, |_, score| 1.0 - score),
            Self::Speaker | Self::Unknown => return None,
        };
        Some(Ownership { probability, fit: probability })
    }
}

fn product(scores: &[Score], factor: impl Fn(UserIndex, f64) -> f64) -> f64 {
    scores
        .iter()
        .enumerate()
        .filter_map(|(place, score)| Some(factor(UserIndex::new(place)?, score.value())))
        .product()
}

/// The probability of at least two owners: the chances of none, one and more are carried from member to member.
fn several(scores: &[Score]) -> f64 {
    scores.iter().fold([1.0, 0.0, 0.0], |[none, one, more], score| {
        let own = score.value();
        [none * (1.0 - own), one * (1.0 - own) + none * own, more + one * own]
    })[2]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::support::{scores, set, user};

    fn probability(reference: OwnerReference, values: &[f64]) -> f64 {
        reference.ownership(&scores(values)).unwrap().probability
    }

    /// By adding up all owner sets, as the formulas say without their short cuts.
    fn summed(values: &[f64], holds: impl Fn(OwnerSet) -> bool) -> f64 {
        (0..1_u32 << values.len())
            .map(|bits| {
                let members: OwnerSet =
                    (0..values.len()).filter(|place| bits >> place & 1 == 1).map(user).collect();
                let chance: f64 = values
                    .iter()
                    .enumerate()
                    .map(|(place, own)| if members.contains(user(place)) { *own } else { 1.0 - own })
                    .product();
                if holds(members) { chance } else { 0.0 }
            })
            .sum()
    }

    proptest! {
        #[test]
        fn probabilities_are_sums_over_owner_sets(values in proptest::collection::vec(0.0..=1.0, 2..6)) {
            let pair = set(&[0, 1]);
            for (reference, expected) in [
                (OwnerReference::Anybody, 1.0),
                (OwnerReference::Members(pair), summed(&values, |owners| pair.is_subset(owners))),
                (OwnerReference::OneOf(pair), summed(&values, |owners| !owners.intersection(pair).is_empty())),
                (OwnerReference::Ours(Some(user(0))), summed(&values, |owners| owners.contains(user(0)) && owners.len() > 1)),
                (OwnerReference::Ours(None), summed(&values, |owners| owners.len() > 1)),
                (OwnerReference::Outside, summed(&values, OwnerSet::is_empty)),
            ] {
                prop_assert!((probability(reference, &values) - expected).abs() < 1e-12, "{reference:?}");
            }
        }
    }

    #[test]
    fn own_things_are_called_mine_more_readily_than_shared_ones() {
        let mine = OwnerReference::Members(set(&[0]));
        let alone = mine.ownership(&scores(&[1.0, 0.0])).unwrap();
        let shared = mine.ownership(&scores(&[1.0, 1.0])).unwrap();
        assert_eq!((alone.probability, alone.fit), (1.0, 1.0));
        assert_eq!((shared.probability, shared.fit), (1.0, STEP));
    }
}
