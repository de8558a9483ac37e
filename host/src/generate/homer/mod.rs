//! Homes that live by HOMER (*Household Object Movements from Everyday Routines*; Patel and Chernova, *Proactive Robot
//! Assistance via Spatio-Temporal Object Modeling*, 2022).
//!
//! HOMER records one resident. As the paper does (its Appendix D), days are sampled from it and what is done with each
//! thing is cut into sessions of no gap over 20 minutes; who does it is drawn by the law of the thing's usage type, so
//! that the schedules say when things are used and the ownership says by whom.

mod data;
mod error;
mod sampler;
mod schedule;
mod script;
#[cfg(test)]
pub(super) mod tests;

use std::collections::{BTreeMap, HashMap};
use std::sync::{LazyLock, Mutex, PoisonError};

use rand::RngExt;
use rand::seq::{IndexedRandom, SliceRandom};
use rand_chacha::ChaCha8Rng;

pub use data::HomerData;
pub use error::HomerError;
pub use script::Verb;

use super::belongings::{self, Belonging};
use super::catalogue::{Handling, Kept, Suits, Thing};
use super::parameters::Structure;
use super::random::Stream;
use super::sessions::{Session, ThingHistory};
use super::{Household, Life, paper};
use data::ClassFacts;
use schedule::Usage;

/// What an episode's description says of where it comes from.
pub(super) const LICENCE_NOTE: &str = " Sampled from the HOMER data set of Georgia Tech's RAIL lab, under CC BY-NC-SA \
                                       4.0; what is made from it carries the same licence.";

/// How many schedules are sampled to find one in which enough things are used.
const SCHEDULES_TRIED: usize = 50;
/// How many exchanges of one thing for another are tried to come near the volume of the paper's data.
const EXCHANGES_TRIED: usize = 2000;
/// How near that is: a fiftieth of the volume.
const NEAR: usize = paper::CAPTIONS / 50;

/// What there is in the home and what happens to it. Things that are used too seldom are left out.
///
/// # Errors
/// If too few things are used often enough, or a persona does not come home.
pub(super) fn life(data: &HomerData, household: &Household<'_>) -> Result<Life, HomerError> {
    let Household { parameters, habits, people, days, .. } = household;
    let generator = &mut household.random(Stream::Belongings);
    let wanted = generator.random_range(parameters.things.clone());
    let usage = usage(data, household, wanted)?;
    let chosen: Vec<&'static Thing> = choose(&usage, wanted, parameters.structure, generator)
        .into_iter()
        .filter_map(|class| Some(thing(class, data.classes.get(class)?)))
        .collect();
    let mut belongings = belongings::assign(chosen, people, parameters, habits.role_fit, generator);
    let generator = &mut household.random(Stream::HandDowns);
    belongings::hand_down(&mut belongings, parameters.handed_down, days.len(), generator);

    let generator = &mut household.random(Stream::Sessions);
    let histories = belongings
        .iter()
        .map(|belonging| {
            let sessions = usage.get(belonging.thing.class).map_or(&[][..], Vec::as_slice);
            live(belonging, sessions, people.len(), generator)
        })
        .collect();
    Ok(Life { belongings, histories })
}

/// The sessions of the classes that are used often enough, in a schedule that has as many of them as the home has
/// things. Of more sessions than a thing may have, as many are drawn; those that are kept are kept whole.
fn usage(
    data: &HomerData,
    household: &Household<'_>,
    wanted: usize,
) -> Result<BTreeMap<String, Vec<Usage>>, HomerError> {
    let (least, most) = household.parameters.sessions.clone().into_inner();
    let (members, days) = (household.people.len(), household.days.len());
    let generator = &mut household.random(Stream::Schedule);
    let mut found = 0;
    for _ in 0..SCHEDULES_TRIED {
        let mut usage = schedule::sample(data, members, days, generator)?;
        usage.retain(|_, sessions| sessions.len() >= least);
        if usage.len() >= wanted {
            for sessions in usage.values_mut().filter(|sessions| sessions.len() > most) {
                *sessions = sessions.sample(generator, most).cloned().collect();
                sessions.sort_by_key(|session| (session.day, session.steps.first().map(|step| step.minute)));
            }
            return Ok(usage);
        }
        found = found.max(usage.len());
    }
    Err(HomerError::TooFewClasses {
        path: data.folder.clone(),
        needed: wanted,
        found,
        sessions: least,
        days,
        tried: SCHEDULES_TRIED,
    })
}

/// Draws which classes are things of the home, every one equally likely. With the paper's structure single things are
/// then exchanged for others, as they are drawn, where that brings the number of captions nearer to the paper's, until it
/// is near; a schedule with less to see than that keeps what comes nearest.
fn choose<'a>(
    usage: &'a BTreeMap<String, Vec<Usage>>,
    wanted: usize,
    structure: Structure,
    generator: &mut ChaCha8Rng,
) -> Vec<&'a str> {
    let mut classes: Vec<(&str, usize)> = usage
        .iter()
        .map(|(class, sessions)| (class.as_str(), sessions.iter().map(|session| session.steps.len()).sum()))
        .collect();
    classes.shuffle(generator);
    let mut others = classes.split_off(wanted.min(classes.len()));
    if structure == Structure::Paper && !others.is_empty() {
        let mut captions: usize = classes.iter().map(|(_, captions)| captions).sum();
        for _ in 0..EXCHANGES_TRIED {
            let distance = captions.abs_diff(paper::CAPTIONS);
            if distance <= NEAR {
                break;
            }
            let (out, into) =
                (generator.random_range(0..classes.len()), generator.random_range(0..others.len()));
            let exchanged = captions + others[into].1 - classes[out].1;
            if exchanged.abs_diff(paper::CAPTIONS) < distance {
                std::mem::swap(&mut classes[out], &mut others[into]);
                captions = exchanged;
            }
        }
    }
    classes.into_iter().map(|(class, _)| class).collect()
}

/// Draws who uses a thing in each of its sessions.
fn live(
    belonging: &Belonging,
    sessions: &[Usage],
    people: usize,
    generator: &mut ChaCha8Rng,
) -> ThingHistory {
    let mut counts = vec![0; people];
    let mut history = ThingHistory::default();
    for usage in sessions {
        match belonging.next_user(usage.day, &counts, generator) {
            Some(user) => {
                counts[user] += 1;
                history.sessions.push(Session { user, day: usage.day, steps: usage.steps.clone() });
            }
            None => history.unplaced += 1,
        }
    }
    history
}

/// The catalogue's form of a class of HOMER's. A class is made once in the life of the program, so that it can be
/// named as the classes of our own catalogue are.
fn thing(class: &str, facts: &ClassFacts) -> &'static Thing {
    static MADE: LazyLock<Mutex<HashMap<(String, ClassFacts), &'static Thing>>> =
        LazyLock::new(Mutex::default);
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    made.entry((class.to_owned(), facts.clone())).or_insert_with(|| {
        let carried = facts.verbs.contains(&Verb::Grab);
        Box::leak(Box::new(Thing {
            class: Box::leak(class.to_owned().into_boxed_str()),
            kept: kept(facts.room.as_deref()),
            height: 0.9,
            handling: if carried { Handling::Carried } else { Handling::Fixed },
            activities: &[],
            uses: script::USES,
            cleaning: None,
            weekly: 1.0,
            copies: 1,
            suits: Suits::Anyone,
            common: 0.5,
        }))
    })
}

/// Where things of a room are kept in our own floor plan.
fn kept(room: Option<&str>) -> Kept {
    match room {
        Some("bathroom") => Kept::BathroomShelf,
        Some("bedroom") => Kept::Bedside,
        Some("home_office") => Kept::Desk,
        Some("dining_room" | "kitchen") => Kept::Cupboard,
        _ => Kept::Seat,
    }
}
