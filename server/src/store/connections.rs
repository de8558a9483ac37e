//! The connections to one database: one that writes, and some that read beside it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use rusqlite::Connection;

use super::{Access, StoreError, open};

/// How many connections read at once. A read takes well under a millisecond, so more would only cost memory.
const MOST_READERS: usize = 16;

/// The connections to one database.
///
/// Readers have connections of their own, because in SQLite's write-ahead log nobody who reads waits for somebody
/// who writes. A database in memory is seen by one connection only, which then does both.
#[derive(Debug)]
pub(super) enum Connections {
    /// A database in memory.
    One(Mutex<Connection>),
    /// A file.
    Several {
        /// The one that writes, where the file may be written to.
        writer: Option<Mutex<Connection>>,
        /// Those that read.
        readers: Pool,
    },
}

/// Connections that read, opened when they are first needed.
#[derive(Debug)]
pub(super) struct Pool {
    path: PathBuf,
    access: Access,
    state: Mutex<PoolState>,
    returned: Condvar,
}

#[derive(Default)]
struct PoolState {
    idle: Vec<Connection>,
    open: usize,
}

impl fmt::Debug for PoolState {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} of {} idle", self.idle.len(), self.open)
    }
}

impl Connections {
    pub(super) fn to_file(path: &Path, access: Access) -> Result<Self, StoreError> {
        let first = open::file(path, access)?;
        let mut readers = PoolState::default();
        let writer = match access {
            Access::ReadWrite => Some(Mutex::new(first)),
            Access::ReadOnly => {
                readers = PoolState { idle: vec![first], open: 1 };
                None
            }
        };
        let readers =
            Pool { path: path.to_owned(), access, state: Mutex::new(readers), returned: Condvar::new() };
        Ok(Self::Several { writer, readers })
    }

    pub(super) fn to_memory() -> Result<Self, StoreError> {
        Ok(Self::One(Mutex::new(open::memory()?)))
    }

    /// A connection for reading, as soon as there is one.
    pub(super) fn reader(&self) -> Result<Lent<'_>, StoreError> {
        match self {
            Self::One(connection) => Ok(Lent::Only(locked(connection))),
            Self::Several { readers, .. } => readers.lend(),
        }
    }

    /// The connection for writing, as soon as nobody of this process writes.
    pub(super) fn writer(&self) -> Result<MutexGuard<'_, Connection>, StoreError> {
        match self {
            Self::One(connection) | Self::Several { writer: Some(connection), .. } => Ok(locked(connection)),
            Self::Several { writer: None, .. } => Err(StoreError::OpenedReadOnly),
        }
    }
}

impl Pool {
    fn lend(&self) -> Result<Lent<'_>, StoreError> {
        let mut state = locked(&self.state);
        loop {
            if let Some(connection) = state.idle.pop() {
                return Ok(Lent::Pooled { pool: self, connection: Some(connection) });
            }
            if state.open < MOST_READERS {
                break;
            }
            state = self.returned.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.open += 1;
        drop(state);
        match open::another(&self.path, self.access) {
            Ok(connection) => Ok(Lent::Pooled { pool: self, connection: Some(connection) }),
            Err(source) => {
                locked(&self.state).open -= 1;
                self.returned.notify_one();
                Err(source)
            }
        }
    }

    fn take_back(&self, connection: Connection) {
        locked(&self.state).idle.push(connection);
        self.returned.notify_one();
    }
}

/// A connection that goes back where it came from when it is dropped.
pub(super) enum Lent<'a> {
    /// The only one that there is.
    Only(MutexGuard<'a, Connection>),
    /// One of several.
    Pooled {
        /// Where it belongs.
        pool: &'a Pool,
        /// It is there until it is given back.
        connection: Option<Connection>,
    },
}

impl Lent<'_> {
    /// The connection; `None` after it was given back, which is when this is dropped.
    pub(super) fn connection(&mut self) -> Option<&mut Connection> {
        match self {
            Self::Only(connection) => Some(connection),
            Self::Pooled { connection, .. } => connection.as_mut(),
        }
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        if let Self::Pooled { pool, connection } = self
            && let Some(connection) = connection.take()
        {
            pool.take_back(connection);
        }
    }
}

/// A panic of another thread leaves no half-written state behind: its transaction was rolled back.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
