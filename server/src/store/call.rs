//! A call as it is seen from outside: how far it has come, and that nobody waits for it any more.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rusqlite::{Connection, InterruptHandle};

use super::StoreError;

/// What is done with captions, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// They are read.
    Reading,
    /// They are stored.
    Storing,
}

/// How far a long piece of work has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// How many items are done.
    pub done: u64,
    /// Of how many.
    pub total: u64,
}

/// A call under way. It can be interrupted from another thread, and tells how far it has come.
#[derive(Clone, Default)]
pub struct Call {
    shared: Arc<Shared>,
}

type Listener = Box<dyn Fn(Progress) + Send + Sync>;

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    listener: Option<Listener>,
}

#[derive(Default)]
enum State {
    /// The call is not in the database.
    #[default]
    Outside,
    /// The call is in the database, on this connection.
    Inside(InterruptHandle),
    /// The call may not go on.
    Interrupted,
}

impl Progress {
    /// The share of the whole work that is done, 0…1. It never falls.
    pub fn share(&self) -> f64 {
        let before = match self.stage {
            Stage::Reading => 0.0,
            Stage::Storing => 0.5,
        };
        before + 0.5 * self.done as f64 / (self.total as f64).max(1.0)
    }
}

impl fmt::Display for Progress {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let done = match self.stage {
            Stage::Reading => "read",
            Stage::Storing => "stored",
        };
        write!(formatter, "{} of {} captions {done}", self.done, self.total)
    }
}

impl fmt::Debug for Call {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = match &*self.state() {
            State::Outside => "outside",
            State::Inside(_) => "inside",
            State::Interrupted => "interrupted",
        };
        formatter.debug_struct("Call").field("state", &state).finish_non_exhaustive()
    }
}

impl Call {
    /// A call whose progress somebody wants to know.
    pub fn with_listener(listener: impl Fn(Progress) + Send + Sync + 'static) -> Self {
        Self { shared: Arc::new(Shared { state: Mutex::default(), listener: Some(Box::new(listener)) }) }
    }

    /// Stops the call: the statement that runs is broken off, the work ends at the next step that asks, and what was not
    /// committed by then is not kept.
    pub fn interrupt(&self) {
        let mut state = self.state();
        if let State::Inside(handle) = &*state {
            handle.interrupt();
        }
        *state = State::Interrupted;
    }

    /// Notes how far the call has come.
    ///
    /// # Errors
    /// [`StoreError::Interrupted`] if it shall not go on.
    pub(crate) fn advance(&self, progress: Progress) -> Result<(), StoreError> {
        self.go_on()?;
        if let Some(listener) = &self.shared.listener {
            listener(progress);
        }
        Ok(())
    }

    /// Between two statements an interruption reaches nobody in SQLite, so that it is asked for here.
    pub(crate) fn go_on(&self) -> Result<(), StoreError> {
        match *self.state() {
            State::Interrupted => Err(StoreError::Interrupted),
            State::Outside | State::Inside(_) => Ok(()),
        }
    }

    /// Notes that the call uses this connection until the result is dropped.
    pub(super) fn enter(&self, connection: &Connection) -> Result<Visit<'_>, StoreError> {
        let mut state = self.state();
        match *state {
            State::Interrupted => Err(StoreError::Interrupted),
            State::Outside | State::Inside(_) => {
                *state = State::Inside(connection.get_interrupt_handle());
                Ok(Visit { call: self })
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The time that a call spends on a connection, which serves others afterwards. They must not be hit.
pub(super) struct Visit<'a> {
    call: &'a Call,
}

impl Drop for Visit<'_> {
    fn drop(&mut self) {
        let mut state = self.call.state();
        if matches!(*state, State::Inside(_)) {
            *state = State::Outside;
        }
    }
}
