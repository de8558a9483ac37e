//! The home's map: things, where they are and what they look like.

use std::collections::BTreeMap;

use coin_schemas::episode::EpisodeObject;
use coin_schemas::household::{ClassLabel, ObjectId, Position};
use rusqlite::{OptionalExtension, Row};

use super::{Reader, StoreError, Writer};

/// The key of a thing in the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ObjectKey(pub(super) i64);

/// A thing of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredObject {
    /// Its key.
    pub key: ObjectKey,
    /// Its id.
    pub id: ObjectId,
    /// Its class.
    pub class: ClassLabel,
    /// Where it is, in metres.
    pub position: Position,
    /// The room that it is in.
    pub room: Option<String>,
}

impl StoredObject {
    /// Where it is, in metres, to the micrometre: what is made from many sightings has more digits than anybody can use.
    pub fn shown_position(&self) -> Position {
        let rounded = self.position.metres().map(|metres| (metres * 1e6).round() / 1e6 + 0.0);
        // What is so far away that it cannot be rounded is shown as it is.
        Position::new(rounded).unwrap_or(self.position)
    }

    fn from_row(row: &Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            key: ObjectKey(row.get(0)?),
            id: ObjectId::new(row.get::<_, String>(1)?)?,
            class: ClassLabel::new(row.get::<_, String>(2)?)?,
            position: Position::new([row.get(3)?, row.get(4)?, row.get(5)?])?,
            room: row.get(6)?,
        })
    }
}

impl Reader<'_> {
    /// The thing of this id, or that had this id before it was found to be another thing that was known already.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn object(&self, id: &str) -> Result<Option<StoredObject>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT object_key, id, class, x, y, z, room FROM objects WHERE id = ?1")?;
        let mut rows = statement.query([id])?;
        match rows.next()? {
            Some(row) => StoredObject::from_row(row).map(Some),
            None => self.formerly(id)?.map(|key| self.stored(key)).transpose(),
        }
    }

    /// The key of the thing of this id, or that had this id.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn object_key(&self, id: &str) -> Result<Option<ObjectKey>, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT object_key FROM objects WHERE id = ?1")?;
        match statement.query_row([id], |row| row.get(0)).optional()? {
            Some(key) => Ok(Some(ObjectKey(key))),
            None => self.formerly(id),
        }
    }

    fn formerly(&self, id: &str) -> Result<Option<ObjectKey>, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT object_key FROM former_ids WHERE id = ?1")?;
        Ok(statement.query_row([id], |row| row.get(0)).optional()?.map(ObjectKey))
    }

    /// The thing of this key, which the database has.
    pub(super) fn stored(&self, key: ObjectKey) -> Result<StoredObject, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, id, class, x, y, z, room FROM objects WHERE object_key = ?1",
        )?;
        let mut rows = statement.query([key.0])?;
        match rows.next()? {
            Some(row) => StoredObject::from_row(row),
            None => Err(StoreError::damaged(format!("an index has object {}, which is not there", key.0))),
        }
    }

    /// All things, by id.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn objects(&self) -> Result<Vec<StoredObject>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT object_key, id, class, x, y, z, room FROM objects ORDER BY id")?;
        let mut rows = statement.query([])?;
        let mut objects = Vec::new();
        while let Some(row) = rows.next()? {
            objects.push(StoredObject::from_row(row)?);
        }
        Ok(objects)
    }

    /// The visual feature of a thing, as it was handed in.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn feature(&self, object: ObjectKey) -> Result<Option<Vec<f32>>, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT vector FROM features WHERE object_key = ?1")?;
        let blob: Option<Vec<u8>> = statement.query_row([object.0], |row| row.get(0)).optional()?;
        Ok(blob.as_deref().map(from_bytes))
    }

    /// The visual features of all things that have one, as they were handed in.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn features(&self) -> Result<BTreeMap<ObjectKey, Vec<f32>>, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT object_key, vector FROM features")?;
        let mut rows = statement.query([])?;
        let mut features = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let blob = row.get_ref(1)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
            features.insert(ObjectKey(row.get(0)?), from_bytes(blob));
        }
        Ok(features)
    }
}

impl Writer<'_> {
    /// Adds a thing that is not in the map yet.
    ///
    /// # Errors
    /// Failures of the database, an id that is taken among them.
    pub fn add_object(&self, object: &EpisodeObject) -> Result<ObjectKey, StoreError> {
        let [x, y, z] = object.position.metres();
        self.connection
            .prepare_cached("INSERT INTO objects (id, class, x, y, z, room) VALUES (?1, ?2, ?3, ?4, ?5, ?6)")?
            .execute((object.id.as_str(), object.class.as_str(), x, y, z, &object.room))?;
        Ok(ObjectKey(self.connection.last_insert_rowid()))
    }

    /// Stores what a thing looks like: 512 numbers, which the schema of the database holds to.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_feature(&self, object: ObjectKey, feature: &[f32]) -> Result<(), StoreError> {
        self.connection
            .prepare_cached(
                "INSERT INTO features (object_key, vector) VALUES (?1, ?2)
                 ON CONFLICT (object_key) DO UPDATE SET vector = excluded.vector",
            )?
            .execute((object.0, to_bytes(feature)))?;
        Ok(())
    }
}

pub(super) fn to_bytes(feature: &[f32]) -> Vec<u8> {
    feature.iter().flat_map(|component| component.to_le_bytes()).collect()
}

pub(super) fn from_bytes(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<4>().0.iter().map(|&component| f32::from_le_bytes(component)).collect()
}
