//! What the looks and the places of other things hint at, and how much such hints are worth in one home.
//!
//! Things around are no independent witnesses, and no home is like another. So a hint counts by an exponent, and which one
//! follows from how well the hints foretell the use and the answers of all things of this home, each from the others.

use std::collections::BTreeMap;

use libm::{exp, log};

use super::super::TRUST;
use super::Thing;
use crate::owners::OwnerSet;

/// The exponents are 0 and 1/8, 1/4, 1/2, 1 of the largest one.
const EXPONENTS: usize = 5;

/// The smallest of them but 0, where the largest is 1.
const SMALLEST_EXPONENT: f64 = 0.125;

/// Where an owner set is less probable than this by the use of a thing alone, no hint matters.
const EXCLUDED: f64 = 1e-6;

/// Known owners, how many things are theirs, and the sum of what relates these to one thing (cosines or weights).
pub(super) type GroupedWitnesses = Vec<(OwnerSet, f64, f64)>;

/// Things of known owners, by these.
pub(super) fn grouped(witnesses: impl Iterator<Item = (OwnerSet, f64)>) -> GroupedWitnesses {
    let mut groups: BTreeMap<OwnerSet, (f64, f64)> = BTreeMap::new();
    for (owners, relation) in witnesses {
        let (count, sum) = groups.entry(owners).or_default();
        *count += 1.0;
        *sum += relation;
    }
    groups.into_iter().map(|(owners, (count, sum))| (owners, count, sum)).collect()
}

/// One thing with what hints at its owners, and without.
pub(super) struct Hinted<'a> {
    /// What is thought of the thing without the hints.
    judged: &'a Judged<'a>,
    /// How well every considered set fits the hints, by every exponent but 0.
    powers: Vec<[f64; EXPONENTS - 1]>,
}

/// A thing as it is judged without its company.
pub(super) struct Judged<'a> {
    pub(super) thing: &'a Thing,
    /// The probability of every owner set, its use known.
    pub(super) belief: &'a [f64],
    /// Whom a person named.
    pub(super) answer: Option<OwnerSet>,
    /// The places of the sets whose fit is considered.
    considered: Vec<usize>,
    /// The probability of every set before the use is known, where the thing shows what hints are worth. Then every set is
    /// considered.
    prior: Option<Vec<f64>>,
}

impl<'a> Judged<'a> {
    /// A thing that shows what hints are worth.
    pub(super) fn telling(
        thing: &'a Thing,
        belief: &'a [f64],
        answer: Option<OwnerSet>,
        prior: Vec<f64>,
    ) -> Self {
        Self { thing, belief, answer, considered: (0..belief.len()).collect(), prior: Some(prior) }
    }

    /// Another thing. What its use all but excludes, its company does not bring back.
    pub(super) fn silent(thing: &'a Thing, belief: &'a [f64], answer: Option<OwnerSet>) -> Self {
        let considered = (0..belief.len()).filter(|&place| belief[place] > EXCLUDED).collect();
        Self { thing, belief, answer, considered, prior: None }
    }

    /// With the logarithms of how well owner sets fit, which count by no more than the largest exponent.
    pub(super) fn hinted(&self, largest_exponent: f64, mut fit: impl FnMut(OwnerSet) -> f64) -> Hinted<'_> {
        let fits: Vec<f64> = self.considered.iter().map(|&place| fit(self.thing.owners(place))).collect();
        let best = fits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let powers = fits.iter().map(|fit| {
            let mut power = exp(SMALLEST_EXPONENT * largest_exponent * (fit - best));
            [(); EXPONENTS - 1].map(|()| {
                let this = power;
                power *= power;
                this
            })
        });
        Hinted { judged: self, powers: powers.collect() }
    }
}

impl Hinted<'_> {
    /// Σ_S weight(S)·f(S)^x for every exponent x.
    fn sums(&self, weights: &[f64]) -> [f64; EXPONENTS] {
        let mut sums = [0.0; EXPONENTS];
        for (&place, powers) in self.judged.considered.iter().zip(&self.powers) {
            let weight = weights[place];
            sums[0] += weight;
            sums[1..].iter_mut().zip(powers).for_each(|(sum, power)| *sum += weight * power);
        }
        sums
    }

    /// ln p(use, answer | hints) − ln p(use, answer) for every exponent x, which is
    /// ln Σ_S p(S | use, answer)·f(S)^x − ln Σ_S π(S)·f(S)^x.
    fn log_evidence(&self, prior: &[f64]) -> [f64; EXPONENTS] {
        let Judged { thing, belief, answer, .. } = self.judged;
        let (mut seen, foretold) = (self.sums(belief), self.sums(prior));
        if let Some(named) = answer.and_then(|owners| thing.place_of(owners)) {
            seen.iter_mut().for_each(|sum| *sum *= 1.0 - TRUST);
            seen[0] += TRUST;
            seen[1..].iter_mut().zip(self.powers[named]).for_each(|(sum, power)| *sum += TRUST * power);
        }
        let mut logarithms = seen;
        logarithms.iter_mut().zip(foretold).for_each(|(seen, foretold)| *seen = log(*seen / foretold));
        logarithms
    }

    /// How much likelier or less the hints make every considered set, where the exponents are so probable.
    fn company(&self, exponents: &[f64; EXPONENTS]) -> Company {
        let mut shares = self.sums(self.judged.belief);
        shares.iter_mut().zip(exponents).for_each(|(sum, probability)| *sum = probability / *sum);
        let factor = |powers: &[f64; EXPONENTS - 1]| {
            shares[0] + shares[1..].iter().zip(powers).map(|(share, power)| share * power).sum::<f64>()
        };
        Company(self.judged.considered.iter().copied().zip(self.powers.iter().map(factor)).collect())
    }
}

/// What hints make of every thing of a home.
///
/// p(x) ∝ ∏ Σ_S p(S | use, answer)·f(S)^x / Σ_S π(S)·f(S)^x over the things that show it, where f comes from *other*
/// things.
pub(super) fn worth(things: &[Hinted<'_>]) -> Vec<Company> {
    let mut logarithms = [0.0; EXPONENTS];
    for thing in things {
        let Some(prior) = &thing.judged.prior else { continue };
        logarithms.iter_mut().zip(thing.log_evidence(prior)).for_each(|(sum, of_thing)| *sum += of_thing);
    }
    let best = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let relative = logarithms.map(|logarithm| exp(logarithm - best));
    let all: f64 = relative.iter().sum();
    let exponents = relative.map(|weight| weight / all);
    things.iter().map(|thing| thing.company(&exponents)).collect()
}

/// How much likelier or less owner sets of a thing are made by its company; those that are left out, not at all.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Company(Vec<(usize, f64)>);

impl Company {
    /// With what other company of the same thing makes of it.
    pub(super) fn and(mut self, other: &Self) -> Self {
        self.0.iter_mut().zip(&other.0).for_each(|((_, factor), (_, other))| *factor *= other);
        self
    }

    /// A belief with what the company says.
    pub(super) fn applied(&self, belief: &[f64]) -> Vec<f64> {
        let mut belief = belief.to_vec();
        self.0.iter().for_each(|&(place, factor)| belief[place] *= factor);
        belief
    }
}
