//! A whole home judged at once: what one thing tells of the people's habits counts for every other one.
//!
//! Every thing is explained by three accounts of its use (see `likelihood`), which are mixed as the `habits` of the
//! home are; the habits are known as far as all things and all answers tell them. Looks and places count for as much as they
//! turn out to tell in this very home (see `company`). Nothing is drawn by chance: the same home gives the same judgement.

mod company;
mod habits;
mod hints;
mod likelihood;
mod nearness;
mod resemblance;
mod ties;
mod value;
mod weighed;

use std::collections::BTreeMap;
use std::sync::Arc;

use libm::{exp, log};

use super::prior::{Candidates, Opinion};
use super::{EvidenceParameters, HabitSource, Relation, likeness_counts, log_likelihood};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::UserIndex;
use company::in_company;
use habits::Habits;
use hints::Company;
use likelihood::Accounts;
use weighed::{Basis, Weighed};

/// Where a thing has more candidate sets than this, as in a household of more than twelve, it is judged by itself with the
/// bare formula of [`super::log_likelihood`]; so many people give their home no one habit.
const MOST_SETS: usize = 800;

/// The most rivals of a best owner set that are tried, those which explain the use of the thing best. In a household of five
/// these are all.
const MOST_RIVALS: usize = 30;

/// Habits that are less probable than this are left out of the mixture.
const NEGLIGIBLE: f64 = 1e-4;

/// What was worked out for habits holds for others whose probabilities differ by no more.
const SAME: f64 = 1e-9;

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

/// What was seen of one thing, worked out by itself. This takes most of the time of a large home, and whoever has several
/// processors can share it among them.
#[derive(Debug, Clone, PartialEq)]
pub struct ThingEvidence(Thing);

impl ThingEvidence {
    /// Of a thing that somebody can own.
    ///
    /// # Panics
    /// If the thing has no candidate.
    pub fn new(seen: SeenThing, parameters: &EvidenceParameters) -> Self {
        Self(Thing::new(seen, parameters))
    }
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
    weighed: Vec<Arc<Weighed>>,
    habits: Vec<(Habits, f64)>,
    beliefs: Vec<Arc<Vec<f64>>>,
    /// What the company of every thing makes of it; nothing where that tells nothing.
    company: Vec<Company>,
    distributions: Vec<OwnerSetDistribution>,
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
        let evidence = things.into_iter().map(|seen| ThingEvidence::new(seen, &parameters));
        Self::of(evidence.collect(), parameters)
    }

    /// Of things whose evidence was worked out before, with the same parameters.
    pub fn of(things: Vec<ThingEvidence>, parameters: EvidenceParameters) -> Self {
        let mut things: Vec<Thing> = things.into_iter().map(|ThingEvidence(thing)| thing).collect();
        let alike =
            mutual(&things, |seen| &seen.alike, |one, other| likeness_counts(&one.class, &other.class));
        let near = mutual(&things, |seen| &seen.near, |_, _| true);
        for ((thing, alike), near) in things.iter_mut().zip(alike).zip(near) {
            thing.seen.alike = alike;
            thing.seen.near = near;
        }
        Self { things, parameters }
    }

    /// Judges every thing, given what is told of each, in their order.
    ///
    /// # Panics
    /// If not every thing is told of.
    pub fn judge(&self, told: &[Told<'_>]) -> HomeJudgement {
        self.judged(told, None)
    }

    /// Judges every thing again after more was answered, with the opinions of before. The result is that of
    /// [`Self::judge`]; what did not change is not worked out again.
    ///
    /// # Panics
    /// If not every thing is told of.
    pub fn judge_again(&self, told: &[Told<'_>], before: &HomeJudgement) -> HomeJudgement {
        self.judged(told, Some(before))
    }

    fn judged(&self, told: &[Told<'_>], before: Option<&HomeJudgement>) -> HomeJudgement {
        assert_eq!(told.len(), self.things.len(), "something must be told of every thing, if only nothing");
        let answers: Vec<Option<OwnerSet>> = told.iter().map(|told| told.answer).collect();
        let weighed: Vec<Arc<Weighed>> = (0..self.things.len())
            .map(|place| {
                let basis = self.basis(place, &answers);
                match before.map(|before| &before.weighed[place]) {
                    Some(before) if before.basis == basis => Arc::clone(before),
                    _ => Arc::new(self.weigh(place, basis, told[place].opinion)),
                }
            })
            .collect();
        let habits = self.habits(&weighed);
        let same_habits = before.is_some_and(|before| are_same(&before.habits, &habits));
        let beliefs: Vec<Arc<Vec<f64>>> = weighed
            .iter()
            .enumerate()
            .map(|(place, weighed)| match before {
                Some(before) if same_habits && Arc::ptr_eq(weighed, &before.weighed[place]) => {
                    Arc::clone(&before.beliefs[place])
                }
                _ => Arc::new(weighed.belief(&self.things[place], &habits, &self.parameters)),
            })
            .collect();
        let company = self.company(&weighed, &habits, &beliefs, &answers);
        let distributions = (0..self.things.len())
            .map(|place| match before {
                Some(before)
                    if company.is_empty()
                        && before.company.is_empty()
                        && Arc::ptr_eq(&beliefs[place], &before.beliefs[place]) =>
                {
                    before.distributions[place].clone()
                }
                _ => self.things[place].distribution(&in_company(&beliefs[place], company.get(place))),
            })
            .collect();
        HomeJudgement { weighed, habits, beliefs, company, distributions }
    }

    /// What is to be made of one thing with another opinion than it was judged with. The habits of the home and what
    /// the company of the thing tells stay as they were judged.
    pub fn reconsidered(
        &self,
        judgement: &HomeJudgement,
        place: usize,
        opinion: Opinion<'_>,
    ) -> OwnerSetDistribution {
        let thing = &self.things[place];
        let weighed = self.weigh(place, judgement.weighed[place].basis.clone(), opinion);
        let belief = weighed.belief(thing, &judgement.habits, &self.parameters);
        thing.distribution(&in_company(&belief, judgement.company.get(place)))
    }

    /// The least probability that the best owner set of a thing can be left with by a language model, whatever it says:
    /// with the whole weight of an opinion on a rival. 1 where there is no rival. Where this is high a model need not be
    /// asked, because its word can settle nothing.
    pub fn least_confidence(&self, judgement: &HomeJudgement, place: usize) -> f64 {
        let without = self.reconsidered(judgement, place, Opinion::None);
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
            self.reconsidered(judgement, place, Opinion::Certain(rival)).probability(best)
        };
        rivals.iter().take(MOST_RIVALS).map(left_by).fold(confidence, f64::min)
    }

    fn basis(&self, place: usize, answers: &[Option<OwnerSet>]) -> Basis {
        let thing = &self.things[place];
        let near = thing.seen.near.iter();
        let couplings = near.filter_map(|&(other, weight)| {
            let owners = thing.candidates.narrowed((*answers.get(other)?)?)?;
            Some((owners, self.parameters.coupling(Relation::Near { weight })))
        });
        Basis { answer: answers[place], couplings: couplings.collect() }
    }

    fn weigh(&self, place: usize, basis: Basis, opinion: Opinion<'_>) -> Weighed {
        Weighed::new(&self.things[place], basis, opinion, &self.parameters)
    }

    /// p(habits | all things, all answers) over the grid, without what is negligible. Where habits are not learnt they are as
    /// probable as before anything was seen.
    fn habits(&self, weighed: &[Arc<Weighed>]) -> Vec<(Habits, f64)> {
        let people = self.things.iter().map(|thing| thing.candidates.people()).max().unwrap_or(0);
        let mut logarithms: Vec<f64> = Habits::all().map(|habits| log(habits.prior(people))).collect();
        if self.parameters.habits == HabitSource::Learnt {
            for thing in weighed {
                logarithms.iter_mut().zip(thing.log_evidence()).for_each(|(sum, of_thing)| *sum += of_thing);
            }
        }
        let probabilities = from_logarithms(logarithms.into_iter());
        let mut habits: Vec<(Habits, f64)> =
            Habits::all().zip(probabilities).filter(|&(_, probability)| probability > NEGLIGIBLE).collect();
        let heard: f64 = habits.iter().map(|(_, probability)| probability).sum();
        habits.iter_mut().for_each(|(_, probability)| *probability /= heard);
        habits
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

    /// The members of the set at a place.
    fn owners(&self, place: usize) -> OwnerSet {
        self.candidates.widened(self.candidates.sets()[place])
    }

    /// The place of these members among the sets; `None` where they are no candidates.
    fn place_of(&self, owners: OwnerSet) -> Option<usize> {
        let owners = self.candidates.narrowed(owners)?;
        self.candidates.sets().iter().position(|&set| set == owners)
    }

    /// The probabilities by members of the household. Whether what is everybody's is a latecomer's too is as likely as
    /// not.
    fn distribution(&self, belief: &[f64]) -> OwnerSetDistribution {
        let SeenThing { candidates, latecomers, .. } = self.seen;
        let entries = self.candidates.sets().iter().zip(belief);
        let mut weights: Vec<(OwnerSet, f64)> =
            entries.map(|(&set, &weight)| (self.candidates.widened(set), weight)).collect();
        let largest = belief.iter().copied().fold(0.0, f64::max);
        if let Some(entry) = weights
            .iter_mut()
            .find(|(set, weight)| *set == candidates && *weight >= largest)
            .filter(|_| !latecomers.is_empty() && candidates.len() > 1)
        {
            entry.1 /= 2.0;
            let with_them = (candidates.union(latecomers), entry.1);
            weights.push(with_them);
        }
        OwnerSetDistribution::from_weights(weights)
    }
}

/// Whether two distributions of habits are the same but for rounding.
fn are_same(left: &[(Habits, f64)], right: &[(Habits, f64)]) -> bool {
    left.len() == right.len()
        && left.iter().zip(right).all(|(left, right)| left.0 == right.0 && (left.1 - right.1).abs() <= SAME)
}

/// The weights whose natural logarithms these are, made to sum to 1.
fn from_logarithms(logarithms: impl Iterator<Item = f64>) -> Vec<f64> {
    let logarithms: Vec<f64> = logarithms.collect();
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = logarithms.iter().map(|&logarithm| exp(logarithm - largest)).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// For every thing what it is related to or what is related to it, closest first, where that counts. Look-alikes of its own
/// class do not, which look alike because they are of it.
fn mutual(
    things: &[Thing],
    related: fn(&SeenThing) -> &[(usize, f64)],
    counts: fn(&SeenThing, &SeenThing) -> bool,
) -> Vec<Vec<(usize, f64)>> {
    let mut all: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); things.len()];
    for (place, thing) in things.iter().enumerate() {
        for &(other, relation) in related(&thing.seen) {
            if other != place && things.get(other).is_some_and(|other| counts(&thing.seen, &other.seen)) {
                all[place].insert(other, relation);
                all[other].insert(place, relation);
            }
        }
    }
    let closest_first = |others: BTreeMap<usize, f64>| {
        let mut others: Vec<(usize, f64)> = others.into_iter().collect();
        others.sort_by(|left, right| right.1.total_cmp(&left.1).then(left.0.cmp(&right.0)));
        others
    };
    all.into_iter().map(closest_first).collect()
}

#[cfg(test)]
mod tests;
