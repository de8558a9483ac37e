//! Homes that live by HOMER (*Household Object Movements from Everyday Routines*; Patel and Chernova, *Proactive Robot
//! Assistance via Spatio-Temporal Object Modeling*, 2022).
//!
//! HOMER records one resident. As the paper does (its Appendix D), days are sampled from it and what is done with each
//! thing is cut into sessions of no gap over 20 minutes; who does it is drawn by the law of the thing's usage type, so
//! that the schedules say when things are used and the ownership says by whom.

mod data;
mod schedule;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

pub use data::{HomerData, HomerError};

use super::belongings::{self, Belonging};
use super::catalogue::{Handling, Kept, Suits, Thing};
use super::parameters::RoutineParameters;
use super::people::Person;
use super::random::Stream;
use super::sessions::{Session, ThingHistory};
use data::ClassFacts;
use schedule::Usage;

/// What an episode's description says of where it comes from.
pub(super) const LICENCE_NOTE: &str = " Sampled from the HOMER data set of Georgia Tech's RAIL lab, under CC BY-NC-SA \
                                       4.0; what is made from it carries the same licence.";

/// What there is in the home and what happens to it. Things that are used too seldom are left out.
pub(super) fn life(
    data: &HomerData,
    people: &[Person],
    parameters: &RoutineParameters,
    role_fit: f64,
    days: usize,
    random: impl Fn(Stream) -> ChaCha8Rng,
) -> (Vec<Belonging>, Vec<ThingHistory>) {
    let usage = schedule::sample(data, people.len(), days, &mut random(Stream::Schedule));
    let generator = &mut random(Stream::Belongings);
    let least = *parameters.sessions.start();
    let used: Vec<&str> = usage
        .iter()
        .filter(|(_, sessions)| sessions.len() >= least)
        .map(|(class, _)| class.as_str())
        .collect();
    let wanted = rand::RngExt::random_range(generator, parameters.things.clone());
    let chosen: Vec<&'static Thing> = used
        .sample(generator, wanted)
        .filter_map(|class| Some(thing(class, data.classes.get(*class)?)))
        .collect();
    let mut belongings = belongings::assign(chosen, people, parameters, role_fit, generator);
    belongings::hand_down(&mut belongings, parameters.handed_down, days, &mut random(Stream::HandDowns));

    let generator = &mut random(Stream::Sessions);
    let nothing = Vec::new();
    let histories = belongings
        .iter()
        .map(|belonging| {
            let sessions = usage.get(belonging.thing.class).unwrap_or(&nothing);
            live(belonging, sessions, people.len(), *parameters.sessions.end(), generator)
        })
        .collect();
    (belongings, histories)
}

/// Draws who uses a thing in each of its sessions. Of more sessions than a thing may have, as many are drawn.
fn live(
    belonging: &Belonging,
    sessions: &[Usage],
    people: usize,
    most: usize,
    generator: &mut ChaCha8Rng,
) -> ThingHistory {
    let mut kept: Vec<&Usage> = sessions.sample(generator, most).collect();
    kept.sort_by_key(|usage| (usage.day, usage.steps.first().map(|step| step.minute)));
    let mut counts = vec![0; people];
    let mut history = ThingHistory::default();
    for usage in kept {
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
        let switched = facts.verbs.contains("SWITCHON");
        let carried = facts.verbs.contains("GRAB");
        Box::leak(Box::new(Thing {
            class: Box::leak(class.to_owned().into_boxed_str()),
            kept: kept(facts.room.as_deref()),
            height: 0.9,
            handling: if carried { Handling::Carried } else { Handling::Fixed },
            activities: &[],
            uses: match (switched, facts.verbs.contains("READ"), facts.verbs.contains("DRINK")) {
                (true, _, _) => &["turns on", "turns off", "is using"],
                (_, true, _) => &["reads", "uses", "is using"],
                (_, _, true) => &["drinks from", "uses", "is using"],
                _ => &["is using", "uses", "briefly uses"],
            },
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
