//! What the looks of things tell of their owners in one home.
//!
//! Whether people's things look like each other is a habit of a home too: in one the child's things are all of one
//! colour, in another everybody buys the same brand. So the home itself is asked how alike things are, by how their
//! owners are related, where these are known or nearly so.

use super::hints::GroupedWitnesses;
use super::ties::{KnownPairs, TieLine};
use crate::owners::OwnerSet;

/// How alike things of different classes are in a home, by how their owners are related.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Resemblance(TieLine);

impl Resemblance {
    /// From pairs of things whose owners are known, with their cosines; `None` where they tell nothing.
    pub(super) fn learn(pairs: impl Iterator<Item = (OwnerSet, OwnerSet, f64)>) -> Option<Self> {
        let mut known = KnownPairs::default();
        pairs.for_each(|(one, other, cosine)| known.add(one, other, cosine));
        known.line().map(Self)
    }

    /// ln of how well it fits that a thing has these owners, up to a constant: its cosines with things of known owners are
    /// normal around what is expected.
    pub(super) fn fit(&self, owners: OwnerSet, witnesses: &GroupedWitnesses) -> f64 {
        let Self(line) = self;
        let fits = witnesses.iter().map(|&(others, count, sum)| {
            let expected = line.expected(owners, others);
            expected * (2.0 * sum - expected * count)
        });
        fits.sum::<f64>() / (2.0 * line.variance)
    }
}
