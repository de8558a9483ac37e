//! Everything that is kept, and the only place that knows how: SQL stands nowhere else.
//!
//! The rest of the server sees [`Store`], and in it [`Reader`] and [`Writer`], whose methods speak of people,
//! things, events and beliefs. A tool call does its work in one closure, [`Store::read`] or [`Store::write`],
//! which is one transaction: it sees one state of the home, and either all of it is kept or nothing.
//!
//! A write is acknowledged after it was committed and synchronised to the disk (`synchronous = FULL`): what was
//! acknowledged survives the death of the process and a power cut. Several processes may use one file; a write
//! waits up to [`BUSY_SECONDS`] seconds for another's.

mod answers;
mod beliefs;
mod call;
mod connections;
mod error;
mod forms;
mod household;
mod import;
mod indexing;
mod inspection;
mod lists;
mod looks;
mod map;
mod merging;
mod migrations;
mod newcomers;
mod observing;
mod open;
mod places;
mod semantic_map;
mod sightings;
#[cfg(test)]
mod tests;
mod usage;

use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

use rusqlite::{Connection, TransactionBehavior};

pub use answers::{OpenQuestions, RecordedAnswer, Refusal, Retraction};
pub use beliefs::{Belief, Inference};
pub use call::{Call, Progress, Stage};
pub use error::{BUSY_SECONDS, StoreError};
pub use forms::{FORM_KEY_BYTES, FormSerial, SERIAL_BYTES, Spending};
pub use household::{Household, UserKey};
pub use import::ImportSummary;
pub use indexing::LookIndexing;
pub use inspection::Inspection;
pub(crate) use looks::Alike;
pub use map::{ObjectKey, StoredObject};
pub use observing::{MovedObject, Observations, Observed, PerhapsMovedObject, SplitFailure, ViewInRooms};
pub use sightings::{ChangeKind, FormerPlace, ObjectChange};
pub(crate) use usage::EVENTS_BETWEEN_REPORTS;
pub use usage::{UsageCounts, UsageLog, UsageRecord};

use connections::Connections;
use looks::KeptLooks;
use semantic_map::KeptMap;

/// What may be done with a store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Access {
    /// Reading and writing; the file is created where it is missing.
    #[default]
    ReadWrite,
    /// Reading only; the file must be there.
    ReadOnly,
}

/// A home's memory. It may be shared between threads, and a copy speaks of the same home: reads go on beside one
/// another and beside a write, writes follow one another.
#[derive(Debug, Clone)]
pub struct Store {
    connections: Arc<Connections>,
    looks: Arc<KeptLooks>,
    map: Arc<KeptMap>,
    access: Access,
    call: Call,
}

impl Store {
    /// Opens a file, and creates it and its folder where they are missing and `access` allows it.
    ///
    /// # Errors
    /// [`StoreError::Open`], which names the file and the reason.
    pub fn open(path: &Path, access: Access) -> Result<Self, StoreError> {
        let connections = Connections::to_file(path, access).map_err(|source| source.opening(path))?;
        Ok(Self::on(connections, access))
    }

    /// Opens a store that is gone when it is dropped.
    ///
    /// # Errors
    /// If there is no memory left.
    pub fn open_in_memory() -> Result<Self, StoreError> {
        Ok(Self::on(Connections::to_memory()?, Access::ReadWrite))
    }

    fn on(connections: Connections, access: Access) -> Self {
        Self {
            connections: Arc::new(connections),
            looks: Arc::default(),
            map: Arc::default(),
            access,
            call: Call::default(),
        }
    }

    /// What the store was opened for.
    pub fn access(&self) -> Access {
        self.access
    }

    /// The same home, for one call that may be interrupted and whose progress may be followed.
    #[must_use]
    pub fn during(&self, call: &Call) -> Self {
        Self { call: call.clone(), ..self.clone() }
    }

    /// The call that the store is used for.
    pub(crate) fn call(&self) -> &Call {
        &self.call
    }

    /// Whether somebody who looks at the home now would not have to wait for others who do.
    pub(crate) fn is_free_to_read(&self) -> bool {
        self.connections.has_free_reader()
    }

    /// Looks at one state of the home.
    ///
    /// # Errors
    /// What `work` returns, and failures of the database.
    pub fn read<T, E: From<StoreError>>(
        &self,
        work: impl FnOnce(&Reader<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut lent = self.connections.reader();
        let connection = lent.connection().ok_or(StoreError::Interrupted)?;
        // The visit ends before the transaction does: an interruption must not hit its end.
        let moment = Moment::begin(connection)?;
        let _visit = self.call.enter(connection)?;
        work(&self.reader(moment.connection, Sight::Committed))
    }

    fn reader<'a>(&'a self, connection: &'a Connection, sight: Sight) -> Reader<'a> {
        Reader { connection, call: &self.call, looks: &self.looks, sight }
    }

    /// Changes the home, all or nothing: where `work` fails, nothing of it is kept.
    ///
    /// # Errors
    /// What `work` returns, and failures of the database.
    pub fn write<T, E: From<StoreError>>(
        &self,
        work: impl FnOnce(&Writer<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        let (value, revision) = self.change(|writer| {
            let value = work(writer)?;
            Ok::<_, E>((value, writer.feature_revision()?))
        })?;
        self.look_after_index(revision);
        Ok(value)
    }

    fn change<T, E: From<StoreError>>(&self, work: impl FnOnce(&Writer<'_>) -> Result<T, E>) -> Result<T, E> {
        let mut connection = self.connections.writer()?;
        self.call.go_on()?;
        let transaction =
            connection.transaction_with_behavior(TransactionBehavior::Immediate).map_err(StoreError::from)?;
        let value = {
            // An interruption reaches the work, but neither the commit nor the end of what is given up.
            let _visit = self.call.enter(&transaction)?;
            work(&Writer { reader: self.reader(&transaction, Sight::Uncommitted) })?
        };
        self.call.go_on()?;
        transaction.commit().map_err(StoreError::from)?;
        Ok(value)
    }
}

/// One state of the home, for looking at.
#[derive(Debug)]
pub struct Reader<'connection> {
    connection: &'connection Connection,
    call: &'connection Call,
    looks: &'connection KeptLooks,
    sight: Sight,
}

/// What a transaction sees of the home.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sight {
    /// What was committed, and nothing else.
    Committed,
    /// Also what it has written itself, which may not be kept.
    Uncommitted,
}

impl Reader<'_> {
    /// Whether the call may go on, for work that computes for long between two statements.
    ///
    /// # Errors
    /// [`StoreError::Interrupted`] if nobody waits for it any more.
    pub(crate) fn go_on(&self) -> Result<(), StoreError> {
        self.call.go_on()
    }
}

/// One state of the home, for as long as this is held. Its two statements stay prepared, which those of rusqlite's own
/// transactions do not.
struct Moment<'connection> {
    connection: &'connection Connection,
}

impl<'connection> Moment<'connection> {
    fn begin(connection: &'connection Connection) -> Result<Self, StoreError> {
        connection.prepare_cached("BEGIN DEFERRED")?.execute([])?;
        Ok(Self { connection })
    }
}

impl Drop for Moment<'_> {
    fn drop(&mut self) {
        // What the disk failed at was rolled back already.
        if self.connection.is_autocommit() {
            return;
        }
        let ended = self.connection.prepare_cached("ROLLBACK").and_then(|mut end| end.execute([]));
        if let Err(source) = ended {
            tracing::warn!("a look at the database could not be ended: {source}");
        }
    }
}

/// One change of the home. It can be read like a [`Reader`], and shows what it has written itself.
#[derive(Debug)]
pub struct Writer<'connection> {
    reader: Reader<'connection>,
}

impl<'connection> Deref for Writer<'connection> {
    type Target = Reader<'connection>;

    fn deref(&self) -> &Self::Target {
        &self.reader
    }
}
