//! Opening the database file.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use rusqlite::{Connection, OpenFlags, TransactionBehavior};

use super::Access;
use super::error::{BUSY_SECONDS, StoreError};
use super::migrations::{self, Identity};

/// Statements that stay prepared. The store has some thirty.
const PREPARED_STATEMENTS: usize = 64;

/// How long a process waits between two looks at a lock that another one holds. A commit takes about as long.
const LOCK_PAUSE: Duration = Duration::from_millis(2);

/// How often opening is tried where the disk fails. A busy disk was seen to fail once and to work a moment later.
const OPENING_TRIES: usize = 3;

/// How long to wait before the journal mode is tried again.
const RETRY_PAUSE: Duration = Duration::from_millis(20);

pub(super) fn memory() -> Result<Connection, StoreError> {
    let mut connection = Connection::open_in_memory()?;
    prepare(&mut connection)?;
    migrations::migrate(&mut connection)?;
    Ok(connection)
}

pub(super) fn file(path: &Path, access: Access) -> Result<Connection, StoreError> {
    if path.is_dir() {
        return Err(StoreError::Folder);
    }
    let mut tries = 1;
    loop {
        let opened = match access {
            Access::ReadWrite => read_write(path),
            Access::ReadOnly => read_only(path),
        };
        match opened {
            Err(StoreError::Disk { .. }) if tries < OPENING_TRIES => tries += 1,
            outcome => return outcome,
        }
        thread::sleep(RETRY_PAUSE);
    }
}

fn read_write(path: &Path) -> Result<Connection, StoreError> {
    open_or_create(path)?;
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut connection = Connection::open_with_flags(path, flags)?;
    prepare(&mut connection)?;
    if let Identity::Ours { version } = migrations::identify(&connection)? {
        migrations::refuse_newer(version)?;
    }
    use_write_ahead_log(&connection)?;
    migrations::migrate(&mut connection)?;
    Ok(connection)
}

/// One more connection to a file that is open already, for reading.
pub(super) fn another(path: &Path, access: Access) -> Result<Connection, StoreError> {
    if access == Access::ReadOnly {
        return file(path, access);
    }
    // It may write as far as SQLite is concerned, because readers of a write-ahead log have to lock it.
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut connection = Connection::open_with_flags(path, flags)?;
    prepare(&mut connection)?;
    connection.execute_batch("PRAGMA query_only = ON; PRAGMA cache_size = -4000;")?;
    Ok(connection)
}

fn read_only(path: &Path) -> Result<Connection, StoreError> {
    if !path.try_exists().map_err(|source| StoreError::File { source })? {
        return Err(StoreError::Missing);
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    match look(Connection::open_with_flags(path, flags)?) {
        // Where nobody can write, SQLite cannot make the files that it coordinates with others by, and nobody is
        // there to coordinate with.
        Err(StoreError::Unopenable { .. } | StoreError::ReadOnly) if !has_log(path) => {
            look(Connection::open_with_flags(immutable(path), flags | OpenFlags::SQLITE_OPEN_URI)?)
        }
        outcome => outcome,
    }
}

/// Makes a connection ready for reading, if the file is a home of the present version.
pub(super) fn look(mut connection: Connection) -> Result<Connection, StoreError> {
    prepare(&mut connection)?;
    let version = match migrations::identify(&connection)? {
        Identity::Ours { version } => version,
        Identity::Empty => 0,
    };
    migrations::refuse_newer(version)?;
    if version < migrations::VERSION {
        return Err(StoreError::TooOld { found: version, known: migrations::VERSION });
    }
    Ok(connection)
}

/// Whether changes may wait beside the file that are not in it yet.
fn has_log(path: &Path) -> bool {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    fs::metadata(log).is_ok_and(|log| log.len() > 0)
}

/// The URI of a file that nobody changes.
pub(super) fn immutable(path: &Path) -> String {
    let mut uri = "file:".to_owned();
    for byte in path.as_os_str().as_encoded_bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' => {
                uri.push(char::from(*byte));
            }
            other => uri.push_str(&format!("%{other:02X}")),
        }
    }
    uri + "?immutable=1"
}

/// Makes sure that the file can be written to. A missing one is created, with its folder, so that only its owner
/// can read it: it will hold what a family does all day.
fn open_or_create(path: &Path) -> Result<(), StoreError> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|source| StoreError::NoFolder { source })?;
    }
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(false);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path).map(drop).map_err(|source| match source.kind() {
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => StoreError::ReadOnly,
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => StoreError::Full,
        _ => StoreError::File { source },
    })
}

/// Waits a moment for another process, up to [`BUSY_SECONDS`] in all. SQLite's own waiting looks ten times a second at
/// last, and beside a server that writes without a pause it was seen to miss every gap for five seconds.
fn wait_for_the_lock(tries: i32) -> bool {
    let may_wait = LOCK_PAUSE * tries.unsigned_abs() < Duration::from_secs(BUSY_SECONDS);
    if may_wait {
        thread::sleep(LOCK_PAUSE);
    }
    may_wait
}

fn prepare(connection: &mut Connection) -> Result<(), StoreError> {
    connection.busy_handler(Some(wait_for_the_lock))?;
    connection.set_prepared_statement_cache_capacity(PREPARED_STATEMENTS);
    connection.set_transaction_behavior(TransactionBehavior::Immediate);
    connection.execute_batch(
        "PRAGMA foreign_keys = ON;
         PRAGMA synchronous = FULL;
         PRAGMA trusted_schema = OFF;
         PRAGMA cache_size = -16000;
         PRAGMA journal_size_limit = 67108864;",
    )?;
    Ok(())
}

/// Lets readers and a writer of several processes work at once. The mode stays in the file, and it is not
/// written again where it is set. SQLite gives up at once, without waiting, where two processes create the same
/// file together; so the waiting is done here.
fn use_write_ahead_log(connection: &Connection) -> Result<(), StoreError> {
    let mode: String = connection.query_row("PRAGMA journal_mode", [], |row| row.get(0))?;
    if mode.eq_ignore_ascii_case("wal") {
        return Ok(());
    }
    let deadline = Instant::now() + Duration::from_secs(BUSY_SECONDS);
    loop {
        match connection.query_row("PRAGMA journal_mode = WAL", [], |_| Ok(())).map_err(StoreError::from) {
            Err(StoreError::Locked) if Instant::now() < deadline => thread::sleep(RETRY_PAUSE),
            outcome => return outcome,
        }
    }
}
