//! A thing with what its accounts, its prior and its answer say under every habit that the home may have.

use libm::log;

use super::super::prior::{Candidates, Opinion, SizePrior, logarithms, with_relatives};
use super::super::{EvidenceParameters, TRUST};
use super::habits::{EVENNESS, FOLLOWED, Habits, LENDING, MISTAKEN, OPINIONS, SIZES};
use super::likelihood::Accounts;
use super::{Thing, Use};
use crate::owners::OwnerSet;

/// A thing with the prior that what is told gives it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weighed {
    /// What it rests on; the same basis leads to the same weights.
    pub(super) basis: Basis,
    weights: Weights,
}

/// What the weights of a thing depend on, beside its own evidence and the opinion of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Basis {
    /// Whom a person named.
    pub(super) answer: Option<OwnerSet>,
    /// The answered owners of near things by their places among the candidates, and how strongly they couple.
    pub(super) couplings: Vec<(OwnerSet, f64)>,
}

#[derive(Debug, Clone, PartialEq)]
enum Weights {
    /// Its belief depends on the habits of the home.
    ByHabits {
        /// For each of [`SIZES`] and then of [`OPINIONS`].
        priors: Vec<Vec<f64>>,
        /// ln p(use, answer | habits) up to a constant, at every point of the grid.
        log_evidence: Vec<f64>,
    },
    /// It is judged by itself, with one prior and the belief that follows.
    Alone { prior: Vec<f64>, belief: Vec<f64> },
}

impl Weighed {
    pub(super) fn new(
        thing: &Thing,
        basis: Basis,
        opinion: Opinion<'_>,
        parameters: &EvidenceParameters,
    ) -> Self {
        let candidates = &thing.candidates;
        let prior = |sizes: SizePrior, parameters: &EvidenceParameters| {
            let mut prior = candidates.own(opinion, sizes, parameters);
            with_relatives(candidates.sets(), &mut prior, &basis.couplings);
            prior
        };
        let weights = match &thing.use_of_it {
            Use::Accounts(accounts) => {
                let weighed: [EvidenceParameters; OPINIONS] = [*parameters, followed(parameters)];
                let priors: Vec<Vec<f64>> = SIZES
                    .iter()
                    .flat_map(|&sizes| weighed.each_ref().map(|parameters| prior(sizes, parameters)))
                    .collect();
                let mixture = Mixture { candidates, accounts, priors: &priors, parameters };
                let log_evidence = mixture.log_evidence(basis.answer);
                Weights::ByHabits { priors, log_evidence }
            }
            Use::Bare(use_of_it) => {
                let prior = prior(parameters.sizes(), parameters);
                let belief = super::from_logarithms(
                    logarithms(&prior).zip(use_of_it).map(|(prior, used)| prior + used),
                );
                Weights::Alone { prior, belief }
            }
        };
        Self { basis, weights }
    }

    /// ln p(use, answer | habits) at every point of the grid; empty where the thing says nothing of habits.
    pub(super) fn log_evidence(&self) -> &[f64] {
        match &self.weights {
            Weights::ByHabits { log_evidence, .. } => log_evidence,
            Weights::Alone { .. } => &[],
        }
    }

    /// Σ_h p(h)·π(S | h) for every set: what is thought before anybody has used the thing.
    pub(super) fn prior(&self, habits: &[(Habits, f64)]) -> Vec<f64> {
        match &self.weights {
            Weights::ByHabits { priors, .. } => {
                let mut shares = [0.0; SIZES.len() * OPINIONS];
                habits.iter().for_each(|(habits, probability)| shares[habits.prior_place()] += probability);
                let sets = 0..priors.first().map_or(0, Vec::len);
                sets.map(|set| shares.iter().zip(priors).map(|(share, prior)| share * prior[set]).sum())
                    .collect()
            }
            Weights::Alone { prior, .. } => prior.clone(),
        }
    }

    /// Σ_h p(h)·p(S | use, h) for every set, without the thing's own answer.
    pub(super) fn belief(
        &self,
        thing: &Thing,
        habits: &[(Habits, f64)],
        parameters: &EvidenceParameters,
    ) -> Vec<f64> {
        match (&self.weights, &thing.use_of_it) {
            (Weights::ByHabits { priors, .. }, Use::Accounts(accounts)) => {
                Mixture { candidates: &thing.candidates, accounts, priors, parameters }.belief(habits)
            }
            (Weights::Alone { belief, .. }, _) | (Weights::ByHabits { .. }, Use::Bare(belief)) => {
                belief.clone()
            }
        }
    }
}

/// The constants in a home whose things are whose one would expect. An opinion that is not heard stays so.
fn followed(parameters: &EvidenceParameters) -> EvidenceParameters {
    let weight = |usual: f64| if usual > 0.0 { usual.max(FOLLOWED) } else { 0.0 };
    EvidenceParameters {
        common_sense: weight(parameters.common_sense),
        language_model: weight(parameters.language_model),
        ..*parameters
    }
}

/// π(S | h)·p(use | S, h), in which the accounts are mixed as the habits h are.
struct Mixture<'a> {
    candidates: &'a Candidates,
    accounts: &'a Accounts,
    priors: &'a [Vec<f64>],
    parameters: &'a EvidenceParameters,
}

impl Mixture<'_> {
    /// The probability of a change of hands, which a thing that was used less than twice cannot have shown.
    fn change(&self) -> f64 {
        if self.accounts.changed.is_empty() { 0.0 } else { self.parameters.change_of_hands }
    }

    fn joint(&self, habits: Habits) -> impl Iterator<Item = f64> {
        let kept = &self.accounts.kept[habits.mistaken];
        let lent = &self.accounts.lent[habits.lent()];
        let changed = self.accounts.changed.get(habits.changed());
        let change = self.change();
        let prior = &self.priors[habits.prior_place()];
        let (single, shared) = (habits.kept(1), habits.kept(2));
        self.candidates.sets().iter().enumerate().map(move |(place, set)| {
            let share = if set.len() == 1 { single } else { shared };
            let stayed = share * kept[place] + (1.0 - share) * lent[place];
            let moved = changed.map_or(0.0, |changed| changed[place]);
            prior[place] * ((1.0 - change) * stayed + change * moved)
        })
    }

    fn belief(&self, habits: &[(Habits, f64)]) -> Vec<f64> {
        let mut belief = vec![0.0; self.candidates.sets().len()];
        for &(habits, probability) in habits {
            let joint: Vec<f64> = self.joint(habits).collect();
            let all: f64 = joint.iter().sum();
            belief.iter_mut().zip(joint).for_each(|(sum, joint)| *sum += probability * joint / all);
        }
        belief
    }

    /// Σ_S π(S | h)·p(use | S, h) is linear in the accounts, so that their sums under each prior are enough for every
    /// point of the grid.
    fn log_evidence(&self, answer: Option<OwnerSet>) -> Vec<f64> {
        let named = match answer {
            // Somebody outside owns it: what that tells is no habit of the people here.
            Some(owners) if owners.is_empty() => return Vec::new(),
            Some(owners) => {
                let owners = self.candidates.narrowed(owners);
                let place =
                    owners.and_then(|owners| self.candidates.sets().iter().position(|&set| set == owners));
                let Some(place) = place else { return Vec::new() };
                Some(place)
            }
            None => None,
        };
        let sums: Vec<Sums> = self.priors.iter().map(|prior| self.sums(prior)).collect();
        Habits::all()
            .map(|habits| {
                let all = sums[habits.prior_place()].mixed(habits, self.change());
                match named.and_then(|place| self.joint(habits).nth(place)) {
                    Some(named) => log(TRUST * named + (1.0 - TRUST) * all),
                    None => log(all),
                }
            })
            .collect()
    }

    fn sums(&self, prior: &[f64]) -> Sums {
        let of = |account: &Vec<f64>| -> [f64; 2] {
            let mut sums = [0.0; 2];
            for ((set, prior), account) in self.candidates.sets().iter().zip(prior).zip(account) {
                sums[usize::from(set.len() > 1)] += prior * account;
            }
            sums
        };
        Sums {
            kept: self.accounts.kept.iter().map(of).collect(),
            lent: self.accounts.lent.iter().map(of).collect(),
            changed: self.accounts.changed.iter().map(of).collect(),
        }
    }
}

/// Σ π(S)·account(S) over the sets of one owner, and over the others.
struct Sums {
    /// For each of [`MISTAKEN`].
    kept: Vec<[f64; 2]>,
    /// For each of [`LENDING`] and then of [`EVENNESS`].
    lent: Vec<[f64; 2]>,
    /// For each of [`LENDING`] and then of [`LOOSEST`], or nothing.
    changed: Vec<[f64; 2]>,
}

impl Sums {
    fn mixed(&self, habits: Habits, change: f64) -> f64 {
        debug_assert_eq!(
            (self.kept.len(), self.lent.len()),
            (MISTAKEN.len(), LENDING.len() * EVENNESS.len())
        );
        let (kept, lent) = (self.kept[habits.mistaken], self.lent[habits.lent()]);
        let changed = self.changed.get(habits.changed()).copied().unwrap_or_default();
        [1, 2].iter().zip(kept).zip(lent).zip(changed).fold(0.0, |sum, (((&owners, kept), lent), changed)| {
            let share = habits.kept(owners);
            sum + (1.0 - change) * (share * kept + (1.0 - share) * lent) + change * changed
        })
    }
}
