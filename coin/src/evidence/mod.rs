//! The evidence model: how probable every owner set is, given who used a thing in how many sessions and whose
//! the things around it are.
//!
//! A session is one decision to use a thing. An owner set S of k of n members explains the session counts c by a
//! borrow rate (the share of sessions of non-owners, integrated out under a Beta prior) and an even split among
//! the owners (a Dirichlet–multinomial). Three terms of the prior look elsewhere: how many owners things have, what
//! common sense expects of the class, and the answered owners of near things and look-alikes.

mod context;
mod newcomers;

use libm::{lgamma, log};

use coin_schemas::household::Score;

pub use context::WeighedContext;
pub use newcomers::{Arrivals, judge};

use crate::common_sense::Expectation;
use crate::owners::{OwnerSet, OwnerSetDistribution, candidate_sets};
use crate::roster::UserIndex;

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
    /// The place term: how probable it is that a thing at no distance from a thing with answered owners has the
    /// same ones. 0 switches the term off; it stays below 1, because no neighbour makes anything certain.
    pub place: f64,
    /// The looks term: the same for a thing that looks exactly alike, also below 1. 0 switches the term off.
    pub looks: f64,
    /// The class term: how probable it is that the thing follows what common sense expects of its class in this
    /// household. 0 switches the term off.
    pub common_sense: f64,
    /// The class term where a language model speaks in place of the file of classes: how probable it is that the
    /// thing follows the model's common sense. With .25 a model that is sure of one person of three makes that
    /// person 2.7 times as likely before anybody used the thing, about what the file grants to a role that suits;
    /// three sessions of somebody else outweigh it. It was reasoned so and not fitted: no language model was heard.
    pub language_model: f64,
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
        }
    }
}

/// What is thought of a thing's owners before anybody has used it, beside how many owners things have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opinion<'a> {
    /// Nothing is.
    None,
    /// What the file of classes expects in this household.
    OfClass(&'a Expectation),
    /// What a language model makes of the class, the people and the place: for every member the probability of being
    /// an owner, in the order of the roster. It must not have seen the usage, which would count twice.
    OfModel(&'a [Score]),
    /// The surest opinion that a language model can have: nobody but these people.
    Certain(OwnerSet),
}

impl<'a> From<Option<&'a Expectation>> for Opinion<'a> {
    fn from(expectation: Option<&'a Expectation>) -> Self {
        expectation.map_or(Self::None, Self::OfClass)
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
    /// The probability that the thing has the relative's owners *because* of the relation.
    pub fn coupling(&self, relation: Relation) -> f64 {
        match relation {
            Relation::Near { weight } => self.place * weight,
            Relation::LooksAlike { similarity } => self.looks * similarity.max(0.0),
        }
    }

    /// π(S): by the number of owners, evenly within a number. The sizes between one and everyone share what is
    /// left; where there is none between, one and everyone are scaled up to 1.
    fn log_prior(&self, owners: usize, members: usize, sizes_between: usize, sets_of_size: f64) -> f64 {
        let between = 1.0 - self.prior_single - self.prior_everyone;
        let total = if members == 1 {
            return 0.0;
        } else if sizes_between == 0 {
            self.prior_single + self.prior_everyone
        } else {
            1.0
        };
        let of_size = if owners == 1 {
            self.prior_single
        } else if owners == members {
            self.prior_everyone
        } else {
            between / sizes_between as f64
        };
        log(of_size / total / sets_of_size)
    }
}

/// What is expected of an owner set: by its size, and within a size in proportion to how well its members are
/// suited together.
fn expected(expectation: &Expectation, set: OwnerSet, sizes_between: usize, suited: &[f64]) -> f64 {
    let members = expectation.suitability.len();
    let between = 1.0 - expectation.single - expectation.everyone;
    let of_size = match set.len() {
        size if size == members => expectation.everyone,
        1 => expectation.single,
        _ => between / sizes_between as f64,
    };
    let total = match (members, sizes_between) {
        (1, _) => return 1.0,
        (_, 0) => expectation.single + expectation.everyone,
        _ => 1.0,
    };
    of_size / total * suitability(expectation, set) / suited[set.len()]
}

fn suitability(expectation: &Expectation, set: OwnerSet) -> f64 {
    set.iter().filter_map(|user| expectation.suitability.get(user.place())).product()
}

/// A language model's scores as weights of owner sets: `e(S) ∝ π(S) · ∏_{u∈S} s_u · ∏_{u∉S} (1−s_u)`. A model is told to
/// give one half where nothing speaks for or against a member, so the scores are odds against that: one half for
/// everybody says nothing.
struct ModelOpinion<'a> {
    scores: &'a [Score],
    sum: f64,
}

impl<'a> ModelOpinion<'a> {
    fn new(scores: &'a [Score], sets: &[OwnerSet], prior: impl Fn(OwnerSet) -> f64) -> Self {
        let opinion = Self { scores, sum: 0.0 };
        let sum = sets.iter().fold(0.0, |sum, &set| sum + opinion.of(set, prior(set)));
        Self { sum, ..opinion }
    }

    /// e(S) before it is normalised.
    fn of(&self, set: OwnerSet, prior: f64) -> f64 {
        let odds = self.scores.iter().enumerate().map(|(place, score)| {
            match UserIndex::new(place).is_some_and(|user| set.contains(user)) {
                true => score.value(),
                false => 1.0 - score.value(),
            }
        });
        prior * odds.product::<f64>()
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
    let members = sessions.len();
    let sets = candidate_sets(members);
    let sets_of_size = |size: usize| sets.iter().filter(|set| set.len() == size).count() as f64;
    let size_counts: Vec<f64> = (0..=members).map(sets_of_size).collect();
    let sizes_between = (2..members).filter(|&size| size_counts[size] > 0.0).count();

    let expectation = match opinion {
        Opinion::OfClass(expectation) if expectation.suitability.len() == members => Some(expectation),
        _ => None,
    };
    let mut suited = vec![0.0; members + 1];
    for &set in &sets {
        suited[set.len()] += expectation.map_or(0.0, |expectation| suitability(expectation, set));
    }
    let by_size =
        |set: OwnerSet| parameters.log_prior(set.len(), members, sizes_between, size_counts[set.len()]);
    let of_model = match opinion {
        Opinion::OfModel(scores) if scores.len() == members && members > 1 => {
            Some(ModelOpinion::new(scores, &sets, |set| libm::exp(by_size(set))))
        }
        _ => None,
    }
    .filter(|opinion| opinion.sum > 0.0);

    let couplings: Vec<(OwnerSet, f64)> = relatives
        .iter()
        .filter(|relative| sets.contains(&relative.owners))
        .map(|relative| (relative.owners, parameters.coupling(relative.relation)))
        .collect();
    let independent: f64 = couplings.iter().map(|&(_, coupling)| 1.0 - coupling).product();
    let coupling_sum: f64 = couplings.iter().map(|&(_, coupling)| coupling).sum();

    OwnerSetDistribution::from_log_weights(sets.iter().map(|&set| {
        let by_size = by_size(set);
        let mixed = |weight: f64, expected: f64| log((1.0 - weight) * libm::exp(by_size) + weight * expected);
        let own = match (opinion, expectation, &of_model) {
            (Opinion::Certain(owners), ..) => {
                mixed(parameters.language_model, if set == owners { 1.0 } else { 0.0 })
            }
            (_, Some(expectation), _) => {
                mixed(parameters.common_sense, expected(expectation, set, sizes_between, &suited))
            }
            (_, None, Some(opinion)) => {
                mixed(parameters.language_model, opinion.of(set, libm::exp(by_size)) / opinion.sum)
            }
            (_, None, None) => by_size,
        };
        let shared: f64 =
            couplings.iter().filter(|&&(owners, _)| owners == set).map(|&(_, coupling)| coupling).sum();
        let prior = if coupling_sum > 0.0 {
            log(independent * libm::exp(own) + (1.0 - independent) * shared / coupling_sum)
        } else {
            own
        };
        (set, prior + log_likelihood(sessions, set, parameters))
    }))
}

/// The least probability that the best owner set can be left with by a language model, whatever it says: with the whole
/// weight of an opinion on the rival that explains the usage best. 1 where there is no rival. Where this is high a model
/// need not be asked, because its word can settle nothing.
pub fn least_confidence(
    sessions: &[u64],
    relatives: &[KnownRelative],
    parameters: &EvidenceParameters,
) -> f64 {
    let (best, confidence) = posterior(sessions, Opinion::None, relatives, parameters).best();
    let likelihood = |set: &OwnerSet| log_likelihood(sessions, *set, parameters);
    let rivals = candidate_sets(sessions.len()).into_iter().filter(|&set| set != best);
    rivals
        .max_by(|left, right| likelihood(left).total_cmp(&likelihood(right)))
        .map_or(confidence, |rival| {
            posterior(sessions, Opinion::Certain(rival), relatives, parameters).probability(best)
        })
        .min(confidence)
}

#[cfg(test)]
mod tests;
