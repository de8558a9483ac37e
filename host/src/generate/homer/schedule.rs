//! Days sampled from persona histograms, and what is done with each thing on them.

use std::collections::BTreeMap;

use coin::usage::SESSION_GAP_SECONDS;
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::data::{HomerData, SLOTS, ScriptStep};
use crate::generate::plan::{FIRST_MINUTE, LAST_MINUTE, Minute};
use crate::generate::sessions::{Action, CAPTIONS_PER_SESSION, Putting, Step};

/// Steps of a script in one minute.
const STEPS_A_MINUTE: usize = 3;

/// One session with a thing, before anybody is its user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Usage {
    pub(super) day: usize,
    pub(super) steps: Vec<Step>,
}

/// Samples so many days and gives every thing's sessions in order of time.
///
/// There is one persona for each member of the household. On each day and in each hour, every activity of a persona
/// happens with the probability of its histogram, at a minute drawn evenly; one of its scripts, drawn evenly, says
/// what is done, three steps a minute. Steps with one thing and no gap over 20 minutes are one session; of more steps
/// than a camera tells of one session the first ones and the last are kept.
pub(super) fn sample(
    data: &HomerData,
    members: usize,
    days: usize,
    generator: &mut ChaCha8Rng,
) -> BTreeMap<String, Vec<Usage>> {
    let personas: Vec<&BTreeMap<String, Vec<f64>>> =
        (0..members).filter_map(|_| data.personas.choose(generator)).collect();
    let mut events: BTreeMap<&str, Vec<(usize, Step)>> = BTreeMap::new();
    for day in 0..days {
        for persona in &personas {
            for (activity, hours) in *persona {
                for (slot, &probability) in hours.iter().enumerate().take(SLOTS) {
                    if !generator.random_bool(probability) {
                        continue;
                    }
                    let start = FIRST_MINUTE + slot as Minute * 60 + generator.random_range(0..60);
                    let Some(script) = data.scripts.get(activity).and_then(|ways| ways.choose(generator))
                    else {
                        continue;
                    };
                    for (place, step) in script.iter().enumerate() {
                        let minute = start + (place / STEPS_A_MINUTE) as Minute;
                        if let Some(action) = action(step).filter(|_| minute <= LAST_MINUTE)
                            && let Some((class, _)) = data.classes.get_key_value(&step.class)
                        {
                            events.entry(class).or_default().push((day, Step { minute, action }));
                        }
                    }
                }
            }
        }
    }
    events.into_iter().map(|(class, events)| (class.to_owned(), sessions(events))).collect()
}

/// The steps that handle a thing; walking, sitting and turning to it do not.
fn action(step: &ScriptStep) -> Option<Action> {
    match step.verb.as_str() {
        "FIND" => Some(Action::Search),
        "GRAB" => Some(Action::Take),
        "PUTBACK" | "PUTIN" | "PUTOBJBACK" => Some(Action::Place(Putting::Back)),
        "SWITCHON" | "READ" | "DRINK" | "OPEN" => Some(Action::Use(0)),
        "SWITCHOFF" | "CLOSE" | "LOOKAT" => Some(Action::Use(1)),
        _ => None,
    }
}

fn sessions(mut events: Vec<(usize, Step)>) -> Vec<Usage> {
    // The sort is stable: steps of one minute keep the order of the script.
    events.sort_by_key(|(day, step)| (*day, step.minute));
    let mut sessions: Vec<Usage> = Vec::new();
    for (day, step) in events {
        let gap = |last: &Step| i64::from(step.minute - last.minute) * 60 > SESSION_GAP_SECONDS;
        match sessions.last_mut() {
            Some(session) if session.day == day && session.steps.last().is_some_and(|last| !gap(last)) => {
                if !session.steps.contains(&step) {
                    session.steps.push(step);
                }
            }
            _ => sessions.push(Usage { day, steps: vec![step] }),
        }
    }
    let most = *CAPTIONS_PER_SESSION.end();
    for session in &mut sessions {
        if session.steps.len() > most {
            session.steps.drain(most - 1..session.steps.len() - 1);
        }
    }
    sessions
}
