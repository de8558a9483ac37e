//! People who join a home that was lived in before.

use coin::captions::{Action, CaptionReader, civil_seconds};
use coin::roster::UserIndex;
use coin_schemas::household::{Owners, OwnershipBoolean, UserName};
use jiff::civil::DateTime;

use super::beliefs::{Belief, owners_of, text};
use super::household::Household;
use super::map::ObjectKey;
use super::{Reader, StoreError, Writer};

/// An event whose actor could not be told.
struct Unattributed {
    object: i64,
    at: i64,
    caption: String,
}

impl Reader<'_> {
    /// Whether anything was seen or said in this home.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn is_lived_in(&self) -> Result<bool, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT EXISTS (SELECT 1 FROM usage_events) OR EXISTS (SELECT 1 FROM answers)
                 OR EXISTS (SELECT 1 FROM inferences)",
        )?;
        Ok(statement.query_row([], |row| row.get(0))?)
    }

    /// When a thing was first used, in seconds of local time; `None` where nobody was seen using it.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn first_used(&self, object: ObjectKey) -> Result<Option<i64>, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT min(at) FROM usage_events WHERE object_key = ?1")?;
        Ok(statement.query_row([object.0], |row| row.get(0))?)
    }
}

impl Writer<'_> {
    /// Notes when a person joined.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_joined_at(&self, name: &UserName, at: DateTime) -> Result<(), StoreError> {
        self.connection
            .prepare_cached("UPDATE users SET joined_at = ?2 WHERE name = ?1")?
            .execute((name.as_str(), civil_seconds(at)))?;
        Ok(())
    }

    /// Reads again the captions whose actor could not be told, and gives `newcomer` those that name this person. How
    /// many there are.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn attribute_to(&self, household: &Household, newcomer: UserIndex) -> Result<u64, StoreError> {
        let reader = CaptionReader::new(household.roster());
        let mut update = self.connection.prepare_cached(
            "UPDATE usage_events SET actor = ?4, action = ?5 WHERE object_key = ?1 AND at = ?2 AND caption = ?3",
        )?;
        let mut attributed = 0;
        for event in self.unattributed()? {
            // What was stored was read before; what cannot be read any more stays as it is.
            let Ok(observation) = reader.read(&event.caption) else { continue };
            if observation.actor == Some(newcomer) {
                let (actor, action) = (household.key(newcomer).0, Action::code(observation.action));
                update.execute((event.object, event.at, event.caption, actor, action))?;
                attributed += 1;
            }
        }
        Ok(attributed)
    }

    fn unattributed(&self) -> Result<Vec<Unattributed>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT object_key, at, caption FROM usage_events WHERE actor IS NULL")?;
        let mut rows = statement.query([])?;
        let mut events = Vec::new();
        while let Some(row) = rows.next()? {
            events.push(Unattributed { object: row.get(0)?, at: row.get(1)?, caption: row.get(2)? });
        }
        Ok(events)
    }

    /// Opens again what was settled as everybody's when `before` was the household: whether "everybody" means a
    /// newcomer too is not known. Answers stay in the history; what a model concluded is not settled any more. The
    /// things, in the order in which they were added.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn reopen_shared(&self, before: &Household, at: DateTime) -> Result<Vec<ObjectKey>, StoreError> {
        if before.roster().len() < 2 {
            return Ok(Vec::new());
        }
        let everybody = before.roster().owners(before.roster().everyone());
        let mut reopened = Vec::new();
        for object in self.shared_answers(&everybody)? {
            self.connection
                .prepare_cached(
                    "UPDATE answers SET reopened_at = ?2 WHERE (object_key, sequence) IN
                         (SELECT object_key, sequence FROM present_answers WHERE object_key = ?1)",
                )?
                .execute((object.0, civil_seconds(at)))?;
            self.connection
                .prepare_cached("DELETE FROM present_answers WHERE object_key = ?1")?
                .execute([object.0])?;
            reopened.push(object);
        }
        let mut statement = self.connection.prepare_cached(
            "UPDATE inferences SET settled = 0 WHERE settled = 1 AND owners = ?1 RETURNING object_key",
        )?;
        let mut rows = statement.query([serde_json::to_string(&everybody)?])?;
        while let Some(row) = rows.next()? {
            let object = ObjectKey(row.get(0)?);
            // What a person said of the thing stays settled, whatever a model concluded.
            if !matches!(self.belief(object)?, Some(Belief::Answered { .. })) {
                reopened.push(object);
            }
        }
        reopened.sort_unstable();
        reopened.dedup();
        Ok(reopened)
    }

    fn shared_answers(&self, everybody: &Owners) -> Result<Vec<ObjectKey>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, ownership FROM present_answers JOIN answers USING (object_key, sequence)
             WHERE outside = 0",
        )?;
        let mut rows = statement.query([])?;
        let mut shared = Vec::new();
        while let Some(row) = rows.next()? {
            let ownership: OwnershipBoolean = serde_json::from_str(text(row, 1)?)?;
            if owners_of(&ownership) == *everybody {
                shared.push(ObjectKey(row.get(0)?));
            }
        }
        Ok(shared)
    }
}
