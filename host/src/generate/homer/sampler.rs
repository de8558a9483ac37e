//! Days of a persona, sampled as HOMER samples them.

use std::collections::BTreeMap;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::data::{Persona, SLOTS};
use super::script::Script;
use crate::generate::plan::FIRST_MINUTE;

/// A second of the day, from midnight.
pub(super) type Second = u32;

/// Going out …
pub(super) const LEAVING_HOME: &str = "leave_home";
/// … and what alone can follow.
pub(super) const COMING_HOME: &str = "come_home";

const HOUR: Second = 60 * 60;
const FIRST_SECOND: Second = FIRST_MINUTE as Second * 60;
const MIDNIGHT: Second = 24 * HOUR;
/// Who does nothing is asked again after ten minutes.
const IDLE: Second = 10 * 60;
/// The hours of the histogram, from the one in which an activity ends, in which it does not happen again.
pub(super) const BLOCKED_HOURS: usize = 3;
/// How often a day that ends away from home is sampled again.
pub(super) const DAYS_TRIED: usize = 1000;

/// The script that one member of the household follows for each activity.
pub(super) type Habits<'a> = BTreeMap<&'a str, &'a Script>;

/// Something that a persona does on a day.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Occurrence<'a> {
    pub(super) activity: &'a str,
    pub(super) from: Second,
    /// When the next thing may begin.
    pub(super) until: Second,
}

/// Where a persona is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Whereabouts {
    Home,
    Out,
}

/// The histograms of a persona on one day, and what of them is left.
#[derive(Debug, Clone)]
pub(super) struct DaySampler<'a> {
    persona: &'a Persona,
    /// The sum of the shares of the busiest hour, the scale of every draw.
    busiest: f64,
    whereabouts: Whereabouts,
    /// The first hour of the histogram in which a finished activity can be drawn again.
    blocked_until: BTreeMap<&'a str, usize>,
}

impl<'a> DaySampler<'a> {
    pub(super) fn new(persona: &'a Persona) -> Self {
        Self {
            persona,
            busiest: persona.busiest(),
            whereabouts: Whereabouts::Home,
            blocked_until: BTreeMap::new(),
        }
    }

    /// One draw over everything that the persona may do in an hour of the histogram; `None` is doing nothing.
    ///
    /// At home each activity has its share of that hour, divided by the sum of the busiest hour's; what is left is idle.
    /// Away from home there is only coming home: its share of the hour, divided by its shares of this and all later
    /// hours, so that it happens in the end.
    pub(super) fn draw(&mut self, hour: usize, generator: &mut ChaCha8Rng) -> Option<&'a str> {
        let drawn = match self.whereabouts {
            Whereabouts::Home => {
                let mut left = generator.random_range(0.0..self.busiest);
                self.persona.at_home().map(|(activity, _)| activity).find(|activity| {
                    left -= self.share(activity, hour);
                    left < 0.0
                })
            }
            Whereabouts::Out => {
                let total: f64 = (hour..SLOTS).map(|later| self.share(COMING_HOME, later)).sum();
                let comes = total > 0.0 && generator.random_range(0.0..total) < self.share(COMING_HOME, hour);
                comes.then_some(COMING_HOME)
            }
        };
        match drawn {
            Some(LEAVING_HOME) => self.whereabouts = Whereabouts::Out,
            Some(COMING_HOME) => self.whereabouts = Whereabouts::Home,
            _ => {}
        }
        drawn
    }

    fn share(&self, activity: &str, hour: usize) -> f64 {
        let blocked = self.blocked_until.get(activity).is_some_and(|&until| hour < until);
        if blocked { 0.0 } else { self.persona.share(activity, hour) }
    }

    /// Takes a finished activity out of the hour in which it ended and of the next ones.
    fn block(&mut self, done: &Occurrence<'a>) {
        self.blocked_until.insert(done.activity, slot(done.until) + BLOCKED_HOURS);
    }
}

/// The place in the histogram of the hour of this second.
fn slot(second: Second) -> usize {
    (second.saturating_sub(FIRST_SECOND) / HOUR) as usize
}

/// Samples a day from six in the morning to midnight, by HOMER's own rules (`ScheduleDistributionSampler` and
/// `ScheduleFromHybridDuration` of GT-RAIL's `rail_tasksim`): one draw at a time. What is drawn takes a time drawn evenly
/// from the range of its script. Then is the next draw: the same activity again goes on, for no longer than the script
/// takes at most; another one, or none, ends it and blocks it for three hours. After a draw of nothing the next one is
/// ten minutes later. A day that ends away from home is no day.
///
/// `None` where no day of [`DAYS_TRIED`] ends at home.
pub(super) fn day<'a>(
    persona: &'a Persona,
    habits: &Habits<'a>,
    generator: &mut ChaCha8Rng,
) -> Option<Vec<Occurrence<'a>>> {
    (0..DAYS_TRIED).find_map(|_| {
        let mut sampler = DaySampler::new(persona);
        let occurrences = walk(&mut sampler, habits, generator);
        (sampler.whereabouts == Whereabouts::Home).then_some(occurrences)
    })
}

fn walk<'a>(
    sampler: &mut DaySampler<'a>,
    habits: &Habits<'a>,
    generator: &mut ChaCha8Rng,
) -> Vec<Occurrence<'a>> {
    let mut done: Vec<Occurrence<'a>> = Vec::new();
    let mut running: Option<Occurrence<'a>> = None;
    let mut time = FIRST_SECOND;
    while time < MIDNIGHT {
        let mut next = sampler.draw(slot(time), generator);
        if let Some(mut current) = running.take() {
            current.until = time;
            if next == Some(current.activity) {
                let longest = habits.get(current.activity).map_or(0, |script| script.longest());
                let minutes_left = (current.from + longest).saturating_sub(time) / 60;
                if minutes_left > 0 {
                    time += generator.random_range(0..=minutes_left) * 60;
                    running = Some(current);
                    continue;
                }
                next = None;
            }
            sampler.block(&current);
            done.push(current);
        }
        match next.and_then(|activity| Some((activity, habits.get(activity)?))) {
            Some((activity, script)) => {
                running = Some(Occurrence { activity, from: time, until: time });
                time += generator.random_range(script.shortest()..=script.longest());
            }
            None => time += IDLE,
        }
    }
    done.extend(running.map(|current| Occurrence { until: time, ..current }));
    done
}
