//! Everything that is kept, and the only place that knows how: SQL stands nowhere else.
//!
//! The rest of the server sees [`Store`], and in it [`Reader`] and [`Writer`], whose methods speak of people,
//! things, events and beliefs. A tool call does its work in one closure, [`Store::read`] or [`Store::write`],
//! which is one transaction: it sees one state of the home, and either all of it is kept or nothing.
//!
//! A write is acknowledged after it was committed and synchronised to the disk (`synchronous = FULL`): what was
//! acknowledged survives the death of the process and a power cut. Several processes may use one file; a write
//! waits up to [`BUSY_SECONDS`] seconds for another's.

mod beliefs;
mod error;
mod household;
mod import;
mod inspection;
mod map;
mod migrations;
mod open;
#[cfg(test)]
mod tests;
mod usage;

use std::ops::Deref;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use rusqlite::{Connection, Transaction, TransactionBehavior};

pub use beliefs::{Belief, Inference, RecordedAnswer, Retraction};
pub use error::{BUSY_SECONDS, StoreError};
pub use household::{Household, UserKey};
pub use import::ImportSummary;
pub use inspection::Inspection;
pub use map::{ObjectKey, StoredObject};
pub use usage::{UsageCounts, UsageLog, UsageRecord};

/// What may be done with a store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Access {
    /// Reading and writing; the file is created where it is missing.
    #[default]
    ReadWrite,
    /// Reading only; the file must be there.
    ReadOnly,
}

/// A home's memory. It may be shared between threads; calls follow one another.
#[derive(Debug)]
pub struct Store {
    connection: Mutex<Connection>,
    access: Access,
}

impl Store {
    /// Opens a file, and creates it and its folder where they are missing and `access` allows it.
    ///
    /// # Errors
    /// [`StoreError::Open`], which names the file and the reason.
    pub fn open(path: &Path, access: Access) -> Result<Self, StoreError> {
        let connection = open::file(path, access).map_err(|source| source.opening(path))?;
        Ok(Self { connection: Mutex::new(connection), access })
    }

    /// Opens a store that is gone when it is dropped.
    ///
    /// # Errors
    /// If there is no memory left.
    pub fn open_in_memory() -> Result<Self, StoreError> {
        Ok(Self { connection: Mutex::new(open::memory()?), access: Access::ReadWrite })
    }

    /// What the store was opened for.
    pub fn access(&self) -> Access {
        self.access
    }

    /// Looks at one state of the home.
    ///
    /// # Errors
    /// What `work` returns, and failures of the database.
    pub fn read<T, E: From<StoreError>>(
        &self,
        work: impl FnOnce(&Reader<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        let transaction =
            connection.transaction_with_behavior(TransactionBehavior::Deferred).map_err(StoreError::from)?;
        let value = work(&Reader { transaction })?;
        Ok(value)
    }

    /// Changes the home, all or nothing: where `work` fails, nothing of it is kept.
    ///
    /// # Errors
    /// What `work` returns, and failures of the database.
    pub fn write<T, E: From<StoreError>>(
        &self,
        work: impl FnOnce(&Writer<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        if self.access == Access::ReadOnly {
            return Err(StoreError::OpenedReadOnly.into());
        }
        let mut connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        let transaction =
            connection.transaction_with_behavior(TransactionBehavior::Immediate).map_err(StoreError::from)?;
        let writer = Writer { reader: Reader { transaction } };
        let value = work(&writer)?;
        writer.reader.transaction.commit().map_err(StoreError::from)?;
        Ok(value)
    }
}

/// One state of the home, for looking at.
#[derive(Debug)]
pub struct Reader<'connection> {
    transaction: Transaction<'connection>,
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
