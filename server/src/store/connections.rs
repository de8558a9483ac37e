//! The connections to one database: one that writes, and some that read beside it.

use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use rusqlite::Connection;

use super::{Access, StoreError, open};

/// How many connections read at once. A read takes well under a millisecond of computing, so that more than there are
/// processors would only wait for one another. They are opened together with the one that writes: a file that takes the
/// place of another one later must not be read in its stead.
const READERS: usize = 4;

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

/// Connections that read.
#[derive(Debug)]
pub(super) struct Pool {
    idle: Mutex<Vec<Connection>>,
    returned: Condvar,
}

impl Connections {
    pub(super) fn to_file(path: &Path, access: Access) -> Result<Self, StoreError> {
        let first = open::file(path, access)?;
        let mut idle = Vec::with_capacity(READERS);
        let writer = match access {
            Access::ReadWrite => Some(Mutex::new(first)),
            Access::ReadOnly => {
                idle.push(first);
                None
            }
        };
        while idle.len() < READERS {
            idle.push(open::another(path, access)?);
        }
        Ok(Self::Several { writer, readers: Pool { idle: Mutex::new(idle), returned: Condvar::new() } })
    }

    pub(super) fn to_memory() -> Result<Self, StoreError> {
        Ok(Self::One(Mutex::new(open::memory()?)))
    }

    /// A connection for reading, as soon as there is one.
    pub(super) fn reader(&self) -> Lent<'_> {
        match self {
            Self::One(connection) => Lent::Only(locked(connection)),
            Self::Several { readers, .. } => readers.lend(),
        }
    }

    /// Whether somebody who reads now would not have to wait.
    pub(super) fn has_free_reader(&self) -> bool {
        match self {
            Self::One(connection) => connection.try_lock().is_ok(),
            Self::Several { readers, .. } => !locked(&readers.idle).is_empty(),
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
    fn lend(&self) -> Lent<'_> {
        let mut idle = locked(&self.idle);
        loop {
            match idle.pop() {
                Some(connection) => return Lent::Pooled { pool: self, connection: Some(connection) },
                None => idle = self.returned.wait(idle).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    fn take_back(&self, connection: Connection) {
        locked(&self.idle).push(connection);
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
