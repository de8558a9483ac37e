//! A whole home judged at once: what one thing tells of the people's habits counts for every other one.
//!
//! Every thing is explained by three accounts of its use (see `likelihood`), which are mixed as the `habits` of the
//! home are; the habits are known as far as all things and all answers tell them. Looks count for as much as they turn out
//! to tell in this very home (see `resemblance`). The whole is closed form: the same home gives the same judgement.

mod habits;
mod likelihood;
mod resemblance;
mod weighed;

use std::borrow::Cow;
use std::sync::Arc;

use libm::exp;

use super::prior::{Candidates, Opinion, relative_weights};
use super::{EvidenceParameters, HabitSource, Relation, likeness_counts, log_likelihood};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::UserIndex;
use habits::Habits;
use likelihood::Accounts;
use resemblance::{MOST_ALIKE, Resemblance};
use weighed::{Basis, Weighed};

/// Where a thing has more candidate sets than this, as in a household of more than twelve, it is judged by itself with the
/// bare formula of [`super::log_likelihood`]; so many people give their home no one habit.
const MOST_SETS: usize = 800;

/// From this probability of its best owner set on, a thing helps to find out what looks tell in a home.
const SURE_ENOUGH: f64 = 0.7;

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
    /// For every set of every thing, how much likelier or less its looks make it; nothing where looks tell nothing.
    looks: Vec<Vec<f64>>,
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
        let looks = self.by_looks(&beliefs, &answers);
        let distributions = (0..self.things.len())
            .map(|place| match before {
                Some(before)
                    if looks.is_empty()
                        && before.looks.is_empty()
                        && Arc::ptr_eq(&beliefs[place], &before.beliefs[place]) =>
                {
                    before.distributions[place].clone()
                }
                _ => self.things[place].distribution(&seen_with(&beliefs[place], looks.get(place))),
            })
            .collect();
        HomeJudgement { weighed, habits, beliefs, looks, distributions }
    }

    /// What is to be made of one thing with another opinion than it was judged with. The habits of the home and what its
    /// looks tell stay as they were judged.
    pub fn reconsidered(
        &self,
        judgement: &HomeJudgement,
        place: usize,
        opinion: Opinion<'_>,
    ) -> OwnerSetDistribution {
        let thing = &self.things[place];
        let weighed = self.weigh(place, judgement.weighed[place].basis.clone(), opinion);
        let belief = weighed.belief(thing, &judgement.habits, &self.parameters);
        thing.distribution(&seen_with(&belief, judgement.looks.get(place)))
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

    /// p(habits | all things, all answers) over the grid, without what is negligible. Where habits are not learnt every
    /// point is as probable as any other.
    fn habits(&self, weighed: &[Arc<Weighed>]) -> Vec<(Habits, f64)> {
        let mut logarithms = vec![0.0; habits::HABITS];
        if self.parameters.habits == HabitSource::Learnt {
            for thing in weighed {
                logarithms.iter_mut().zip(thing.log_evidence()).for_each(|(sum, of_thing)| *sum += of_thing);
            }
        }
        let probabilities = from_logarithms(logarithms.into_iter());
        Habits::all().zip(probabilities).filter(|&(_, probability)| probability > NEGLIGIBLE).collect()
    }

    /// For every set of every thing, how much likelier or less its looks make it; nothing where looks tell nothing. Only
    /// things whose owners were named, or are nearly sure, speak for the looks of others.
    fn by_looks(&self, beliefs: &[Arc<Vec<f64>>], answers: &[Option<OwnerSet>]) -> Vec<Vec<f64>> {
        if self.parameters.resemblance <= 0.0 || self.things.iter().all(|thing| thing.seen.alike.is_empty()) {
            return Vec::new();
        }
        let known: Vec<Option<OwnerSet>> = self
            .things
            .iter()
            .zip(beliefs)
            .zip(answers)
            .map(|((thing, belief), answer)| match *answer {
                Some(owners) => Some(owners).filter(|owners| !owners.is_empty()),
                None => thing.nearly_sure(belief),
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
        let Some(resemblance) = Resemblance::learn(pairs) else { return Vec::new() };
        self.things
            .iter()
            .map(|thing| {
                let others = thing.seen.alike.iter();
                let others =
                    others.filter_map(|&(other, cosine)| Some((known[other]?, cosine))).take(MOST_ALIKE);
                let witnesses = resemblance.witnesses(others);
                let fits = thing.candidates.sets().iter().map(|&set| {
                    self.parameters.resemblance * witnesses.log_likelihood(thing.candidates.widened(set))
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

    /// The best owner set, where it is nearly sure.
    fn nearly_sure(&self, belief: &[f64]) -> Option<OwnerSet> {
        let place = (0..belief.len()).find(|&place| belief[place] >= SURE_ENOUGH)?;
        Some(self.candidates.widened(self.candidates.sets()[place]))
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

/// Whether two distributions of habits differ by no more than what is left out of either.
fn are_same(left: &[(Habits, f64)], right: &[(Habits, f64)]) -> bool {
    left.len() == right.len()
        && left
            .iter()
            .zip(right)
            .all(|(left, right)| left.0 == right.0 && (left.1 - right.1).abs() <= NEGLIGIBLE)
}

/// A belief with what its looks say, where they say anything.
fn seen_with<'a>(belief: &'a [f64], looks: Option<&Vec<f64>>) -> Cow<'a, [f64]> {
    match looks {
        None => Cow::Borrowed(belief),
        Some(looks) => belief.iter().zip(looks).map(|(belief, looks)| belief * looks).collect(),
    }
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
