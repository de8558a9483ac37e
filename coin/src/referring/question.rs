//! Words for a person: which one is meant, and why nothing is handed out.

use std::collections::HashMap;

use coin_schemas::household::{ObjectId, Score};

use super::MappedThing;
use super::interpretation::Interpretation;
use super::ownership::OwnerReference;
use crate::dialogue::thing::Thing;
use crate::dialogue::wording::{Joined, join, list};
use crate::owners::OwnerSet;
use crate::roster::{Roster, UserIndex};
use crate::space::distance;

/// From this score on a member is named as an owner, as in the paper's Ŝ = {u | s_u ≥ 0.5}.
const OWNER: f64 = 0.5;

/// A neighbour that helps to tell things apart is at most this far away, in metres.
const BESIDE: f64 = 1.0;

/// The most things that a question or a refusal lists.
pub(super) const LISTED: usize = 4;

/// The most things that owners and neighbours tell apart: to compare more takes long, and of more a question lists a few
/// anyway.
pub(super) const COMPARED: usize = 12;

/// What a decision is made of.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) roster: &'a Roster,
    pub(super) things: &'a [MappedThing<'a>],
    /// The owners' scores of the things that are spoken of, by place.
    pub(super) scores: &'a HashMap<usize, Vec<Score>>,
    pub(super) speaker: Option<UserIndex>,
    pub(super) interpretation: &'a Interpretation,
}

impl Scene<'_> {
    pub(super) fn ids(&self, things: &[usize]) -> Vec<ObjectId> {
        things.iter().map(|&thing| self.things[thing].id.clone()).collect()
    }

    fn owners(&self, thing: usize) -> OwnerSet {
        let scores = self.scores.get(&thing);
        self.roster
            .indices()
            .filter(|user| {
                scores.and_then(|scores| scores.get(user.place())).is_some_and(|score| score.value() >= OWNER)
            })
            .collect()
    }

    /// "the mug in the kitchen"
    fn name(&self, thing: usize) -> Thing {
        let thing = &self.things[thing];
        Thing::new(thing.class, thing.room, thing.position.metres())
    }

    /// "the mug"
    fn bare_name(&self, thing: usize) -> Thing {
        let thing = &self.things[thing];
        Thing::new(thing.class, None, thing.position.metres())
    }

    /// "yours", "Mary's", "Bob and Mary's", "everybody's"; `None` where the owner is not known.
    fn whose(&self, owners: OwnerSet) -> Option<String> {
        let alone = owners.iter().next().filter(|_| owners.len() == 1);
        match alone {
            _ if owners.is_empty() => None,
            Some(user) if Some(user) == self.speaker => Some("yours".to_owned()),
            None if owners == self.roster.everyone() => Some("everybody's".to_owned()),
            _ => Some(format!("{}'s", list(self.roster, owners, Joined::And))),
        }
    }

    /// How far the other thing is away, if it is beside this one.
    fn beside(&self, thing: usize, other: usize) -> Option<f64> {
        let (thing, other) = (&self.things[thing], &self.things[other]);
        let together = thing.room.is_none() || other.room.is_none() || thing.room == other.room;
        Some(distance(thing.position, other.position, 1.0)).filter(|&metres| together && metres <= BESIDE)
    }

    /// For every candidate "by the kettle": the nearest thing of another name that stands in no other candidate's
    /// neighbourhood.
    fn neighbours(&self, candidates: &[usize]) -> Vec<Option<String>> {
        let around: Vec<Vec<(usize, f64)>> = candidates
            .iter()
            .map(|&thing| {
                let others = (0..self.things.len()).filter(|other| !candidates.contains(other));
                others.filter_map(|other| Some((other, self.beside(thing, other)?))).collect()
            })
            .collect();
        candidates
            .iter()
            .zip(&around)
            .map(|(&thing, near)| {
                near.iter()
                    .filter(|&&(other, _)| self.things[other].class != self.things[thing].class)
                    .filter(|&&(other, metres)| {
                        // Another of the same name, or another candidate nearer by, would make it mean both.
                        let class = self.things[other].class;
                        candidates.iter().all(|&rival| {
                            rival == thing
                                || self
                                    .beside(rival, other)
                                    .is_none_or(|rival_metres| rival_metres > 2.0 * metres)
                        }) && around
                            .iter()
                            .flatten()
                            .all(|&(twin, _)| twin == other || self.things[twin].class != class)
                            && candidates.iter().all(|&rival| self.things[rival].class != class)
                    })
                    .min_by(|left, right| left.1.total_cmp(&right.1))
                    .map(|&(other, _)| format!("by {}", self.bare_name(other).name))
            })
            .collect()
    }
}

/// What tells candidates apart, in words; `None` for a candidate of which it says nothing.
type Feature = Vec<Option<String>>;

/// How a question about a feature begins.
#[derive(Clone, Copy)]
enum Asked {
    Whose,
    Which,
}

/// The one question that separates the candidates best: by label, owner, room or neighbour, whichever leaves the
/// fewest candidates over on average, Σ n² / n over its groups. On a tie the one that a person knows best comes first, in
/// this order. One candidate alone is in doubt because of its owner.
pub(super) fn which(scene: &Scene<'_>, candidates: &[usize]) -> String {
    if let [only] = candidates {
        return is_it(scene, *only);
    }
    let of = |word: &dyn Fn(usize) -> Option<String>| -> Feature {
        candidates.iter().map(|&thing| word(thing)).collect()
    };
    let labels = of(&|thing| Some(scene.bare_name(thing).name));
    let few = candidates.len() <= COMPARED;
    let owners = of(&|thing| scene.whose(scene.owners(thing)).filter(|_| few));
    let rooms = of(&|thing| Some(scene.name(thing).name).filter(|_| scene.things[thing].room.is_some()));
    let neighbours = if few { scene.neighbours(candidates) } else { vec![None; candidates.len()] };
    let nearby: Feature = neighbours
        .iter()
        .zip(candidates)
        .map(|(neighbour, &thing)| Some(format!("{} {}", scene.bare_name(thing).name, neighbour.as_ref()?)))
        .collect();
    let one_label = left_over(&labels) >= candidates.len() as f64;
    let features =
        [(&labels, Asked::Which), (&owners, Asked::Whose), (&rooms, Asked::Which), (&nearby, Asked::Which)];
    let best = features
        .into_iter()
        .min_by(|left, right| left_over(left.0).total_cmp(&left_over(right.0)))
        .filter(|(feature, _)| left_over(feature) < candidates.len() as f64);
    let noun = if one_label { scene.bare_name(candidates[0]).name } else { "the thing".to_owned() };
    let noun = noun.trim_start_matches("the ").to_owned();
    match best {
        Some((feature, Asked::Whose)) => format!("Whose {noun} do you mean: {}?", alternatives(feature)),
        Some((feature, Asked::Which)) => format!("Which one do you mean: {}?", alternatives(feature)),
        None => format!(
            "I know {} like {} and cannot tell them apart. Will any of them do?",
            candidates.len(),
            scene.name(candidates[0]).name
        ),
    }
}

/// How many candidates an answer leaves on average, if each is equally likely to be meant: Σ n² / n over the groups.
fn left_over(feature: &Feature) -> f64 {
    let total = feature.len() as f64;
    let mut groups: HashMap<Option<&str>, usize> = HashMap::new();
    for word in feature {
        *groups.entry(word.as_deref()).or_default() += 1;
    }
    feature.iter().map(|word| groups[&word.as_deref()] as f64).fold(0.0, |sum, group| sum + group / total)
}

/// The different words, the first ones, joined by "or".
fn alternatives(feature: &Feature) -> String {
    let mut words: Vec<String> = Vec::new();
    for word in feature.iter().flatten() {
        if !words.contains(word) {
            words.push(word.clone());
        }
    }
    if words.len() > LISTED || feature.contains(&None) {
        words.truncate(LISTED);
        words.push("another one".to_owned());
    }
    join(&words, Joined::Or)
}

fn is_it(scene: &Scene<'_>, thing: usize) -> String {
    let name = scene.name(thing);
    let whose = scene.whose(scene.owners(thing));
    match (wanted(scene), scene.interpretation.thing.owner, whose) {
        (_, OwnerReference::Speaker, Some(whose)) => {
            format!("I know only {}, which {} {whose}. Who are you?", name.name, name.is.to_lowercase())
        }
        (_, OwnerReference::Speaker, None) => format!("{} {} yours?", name.is, name.name),
        (Some(wanted), ..) => format!("{} {} {wanted}?", name.is, name.name),
        (None, ..) => format!("Do you mean {}?", name.name),
    }
}

/// Whose thing is asked for: "yours", "Mary's".
fn wanted(scene: &Scene<'_>) -> Option<String> {
    match scene.interpretation.thing.owner {
        OwnerReference::Members(members) => scene.whose(members),
        OwnerReference::OneOf(members) => Some(format!("{}'s", list(scene.roster, members, Joined::Or))),
        OwnerReference::Ours(_) => Some("shared with you".to_owned()),
        OwnerReference::Outside => Some("somebody else's".to_owned()),
        OwnerReference::Anybody | OwnerReference::Speaker | OwnerReference::Unknown => None,
    }
}

/// Why nothing is handed out: what is here instead, and whose it is.
pub(super) fn why_none(scene: &Scene<'_>, instead: &[usize]) -> String {
    let words = scene.interpretation.thing.said.as_str();
    if words.is_empty() {
        return "I do not know which thing is meant.".to_owned();
    }
    let there = if scene.interpretation.hints.is_empty() { "" } else { " there" };
    let start = match (scene.interpretation.thing.owner, wanted(scene)) {
        _ if instead.is_empty() => return format!("I know of no {words}."),
        (OwnerReference::Unknown, _) => format!("I do not know whose {words} you mean."),
        (OwnerReference::Ours(_), _) => format!("I know of no {words}{there} that you share."),
        (_, Some(whose)) => format!("I know of no {words} of {whose}{there}."),
        (_, None) => format!("I know of no {words}{there}."),
    };
    let mut known: Vec<String> = instead
        .iter()
        .take(LISTED)
        .map(|&thing| {
            let name = scene.name(thing);
            let is = name.is.to_lowercase();
            match scene.whose(scene.owners(thing)) {
                Some(whose) => format!("{}, which {is} {whose}", name.name),
                None => format!("{}, whose owner I do not know", name.name),
            }
        })
        .collect();
    if instead.len() > LISTED {
        known.push(format!("{} more", instead.len() - LISTED));
    }
    format!("{start} I know {}.", known.join(", and "))
}
