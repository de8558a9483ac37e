//! The schema's history. Migrations are only ever appended: a file that a user has must open with every later
//! version of the program.

use rusqlite::{Connection, Transaction, TransactionBehavior};
use rusqlite_migration::{M, Migrations};

use super::error::StoreError;

/// Marks a SQLite file as ours (`COIN` in ASCII).
pub(super) const APPLICATION_ID: i32 = 0x434F_494E;

const STEPS: &[M<'_>] = &[
    M::up(include_str!("01-household.sql")),
    M::up(include_str!("02-retractions.sql")),
    M::up(include_str!("03-conversations.sql")),
    M::up(include_str!("04-sightings.sql")),
    M::up(include_str!("05-indexes.sql")),
];

/// The version of a database that this program writes.
pub(super) const VERSION: usize = STEPS.len();

/// What a SQLite file says of itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Identity {
    /// It holds nothing yet.
    Empty,
    /// It is ours, of this version.
    Ours {
        /// The number of migrations that it has seen.
        version: usize,
    },
}

/// Reads the marks of the file. A file of another program is refused.
pub(super) fn identify(connection: &Connection) -> Result<Identity, StoreError> {
    // All marks are read in one transaction: another process may be making the file at this moment.
    let moment = Transaction::new_unchecked(connection, TransactionBehavior::Deferred)?;
    let application: i32 = moment.query_row("PRAGMA application_id", [], |row| row.get(0))?;
    let version: i64 = moment.query_row("PRAGMA user_version", [], |row| row.get(0))?;
    let tables: i64 = moment.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
    if application == APPLICATION_ID {
        return Ok(Identity::Ours { version: usize::try_from(version).unwrap_or(usize::MAX) });
    }
    if application == 0 && version == 0 && tables == 0 {
        Ok(Identity::Empty)
    } else {
        Err(StoreError::Foreign { application })
    }
}

/// Refuses a database that a newer program has written.
pub(super) fn refuse_newer(version: usize) -> Result<(), StoreError> {
    if version > VERSION { Err(StoreError::TooNew { found: version, known: VERSION }) } else { Ok(()) }
}

/// Brings the schema up to [`VERSION`]. A database that is there already is not written to.
pub(super) fn migrate(connection: &mut Connection) -> Result<(), StoreError> {
    let up_to_date = |connection: &Connection| match identify(connection)? {
        Identity::Ours { version } => refuse_newer(version).map(|()| version == VERSION),
        Identity::Empty => Ok(false),
    };
    if up_to_date(connection)? {
        return Ok(());
    }
    match Migrations::from_slice(STEPS).to_latest(connection) {
        Ok(()) => Ok(()),
        // Another process may have migrated the file between the look at its version and the write lock.
        Err(_) if up_to_date(connection)? => Ok(()),
        Err(rusqlite_migration::Error::RusqliteError { err, .. }) => Err(err.into()),
        Err(source) => Err(StoreError::Migration { source: Box::new(source) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_steps_apply_to_an_empty_database() {
        Migrations::from_slice(STEPS).validate().unwrap();
    }

    #[test]
    fn answers_of_the_first_version_count_as_before() {
        let mut connection = Connection::open_in_memory().unwrap();
        Migrations::from_slice(&STEPS[..1]).to_latest(&mut connection).unwrap();
        connection
            .execute_batch(
                r#"INSERT INTO users (name) VALUES ('Bob');
                   INSERT INTO objects (id, class, x, y, z) VALUES ('1', 'marker', 0, 0, 0);
                   INSERT INTO answers VALUES (1, 1, 'Whose?', 'Bob''s.', '{"Bob":true}', 0, NULL, 0, 'answered');
                   INSERT INTO present_answers VALUES (1, 1);"#,
            )
            .unwrap();
        migrate(&mut connection).unwrap();
        assert_eq!(identify(&connection).unwrap(), Identity::Ours { version: VERSION });
        let kept: (String, Option<i64>) = connection
            .query_row(
                "SELECT answer, retracted_at FROM answers JOIN present_answers USING (object_key, sequence)",
                [],
                |row| Ok((row.get(0)?, row.get(1)?)),
            )
            .unwrap();
        assert_eq!(kept, ("Bob's.".to_owned(), None));
    }
}
