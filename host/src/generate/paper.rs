//! The exact week of [`Protocol::Paper`](super::Protocol::Paper).
//!
//! The paper's tables fix, through the rows of its two heuristics, what its data look like: the owner sets and
//! usage types of [`belongings`](super::belongings), 3,425 captions, Frequency naming an owner of everything, and
//! Last-User naming an owner of everything but two of the eleven temporarily shared things with one owner.
//!
//! The week is drawn under these conditions by rejection. The number of sessions is redrawn until the home has
//! 780 to 920 of them; captions are then added to or taken from sessions drawn at random until there are 3,425.
//! Which two things end in a borrower's hands is drawn. The week of each thing is drawn again, from the same law
//! as every other home's, until its own conditions hold. The result is thus a draw from that law given the
//! conditions; no session is edited and no seed is chosen.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use coin_schemas::household::UsageType;

use super::belongings::Belonging;
use super::plan::DayPlan;
use super::sessions::{CAPTIONS_PER_SESSION, ThingHistory, live, session_lengths};

/// The captions of the paper's week.
pub(super) const CAPTIONS: usize = 3425;
/// The temporarily shared things of one owner that somebody else used last.
pub(super) const LAST_USED_BY_BORROWER: usize = 2;
const SESSIONS: std::ops::RangeInclusive<usize> = 780..=920;

/// Who the last user of a thing must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LastUser {
    Owner,
    Borrower,
}

/// Draws the histories of all things, given how a thing's number of sessions is drawn.
pub(super) fn histories(
    belongings: &[Belonging],
    plans: &[Vec<DayPlan>],
    session_count: impl Fn(&Belonging, &mut ChaCha8Rng) -> usize,
    generator: &mut ChaCha8Rng,
) -> Vec<ThingHistory> {
    let counts = loop {
        let counts: Vec<usize> =
            belongings.iter().map(|belonging| session_count(belonging, generator)).collect();
        if SESSIONS.contains(&counts.iter().sum()) {
            break counts;
        }
    };
    let mut lengths: Vec<Vec<usize>> =
        counts.into_iter().map(|count| session_lengths(count, generator)).collect();
    land_on_total(&mut lengths, generator);
    let borrowed_last = choose_borrowed_last(belongings, generator);
    belongings
        .iter()
        .zip(&lengths)
        .enumerate()
        .map(|(place, (belonging, lengths))| {
            let last_user = if borrowed_last.contains(&place) { LastUser::Borrower } else { LastUser::Owner };
            // Each condition has a probability well above nil, so this ends.
            loop {
                let history = live(belonging, lengths, plans, generator);
                if holds(belonging, &history, last_user, plans.len()) {
                    break history;
                }
            }
        })
        .collect()
}

/// Adds captions to sessions, or takes them away, until there are [`CAPTIONS`].
fn land_on_total(lengths: &mut [Vec<usize>], generator: &mut ChaCha8Rng) {
    let mut total: usize = lengths.iter().flatten().sum();
    while total != CAPTIONS {
        let thing = generator.random_range(0..lengths.len());
        let session = generator.random_range(0..lengths[thing].len());
        let length = &mut lengths[thing][session];
        let wanted = if total < CAPTIONS { *length + 1 } else { *length - 1 };
        if CAPTIONS_PER_SESSION.contains(&wanted) {
            total = total + wanted - *length;
            *length = wanted;
        }
    }
}

fn choose_borrowed_last(belongings: &[Belonging], generator: &mut ChaCha8Rng) -> Vec<usize> {
    let candidates: Vec<usize> = belongings
        .iter()
        .enumerate()
        .filter(|(_, belonging)| {
            belonging.usage_type == UsageType::TemporarySharing && belonging.owners.len() == 1
        })
        .map(|(place, _)| place)
        .collect();
    candidates.sample(generator, LAST_USED_BY_BORROWER).copied().collect()
}

/// Whether every session found its time, an owner has strictly more events than anybody else, and the last
/// user is as wanted. Two people never share a minute on one thing, so the last event has no tie.
fn holds(belonging: &Belonging, history: &ThingHistory, last_user: LastUser, people: usize) -> bool {
    let mut events = vec![0_usize; people];
    for session in &history.sessions {
        events[session.user] += session.steps.len();
    }
    let most = |of: &[usize]| of.iter().map(|&person| events[person]).max().unwrap_or(0);
    let last_is_owner =
        history.sessions.last().is_some_and(|session| belonging.owners.contains(&session.user));
    history.unplaced == 0
        && most(&belonging.owners) > most(&belonging.others)
        && last_is_owner == (last_user == LastUser::Owner)
}
