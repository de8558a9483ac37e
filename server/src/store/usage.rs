//! What was seen: usage events, each with the line that it was read from.

use coin::captions::{Action, Observation, civil_seconds};
use coin::usage::UsageEvent;

use super::household::{Household, UserKey};
use super::map::ObjectKey;
use super::{Progress, Reader, Stage, StoreError, Writer};

/// After how many events it is said how far recording has come: often enough for somebody who waits or gives up.
pub(crate) const EVENTS_BETWEEN_REPORTS: usize = 500;

/// An event to store.
#[derive(Debug, Clone, PartialEq)]
pub struct UsageRecord<'a> {
    /// The thing.
    pub object: ObjectKey,
    /// What was read from the line.
    pub observation: Observation,
    /// The line as it came.
    pub caption: &'a str,
}

/// What became of events that were to be stored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct UsageCounts {
    /// Events that were new, unattributed ones included.
    pub recorded: u64,
    /// Events among them whose actor could not be told.
    pub unattributed: u64,
    /// Events that were there already.
    pub duplicates: u64,
}

/// The events of one thing in the order of time, lines of the same moment by their text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UsageLog {
    /// The events.
    pub events: Vec<UsageEvent>,
    text: String,
    ends: Vec<usize>,
}

impl UsageLog {
    /// The line of the event at `place`.
    ///
    /// # Panics
    /// If there is no such event.
    pub fn caption(&self, place: usize) -> &str {
        let start = place.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.text[start..self.ends[place]]
    }
}

impl Reader<'_> {
    /// The events of a thing from `first_seconds` to `last_seconds` of local time, both included.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn usage(
        &self,
        household: &Household,
        object: ObjectKey,
        first_seconds: i64,
        last_seconds: i64,
    ) -> Result<UsageLog, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT at, actor, action, caption FROM usage_events
             WHERE object_key = ?1 AND at BETWEEN ?2 AND ?3 ORDER BY at, caption",
        )?;
        let mut rows = statement.query([object.0, first_seconds, last_seconds])?;
        let mut log = UsageLog::default();
        while let Some(row) = rows.next()? {
            let actor: Option<i64> = row.get(1)?;
            let code: u8 = row.get(2)?;
            let action = Action::from_code(code)
                .ok_or_else(|| StoreError::damaged(format!("there is no action of code {code}")))?;
            log.events.push(UsageEvent {
                at_seconds: row.get(0)?,
                actor: actor.and_then(|key| household.user(UserKey(key))),
                action,
            });
            let caption =
                row.get_ref(3)?.as_str().map_err(|source| StoreError::damaged(source.to_string()))?;
            log.text.push_str(caption);
            log.ends.push(log.text.len());
        }
        Ok(log)
    }

    /// How many events are stored in all. It counts them one by one.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn event_count(&self) -> Result<u64, StoreError> {
        let count: i64 =
            self.connection.query_row("SELECT count(*) FROM usage_events", [], |row| row.get(0))?;
        Ok(count.unsigned_abs())
    }
}

impl Writer<'_> {
    /// Stores events. Those that are there already stay as they are.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn record_usage(
        &self,
        household: &Household,
        records: &[UsageRecord<'_>],
    ) -> Result<UsageCounts, StoreError> {
        // In the order of the table, insertions walk along its leaves instead of jumping from one to another.
        let mut order: Vec<(i64, i64, &UsageRecord<'_>)> = records
            .iter()
            .map(|record| (record.object.0, civil_seconds(record.observation.at), record))
            .collect();
        order.sort_unstable_by_key(|&(object, at, record)| (object, at, record.caption));
        let mut statement = self.connection.prepare_cached(
            "INSERT INTO usage_events (object_key, at, caption, actor, action) VALUES (?1, ?2, ?3, ?4, ?5)
             ON CONFLICT DO NOTHING",
        )?;
        let mut counts = UsageCounts::default();
        let total = records.len() as u64;
        for (done, (object, at, record)) in (0..).zip(order) {
            if done % EVENTS_BETWEEN_REPORTS == 0 {
                self.call.advance(Progress { stage: Stage::Storing, done: done as u64, total })?;
            }
            let Observation { actor, action, .. } = record.observation;
            let actor = actor.map(|user| household.key(user).0);
            if statement.execute((object, at, record.caption, actor, action.code()))? == 0 {
                counts.duplicates += 1;
            } else {
                counts.recorded += 1;
                counts.unattributed += u64::from(actor.is_none());
            }
        }
        Ok(counts)
    }
}
