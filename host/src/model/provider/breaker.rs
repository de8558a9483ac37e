//! A circuit breaker over all calls of a model: a server that fails again and again is left alone for a while.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::time::Instant;

use super::failure::Failure;

/// Counts failed attempts in a row, and refuses further ones for a while when there are too many.
#[derive(Debug)]
pub(super) struct Breaker {
    most_failures: u32,
    pause: Duration,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    failures: u32,
    /// How the last attempt failed.
    last: String,
    /// Until when nothing is tried. After that, one attempt at a time is.
    open_until: Option<Instant>,
    trial: Trial,
    history: History,
}

#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
enum Trial {
    #[default]
    None,
    UnderWay,
}

/// Whether a server was ever there.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) enum History {
    /// No attempt has had an answer that did not speak of a fault of the server.
    #[default]
    NeverAnswered,
    /// At least one has.
    Answered,
}

/// The right to make one attempt. If it is dropped, nothing is learnt of the server.
#[derive(Debug)]
pub(super) struct Permit<'a> {
    breaker: &'a Breaker,
    is_trial: bool,
}

impl Breaker {
    /// A breaker that opens for `pause` after so many failures in a row.
    pub(super) fn new(most_failures: u32, pause: Duration) -> Self {
        Self { most_failures: most_failures.max(1), pause, state: Mutex::default() }
    }

    /// Asks whether an attempt may be made.
    pub(super) fn permit(&self) -> Result<Permit<'_>, Failure> {
        let mut state = self.state();
        let Some(open_until) = state.open_until else {
            return Ok(Permit { breaker: self, is_trial: false });
        };
        let wait = open_until.saturating_duration_since(Instant::now());
        if wait.is_zero() && state.trial == Trial::None {
            state.trial = Trial::UnderWay;
            return Ok(Permit { breaker: self, is_trial: true });
        }
        Err(Failure::NotTried { failures: state.failures, last: state.last.clone(), wait })
    }

    /// Whether the server was ever there.
    pub(super) fn history(&self) -> History {
        self.state().history
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Permit<'_> {
    /// Says how the attempt went.
    pub(super) fn settle(self, failure: Option<&Failure>) {
        let mut state = self.breaker.state();
        match failure {
            // Somebody is there who speaks, though perhaps not the provider's language.
            Some(Failure::Garbled { .. } | Failure::NotTried { .. }) => {}
            Some(Failure::Status(refusal)) if refusal.status < 500 => state.succeed(),
            Some(failure) => {
                state.failures = state.failures.saturating_add(1);
                state.last = failure.to_string();
                if state.failures >= self.breaker.most_failures {
                    state.open_until = Some(Instant::now() + self.breaker.pause);
                }
            }
            None => state.succeed(),
        }
    }
}

impl State {
    fn succeed(&mut self) {
        self.failures = 0;
        self.open_until = None;
        self.history = History::Answered;
    }
}

impl Drop for Permit<'_> {
    fn drop(&mut self) {
        if self.is_trial {
            self.breaker.state().trial = Trial::None;
        }
    }
}
