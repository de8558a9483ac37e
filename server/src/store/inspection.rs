//! Looking at a database without leaving a trace.

use std::path::Path;

use rusqlite::{Connection, OpenFlags};

use super::open;
use super::{Access, StoreError};

/// What a database holds, and whether it is whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inspection {
    /// The number of migrations that it has seen.
    pub version: u32,
    /// What SQLite's quick check found wrong with it.
    pub damage: Vec<String>,
    /// Who lives there.
    pub people: Vec<String>,
    /// How many things there are.
    pub things: u64,
    /// How many events were seen.
    pub events: u64,
    /// How many answers were given, those included that were taken back.
    pub answers: u64,
}

impl Inspection {
    /// Looks at a database file.
    ///
    /// # Errors
    /// [`StoreError::Open`] if it is missing, of another program, or of another version; other errors if SQLite
    /// cannot read it.
    pub fn of(path: &Path) -> Result<Self, StoreError> {
        let connection = untouched(path).map_err(|source| source.opening(path))?;
        let count = |sql: &str| connection.query_row(sql, [], |row| row.get(0)).map(i64::unsigned_abs);
        let texts = |sql: &str| -> rusqlite::Result<Vec<String>> {
            connection.prepare(sql)?.query_map([], |row| row.get(0))?.collect()
        };
        let damage = texts("PRAGMA quick_check")?.into_iter().filter(|line| line != "ok").collect();
        Ok(Self {
            version: connection.query_row("PRAGMA user_version", [], |row| row.get(0))?,
            damage,
            people: texts("SELECT name FROM users ORDER BY user_key")?,
            things: count("SELECT count(*) FROM objects")?,
            events: count("SELECT count(*) FROM usage_events")?,
            answers: count("SELECT count(*) FROM answers")?,
        })
    }
}

/// Opens a file so that nothing is made beside it. Where a log lies there, another process has it open and the files
/// exist already; where none does, nobody is writing, and the file can be read as one that does not change.
fn untouched(path: &Path) -> Result<Connection, StoreError> {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    if !path.is_file() || Path::new(&log).exists() {
        return open::file(path, Access::ReadOnly);
    }
    let flags =
        OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX | OpenFlags::SQLITE_OPEN_URI;
    open::look(Connection::open_with_flags(open::immutable(path), flags)?)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::store::Store;
    use crate::test_home;

    #[test]
    fn a_home_is_counted_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("home #1?.db");
        Store::open(&path, Access::ReadWrite).unwrap().import(&test_home::episode()).unwrap();
        let before = fs::read(&path).unwrap();
        let inspection = Inspection::of(&path).unwrap();
        assert_eq!((inspection.people.len(), inspection.things, inspection.answers), (3, 5, 0));
        assert!(inspection.events > 0, "{inspection:?}");
        assert_eq!(inspection.damage, Vec::<String>::new());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the database lies there");
        assert_eq!(fs::read(&path).unwrap(), before);
    }

    #[test]
    fn what_another_process_has_not_yet_moved_into_the_file_counts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("home.db");
        let store = Store::open(&path, Access::ReadWrite).unwrap();
        store.import(&test_home::episode()).unwrap();
        assert_eq!(Inspection::of(&path).unwrap().things, 5);
        drop(store);
    }

    #[test]
    fn a_missing_database_stays_missing() {
        let folder = tempfile::tempdir().unwrap();
        let error = Inspection::of(&folder.path().join("home.db")).unwrap_err();
        assert!(error.to_string().contains("there is no such file"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
