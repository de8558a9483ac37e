//! What the places of things tell of their owners in one home.
//!
//! In one home everybody's things lie on everybody's own shelf, in another all lie everywhere. So the home itself is asked
//! how often things lie side by side, by how their owners are related, where these are known or nearly so.

use std::collections::BTreeMap;

use libm::log;

use super::hints::GroupedWitnesses;
use super::ties::{KnownPairs, TieLine};
use crate::owners::OwnerSet;

/// No two things are held to lie side by side less often than this share of the mean.
const LEAST_SHARE: f64 = 0.1;

/// How often things lie side by side in a home, by how their owners are related.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Nearness {
    line: TieLine,
    /// How many things have these owners.
    owned: BTreeMap<OwnerSet, f64>,
}

impl Nearness {
    /// From the known owners of all things and from the pairs of them that lie near each other, with their Gaussian
    /// weights; `None` where they tell nothing.
    pub(super) fn learn(
        known: impl Iterator<Item = OwnerSet>,
        near: impl Iterator<Item = (OwnerSet, OwnerSet, f64)>,
    ) -> Option<Self> {
        let mut owned: BTreeMap<OwnerSet, f64> = BTreeMap::new();
        known.for_each(|owners| *owned.entry(owners).or_default() += 1.0);
        let mut pairs = KnownPairs::default();
        for (&one, &count) in &owned {
            for (&other, &others) in owned.range(one..) {
                let all = if one == other { count * (count - 1.0) / 2.0 } else { count * others };
                pairs.add_unrelated(one, other, all);
            }
        }
        for (one, other, weight) in near {
            pairs.add_unrelated(one, other, -1.0);
            pairs.add(one, other, weight);
        }
        pairs.line().map(|line| Self { line, owned })
    }

    fn expected(&self, one: OwnerSet, other: OwnerSet) -> f64 {
        self.line.expected(one, other).max(LEAST_SHARE * self.line.mean)
    }

    /// How often all things together lie beside one with these owners.
    pub(super) fn all(&self, owners: OwnerSet) -> f64 {
        self.owned.iter().map(|(&others, count)| count * self.expected(owners, others)).sum()
    }

    /// ln of how well it fits that a thing has these owners, up to a constant: every thing that lies near, by its weight,
    /// is drawn from all others in proportion to how often such things lie side by side.
    pub(super) fn fit(&self, owners: OwnerSet, witnesses: &GroupedWitnesses, all: f64) -> f64 {
        witnesses.iter().map(|&(others, _, weight)| weight * log(self.expected(owners, others) / all)).sum()
    }
}
