//! The home itself: its people and its present.

use coin::captions::{civil_seconds, from_civil_seconds};
use coin::owners::OwnerSet;
use coin::roster::{Roster, UserIndex};
use coin_schemas::household::{Background, UserName, Users};
use jiff::civil::DateTime;
use rusqlite::OptionalExtension;

use super::{Reader, StoreError, Writer};

/// The key of a person in the store; it stays when others join the home.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct UserKey(pub(super) i64);

/// The people of a home, with their keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Household {
    roster: Roster,
    keys: Vec<UserKey>,
    /// In the order of the roster; `None` for those who were there from the beginning.
    joined_at: Vec<Option<i64>>,
}

impl Household {
    /// The people.
    pub fn roster(&self) -> &Roster {
        &self.roster
    }

    /// The key of a member.
    ///
    /// # Panics
    /// If `user` belongs to a larger roster.
    pub fn key(&self, user: UserIndex) -> UserKey {
        self.keys[user.place()]
    }

    /// Those who joined after a moment of local time, in seconds.
    pub fn newcomers_after(&self, seconds: i64) -> OwnerSet {
        self.roster.indices().filter(|user| self.joined_at[user.place()] > Some(seconds)).collect()
    }

    /// The member of this key.
    pub fn user(&self, key: UserKey) -> Option<UserIndex> {
        self.keys.iter().position(|&other| other == key).and_then(UserIndex::new)
    }
}

impl Reader<'_> {
    /// The people of the home; `None` as long as there is nobody.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn household(&self) -> Result<Option<Household>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT user_key, name, role, occupation, joined_at FROM users")?;
        let mut rows = statement.query([])?;
        let mut people: Vec<(UserName, UserKey, Option<i64>)> = Vec::new();
        let mut users = Users::new();
        while let Some(row) = rows.next()? {
            let name = UserName::new(row.get::<_, String>(1)?)?;
            users.insert(name.clone(), Background { role: row.get(2)?, occupation: row.get(3)? });
            people.push((name, UserKey(row.get(0)?), row.get(4)?));
        }
        if people.is_empty() {
            return Ok(None);
        }
        people.sort();
        let roster = Roster::new(&users)?;
        let (keys, joined_at) = people.into_iter().map(|(_, key, joined_at)| (key, joined_at)).unzip();
        Ok(Some(Household { roster, keys, joined_at }))
    }

    /// The name of the recording that the home was imported from.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn recording(&self) -> Result<Option<String>, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT recording FROM home")?;
        Ok(statement.query_row([], |row| row.get(0)).optional()?.flatten())
    }

    /// The present of a home that was imported from a recording: the later of the recording's `now` and the
    /// latest event recorded since. `None` where the home lives by the wall clock.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn clock(&self) -> Result<Option<DateTime>, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT clock FROM home")?;
        let seconds: Option<i64> = statement.query_row([], |row| row.get(0)).optional()?.flatten();
        seconds.map(datetime).transpose()
    }
}

impl Writer<'_> {
    /// Adds a person, or changes what is known of one.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_user(&self, name: &UserName, background: &Background) -> Result<(), StoreError> {
        self.connection
            .prepare_cached(
                "INSERT INTO users (name, role, occupation) VALUES (?1, ?2, ?3)
                 ON CONFLICT (name) DO UPDATE SET role = excluded.role, occupation = excluded.occupation",
            )?
            .execute((name.as_str(), &background.role, &background.occupation))?;
        Ok(())
    }

    /// Notes which recording the home comes from. Its present is not set back.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_recording(&self, name: &str, now: DateTime) -> Result<(), StoreError> {
        self.connection
            .prepare_cached(
                "UPDATE home SET recording = ?1, recorded_at = coalesce(recorded_at, ?2),
                     clock = max(coalesce(clock, ?2), ?2)",
            )?
            .execute((name, civil_seconds(now)))?;
        Ok(())
    }

    /// Moves the present of a recorded home forward to an event. A home that lives by the wall clock stays so.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn advance_clock(&self, event: DateTime) -> Result<(), StoreError> {
        self.connection
            .prepare_cached("UPDATE home SET clock = ?1 WHERE clock < ?1")?
            .execute([civil_seconds(event)])?;
        Ok(())
    }
}

/// The local time that a column holds.
pub(super) fn datetime(seconds: i64) -> Result<DateTime, StoreError> {
    from_civil_seconds(seconds).ok_or_else(|| StoreError::damaged(format!("{seconds} is no local time")))
}
