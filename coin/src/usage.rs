//! Sessions and usage statistics of one thing (the paper's usage summary, Section 4).
//!
//! A **session** is a run of events of one user with no gap over [`SESSION_GAP_SECONDS`] and no event of
//! another user in between. Sessions, not events, are the unit of evidence: the events of one session are one
//! decision to use the thing. An event without an actor belongs to nobody: it is counted, and it neither cuts
//! a session, nor prolongs one, nor bridges a gap.

use crate::captions::Action;
use crate::roster::{MAX_USERS, UserIndex};

/// Δt: a longer pause than this begins a new session, in seconds (20 minutes).
pub const SESSION_GAP_SECONDS: i64 = 1200;

/// The length of a day and of a tenth of it, in seconds.
const TENTH_OF_A_DAY: i128 = 8640;

/// One caption about one thing, as far as it counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UsageEvent {
    /// When, in civil seconds (see [`crate::captions::civil_seconds`]).
    pub at_seconds: i64,
    /// Who, where it is known.
    pub actor: Option<UserIndex>,
    /// What was done.
    pub action: Action,
}

/// What one user did with the thing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UserStatistics {
    /// The user.
    pub user: UserIndex,
    /// How many events are the user's.
    pub total_events: u64,
    /// How many sessions these events make.
    pub sessions: u64,
    /// How many events there are of each action, indexed by [`Action::code`].
    pub actions: [u64; 8],
    /// When the user's last event was, in civil seconds.
    pub last_at_seconds: i64,
    /// Indices of the user's latest events, oldest first.
    pub examples: Vec<usize>,
}

/// What everybody did with the thing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct UsageStatistics {
    /// The users who have events: most events first, then in the order of the roster.
    pub users: Vec<UserStatistics>,
    /// How many events have no actor.
    pub unattributed_events: u64,
}

/// Cuts a stream of events into sessions.
#[derive(Debug, Clone, Copy, Default)]
struct Sessions {
    current: Option<(UserIndex, i64)>,
}

impl Sessions {
    /// Takes the next attributed event; whether a session begins with it.
    fn begins_with(&mut self, user: UserIndex, at_seconds: i64) -> bool {
        let goes_on = self.current.is_some_and(|(current, last)| {
            current == user && at_seconds.saturating_sub(last) <= SESSION_GAP_SECONDS
        });
        self.current = Some((user, at_seconds));
        !goes_on
    }
}

/// Sums the events of one thing up. They stand in time order and are restricted to the window already; events
/// of the same second keep the order they are given in, which decides whether users alternate.
pub fn summarise(events: &[UsageEvent], max_examples: usize) -> UsageStatistics {
    let mut statistics = UsageStatistics::default();
    let mut place_of: [Option<usize>; MAX_USERS] = [None; MAX_USERS];
    let mut sessions = Sessions::default();
    for event in events {
        let Some(user) = event.actor else {
            statistics.unattributed_events += 1;
            continue;
        };
        let place = *place_of[user.place()].get_or_insert_with(|| {
            statistics.users.push(UserStatistics {
                user,
                total_events: 0,
                sessions: 0,
                actions: [0; 8],
                last_at_seconds: event.at_seconds,
                examples: Vec::new(),
            });
            statistics.users.len() - 1
        });
        let summary = &mut statistics.users[place];
        summary.total_events += 1;
        summary.sessions += u64::from(sessions.begins_with(user, event.at_seconds));
        summary.actions[usize::from(event.action.code())] += 1;
        summary.last_at_seconds = event.at_seconds;
    }
    collect_examples(&mut statistics, &place_of, events, max_examples);
    statistics.users.sort_by_key(|summary| (std::cmp::Reverse(summary.total_events), summary.user));
    statistics
}

/// Walks back from the latest event until everybody has their examples.
fn collect_examples(
    statistics: &mut UsageStatistics,
    place_of: &[Option<usize>; MAX_USERS],
    events: &[UsageEvent],
    max_examples: usize,
) {
    let mut wanted: u64 = statistics
        .users
        .iter()
        .map(|summary| summary.total_events.min(u64::try_from(max_examples).unwrap_or(u64::MAX)))
        .sum();
    for (index, event) in events.iter().enumerate().rev() {
        if wanted == 0 {
            break;
        }
        let Some(place) = event.actor.and_then(|user| place_of[user.place()]) else { continue };
        let examples = &mut statistics.users[place].examples;
        if examples.len() < max_examples {
            examples.push(index);
            wanted -= 1;
        }
    }
    for summary in &mut statistics.users {
        summary.examples.reverse();
    }
}

/// Days from an event to `as_of`, rounded to one decimal; a half is rounded away from zero.
pub fn days_since(last_seconds: i64, as_of_seconds: i64) -> f64 {
    let seconds = i128::from(as_of_seconds) - i128::from(last_seconds);
    let half = if seconds < 0 { -TENTH_OF_A_DAY / 2 } else { TENTH_OF_A_DAY / 2 };
    ((seconds + half) / TENTH_OF_A_DAY) as f64 / 10.0
}

/// Who began each session, in order of time. Events in time order.
pub fn session_order(events: &[UsageEvent]) -> Vec<UserIndex> {
    let mut sessions = Sessions::default();
    let attributed = events.iter().filter_map(|event| Some((event.actor?, event.at_seconds)));
    attributed
        .filter(|&(user, at_seconds)| sessions.begins_with(user, at_seconds))
        .map(|(user, _)| user)
        .collect()
}

/// c_u: the number of sessions of each of `members`, in the order of the roster. Events in time order; events
/// of users beyond `members` are counted for nobody.
pub fn session_counts(events: &[UsageEvent], members: usize) -> Vec<u64> {
    let mut counts = vec![0; members];
    for user in session_order(events) {
        if let Some(count) = counts.get_mut(user.place()) {
            *count += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests;
