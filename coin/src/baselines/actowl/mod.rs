//! Active Ownership Learning (ActOwL): a generative model of where each person's things lie and what they are like,
//! which asks where an answer is expected to tell most. It looks at neither background nor usage.
//!
//! Classes that common sense calls shared are everybody's and are never asked about; that first step is a model's.
//! Of every other thing one person is the owner: label z_o ~ Categorical(π), π ~ Dirichlet(γ); its position is
//! Gaussian given the label, with a Normal–inverse-Wishart prior; its attributes are multinomial given the label,
//! with Dirichlet priors. An answer is an observed label. Labels are sampled by collapsed Gibbs sampling, and the
//! question with the largest expected information gain is asked until none is worth it.
//!
//! A label is one person. An answer that names several owners, or none, takes the thing out of the model; the answer
//! stands.

mod gain;
mod model;
mod position;
#[cfg(test)]
mod tests;

use rand::Rng;

use crate::owners::OwnerSet;
use crate::roster::UserIndex;
use crate::similarity::{cosine, normalise};
use gain::Samples;
use model::{Known, State};
pub use model::{Priors, Things};
pub use position::PositionPrior;

/// How the posterior is sampled and when to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Independent chains, each from random labels.
    pub chains: usize,
    /// Sweeps of each chain that are thrown away.
    pub burn_in: usize,
    /// Samples kept of each chain.
    pub kept: usize,
    /// Sweeps from one kept sample to the next.
    pub thinning: usize,
    /// A question whose answer is expected to tell less is not asked, in nats.
    pub least_gain: f64,
}

impl Default for Sampling {
    /// A thousand samples, with which chance adds about 0.06 nats to a gain over thirty things of three people. Asking
    /// goes on down to that: the publication says nothing of where it stops, and a baseline that gave up early would
    /// be none. On development homes that is 17 questions; the comparison with COIN was published with 19.7.
    fn default() -> Self {
        Self { chains: 4, burn_in: 30, kept: 250, thinning: 2, least_gain: 0.05 }
    }
}

impl Priors {
    /// Weakly informative: one imagined thing for each person, half a one for each value of an attribute, things
    /// around the middle of the home, and those of one person spread half as wide as all of them (ν₀ = 5 is the
    /// least whole number with a finite expected covariance).
    pub fn around(positions: &[[f64; 3]]) -> Self {
        let count = positions.len().max(1) as f64;
        let mean: [f64; 3] =
            std::array::from_fn(|axis| positions.iter().map(|position| position[axis]).sum::<f64>() / count);
        let scatter = std::array::from_fn(|axis| {
            let squares: f64 = positions.iter().map(|position| (position[axis] - mean[axis]).powi(2)).sum();
            // Things on one shelf have no spread in height; a decimetre keeps the covariance from collapsing.
            (0.25 * squares / count).max(0.01)
        });
        let position = PositionPrior { mean, mean_weight: 0.1, degrees_of_freedom: 5.0, scatter };
        Self { label: 1.0, attribute: 0.5, position }
    }
}

/// A run of ActOwL over the things that are not everybody's.
#[derive(Debug, Clone)]
pub struct ActOwl<R> {
    things: Things,
    priors: Priors,
    sampling: Sampling,
    members: usize,
    known: Vec<Known>,
    answers: Vec<Option<OwnerSet>>,
    marginals: Vec<Vec<f64>>,
    samples: Samples,
    generator: R,
}

impl<R: Rng> ActOwl<R> {
    /// Looks at the things for the first time. `members` is at least 1; the generator is the only source of chance.
    pub fn new(things: Things, priors: Priors, sampling: Sampling, members: usize, generator: R) -> Self {
        let count = things.positions.len();
        let mut run = Self {
            things,
            priors,
            sampling,
            members,
            known: vec![Known::Nothing; count],
            answers: vec![None; count],
            marginals: Vec::new(),
            samples: Samples::default(),
            generator,
        };
        run.infer();
        run
    }

    /// The thing to ask about next, by its place; `None` where no answer is expected to tell enough.
    pub fn next_question(&self) -> Option<usize> {
        let unasked = self.unasked();
        unasked
            .iter()
            .map(|&thing| (thing, self.samples.expected_gain(thing, &unasked)))
            // Of equal gains the first wins.
            .rev()
            .max_by(|left, right| left.1.total_cmp(&right.1))
            .filter(|&(_, gain)| gain >= self.sampling.least_gain)
            .map(|(thing, _)| thing)
    }

    /// Takes an answer in and samples anew.
    pub fn answer(&mut self, thing: usize, owners: OwnerSet) {
        let only = if owners.len() == 1 { owners.iter().next() } else { None };
        self.known[thing] = only.map_or(Known::LeftOut, |user| Known::Label(user.place()));
        self.answers[thing] = Some(owners);
        self.infer();
    }

    /// The owners of a thing: the answered ones, else the most probable label.
    pub fn owners(&self, thing: usize) -> OwnerSet {
        self.answers[thing].unwrap_or_else(|| {
            let likeliest = self.marginals[thing]
                .iter()
                .enumerate()
                .rev()
                .max_by(|left, right| left.1.total_cmp(right.1))
                .and_then(|(label, _)| UserIndex::new(label));
            likeliest.map_or(OwnerSet::EMPTY, OwnerSet::single)
        })
    }

    /// The probability of every member being the owner of a thing.
    pub fn probabilities(&self, thing: usize) -> &[f64] {
        &self.marginals[thing]
    }

    fn unasked(&self) -> Vec<usize> {
        (0..self.known.len()).filter(|&thing| self.known[thing] == Known::Nothing).collect()
    }

    fn infer(&mut self) {
        let Sampling { chains, burn_in, kept, thinning, .. } = self.sampling;
        let mut samples = Samples { members: self.members, labels: Vec::with_capacity(chains * kept) };
        for _ in 0..chains {
            let mut state =
                State::new(&self.things, &self.priors, self.members, &self.known, &mut self.generator);
            for _ in 0..burn_in {
                state.sweep(&self.known, &mut self.generator);
            }
            for _ in 0..kept {
                for _ in 0..thinning.max(1) {
                    state.sweep(&self.known, &mut self.generator);
                }
                samples.labels.push(state.assigned.clone());
            }
        }
        self.marginals = samples.marginals(self.known.len());
        self.samples = samples;
    }
}

/// Words for what things look like, one number for each: a thing that looks at least this much like the first of a word
/// has that word, else it begins one of its own.
pub const SAME_LOOK: f64 = 0.8;

/// Numbers from 0 for what things look like, from their visual features; see [`SAME_LOOK`]. A feature without a
/// direction is like no other.
pub fn visual_words(features: &[impl AsRef<[f32]>]) -> Vec<usize> {
    let mut first: Vec<Option<Vec<f32>>> = Vec::new();
    features
        .iter()
        .map(|feature| {
            let feature = normalise(feature.as_ref());
            let alike = |other: &Option<Vec<f32>>| match (&feature, other) {
                (Some(one), Some(other)) => cosine(one, other) >= SAME_LOOK,
                _ => false,
            };
            first.iter().position(alike).unwrap_or_else(|| {
                first.push(feature);
                first.len() - 1
            })
        })
        .collect()
}
