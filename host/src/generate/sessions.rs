//! Sessions: who uses a thing when, and what they do with it, minute by minute.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::belongings::Belonging;
use super::catalogue::{Handling, Thing};
use super::plan::{DayPlan, LAST_MINUTE, Minute, Occurrence, Stretch};

/// Two sessions of one person on one thing are further apart than the 20 minutes that cut sessions.
const SAME_USER_APART: Minute = 21;
/// Sessions of different people do not touch.
const OTHER_USER_APART: Minute = 2;
/// The fewest and the most captions of a session.
pub(super) const CAPTIONS_PER_SESSION: std::ops::RangeInclusive<usize> = 1..=6;

/// One thing that is done in a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    /// Looks for it.
    Search,
    /// Takes it.
    Take,
    /// Uses it, in the way of that number among the ways that suit the class.
    Use(usize),
    /// Carries it elsewhere.
    Move,
    /// Cleans it.
    Clean,
    /// Puts it back, away or down.
    Place(Putting),
}

/// How a thing is put where it belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Putting {
    Back,
    Away,
    Down,
}

/// An action at a minute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    pub(super) minute: Minute,
    pub(super) action: Action,
}

/// One use of a thing by one person.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Session {
    pub(super) user: usize,
    pub(super) day: usize,
    /// In order of time.
    pub(super) steps: Vec<Step>,
}

impl Session {
    fn stretch(&self) -> Option<Stretch> {
        Some(Stretch { from: self.steps.first()?.minute, until: self.steps.last()?.minute })
    }
}

/// What happened to one thing, in order of time.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct ThingHistory {
    pub(super) sessions: Vec<Session>,
    /// Sessions for which nobody found the time.
    pub(super) unplaced: usize,
}

/// Draws how many sessions a thing gets: the catalogue's figure, as busy as the home is, times a spread of its
/// own from about a quarter to twice, for so many days.
pub(super) fn session_count(
    thing: &Thing,
    busyness: f64,
    days: usize,
    limits: &std::ops::RangeInclusive<usize>,
    generator: &mut ChaCha8Rng,
) -> usize {
    let spread = generator.random_range(0.5..1.45) * generator.random_range(0.5..1.45);
    let expected = thing.weekly * busyness * spread * days as f64 / 7.0;
    (expected.round() as usize).clamp(*limits.start(), *limits.end())
}

/// Draws the number of captions of each session. Things differ: some are used in one move, some at length.
pub(super) fn session_lengths(count: usize, generator: &mut ChaCha8Rng) -> Vec<usize> {
    let usual: f64 = generator.random_range(2.0..5.2);
    (0..count)
        .map(|_| {
            let drawn = usual + generator.random_range(-1.5..1.5) + generator.random_range(-1.0..1.0);
            (drawn.round().max(0.0) as usize)
                .clamp(*CAPTIONS_PER_SESSION.start(), *CAPTIONS_PER_SESSION.end())
        })
        .collect()
}

/// Lives through the days with one thing: for each session, in order of days, Appendix D's law says who, that
/// person's plan says when.
pub(super) fn live(
    belonging: &Belonging,
    lengths: &[usize],
    plans: &[Vec<DayPlan>],
    generator: &mut ChaCha8Rng,
) -> ThingHistory {
    let days = plans.first().map_or(0, Vec::len);
    let mut history = ThingHistory::default();
    if days == 0 {
        return history;
    }
    let mut wanted: Vec<usize> = lengths.iter().map(|_| generator.random_range(0..days)).collect();
    wanted.sort_unstable();
    let mut counts = vec![0_usize; plans.len()];
    for (&length, day) in lengths.iter().zip(wanted) {
        let placed = belonging.next_user(day, &counts, generator).and_then(|user| {
            let session = find_time(belonging.thing, user, day, length, plans, &history.sessions, generator)
                // A session that found no time on its day may have moved to one on which the thing was another's.
                .filter(|session| belonging.same_hands(day, session.day))?;
            counts[user] += 1;
            Some(session)
        });
        match placed {
            Some(session) => history.sessions.push(session),
            None => history.unplaced += 1,
        }
    }
    history.sessions.sort_by_key(|session| (session.day, session.steps.first().map(|step| step.minute)));
    history
}

/// Finds a time at which the person would use the thing: while doing what it is for on the wanted day, then at
/// any time of being there, then on another day.
fn find_time(
    thing: &Thing,
    user: usize,
    wanted_day: usize,
    length: usize,
    plans: &[Vec<DayPlan>],
    taken: &[Session],
    generator: &mut ChaCha8Rng,
) -> Option<Session> {
    const ATTEMPTS: usize = 200;
    const ON_THE_DAY: usize = 12;
    const IN_CHARACTER: f64 = 0.85;
    let days = plans[user].len();
    for attempt in 0..ATTEMPTS {
        let day = if attempt < ON_THE_DAY { wanted_day } else { generator.random_range(0..days) };
        let plan = &plans[user][day];
        let fitting: Vec<&Occurrence> = plan
            .occurrences
            .iter()
            .filter(|occurrence| thing.activities.contains(&occurrence.activity))
            .collect();
        let during = match fitting.choose(generator) {
            Some(occurrence) if generator.random_bool(IN_CHARACTER) => occurrence.during,
            _ => match plan.present.choose(generator) {
                Some(&stretch) => stretch,
                None => continue,
            },
        };
        let start = generator.random_range(during.from..=during.until);
        let session = Session { user, day, steps: script(thing, length, start, generator) };
        if fits(&session, taken) {
            return Some(session);
        }
    }
    None
}

/// Whether a session ends in time and keeps its distance from the others.
fn fits(session: &Session, taken: &[Session]) -> bool {
    let Some(new) = session.stretch() else { return false };
    new.until <= LAST_MINUTE
        && taken.iter().filter(|other| other.day == session.day).all(|other| {
            let apart = if other.user == session.user { SAME_USER_APART } else { OTHER_USER_APART };
            other.stretch().is_none_or(|old| old.until + apart <= new.from || new.until + apart <= old.from)
        })
}

/// Writes what is done in a session of so many captions, from the minute on. An action that comes again comes
/// at least a minute later, so that no line is there twice.
fn script(thing: &Thing, length: usize, start: Minute, generator: &mut ChaCha8Rng) -> Vec<Step> {
    let actions = match thing.handling {
        Handling::Carried => carried_script(thing, length, generator),
        Handling::Fixed => fixed_script(thing, length),
    };
    let mut minute = start;
    let mut steps: Vec<Step> = Vec::with_capacity(actions.len());
    for action in actions {
        if !steps.is_empty() {
            minute += generator.random_range(0..=2);
        }
        if steps.contains(&Step { minute, action }) {
            minute += 1;
        }
        steps.push(Step { minute, action });
    }
    steps
}

fn carried_script(thing: &Thing, length: usize, generator: &mut ChaCha8Rng) -> Vec<Action> {
    use Action::{Clean, Move, Place, Search, Take, Use};
    let put = match generator.random_range(0..10) {
        0..=4 => Place(Putting::Back),
        5..=7 => Place(Putting::Away),
        _ => Place(Putting::Down),
    };
    let tend = if thing.cleaning.is_some() && generator.random_bool(0.5) { Clean } else { Move };
    let variant = generator.random_range(0..3);
    match (length, variant) {
        (0, _) => vec![],
        (1, 0) => vec![Take],
        (1, _) => vec![Use(0)],
        (2, 0) => vec![Search, Take],
        (2, 1) => vec![Take, put],
        (2, _) => vec![Use(0), Use(1)],
        (3, 0) => vec![Search, Take, put],
        (3, 1) => vec![Take, Use(0), put],
        (3, _) => vec![Use(0), Use(1), put],
        (4, 0) => vec![Search, Take, Use(0), put],
        (4, 1) => vec![Take, Use(0), Use(1), put],
        (4, _) => vec![Take, Use(0), tend, put],
        (5, 0) => vec![Search, Take, Use(0), Use(1), put],
        (5, 1) => vec![Search, Take, Use(0), tend, put],
        (5, _) => vec![Take, Use(0), tend, Use(1), put],
        (_, 0) => vec![Search, Take, Use(0), Use(1), tend, put],
        (_, 1) => vec![Search, Take, Move, Use(0), Use(1), put],
        (_, _) => vec![Take, Use(0), Use(1), Use(2), tend, put],
    }
}

/// A thing that stays in its place: the first way of use begins, the last one ends, the others are between.
fn fixed_script(thing: &Thing, length: usize) -> Vec<Action> {
    let (begin, end) = (Action::Use(0), Action::Use(thing.uses.len().saturating_sub(1)));
    match length {
        0 => vec![],
        1 => vec![Action::Use(1)],
        2 => vec![begin, end],
        _ => {
            let between = (0..length - 2).map(|place| match place {
                0 => Action::Use(1),
                3 if thing.cleaning.is_some() => Action::Clean,
                // Past the ways that suit the class come the general ones.
                more => Action::Use(thing.uses.len() - 1 + more),
            });
            std::iter::once(begin).chain(between).chain(std::iter::once(end)).collect()
        }
    }
}
