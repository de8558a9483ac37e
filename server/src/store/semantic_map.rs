//! The semantic map as it is read from the database and kept in memory between the calls of a process.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

use coin::captions::{civil_seconds, from_civil_seconds};
use coin::map::detection::{Seen, Sighting, ViewId};
use coin::map::entry::{Entry, EntryId, Move, Place, SightingId};
use coin::map::look::Look;
use coin::map::parameters::MapParameters;
use coin::map::{MapState, SemanticMap};
use coin::similarity::normalise;
use coin_schemas::episode::FEATURE_DIMENSIONS;
use coin_schemas::household::{ClassLabel, Position};
use jiff::SignedDuration;
use jiff::civil::DateTime;
use rusqlite::Row;

use super::map::{ObjectKey, from_bytes};
use super::{Reader, StoreError, Writer};

/// How large a thing of a recording is held to be, which does not say: between a pen (2 cm) and a bed (1 m), so that a
/// detection of either at its very place is within the largest divergence.
const RECORDED_RADIUS: f64 = 0.15;

/// The map as it was at one revision. Whoever changes it takes it out, and puts it back when the change was committed.
#[derive(Debug, Default)]
pub(super) struct KeptMap(Mutex<Option<Revised>>);

/// A map and the revision of the database that it stands for.
#[derive(Debug)]
pub(super) struct Revised {
    pub(super) revision: i64,
    pub(super) map: SemanticMap,
}

impl KeptMap {
    pub(super) fn take(&self) -> Option<Revised> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    pub(super) fn put(&self, revised: Revised) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(revised);
    }
}

impl Reader<'_> {
    /// The revision of the map. It grows with every change, whichever process makes it.
    pub(super) fn map_revision(&self) -> Result<i64, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT map_revision FROM home")?;
        Ok(statement.query_row([], |row| row.get(0))?)
    }
}

impl Writer<'_> {
    /// The map as it is in the database: what was kept of it, where that is not out of date.
    pub(super) fn semantic_map(&self, kept: Option<Revised>) -> Result<SemanticMap, StoreError> {
        match kept {
            Some(Revised { revision, map }) if revision == self.map_revision()? => Ok(map),
            _ => {
                self.enter_recorded()?;
                self.read_map()
            }
        }
    }

    /// Makes a sighting of every thing that is known without one: it was recorded.
    fn enter_recorded(&self) -> Result<(), StoreError> {
        let entered = self
            .connection
            .prepare_cached(
                "INSERT INTO sightings (object_key, sighting, class, x, y, z, radius, at, recorded)
                 SELECT object_key, next_sighting + row_number() OVER (ORDER BY object_key) - 1, class, x, y, z,
                     ?1, 1000 * coalesce(recorded_at, clock, 0), 1
                 FROM objects, home
                 WHERE NOT EXISTS (SELECT 1 FROM sightings WHERE sightings.object_key = objects.object_key)",
            )?
            .execute([RECORDED_RADIUS])?;
        self.connection
            .prepare_cached("UPDATE home SET next_sighting = next_sighting + ?1")?
            .execute([entered as i64])?;
        Ok(())
    }

    fn read_map(&self) -> Result<SemanticMap, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT next_object, next_sighting FROM home")?;
        let (next_object, next_sighting): (i64, i64) =
            statement.query_row([], |row| Ok((row.get(0)?, row.get(1)?)))?;
        let mut state = MapState {
            entries_so_far: next_object.unsigned_abs(),
            sightings_so_far: next_sighting.unsigned_abs(),
            ..MapState::default()
        };
        let mut sightings = self.sightings(&mut state)?;
        self.read_entries(&mut state, &mut sightings)?;
        self.read_moves(&mut state)?;
        self.read_told_apart(&mut state)?;
        if let Some(last) = state.entries.keys().next_back() {
            state.entries_so_far = state.entries_so_far.max(last.0 + 1);
        }
        let parameters = MapParameters { dimension: FEATURE_DIMENSIONS, ..MapParameters::default() };
        Ok(SemanticMap::new(state, parameters))
    }

    /// The sightings of each thing. Which things each view showed is entered into the state.
    fn sightings(&self, state: &mut MapState) -> Result<BTreeMap<EntryId, Sightings>, StoreError> {
        let mut views: BTreeMap<i64, ViewId> = BTreeMap::new();
        let mut statement = self.connection.prepare_cached("SELECT view_key, view FROM views")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            views.insert(row.get(0)?, ViewId(row.get(1)?));
        }
        state.views = views.values().map(|view| (view.clone(), BTreeSet::new())).collect();
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, sighting, class, x, y, z, radius, at, view_key, recorded FROM sightings",
        )?;
        let mut rows = statement.query([])?;
        let mut sightings: BTreeMap<EntryId, Sightings> = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let entry = entry_id(ObjectKey(row.get(0)?));
            let view = row.get::<_, Option<i64>>(8)?.and_then(|key| views.get(&key)).cloned();
            if let Some(of_view) = view.as_ref().and_then(|view| state.views.get_mut(view)) {
                of_view.insert(entry);
            }
            let of_entry = sightings.entry(entry).or_default();
            of_entry.seen.insert(sighting_id(row.get(1)?), sighting(row, view)?);
            of_entry.is_recorded |= row.get::<_, bool>(9)?;
        }
        Ok(sightings)
    }

    fn read_entries(
        &self,
        state: &mut MapState,
        sightings: &mut BTreeMap<EntryId, Sightings>,
    ) -> Result<(), StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, class, x, y, z, weight, sightings, look, first_seen, last_seen, absences, undecided
             FROM objects LEFT JOIN map_entries USING (object_key)",
        )?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let key = ObjectKey(row.get(0)?);
            let id = entry_id(key);
            let Sightings { seen, is_recorded } = sightings.remove(&id).unwrap_or_default();
            let class = ClassLabel::new(row.get::<_, String>(1)?)?;
            let entry = match row.get::<_, Option<f64>>(5)? {
                None => self.recorded_entry(key, seen)?,
                Some(weight) => {
                    if row.get(11)? {
                        state.undecided.insert(id);
                    }
                    let mut classes = BTreeMap::new();
                    for sighting in seen.values() {
                        *classes.entry(sighting.class.clone()).or_default() += 1;
                    }
                    Entry {
                        id,
                        classes,
                        place: Place {
                            position: [row.get(2)?, row.get(3)?, row.get(4)?],
                            weight,
                            sightings: count(row.get(6)?),
                        },
                        look: row.get::<_, Option<Vec<u8>>>(7)?.map(|bytes| Look::of_sum(sum(&bytes))),
                        first_seen: moment(row.get(8)?)?,
                        last_seen: moment(row.get(9)?)?,
                        absences: count(row.get(10)?),
                        moves: Vec::new(),
                        told_apart: BTreeSet::new(),
                        sightings: seen,
                        recorded: is_recorded.then_some(class),
                    }
                }
            };
            state.entries.insert(id, entry);
        }
        Ok(())
    }

    /// The entry of a thing of which nothing is known but what was recorded.
    fn recorded_entry(
        &self,
        key: ObjectKey,
        seen: BTreeMap<SightingId, Sighting>,
    ) -> Result<Entry, StoreError> {
        let Some((number, sighting)) = seen.into_iter().next() else {
            return Err(StoreError::damaged(format!("object {} has no sighting", key.0)));
        };
        let feature = self.feature(key)?.and_then(|feature| normalise(&feature));
        Ok(Entry::recorded(entry_id(key), number, Seen { sighting, feature }))
    }

    fn read_moves(&self, state: &mut MapState) -> Result<(), StoreError> {
        let mut statement = self
            .connection
            .prepare_cached("SELECT object_key, at, x, y, z FROM map_moves ORDER BY object_key, number")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            if let Some(entry) = state.entries.get_mut(&entry_id(ObjectKey(row.get(0)?))) {
                let from = [row.get(2)?, row.get(3)?, row.get(4)?];
                entry.moves.push(Move { at: moment(row.get(1)?)?, from });
            }
        }
        Ok(())
    }

    fn read_told_apart(&self, state: &mut MapState) -> Result<(), StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT object_key, other_key FROM told_apart")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            if let Some(entry) = state.entries.get_mut(&entry_id(ObjectKey(row.get(0)?))) {
                entry.told_apart.insert(entry_id(ObjectKey(row.get(1)?)));
            }
        }
        Ok(())
    }

    /// What the sightings of a thing looked like, at length 1.
    pub(super) fn sighting_features(
        &self,
        key: ObjectKey,
    ) -> Result<BTreeMap<SightingId, Vec<f32>>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT sighting, vector FROM sightings JOIN sighting_features USING (sighting) WHERE object_key = ?1",
        )?;
        let mut rows = statement.query([key.0])?;
        let mut features = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let blob = row.get_ref(1)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
            if let Some(feature) = normalise(&from_bytes(blob)) {
                features.insert(sighting_id(row.get(0)?), feature);
            }
        }
        Ok(features)
    }
}

/// The sightings of one thing.
#[derive(Debug, Default)]
struct Sightings {
    seen: BTreeMap<SightingId, Sighting>,
    is_recorded: bool,
}

/// A sighting of a row: the object, the number, the class, three coordinates, the radius and the time.
pub(super) fn sighting(row: &Row<'_>, view: Option<ViewId>) -> Result<Sighting, StoreError> {
    Ok(Sighting {
        class: ClassLabel::new(row.get::<_, String>(2)?)?,
        position: Position::new([row.get(3)?, row.get(4)?, row.get(5)?])?,
        radius: row.get(6)?,
        at: moment(row.get(7)?)?,
        view,
    })
}

/// The entry of a thing has the number of its key.
pub(super) fn entry_id(key: ObjectKey) -> EntryId {
    EntryId(key.0.unsigned_abs())
}

pub(super) fn object_key(id: EntryId) -> ObjectKey {
    ObjectKey(id.0 as i64)
}

pub(super) fn sighting_id(number: i64) -> SightingId {
    SightingId(number.unsigned_abs())
}

fn count(number: i64) -> usize {
    usize::try_from(number).unwrap_or(0)
}

fn sum(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks::<8>().0.iter().map(|&component| f64::from_le_bytes(component)).collect()
}

/// Milliseconds of local time since 1970.
pub(super) fn milliseconds(at: DateTime) -> i64 {
    civil_seconds(at) * 1000 + i64::from(at.subsec_nanosecond() / 1_000_000)
}

/// The local time that a column of milliseconds holds.
pub(super) fn moment(milliseconds: i64) -> Result<DateTime, StoreError> {
    from_civil_seconds(milliseconds.div_euclid(1000))
        .and_then(|second| {
            second.checked_add(SignedDuration::from_millis(milliseconds.rem_euclid(1000))).ok()
        })
        .ok_or_else(|| StoreError::damaged(format!("{milliseconds} is no local time")))
}
