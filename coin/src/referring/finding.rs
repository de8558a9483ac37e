//! Judges every thing of the map by a request, and decides.

use std::collections::BTreeMap;

use coin_schemas::household::{ObjectId, Score};

use super::interpretation::{Interpretation, interpret};
use super::labels::{Fit, fit, words_of};
use super::ownership::{OwnerReference, Ownership};
use super::places::place_fit;
use super::question::{self, Scene};
use super::{EXCLUDED, LEAST_MATCH, LEAST_PLACE, MappedThing, RIVAL, SURE};
use crate::roster::{Roster, UserIndex};

/// How well one thing fits a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Match {
    /// The thing.
    pub id: ObjectId,
    /// How well the words fit it, 0…1.
    pub matched: f64,
    /// How well its place fits, 0…1.
    pub place: f64,
    /// The probability that the owners are those of the request, 0…1; `None` where it is not known whom the request
    /// means.
    pub ownership: Option<f64>,
    /// The product of match, place and the fit of the ownership, 0…1.
    pub score: f64,
}

/// What a request comes to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Decision {
    /// Exactly this thing is meant.
    Found(ObjectId),
    /// One of these is meant, and a person has to say which, or whether it is the one at all.
    Ambiguous {
        /// The things in the order of the map.
        candidates: Vec<ObjectId>,
        /// The one question that separates them best.
        question: String,
    },
    /// Nothing here is meant.
    None {
        /// What is like it in the order of the map: another person's, elsewhere, or with other properties.
        instead: Vec<ObjectId>,
        /// What was found instead and whose it is, in a sentence.
        reason: String,
    },
}

/// The answer to a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// How the request was read.
    pub interpretation: Interpretation,
    /// The things that the words describe, best score first, then in the order of the map.
    pub matches: Vec<Match>,
    /// What to do.
    pub decision: Decision,
}

/// One thing, judged.
struct Judged {
    thing: usize,
    fit: Fit,
    place: f64,
    ownership: Option<Ownership>,
}

impl Judged {
    /// The product of match, place and ownership; of a request whose owner is not known, of match and place.
    fn score(&self) -> f64 {
        self.fit.whole * self.place * self.ownership.map_or(1.0, |ownership| ownership.fit)
    }

    fn is_described(&self) -> bool {
        self.fit.whole >= LEAST_MATCH && self.place >= LEAST_PLACE
    }

    fn is_owned(&self, least: f64) -> bool {
        self.ownership.is_some_and(|ownership| ownership.probability >= least)
    }
}

/// Finds the thing that a request means.
///
/// Of the things that the words and places describe, those may be meant that belong to whom the request names with a
/// probability above [`EXCLUDED`]; of these, those within [`RIVAL`] of the best score. A single one that is
/// [`SURE`]ly theirs is found. Several, or one in doubt, are ambiguous. A request by an unknown speaker for "my" thing is
/// ambiguous even if only one is here; one that names somebody unknown comes to nothing.
pub fn find(roster: &Roster, things: &[MappedThing<'_>], query: &str, speaker: Option<UserIndex>) -> Finding {
    let interpretation = interpret(roster, query, speaker);
    let judged = judge(things, &interpretation);
    let scene = Scene { roster, things, speaker, interpretation: &interpretation };
    let decision = decide(&judged, &scene);
    let mut matches: Vec<&Judged> = judged.iter().filter(|judged| judged.fit.whole >= LEAST_MATCH).collect();
    matches.sort_by(|left, right| right.score().total_cmp(&left.score()));
    let matches = matches
        .into_iter()
        .map(|judged| Match {
            id: things[judged.thing].id.clone(),
            matched: judged.fit.whole,
            place: judged.place,
            ownership: judged.ownership.map(|ownership| ownership.probability),
            score: judged.score(),
        })
        .collect();
    Finding { interpretation, matches, decision }
}

fn judge(things: &[MappedThing<'_>], interpretation: &Interpretation) -> Vec<Judged> {
    let mut fits: BTreeMap<&str, Fit> = BTreeMap::new();
    let words = &interpretation.thing.class;
    let names_something =
        !interpretation.hints.is_empty() || interpretation.thing.owner != OwnerReference::Anybody;
    things
        .iter()
        .enumerate()
        .map(|(place, thing)| {
            let mut fit = match (words.is_empty(), names_something) {
                (false, _) => *fits.entry(thing.class).or_insert_with(|| fit(words, &words_of(thing.class))),
                // "Bring me something of Mary's" means any thing; "bring me that" means none that is known.
                (true, true) => Fit { noun: 1.0, whole: 1.0 },
                (true, false) => Fit { noun: 0.0, whole: 0.0 },
            };
            let likeness = thing.likeness.map_or(0.0, Score::value);
            fit = Fit { noun: fit.noun.max(likeness), whole: fit.whole.max(likeness) };
            // What the words do not describe is not looked for at a place.
            let described = fit.whole >= LEAST_MATCH;
            let place_fit = if described { place_fit(things, place, &interpretation.hints) } else { 0.0 };
            let ownership = interpretation.thing.owner.ownership(thing.scores);
            Judged { thing: place, fit, place: place_fit, ownership }
        })
        .collect()
}

fn decide(judged: &[Judged], scene: &Scene<'_>) -> Decision {
    let described: Vec<&Judged> = judged.iter().filter(|judged| judged.is_described()).collect();
    let possible: Vec<&Judged> = match scene.interpretation.thing.owner {
        OwnerReference::Unknown => Vec::new(),
        OwnerReference::Speaker => described,
        _ => described
            .into_iter()
            .filter(|judged| judged.ownership.is_some_and(|ownership| ownership.probability > EXCLUDED))
            .collect(),
    };
    let rivals = best(&possible, Judged::score);
    match rivals.as_slice() {
        [] => refuse(judged, scene),
        [only] if only.is_owned(SURE) => Decision::Found(scene.things[only.thing].id.clone()),
        _ => {
            let things: Vec<usize> = rivals.iter().map(|judged| judged.thing).collect();
            Decision::Ambiguous { candidates: scene.ids(&things), question: question::which(scene, &things) }
        }
    }
}

/// Says what is like the thing: by all words where something has them, by the noun otherwise.
fn refuse(judged: &[Judged], scene: &Scene<'_>) -> Decision {
    let by = |value: fn(&Judged) -> f64| -> Vec<usize> {
        let alike: Vec<&Judged> = judged.iter().filter(|judged| value(judged) >= LEAST_MATCH).collect();
        best(&alike, value).iter().map(|judged| judged.thing).collect()
    };
    let whole = by(|judged| judged.fit.whole);
    let things = if whole.is_empty() { by(|judged| judged.fit.noun) } else { whole };
    // Where no word names a thing, everything is alike, and to list the home helps nobody.
    let things = if scene.interpretation.thing.class.is_empty() { Vec::new() } else { things };
    Decision::None { instead: scene.ids(&things), reason: question::why_none(scene, &things) }
}

/// Those within [`RIVAL`] of the best.
fn best<'a>(judged: &[&'a Judged], value: impl Fn(&Judged) -> f64) -> Vec<&'a Judged> {
    let best = judged.iter().map(|judged| value(judged)).fold(0.0, f64::max);
    judged.iter().copied().filter(|judged| value(judged) >= RIVAL * best).collect()
}
