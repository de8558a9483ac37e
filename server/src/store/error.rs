//! What can go wrong with the database, in words for the person who has to mend it.

use std::path::PathBuf;

use coin::captions::CaptionError;
use coin::roster::RosterError;
use coin_schemas::household::InvalidValue;
use rusqlite::ErrorCode;
use thiserror::Error;

/// How long a write waits for other processes, in seconds.
pub const BUSY_SECONDS: u64 = 5;

/// Why the store could not do what it was asked to.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file could not be opened; `source` says why.
    #[error("cannot open the database {}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<StoreError>,
    },
    /// The folder of the file could not be made.
    #[error("its folder cannot be created: {source}")]
    NoFolder {
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The path names a folder.
    #[error("it is a folder; name a file in it")]
    Folder,
    /// The file could not be created or read.
    #[error("{source}")]
    File {
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file is to be read only, and it is not there.
    #[error("there is no such file, and read-only access creates none; import an episode into it first")]
    Missing,
    /// The file is no SQLite database.
    #[error("it is not a SQLite database; name another file with --db")]
    NotADatabase,
    /// The file is a SQLite database of another program.
    #[error(
        "it is a SQLite database of another program (application id {application:#010x}); name another file with --db"
    )]
    Foreign {
        /// The mark of the other program; 0 where it set none.
        application: i32,
    },
    /// A newer program wrote the file.
    #[error(
        "it has version {found} and this program knows versions up to {known}; install a newer coin-server"
    )]
    TooNew {
        /// The version of the file.
        found: usize,
        /// The newest version that this program knows.
        known: usize,
    },
    /// An older program wrote the file, which may not be written to.
    #[error(
        "it has version {found} and must be brought to version {known}; open it once without --read-only"
    )]
    TooOld {
        /// The version of the file.
        found: usize,
        /// The version that this program needs.
        known: usize,
    },
    /// A step of the schema's history failed.
    #[error("its schema cannot be brought up to date: {source}")]
    Migration {
        /// What failed.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The file or its folder may not be written to.
    #[error("the database cannot be written to: the file, its folder or the whole disk is read-only")]
    ReadOnly,
    /// The store was opened for reading only.
    #[error("the database was opened read-only; start coin-server without --read-only to record anything")]
    OpenedReadOnly,
    /// There is no room left.
    #[error("the disk is full: nothing of this call was stored, all that was acknowledged before is kept")]
    Full,
    /// The operating system did not read or write what it was asked to.
    #[error(
        "the disk is full or broken ({detail}): nothing of this call was stored, all that was acknowledged before is kept"
    )]
    Disk {
        /// What SQLite says.
        detail: String,
    },
    /// The file, or the log that belongs beside it, cannot be opened.
    #[error(
        "it cannot be opened ({detail}); the file must be readable, and its folder writable for the -wal and -shm files beside it"
    )]
    Unopenable {
        /// What SQLite says.
        detail: String,
    },
    /// Other processes kept the write lock.
    #[error("the database is locked by another process for over {BUSY_SECONDS} seconds; try again")]
    Locked,
    /// Nobody waits for the call any more.
    #[error("the call was cancelled: nothing of it was stored")]
    Interrupted,
    /// The file is damaged, or holds what this program never writes.
    #[error("the database is damaged ({detail}); restore it from a copy")]
    Damaged {
        /// What was found.
        detail: String,
    },
    /// SQLite failed otherwise.
    #[error("the database failed: {source}")]
    Failed {
        /// What SQLite says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A line is no caption.
    #[error(transparent)]
    Caption(#[from] CaptionError),
    /// There is nobody whose things the home's things could be.
    #[error("nobody lives in this home yet; add its members with add_user, or import an episode")]
    NobodyLivesHere,
    /// The people do not make a household.
    #[error(transparent)]
    Roster(#[from] RosterError),
    /// The home holds something else than the episode that is to be imported.
    #[error(
        "the database already holds another home ({difference}); import the episode into a new file, named with --db"
    )]
    OtherHome {
        /// The first difference that was found.
        difference: String,
    },
    /// There is no such thing.
    #[error("there is no object {id:?} in this home")]
    UnknownObject {
        /// The id that was given.
        id: String,
    },
}

impl StoreError {
    /// Says which file the error is about.
    pub(super) fn opening(self, path: &std::path::Path) -> Self {
        Self::Open { path: path.to_owned(), source: Box::new(self) }
    }

    /// What stands in the file is nothing that this program writes.
    pub(crate) fn damaged(detail: impl Into<String>) -> Self {
        Self::Damaged { detail: detail.into() }
    }
}

/// SQLITE_IOERR_SHMSIZE: the index of the write-ahead log could not be made larger, for want of room.
const SHARED_MEMORY_SIZE: i32 = 4874;

fn extended_code(source: &rusqlite::Error) -> Option<i32> {
    source.sqlite_error().map(|error| error.extended_code)
}

/// SQLite says "disk I/O error" of thirty different things; its extended code tells which.
fn with_code(source: &rusqlite::Error) -> String {
    match extended_code(source) {
        Some(code) => format!("{source}, SQLite code {code}"),
        None => source.to_string(),
    }
}

impl From<rusqlite::Error> for StoreError {
    fn from(source: rusqlite::Error) -> Self {
        match source.sqlite_error_code() {
            Some(ErrorCode::NotADatabase) => Self::NotADatabase,
            Some(ErrorCode::ReadOnly | ErrorCode::PermissionDenied) => Self::ReadOnly,
            Some(ErrorCode::SystemIoFailure) if extended_code(&source) == Some(SHARED_MEMORY_SIZE) => {
                Self::Full
            }
            Some(ErrorCode::DiskFull) => Self::Full,
            Some(ErrorCode::SystemIoFailure) => Self::Disk { detail: with_code(&source) },
            Some(ErrorCode::CannotOpen) => Self::Unopenable { detail: with_code(&source) },
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => Self::Locked,
            Some(ErrorCode::OperationInterrupted) => Self::Interrupted,
            Some(ErrorCode::DatabaseCorrupt) => Self::Damaged { detail: source.to_string() },
            _ => Self::Failed { source: Box::new(source) },
        }
    }
}

impl From<InvalidValue> for StoreError {
    fn from(source: InvalidValue) -> Self {
        Self::damaged(source.to_string())
    }
}

impl From<serde_json::Error> for StoreError {
    fn from(source: serde_json::Error) -> Self {
        Self::damaged(source.to_string())
    }
}
