//! The days of a household, and what is done with each thing on them.

use std::collections::BTreeMap;

use coin::usage::SESSION_GAP_SECONDS;
use rand::seq::{IndexedRandom, SliceRandom};
use rand_chacha::ChaCha8Rng;

use super::data::{HomerData, Persona};
use super::error::HomerError;
use super::sampler::{self, COMING_HOME, Habits, LEAVING_HOME};
use crate::generate::plan::{LAST_MINUTE, Minute};
use crate::generate::sessions::Step;

/// One session with a thing, before anybody is its user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Usage {
    pub(super) day: usize,
    pub(super) steps: Vec<Step>,
}

/// Samples so many days and gives every class's sessions in order of time.
///
/// Each member of the household is a persona of their own, while there are any left, and follows one script for each
/// activity throughout, as in a data set of HOMER's. Steps with one class and no gap over 20 minutes are one session,
/// whole and in order. What would be seen after 23:00, when the paper's watch ends, is not.
///
/// # Errors
/// If a persona does not come home.
pub(super) fn sample(
    data: &HomerData,
    members: usize,
    days: usize,
    generator: &mut ChaCha8Rng,
) -> Result<BTreeMap<String, Vec<Usage>>, HomerError> {
    let mut personas: Vec<&Persona> = data.personas.iter().collect();
    personas.shuffle(generator);
    let mut events: BTreeMap<&str, Vec<(usize, Step)>> = BTreeMap::new();
    for persona in personas.into_iter().cycle().take(members) {
        let habits = habits(data, persona, generator);
        for day in 0..days {
            let occurrences =
                sampler::day(persona, &habits, generator).ok_or_else(|| data.never_home(persona))?;
            for occurrence in occurrences {
                let Some(script) = habits.get(occurrence.activity) else { continue };
                for (begins, step) in script.beginnings(occurrence.until - occurrence.from) {
                    let minute = Minute::try_from((occurrence.from + begins) / 60).unwrap_or(Minute::MAX);
                    let class = step.class.as_ref().and_then(|class| data.classes.get_key_value(class));
                    if let (Some(action), Some((class, _)), true) =
                        (step.verb.action(), class, minute <= LAST_MINUTE)
                    {
                        events.entry(class).or_default().push((day, Step { minute, action }));
                    }
                }
            }
        }
    }
    Ok(events.into_iter().map(|(class, events)| (class.to_owned(), sessions(events))).collect())
}

/// Draws one script for each activity of a persona. Who comes home does so by the script of the same name as that by
/// which they leave, where there is one: it brings back what the other took along.
pub(super) fn habits<'a>(
    data: &'a HomerData,
    persona: &'a Persona,
    generator: &mut ChaCha8Rng,
) -> Habits<'a> {
    let mut habits: Habits<'a> = persona
        .activities()
        .filter_map(|activity| Some((activity, data.scripts.get(activity)?.choose(generator)?)))
        .collect();
    let leaves_by = habits.get(LEAVING_HOME).map(|script| script.name.as_str());
    if let Some(back) = data
        .scripts
        .get(COMING_HOME)
        .and_then(|scripts| scripts.iter().find(|script| Some(script.name.as_str()) == leaves_by))
        && habits.contains_key(COMING_HOME)
    {
        habits.insert(COMING_HOME, back);
    }
    habits
}

fn sessions(mut events: Vec<(usize, Step)>) -> Vec<Usage> {
    // The sort is stable: steps of one minute keep the order of the script.
    events.sort_by_key(|(day, step)| (*day, step.minute));
    let mut sessions: Vec<Usage> = Vec::new();
    for (day, step) in events {
        let gap = |last: &Step| i64::from(step.minute - last.minute) * 60 > SESSION_GAP_SECONDS;
        match sessions.last_mut() {
            Some(session) if session.day == day && session.steps.last().is_some_and(|last| !gap(last)) => {
                // What is done twice in a minute is one line of the history.
                if !session.steps.contains(&step) {
                    session.steps.push(step);
                }
            }
            _ => sessions.push(Usage { day, steps: vec![step] }),
        }
    }
    sessions
}
