//! What other things of the home tell of every one: those that look like it, and those that lie beside it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::habits::Habits;
use super::hints::{Company, Judged, grouped, worth};
use super::nearness::Nearness;
use super::resemblance::Resemblance;
use super::weighed::Weighed;
use super::{HomeEvidence, SeenThing, Thing};
use crate::owners::OwnerSet;

/// From this probability of its best owner set on, a thing speaks for others.
const SURE_ENOUGH: f64 = 0.6;

/// A thing whose use leaves it open whose it is may become clear by its company, and then speak for others in turn. It
/// may once: what is still open then rests on too little to be passed on.
const ROUNDS: usize = 2;

/// The most look-alikes that are heard about one thing.
const MOST_ALIKE: usize = 40;

/// What hints are worth is found out from about so many things, evenly spread over a home. In one of no more, from all.
const MOST_TELLING: usize = 100;

impl HomeEvidence {
    /// What the company of every thing makes of it; nothing where there is none or where it tells nothing. Only things
    /// whose owners were named, or are probably known, speak for others.
    pub(super) fn company(
        &self,
        weighed: &[Arc<Weighed>],
        habits: &[(Habits, f64)],
        beliefs: &[Arc<Vec<f64>>],
        answers: &[Option<OwnerSet>],
    ) -> Vec<Company> {
        let heard =
            |exponent: f64, others: fn(&Thing) -> bool| exponent > 0.0 && self.things.iter().any(others);
        if !heard(self.parameters.resemblance, |thing| !thing.seen.alike.is_empty())
            && !heard(self.parameters.nearness, |thing| !thing.seen.near.is_empty())
        {
            return Vec::new();
        }
        let stride = self.things.len().div_ceil(MOST_TELLING);
        let judged: Vec<Judged<'_>> = (0..self.things.len())
            .map(|place| {
                let (thing, belief, answer) = (&self.things[place], &beliefs[place], answers[place]);
                match place % stride {
                    0 => Judged::telling(thing, belief, answer, weighed[place].prior(habits)),
                    _ => Judged::silent(thing, belief, answer),
                }
            })
            .collect();
        let mut company: Vec<Company> = Vec::new();
        for _ in 0..ROUNDS {
            let known: Vec<Option<OwnerSet>> =
                (0..judged.len()).map(|place| probable_owners(&judged[place], company.get(place))).collect();
            company = self.told_by(&known, &judged);
        }
        company
    }

    /// What things of these owners tell of all others.
    fn told_by(&self, known: &[Option<OwnerSet>], judged: &[Judged<'_>]) -> Vec<Company> {
        let looks = self.by_looks(known, judged);
        let places = self.by_places(known, judged);
        match (looks.is_empty(), places.is_empty()) {
            (_, true) => looks,
            (true, false) => places,
            (false, false) => looks.into_iter().zip(&places).map(|(look, place)| look.and(place)).collect(),
        }
    }

    fn by_looks(&self, known: &[Option<OwnerSet>], judged: &[Judged<'_>]) -> Vec<Company> {
        let pairs = self.known_pairs(known, |seen| &seen.alike);
        let Some(resemblance) = Resemblance::learn(pairs).filter(|_| self.parameters.resemblance > 0.0)
        else {
            return Vec::new();
        };
        let hinted = judged.iter().map(|judged| {
            let witnesses = grouped(witnesses(known, &judged.thing.seen.alike).take(MOST_ALIKE));
            judged.hinted(self.parameters.resemblance, |owners| resemblance.fit(owners, &witnesses))
        });
        worth(&hinted.collect::<Vec<_>>())
    }

    fn by_places(&self, known: &[Option<OwnerSet>], judged: &[Judged<'_>]) -> Vec<Company> {
        let pairs = self.known_pairs(known, |seen| &seen.near);
        let nearness = Nearness::learn(known.iter().copied().flatten(), pairs);
        let Some(nearness) = nearness.filter(|_| self.parameters.nearness > 0.0) else { return Vec::new() };
        let mut all_near = BTreeMap::new();
        let hinted = judged.iter().map(|judged| {
            let witnesses = grouped(witnesses(known, &judged.thing.seen.near));
            judged.hinted(self.parameters.nearness, |owners| {
                let all = all_near.entry(owners).or_insert_with(|| nearness.all(owners));
                nearness.fit(owners, &witnesses, *all)
            })
        });
        worth(&hinted.collect::<Vec<_>>())
    }

    /// Every pair of things of known owners that are related so, once.
    fn known_pairs<'a>(
        &'a self,
        known: &'a [Option<OwnerSet>],
        related: fn(&SeenThing) -> &[(usize, f64)],
    ) -> impl Iterator<Item = (OwnerSet, OwnerSet, f64)> + 'a {
        self.things.iter().enumerate().flat_map(move |(place, thing)| {
            let later = related(&thing.seen).iter().filter(move |&&(other, _)| place < other);
            later.filter_map(move |&(other, relation)| Some((known[place]?, known[other]?, relation)))
        })
    }
}

/// Those of the related things whose owners are known.
fn witnesses<'a>(
    known: &'a [Option<OwnerSet>],
    related: &'a [(usize, f64)],
) -> impl Iterator<Item = (OwnerSet, f64)> + 'a {
    related.iter().filter_map(|&(other, relation)| Some((known[other]?, relation)))
}

/// The owners, where they were named or are more probable than not.
fn probable_owners(judged: &Judged<'_>, company: Option<&Company>) -> Option<OwnerSet> {
    if let Some(owners) = judged.answer {
        return Some(owners).filter(|owners| !owners.is_empty());
    }
    let belief = in_company(judged.belief, company);
    let all: f64 = belief.iter().sum();
    let place = belief.iter().position(|&weight| weight >= SURE_ENOUGH * all)?;
    Some(judged.thing.owners(place))
}

/// A belief with what the company of the thing says, where it says anything.
pub(super) fn in_company<'a>(belief: &'a [f64], company: Option<&Company>) -> Cow<'a, [f64]> {
    company.map_or(Cow::Borrowed(belief), |company| company.applied(belief).into())
}
