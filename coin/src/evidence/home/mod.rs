//! A whole home judged at once: what one thing tells of the people's habits counts for every other one.
//!
//! Every thing is explained by three accounts of its use (see [`likelihood`]), which are mixed as the [`habits`] of the
//! home are; the habits are known as far as all things and all answers tell them. Looks count for as much as they turn out
//! to tell in this very home (see [`resemblance`]). The whole is closed form: the same home gives the same judgement.

mod habits;
mod likelihood;
mod resemblance;

use libm::{exp, log};

use super::prior::{Candidates, Opinion, SizePrior, logarithms, relative_weights, with_relatives};
use super::{EvidenceParameters, HabitSource, Relation, likeness_counts, log_likelihood};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::UserIndex;
use habits::{Habits, SIZES};
use likelihood::Accounts;
use resemblance::{MOST_ALIKE, Resemblance};

/// Where a thing has more candidate sets than this, as in a household of more than twelve, it is judged by itself with the
/// bare formula of [`super::log_likelihood`]; so many people give their home no one habit.
const MOST_SETS: usize = 800;

/// From this probability of its best owner set on, a thing helps to find out what looks tell in a home.
const SURE_ENOUGH: f64 = 0.7;

/// How probable it is that a person's answer is right, as far as the habits of the home are learnt from it.
const TRUST: f64 = 0.95;

/// The most rivals of a best owner set that are tried, those which explain the use of the thing best. In a household of five
/// these are all.
const MOST_RIVALS: usize = 30;

/// Habits that are less probable than this are left out of the mixture.
const NEGLIGIBLE: f64 = 1e-9;

/// What was seen of one thing of a home.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenThing {
    /// Its class as people say it.
    pub class: String,
    /// Who used it, session by session, in order of time.
    pub sessions: Vec<UserIndex>,
    /// What lies near: the places of other things in the home, and their Gaussian weights, 0…1.
    pub near: Vec<(usize, f64)>,
    /// What looks like it: the places of other things in the home, and the cosines, −1…1.
    pub alike: Vec<(usize, f64)>,
    /// The people who can own it.
    pub candidates: OwnerSet,
    /// The people who came after it was used first and have not used it. They are no candidates, but where it is held to
    /// be everybody's it is open whether it is theirs too.
    pub latecomers: OwnerSet,
}

/// What is known or thought of a thing's owners, beside what was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told<'a> {
    /// Whom a person named; nobody where somebody outside the household owns it.
    pub answer: Option<OwnerSet>,
    /// What is thought of it before anybody has used it.
    pub opinion: Opinion<'a>,
}

/// What was seen of all things of a home, worked out as far as no answer and no opinion can change it.
#[derive(Debug, Clone, PartialEq)]
pub struct HomeEvidence {
    things: Vec<Thing>,
    parameters: EvidenceParameters,
}

#[derive(Debug, Clone, PartialEq)]
struct Thing {
    seen: SeenThing,
    candidates: Candidates,
    use_of_it: Use,
}

#[derive(Debug, Clone, PartialEq)]
enum Use {
    /// As the accounts have it.
    Accounts(Accounts),
    /// ln p(c | S) of the bare formula.
    Bare(Vec<f64>),
}

/// How probable every owner set of every thing is.
#[derive(Debug, Clone, PartialEq)]
pub struct HomeJudgement {
    distributions: Vec<OwnerSetDistribution>,
    habits: Vec<(Habits, f64)>,
    /// For every set of every thing, how much likelier or less its looks make it.
    looks: Vec<Vec<f64>>,
}

impl HomeJudgement {
    /// The probabilities, in the order of the things. Those of an answered thing are what would be thought of it without
    /// its own answer.
    pub fn distributions(&self) -> &[OwnerSetDistribution] {
        &self.distributions
    }
}

impl HomeEvidence {
    /// Of these things. A thing that nobody can own must not be among them.
    ///
    /// # Panics
    /// If a thing has no candidate.
    pub fn new(things: Vec<SeenThing>, parameters: EvidenceParameters) -> Self {
        let mut things: Vec<Thing> = things.into_iter().map(|seen| Thing::new(seen, &parameters)).collect();
        let alike = mutual_look_alikes(&things);
        for (thing, alike) in things.iter_mut().zip(alike) {
            thing.seen.alike = alike;
        }
        Self { things, parameters }
    }

    /// Judges every thing, given what is told of each, in their order.
    ///
    /// # Panics
    /// If not every thing is told of.
    pub fn judge(&self, told: &[Told<'_>]) -> HomeJudgement {
        assert_eq!(told.len(), self.things.len(), "something must be told of every thing, if only nothing");
        let answers: Vec<Option<OwnerSet>> = told.iter().map(|told| told.answer).collect();
        let weighed: Vec<Weighed<'_>> = self
            .things
            .iter()
            .zip(told)
            .map(|(thing, told)| self.weigh(thing, told.opinion, &answers))
            .collect();
        let habits = self.habits(&weighed, &answers);
        let beliefs: Vec<Vec<f64>> = weighed.iter().map(|thing| thing.belief(&habits)).collect();
        let looks = self.by_looks(&beliefs, &answers);
        let judged = self.things.iter().zip(&beliefs).zip(&looks);
        let distributions =
            judged.map(|((thing, belief), looks)| thing.distribution(&product(belief, looks))).collect();
        HomeJudgement { distributions, habits, looks }
    }

    /// What is to be made of one thing with another opinion than it was judged with. The habits of the home and what its
    /// looks tell stay as they were judged.
    pub fn reconsidered(
        &self,
        judgement: &HomeJudgement,
        answers: &[Option<OwnerSet>],
        place: usize,
        opinion: Opinion<'_>,
    ) -> OwnerSetDistribution {
        let thing = &self.things[place];
        let belief = self.weigh(thing, opinion, answers).belief(&judgement.habits);
        thing.distribution(&product(&belief, &judgement.looks[place]))
    }

    /// The least probability that the best owner set of a thing can be left with by a language model, whatever it says:
    /// with the whole weight of an opinion on a rival. 1 where there is no rival. Where this is high a model need not be
    /// asked, because its word can settle nothing.
    pub fn least_confidence(
        &self,
        judgement: &HomeJudgement,
        answers: &[Option<OwnerSet>],
        place: usize,
    ) -> f64 {
        let without = self.reconsidered(judgement, answers, place, Opinion::None);
        let (best, confidence) = without.best();
        let thing = &self.things[place];
        let prior = thing.candidates.by_size(self.parameters.sizes());
        let likelihood = |set: OwnerSet| {
            let place =
                thing.candidates.sets().iter().position(|&other| thing.candidates.widened(other) == set);
            place.map_or(0.0, |place| without.probability(set) / prior[place])
        };
        let mut rivals: Vec<(f64, OwnerSet)> = without
            .entries()
            .iter()
            .filter(|&&(set, _)| set != best)
            .map(|&(set, _)| (likelihood(set), set))
            .collect();
        rivals.sort_by(|left, right| right.0.total_cmp(&left.0));
        let left_by = |&(_, rival): &(f64, OwnerSet)| {
            self.reconsidered(judgement, answers, place, Opinion::Certain(rival)).probability(best)
        };
        rivals.iter().take(MOST_RIVALS).map(left_by).fold(confidence, f64::min)
    }

    fn weigh<'a>(&self, thing: &'a Thing, opinion: Opinion<'_>, answers: &[Option<OwnerSet>]) -> Weighed<'a> {
        let couplings: Vec<(OwnerSet, f64)> = thing
            .seen
            .near
            .iter()
            .filter_map(|&(other, weight)| {
                let owners = thing.candidates.narrowed((*answers.get(other)?)?)?;
                Some((owners, self.parameters.coupling(Relation::Near { weight })))
            })
            .collect();
        let prior = |sizes: SizePrior| {
            let mut prior = thing.candidates.own(opinion, sizes, &self.parameters);
            with_relatives(thing.candidates.sets(), &mut prior, &couplings);
            prior
        };
        match &thing.use_of_it {
            Use::Accounts(accounts) => Weighed::ByHabits(ByHabits {
                candidates: &thing.candidates,
                accounts,
                priors: SIZES.map(prior).into(),
                change_of_hands: self.parameters.change_of_hands,
            }),
            Use::Bare(use_of_it) => {
                let prior = prior(self.parameters.sizes());
                Weighed::Alone(from_logarithms(
                    logarithms(&prior).zip(use_of_it).map(|(prior, used)| prior + used),
                ))
            }
        }
    }

    /// p(habits | all things, all answers) over the grid, without what is negligible. Where habits are not learnt every
    /// point is as probable as any other.
    fn habits(&self, weighed: &[Weighed<'_>], answers: &[Option<OwnerSet>]) -> Vec<(Habits, f64)> {
        let logarithms: Vec<f64> = match self.parameters.habits {
            HabitSource::Ordinary => vec![0.0; habits::HABITS],
            HabitSource::Learnt => Habits::all()
                .map(|habits| {
                    weighed
                        .iter()
                        .zip(answers)
                        .map(|(thing, &answer)| thing.log_evidence(habits, answer))
                        .sum()
                })
                .collect(),
        };
        let probabilities = from_logarithms(logarithms.into_iter());
        Habits::all().zip(probabilities).filter(|&(_, probability)| probability > NEGLIGIBLE).collect()
    }

    /// For every set of every thing, how much likelier or less its looks make it. Only things whose owners were named, or
    /// are nearly sure, speak for the looks of others.
    fn by_looks(&self, beliefs: &[Vec<f64>], answers: &[Option<OwnerSet>]) -> Vec<Vec<f64>> {
        let known: Vec<Option<OwnerSet>> = self
            .things
            .iter()
            .zip(beliefs)
            .zip(answers)
            .map(|((thing, belief), answer)| match *answer {
                Some(owners) => Some(owners).filter(|owners| !owners.is_empty()),
                None => {
                    let (best, confidence) = thing.distribution(belief).best();
                    (confidence >= SURE_ENOUGH).then_some(best)
                }
            })
            .collect();
        let pairs = self.things.iter().enumerate().flat_map(|(place, thing)| {
            let known = &known;
            thing
                .seen
                .alike
                .iter()
                .filter(move |&&(other, _)| place < other)
                .filter_map(move |&(other, cosine)| Some((known[place]?, known[other]?, cosine)))
        });
        let resemblance = Resemblance::learn(pairs).filter(|_| self.parameters.resemblance > 0.0);
        self.things
            .iter()
            .map(|thing| {
                let sets = thing.candidates.sets();
                let Some(resemblance) = &resemblance else { return vec![1.0; sets.len()] };
                let others: Vec<(OwnerSet, f64)> = thing
                    .seen
                    .alike
                    .iter()
                    .filter_map(|&(other, cosine)| Some((known[other]?, cosine)))
                    .take(MOST_ALIKE)
                    .collect();
                let fits = sets.iter().map(|&set| {
                    let owners = thing.candidates.widened(set);
                    let of_each = others
                        .iter()
                        .map(|&(others, cosine)| resemblance.log_likelihood(owners, others, cosine));
                    self.parameters.resemblance * of_each.sum::<f64>()
                });
                relative_weights(&fits.collect::<Vec<_>>())
            })
            .collect()
    }
}

impl Thing {
    fn new(seen: SeenThing, parameters: &EvidenceParameters) -> Self {
        assert!(!seen.candidates.is_empty(), "a thing that nobody can own is not judged");
        let candidates = Candidates::of(seen.candidates);
        let users: Vec<usize> = seen.sessions.iter().filter_map(|&user| candidates.place_of(user)).collect();
        let use_of_it = if candidates.sets().len() <= MOST_SETS {
            Use::Accounts(Accounts::new(&users, &candidates, parameters))
        } else {
            let mut counts = vec![0; candidates.people()];
            users.iter().for_each(|&user| counts[user] += 1);
            Use::Bare(candidates.sets().iter().map(|&set| log_likelihood(&counts, set, parameters)).collect())
        };
        Self { seen, candidates, use_of_it }
    }

    /// The probabilities by members of the household. Whether what is everybody's is a latecomer's too is as likely as
    /// not.
    fn distribution(&self, belief: &[f64]) -> OwnerSetDistribution {
        let SeenThing { candidates, latecomers, .. } = self.seen;
        let entries = self.candidates.sets().iter().zip(belief);
        let mut weights: Vec<(OwnerSet, f64)> =
            entries.map(|(&set, &weight)| (self.candidates.widened(set), log(weight))).collect();
        let largest = weights.iter().map(|&(_, weight)| weight).fold(f64::NEG_INFINITY, f64::max);
        if let Some(entry) = weights
            .iter_mut()
            .find(|(set, weight)| *set == candidates && *weight >= largest)
            .filter(|_| !latecomers.is_empty() && candidates.len() > 1)
        {
            entry.1 -= log(2.0);
            let with_them = (candidates.union(latecomers), entry.1);
            weights.push(with_them);
        }
        OwnerSetDistribution::from_log_weights(weights)
    }
}

/// A thing with the prior that what is told gives it.
enum Weighed<'a> {
    /// Its belief depends on the habits of the home.
    ByHabits(ByHabits<'a>),
    /// It is judged by itself, and this is its belief.
    Alone(Vec<f64>),
}

struct ByHabits<'a> {
    candidates: &'a Candidates,
    accounts: &'a Accounts,
    /// For each of [`SIZES`].
    priors: Vec<Vec<f64>>,
    change_of_hands: f64,
}

impl ByHabits<'_> {
    /// π(S | habits)·p(use | S, habits) for every set, given that the habits are these.
    fn joint(&self, habits: Habits) -> impl Iterator<Item = f64> {
        let kept = &self.accounts.kept[habits.mistaken];
        let lent = &self.accounts.lent[habits.lent()];
        let changed = self.accounts.changed.get(habits.lending);
        let change = if changed.is_some() { self.change_of_hands } else { 0.0 };
        let prior = &self.priors[habits.sizes];
        let (single, shared) = (habits.kept(1), habits.kept(2));
        self.candidates.sets().iter().enumerate().map(move |(place, set)| {
            let share = if set.len() == 1 { single } else { shared };
            let stayed = share * kept[place] + (1.0 - share) * lent[place];
            let moved = changed.map_or(0.0, |changed| changed[place]);
            prior[place] * ((1.0 - change) * stayed + change * moved)
        })
    }

    /// ln p(use, answer | habits), up to a constant.
    fn log_evidence(&self, habits: Habits, answer: Option<OwnerSet>) -> f64 {
        let all: f64 = self.joint(habits).sum();
        match answer {
            None => log(all),
            Some(owners) if owners.is_empty() => 0.0,
            Some(owners) => {
                let Some(owners) = self.candidates.narrowed(owners) else { return 0.0 };
                let named =
                    self.candidates.sets().iter().zip(self.joint(habits)).find(|&(&set, _)| set == owners);
                named.map_or(0.0, |(_, named)| log(TRUST * named + (1.0 - TRUST) * all))
            }
        }
    }
}

impl Weighed<'_> {
    fn log_evidence(&self, habits: Habits, answer: Option<OwnerSet>) -> f64 {
        match self {
            Self::ByHabits(thing) => thing.log_evidence(habits, answer),
            Self::Alone(_) => 0.0,
        }
    }

    /// Σ_h p(h)·p(S | use, h) for every set.
    fn belief(&self, habits: &[(Habits, f64)]) -> Vec<f64> {
        let thing = match self {
            Self::Alone(belief) => return belief.clone(),
            Self::ByHabits(thing) => thing,
        };
        let mut belief = vec![0.0; thing.candidates.sets().len()];
        for &(habits, probability) in habits {
            let joint: Vec<f64> = thing.joint(habits).collect();
            let all: f64 = joint.iter().sum();
            belief.iter_mut().zip(joint).for_each(|(sum, joint)| *sum += probability * joint / all);
        }
        belief
    }
}

fn product(left: &[f64], right: &[f64]) -> Vec<f64> {
    left.iter().zip(right).map(|(left, right)| left * right).collect()
}

/// The weights whose natural logarithms these are, made to sum to 1.
fn from_logarithms(logarithms: impl Iterator<Item = f64>) -> Vec<f64> {
    let logarithms: Vec<f64> = logarithms.collect();
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = logarithms.iter().map(|&logarithm| exp(logarithm - largest)).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// For every thing what looks like it or what it looks like, most alike first, without things of its own class, which look
/// alike because they are of it.
fn mutual_look_alikes(things: &[Thing]) -> Vec<Vec<(usize, f64)>> {
    let mut alike: Vec<std::collections::BTreeMap<usize, f64>> = vec![Default::default(); things.len()];
    for (place, thing) in things.iter().enumerate() {
        for &(other, cosine) in &thing.seen.alike {
            if things.get(other).is_some_and(|other| likeness_counts(&thing.seen.class, &other.seen.class)) {
                alike[place].insert(other, cosine);
                alike[other].insert(place, cosine);
            }
        }
    }
    alike
        .into_iter()
        .map(|others| {
            let mut others: Vec<(usize, f64)> = others.into_iter().collect();
            others.sort_by(|left, right| right.1.total_cmp(&left.1).then(left.0.cmp(&right.0)));
            others
        })
        .collect()
}

#[cfg(test)]
mod tests;
