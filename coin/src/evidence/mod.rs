//! The evidence model: how probable every owner set is, given who used a thing in which sessions and whose the things
//! around it are.
//!
//! A session is one decision to use a thing. [`home`] judges all things of a home together, because what they have in
//! common (how much is lent, how often sightings are mistaken, what looks tell) says much of each. [`posterior`] is the
//! bare formula for one thing by itself: an owner set S of k of n members explains the session counts c by a borrow rate
//! (the share of sessions of non-owners, integrated out under a Beta prior) and an even split among the owners (a
//! Dirichlet–multinomial). In both the prior knows how many owners things have, what common sense expects of the class,
//! and the answered owners of things around.

mod answer;
mod context;
pub mod home;
mod newcomers;
mod outdated;
mod prior;

use libm::{lgamma, log};

pub use answer::{DOUBTFUL, after_answer, against_answer};
pub use context::WeighedContext;
pub use newcomers::Arrivals;
pub use outdated::{OUTDATED, since_answer};
pub use prior::{Opinion, SizePrior};

use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::UserIndex;
use prior::{Candidates, OwnPrior, logarithms, with_relatives};

/// How probable it is that a person's answer is right: people are mistaken, misunderstood, or joke.
const TRUST: f64 = 0.95;

/// Where the habits of a home come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HabitSource {
    /// They are those that are usual.
    Ordinary,
    /// They are learnt from all things of the home and all answers about them.
    Learnt,
}

/// The constants of the model. The defaults were fixed on generated development households before any household
/// that judges them was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvidenceParameters {
    /// First parameter a of the Beta prior of the borrow rate.
    pub borrowed: f64,
    /// Second parameter b of the Beta prior of the borrow rate.
    pub own_use: f64,
    /// Concentration α of the split among owners: the larger, the more even.
    pub evenness: f64,
    /// Prior probability that a thing has one owner.
    pub prior_single: f64,
    /// Prior probability that everyone owns it.
    pub prior_everyone: f64,
    /// The place term of what people said: how probable it is that a thing at no distance from a thing with answered owners has the
    /// same ones. 0 switches the term off; it stays below 1, because no neighbour makes anything certain.
    pub place: f64,
    /// The looks term of the bare formula: the same for a thing that looks exactly alike, also below 1. 0 switches the term off.
    pub looks: f64,
    /// The class term: how probable it is that the thing follows what common sense expects of its class in this
    /// household, unless the home shows that its things mostly do. 0 switches the term off.
    pub common_sense: f64,
    /// The class term where a language model speaks in place of the file of classes: how probable it is that the
    /// thing follows the model's common sense. With .25 a model that is sure of one person of three makes that
    /// person 2.7 times as likely before anybody used the thing, about what the file grants to a role that suits;
    /// three sessions of somebody else outweigh it. It was reasoned so and not fitted: no language model was heard.
    pub language_model: f64,
    /// β of the law of turns among people who share a thing: who has used it less is the next one. 0 makes it chance.
    pub turns: f64,
    /// How probable it is that a thing had other owners in an earlier part of its history. 0 switches the term off.
    pub change_of_hands: f64,
    /// The largest exponent of what looks tell in a home; how much of it counts, the home shows. 0 switches the term off.
    pub resemblance: f64,
    /// The same for what lies near. 0 switches the term off.
    pub nearness: f64,
    /// Where the habits of the home come from.
    pub habits: HabitSource,
}

impl Default for EvidenceParameters {
    fn default() -> Self {
        Self {
            borrowed: 1.2,
            own_use: 6.0,
            evenness: 8.0,
            prior_single: 0.60,
            prior_everyone: 0.25,
            place: 0.05,
            looks: 0.50,
            common_sense: 0.10,
            language_model: 0.25,
            turns: 1.5,
            change_of_hands: 0.04,
            resemblance: 1.0,
            nearness: 1.0,
            habits: HabitSource::Learnt,
        }
    }
}

/// A thing whose owners a person named, and how strongly it bears on the thing in question.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownRelative {
    /// Its owners.
    pub owners: OwnerSet,
    /// How it is related.
    pub relation: Relation,
}

/// How a thing with known owners is related to the thing in question.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Relation {
    /// It lies near; the Gaussian weight, 0…1.
    Near {
        /// exp(−d²/2σ²).
        weight: f64,
    },
    /// It looks alike; the cosine, −1…1.
    LooksAlike {
        /// Of the visual features.
        similarity: f64,
    },
}

/// Whether likeness says something about owners. Two mugs look alike because they are mugs; likeness beyond the
/// class is what a person's taste leaves behind.
pub fn likeness_counts(class: &str, other_class: &str) -> bool {
    !class.eq_ignore_ascii_case(other_class)
}

impl EvidenceParameters {
    /// How many owners things have, as far as a home has not shown it.
    pub fn sizes(&self) -> SizePrior {
        SizePrior { single: self.prior_single, everyone: self.prior_everyone }
    }

    /// The probability that the thing has the relative's owners *because* of the relation.
    pub fn coupling(&self, relation: Relation) -> f64 {
        match relation {
            Relation::Near { weight } => self.place * weight,
            Relation::LooksAlike { similarity } => self.looks * similarity.max(0.0),
        }
    }
}

fn log_beta(a: f64, b: f64) -> f64 {
    lgamma(a) + lgamma(b) - lgamma(a + b)
}

/// ln p(c | S): the probability of *who* used the thing in each session, in order, for the owner set S.
///
/// With k owners of n members, N sessions and m of them by others:
/// `[k<n]·(ln B(a+m, b+N−m) − ln B(a, b) − m ln(n−k)) + [k>1]·(lnΓ(kα) − lnΓ(kα+N−m) + Σ_{u∈S} (lnΓ(α+c_u) − lnΓ(α)))`.
pub fn log_likelihood(sessions: &[u64], owners: OwnerSet, parameters: &EvidenceParameters) -> f64 {
    let members = sessions.len();
    let total: u64 = sessions.iter().sum();
    let by_owner: Vec<f64> =
        owners.iter().filter_map(|user| sessions.get(user.place())).map(|&c| c as f64).collect();
    let by_owners: f64 = by_owner.iter().sum();
    let borrowed = total as f64 - by_owners;
    let owner_count = owners.len();
    let mut log_probability = 0.0;
    if owner_count < members {
        let EvidenceParameters { borrowed: a, own_use: b, .. } = *parameters;
        log_probability += log_beta(a + borrowed, b + by_owners)
            - log_beta(a, b)
            - borrowed * log((members - owner_count) as f64);
    }
    if owner_count > 1 {
        let alpha = parameters.evenness;
        let concentration = owner_count as f64 * alpha;
        log_probability += lgamma(concentration) - lgamma(concentration + by_owners)
            + by_owner.iter().map(|count| lgamma(alpha + count) - lgamma(alpha)).sum::<f64>();
    }
    log_probability
}

/// p(S | c, opinion, relatives) over the candidate owner sets of a household of `sessions.len()` members.
///
/// Without relatives the prior of S is `(1 − w)·π(S) + w·e(S)`, where e is what common sense expects, the file's or a
/// language model's, and w the weight of that term; w is 0 where nothing is expected. As a mixture it excludes no
/// owner set, however sure the opinion is. Where a model's scores leave no set possible, such as where all are 0,
/// they say nothing.
///
/// The relatives enter the prior as a mixture: with probability 1 − ∏(1 − ρ_i) the thing has the owners of one of
/// its relatives (each in proportion to its coupling ρ_i), else those of π. A mixture keeps a crowd of
/// neighbours, which are no independent witnesses, from outvoting the thing's own usage. Relatives whose owners
/// are no candidate set, such as somebody outside the household, say nothing.
pub fn posterior(
    sessions: &[u64],
    opinion: Opinion<'_>,
    relatives: &[KnownRelative],
    parameters: &EvidenceParameters,
) -> OwnerSetDistribution {
    let candidates = Candidates::of((0..sessions.len()).filter_map(UserIndex::new).collect());
    let couplings: Vec<(OwnerSet, f64)> =
        relatives.iter().map(|relative| (relative.owners, parameters.coupling(relative.relation))).collect();
    let mut prior = OwnPrior::new(&candidates, opinion).of_sizes(parameters.sizes(), parameters);
    with_relatives(candidates.sets(), &mut prior, &couplings);
    OwnerSetDistribution::from_log_weights(
        candidates
            .sets()
            .iter()
            .zip(logarithms(&prior))
            .map(|(&set, prior)| (set, prior + log_likelihood(sessions, set, parameters))),
    )
}

#[cfg(test)]
mod tests;
