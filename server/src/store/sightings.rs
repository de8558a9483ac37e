//! What is known of things from before the map made one of them: their sightings, and what was found out about them.

use coin::map::detection::{Sighting, ViewId};
use coin::map::entry::SightingId;
use coin_schemas::household::{ClassLabel, Position};
use jiff::civil::DateTime;

use super::map::{ObjectKey, from_bytes};
use super::semantic_map::{moment, sighting, sighting_id};
use super::{Reader, StoreError};

/// A thing as the recording has it that it comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Recorded {
    pub(super) class: ClassLabel,
    pub(super) position: Position,
    pub(super) feature: Option<Vec<f32>>,
    /// Its room, or that there is none; `None` where it has been seen since and may have been moved.
    pub(super) room: Option<Option<String>>,
}

/// What was found out about a thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChangeKind {
    /// It had been moved, and the other id was what it was called at its new place.
    Moved,
    /// The other id was a part of it.
    Merged,
    /// The other thing was taken out of it.
    Split,
}

impl ChangeKind {
    /// Its word, in the database and for people.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Moved => "moved",
            Self::Merged => "merged",
            Self::Split => "split",
        }
    }

    fn of_word(word: &str) -> Result<Self, StoreError> {
        [Self::Moved, Self::Merged, Self::Split]
            .into_iter()
            .find(|kind| kind.as_str() == word)
            .ok_or_else(|| StoreError::damaged(format!("there is no change {word:?}")))
    }
}

/// Something that was found out about a thing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectChange {
    /// What.
    pub kind: ChangeKind,
    /// The id of the other thing.
    pub other: String,
    /// Since when it is so, or when the thing was last seen before.
    pub at: DateTime,
}

/// Where a thing was before it was moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FormerPlace {
    /// Where, in metres.
    pub position: [f64; 3],
    /// Since when it has been seen elsewhere.
    pub until: DateTime,
}

impl Reader<'_> {
    /// A thing as its recording has it.
    pub(super) fn as_recorded(&self, key: ObjectKey) -> Result<Recorded, StoreError> {
        let stored = self.stored(key)?;
        let mut statement = self.connection.prepare_cached(
            "SELECT class, x, y, z, vector FROM sightings LEFT JOIN sighting_features USING (sighting)
             WHERE object_key = ?1 AND recorded AND EXISTS (SELECT 1 FROM map_entries WHERE object_key = ?1)
             ORDER BY sighting LIMIT 1",
        )?;
        let mut rows = statement.query([key.0])?;
        let Some(row) = rows.next()? else {
            let feature = self.feature(key)?;
            let (class, position) = (stored.class, stored.position);
            return Ok(Recorded { class, position, feature, room: Some(stored.room) });
        };
        Ok(Recorded {
            class: ClassLabel::new(row.get::<_, String>(0)?)?,
            position: Position::new([row.get(1)?, row.get(2)?, row.get(3)?])?,
            feature: row.get::<_, Option<Vec<u8>>>(4)?.as_deref().map(from_bytes),
            room: None,
        })
    }

    /// How many sightings a thing has; 0 where it was recorded and nothing was seen of it since.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn sighting_count(&self, key: ObjectKey) -> Result<u64, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT count(*) FROM sightings WHERE object_key = ?1")?;
        Ok(statement.query_row([key.0], |row| row.get::<_, i64>(0))?.unsigned_abs())
    }

    /// The latest sightings of a thing, at most so many, latest last.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn latest_sightings(
        &self,
        key: ObjectKey,
        most: u32,
    ) -> Result<Vec<(SightingId, Sighting)>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, sighting, class, x, y, z, radius, at, view
             FROM sightings LEFT JOIN views USING (view_key)
             WHERE object_key = ?1 ORDER BY at DESC, sighting DESC LIMIT ?2",
        )?;
        let mut rows = statement.query((key.0, most))?;
        let mut sightings = Vec::new();
        while let Some(row) = rows.next()? {
            let view = row.get::<_, Option<String>>(8)?.map(ViewId);
            sightings.push((sighting_id(row.get(1)?), sighting(row, view)?));
        }
        sightings.reverse();
        Ok(sightings)
    }

    /// Where a thing was before, first place first.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn former_places(&self, key: ObjectKey) -> Result<Vec<FormerPlace>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT x, y, z, at FROM map_moves WHERE object_key = ?1 ORDER BY number")?;
        let mut rows = statement.query([key.0])?;
        let mut places = Vec::new();
        while let Some(row) = rows.next()? {
            let position = [row.get(0)?, row.get(1)?, row.get(2)?];
            places.push(FormerPlace { position, until: moment(row.get(3)?)? });
        }
        Ok(places)
    }

    /// What was found out about a thing, first things first.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn changes(&self, key: ObjectKey) -> Result<Vec<ObjectChange>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT kind, other, at FROM map_changes WHERE object_key = ?1 ORDER BY sequence",
        )?;
        let mut rows = statement.query([key.0])?;
        let mut changes = Vec::new();
        while let Some(row) = rows.next()? {
            let kind = ChangeKind::of_word(&row.get::<_, String>(0)?)?;
            changes.push(ObjectChange { kind, other: row.get(1)?, at: moment(row.get(2)?)? });
        }
        Ok(changes)
    }
}
