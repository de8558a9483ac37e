//! Judges every thing of the map by a request, and decides.

use coin_schemas::household::{ObjectId, Score};

use super::interpretation::{Interpretation, interpret};
use super::labels::{Fit, LabelFits};
use super::ownership::{KnownOwners, OwnerReference, Ownership};
use super::places::Place;
use super::question::{self, COMPARED, LISTED, Scene};
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

/// One thing that the words may mean, judged.
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

/// A decision before it is put into words; things by their place in the map.
enum Verdict {
    Found(usize),
    Ambiguous(Vec<usize>),
    None(Vec<usize>),
}

/// Finds the thing that a request means.
///
/// Of the things that the words and places describe, those may be meant that belong to whom the request names with a
/// probability above [`EXCLUDED`]; of these, those within [`RIVAL`] of the best score. A single one that is
/// [`SURE`]ly theirs is found. Several, or one in doubt, are ambiguous. A request by an unknown speaker for "my" thing is
/// ambiguous even if only one is here; one that names somebody unknown comes to nothing.
///
/// `scores` gives, for the thing at a place of `things`, the probability of every member, in the order of the roster, to
/// be among its owners. It is asked once for each thing that the words describe if the request names an owner, and for
/// the few things of which a question or a refusal has to say whose they are.
///
/// # Errors
/// What `scores` fails with.
pub fn find<E>(
    roster: &Roster,
    things: &[MappedThing<'_>],
    query: &str,
    speaker: Option<UserIndex>,
    scores: impl FnMut(usize) -> Result<Vec<Score>, E>,
) -> Result<Finding, E> {
    let interpretation = interpret(roster, query, speaker);
    let mut owners = KnownOwners::new(scores);
    let judged = judge(things, &interpretation, &mut owners)?;
    let verdict = decide(&judged, &interpretation);
    let spoken_of: &[usize] = match &verdict {
        Verdict::Found(_) => &[],
        // Nobody is read a list of more, so that whose they are would tell nothing apart.
        Verdict::Ambiguous(candidates) if candidates.len() > COMPARED => &[],
        Verdict::Ambiguous(candidates) => candidates,
        Verdict::None(instead) => &instead[..instead.len().min(LISTED)],
    };
    for &thing in spoken_of {
        owners.of(thing)?;
    }
    let scene = Scene { roster, things, scores: owners.known(), speaker, interpretation: &interpretation };
    let decision = match verdict {
        Verdict::Found(thing) => Decision::Found(things[thing].id.clone()),
        Verdict::Ambiguous(candidates) => Decision::Ambiguous {
            question: question::which(&scene, &candidates),
            candidates: scene.ids(&candidates),
        },
        Verdict::None(instead) => {
            Decision::None { reason: question::why_none(&scene, &instead), instead: scene.ids(&instead) }
        }
    };
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
    Ok(Finding { interpretation, matches, decision })
}

/// The things whose label or looks fit the noun at least.
fn judge<E, F: FnMut(usize) -> Result<Vec<Score>, E>>(
    things: &[MappedThing<'_>],
    interpretation: &Interpretation,
    owners: &mut KnownOwners<F>,
) -> Result<Vec<Judged>, E> {
    let places = interpretation
        .hints
        .iter()
        .map(|hint| Place::locate(things, hint, owners))
        .collect::<Result<Vec<Place<'_>>, E>>()?;
    let owner = interpretation.thing.owner;
    let names_something = !interpretation.hints.is_empty() || owner != OwnerReference::Anybody;
    let mut fits = LabelFits::new(&interpretation.thing.class);
    let mut judged = Vec::new();
    for (thing, mapped) in things.iter().enumerate() {
        let fit = match (interpretation.thing.class.is_empty(), names_something) {
            (false, _) => fits.of(mapped.class),
            // "Bring me something of Mary's" means any thing; "bring me that" means none that is known.
            (true, true) => Fit { noun: 1.0, whole: 1.0 },
            (true, false) => Fit { noun: 0.0, whole: 0.0 },
        };
        let likeness = mapped.likeness.map_or(0.0, Score::value);
        let fit = Fit { noun: fit.noun.max(likeness), whole: fit.whole.max(likeness) };
        if fit.noun < LEAST_MATCH {
            continue;
        }
        // What the words do not describe is not looked for at a place, and its owner changes nothing.
        let is_described = fit.whole >= LEAST_MATCH;
        let place = match is_described {
            true => places.iter().map(|place| place.fit(things, thing)).product(),
            false => 0.0,
        };
        let ownership = match is_described && owner.depends_on_owners() {
            true => owner.ownership(owners.of(thing)?),
            false => owner.ownership(&[]),
        };
        judged.push(Judged { thing, fit, place, ownership });
    }
    Ok(judged)
}

fn decide(judged: &[Judged], interpretation: &Interpretation) -> Verdict {
    let described: Vec<&Judged> = judged.iter().filter(|judged| judged.is_described()).collect();
    let possible: Vec<&Judged> = match interpretation.thing.owner {
        OwnerReference::Unknown => Vec::new(),
        OwnerReference::Speaker => described,
        _ => described
            .into_iter()
            .filter(|judged| judged.ownership.is_some_and(|ownership| ownership.probability > EXCLUDED))
            .collect(),
    };
    let rivals = best(&possible, Judged::score);
    match rivals.as_slice() {
        [] => Verdict::None(alike(judged, interpretation)),
        [only] if only.is_owned(SURE) => Verdict::Found(only.thing),
        _ => Verdict::Ambiguous(rivals.iter().map(|judged| judged.thing).collect()),
    }
}

/// What is like the thing: by all words where something has them, by the noun otherwise.
fn alike(judged: &[Judged], interpretation: &Interpretation) -> Vec<usize> {
    // Where no word names a thing, everything is alike, and to list the home helps nobody.
    if interpretation.thing.class.is_empty() {
        return Vec::new();
    }
    let by = |value: fn(&Judged) -> f64| -> Vec<usize> {
        let alike: Vec<&Judged> = judged.iter().filter(|judged| value(judged) >= LEAST_MATCH).collect();
        best(&alike, value).iter().map(|judged| judged.thing).collect()
    };
    let whole = by(|judged| judged.fit.whole);
    if whole.is_empty() { by(|judged| judged.fit.noun) } else { whole }
}

/// Those within [`RIVAL`] of the best.
fn best<'a>(judged: &[&'a Judged], value: impl Fn(&Judged) -> f64) -> Vec<&'a Judged> {
    let best = judged.iter().map(|judged| value(judged)).fold(0.0, f64::max);
    judged.iter().copied().filter(|judged| value(judged) >= RIVAL * best).collect()
}
