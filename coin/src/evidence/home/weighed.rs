//! A thing with what its accounts, its prior and its answer say under every habit that the home may have.

use libm::log;

use super::super::prior::{Candidates, Opinion, OwnPrior, SizePrior, logarithms, with_relatives};
use super::super::{EvidenceParameters, TRUST};
use super::habits::{EVENNESS, FOLLOWED, Habits, LENDING, MISTAKEN, OPINIONS, SIZES};
use super::likelihood::Accounts;
use super::{Thing, Use};
use crate::owners::OwnerSet;

/// For each of [`SIZES`] and then of [`OPINIONS`] there is a prior.
const PRIORS: usize = SIZES.len() * OPINIONS;

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
        /// Of every set, its probability under each of [`PRIORS`].
        priors: Vec<[f64; PRIORS]>,
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
        let own = OwnPrior::new(candidates, opinion);
        let prior = |sizes: SizePrior, parameters: &EvidenceParameters| {
            let mut prior = own.of_sizes(sizes, parameters);
            with_relatives(candidates.sets(), &mut prior, &basis.couplings);
            prior
        };
        let weights = match &thing.use_of_it {
            Use::Accounts(accounts) => {
                let weighed: [EvidenceParameters; OPINIONS] = [*parameters, followed(parameters)];
                let mut priors = vec![[0.0; PRIORS]; candidates.sets().len()];
                let all = SIZES.iter().flat_map(|&sizes| weighed.each_ref().map(|of| prior(sizes, of)));
                for (place, prior) in all.enumerate() {
                    priors
                        .iter_mut()
                        .zip(prior)
                        .for_each(|(of_set, probability)| of_set[place] = probability);
                }
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
                let mut shares = [0.0; PRIORS];
                habits.iter().for_each(|(habits, probability)| shares[habits.prior_place()] += probability);
                let mean = |of_set: &[f64; PRIORS]| {
                    shares.iter().zip(of_set).map(|(share, prior)| share * prior).sum()
                };
                priors.iter().map(mean).collect()
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
    priors: &'a [[f64; PRIORS]],
    parameters: &'a EvidenceParameters,
}

impl Mixture<'_> {
    /// The probability of a change of hands, which a thing that was used less than twice cannot have shown.
    fn change(&self) -> f64 {
        if self.accounts.changed.is_empty() { 0.0 } else { self.parameters.change_of_hands }
    }

    /// π(S | h)·p(use | S, h) of the set at every place.
    fn joint(&self, habits: Habits) -> impl Fn(usize) -> f64 {
        let kept = &self.accounts.kept[habits.mistaken];
        let lent = &self.accounts.lent[habits.lent()];
        let changed = self.accounts.changed.get(habits.changed());
        let change = self.change();
        let (sets, priors, prior) = (self.candidates.sets(), self.priors, habits.prior_place());
        let (single, shared) = (habits.kept(1), habits.kept(2));
        move |place| {
            let share = if sets[place].len() == 1 { single } else { shared };
            let stayed = share * kept[place] + (1.0 - share) * lent[place];
            let moved = changed.map_or(0.0, |changed| changed[place]);
            priors[place][prior] * ((1.0 - change) * stayed + change * moved)
        }
    }

    fn belief(&self, habits: &[(Habits, f64)]) -> Vec<f64> {
        let mut belief = vec![0.0; self.candidates.sets().len()];
        for &(habits, probability) in habits {
            let joint: Vec<f64> = (0..belief.len()).map(self.joint(habits)).collect();
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
        let sums = self.sums();
        Habits::all()
            .map(|habits| {
                let all = sums.mixed(habits, self.change());
                match named {
                    Some(named) => log(TRUST * self.joint(habits)(named) + (1.0 - TRUST) * all),
                    None => log(all),
                }
            })
            .collect()
    }

    fn sums(&self) -> Sums {
        let of = |account: &Vec<f64>| -> SumsOfAccount {
            let mut sums = [[0.0; PRIORS]; 2];
            for ((set, priors), account) in self.candidates.sets().iter().zip(self.priors).zip(account) {
                let of_sets = &mut sums[usize::from(set.len() > 1)];
                of_sets.iter_mut().zip(priors).for_each(|(sum, prior)| *sum += prior * account);
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

/// Σ π(S)·account(S) over the sets of one owner, and over the others, under each of [`PRIORS`].
type SumsOfAccount = [[f64; PRIORS]; 2];

/// The sums of every account.
struct Sums {
    /// For each of [`MISTAKEN`].
    kept: Vec<SumsOfAccount>,
    /// For each of [`LENDING`] and then of [`EVENNESS`].
    lent: Vec<SumsOfAccount>,
    /// For each of [`LENDING`] and then of [`LOOSEST`], or nothing.
    changed: Vec<SumsOfAccount>,
}

impl Sums {
    fn mixed(&self, habits: Habits, change: f64) -> f64 {
        debug_assert_eq!(
            (self.kept.len(), self.lent.len()),
            (MISTAKEN.len(), LENDING.len() * EVENNESS.len())
        );
        let under = |sums: &SumsOfAccount| sums.map(|of_sets| of_sets[habits.prior_place()]);
        let (kept, lent) = (under(&self.kept[habits.mistaken]), under(&self.lent[habits.lent()]));
        let changed = self.changed.get(habits.changed()).map(under).unwrap_or_default();
        [1, 2].iter().zip(kept).zip(lent).zip(changed).fold(0.0, |sum, (((&owners, kept), lent), changed)| {
            let share = habits.kept(owners);
            sum + (1.0 - change) * (share * kept + (1.0 - share) * lent) + change * changed
        })
    }
}
