//! What a robot sees enters the map, and what the map makes of it enters the database.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use coin::map::detection::{Detection, Refusal, View, ViewId};
use coin::map::entry::{Entry, EntryId, SightingId};
use coin::map::look::Look;
use coin::map::{Change, Outcome, PerhapsMoved, SemanticMap, SplitError};
use coin_schemas::household::ObjectId;
use jiff::civil::DateTime;
use rusqlite::OptionalExtension;
use thiserror::Error;

use super::map::to_bytes;
use super::semantic_map::{Revised, entry_id, milliseconds, object_key};
use super::sightings::ChangeKind;
use super::{ObjectKey, Store, StoreError, Writer};

/// A view with the names of the rooms that its detections are in, where they are known.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewInRooms {
    /// The view.
    pub view: View,
    /// The room of each detection.
    pub rooms: Vec<Option<String>>,
}

/// What became of a detection.
#[derive(Debug, Clone, PartialEq)]
pub enum Observed {
    /// It was not taken in.
    Refused(Refusal),
    /// It was taken in before; it changes nothing.
    Repeated {
        /// The thing that it is of.
        object: ObjectId,
    },
    /// It is a sighting of a thing.
    Taken {
        /// The thing, after all that was found out by these views.
        object: ObjectId,
        /// Whether this is the first sighting of a thing that the map did not have before.
        is_new: bool,
        /// The Jeffreys divergence in nats from what the thing was before; `None` for a new one.
        divergence: Option<f64>,
        /// How many sightings the thing has.
        views: usize,
    },
}

/// A thing that was found to be elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct MovedObject {
    /// The thing.
    pub object: ObjectId,
    /// Where it was, in metres.
    pub from: [f64; 3],
    /// Where it was when that was found out, in metres.
    pub to: [f64; 3],
    /// When it was first seen there.
    pub at: DateTime,
}

/// A thing that may be one of several that are missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PerhapsMovedObject {
    /// The thing that was seen.
    pub object: ObjectId,
    /// The things that it may be.
    pub candidates: Vec<ObjectId>,
}

/// What views brought.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observations {
    /// What became of every detection of every view.
    pub detections: Vec<Vec<Observed>>,
    /// The things that were found to have moved.
    pub moved: Vec<MovedObject>,
    /// The things of which somebody would have to say whether they are ones that are missing.
    pub perhaps_moved: Vec<PerhapsMovedObject>,
}

/// Why a thing was not split.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SplitFailure {
    /// It cannot be.
    #[error(transparent)]
    Refused(#[from] SplitError),
    /// The database failed.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// A sighting that is to be stored.
struct Arrival<'a> {
    number: SightingId,
    entry: EntryId,
    detection: &'a Detection,
    view: Option<&'a ViewId>,
    room: Option<&'a str>,
}

impl Store {
    /// Takes in views, in their order, in one transaction.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn observe(&self, views: &[ViewInRooms]) -> Result<Observations, StoreError> {
        let kept = self.map.take();
        let (observations, revised) = self.write(|writer| {
            let mut map = writer.semantic_map(kept)?;
            let observations = writer.observe(&mut map, views)?;
            Ok::<_, StoreError>((observations, Revised { revision: writer.map_revision()?, map }))
        })?;
        self.map.put(revised);
        Ok(observations)
    }

    /// Takes sightings out of a thing, which keeps its id, its events and its answers, and makes another thing of them, whose id is
    /// returned. The two are told apart from then on.
    ///
    /// # Errors
    /// If the thing was not made from one of the sightings, or if no sighting would be left to one of the two; failures of
    /// the database.
    pub fn split(
        &self,
        object: ObjectKey,
        sightings: &BTreeSet<SightingId>,
    ) -> Result<ObjectId, SplitFailure> {
        let kept = self.map.take();
        let (id, revised) = self.write(|writer| {
            let mut map = writer.semantic_map(kept)?;
            writer.keep_recorded_feature(object)?;
            let into = map.split(entry_id(object), sightings, &writer.sighting_features(object)?)?;
            writer.persist(&mut map, &[])?;
            let id = writer.stored(object_key(into))?.id;
            Ok::<_, SplitFailure>((id, Revised { revision: writer.map_revision()?, map }))
        })?;
        self.map.put(revised);
        Ok(id)
    }
}

impl Writer<'_> {
    fn observe(&self, map: &mut SemanticMap, views: &[ViewInRooms]) -> Result<Observations, StoreError> {
        let mut outcomes = Vec::with_capacity(views.len());
        let mut arrivals = Vec::new();
        for ViewInRooms { view, rooms } in views {
            self.go_on()?;
            let seen = map.observe(view).outcomes;
            for ((outcome, detection), room) in seen.iter().zip(&view.detections).zip(rooms) {
                if let Outcome::Joined { entry, sighting, .. } | Outcome::New { entry, sighting } = outcome {
                    arrivals.push(Arrival {
                        number: *sighting,
                        entry: *entry,
                        detection,
                        view: view.id.as_ref(),
                        room: room.as_deref(),
                    });
                }
            }
            outcomes.push(seen);
        }
        self.put_views(views)?;
        let kept = self.persist(map, &arrivals)?;
        if let Some(latest) = arrivals.iter().map(|arrival| arrival.detection.at).max() {
            self.advance_clock(latest)?;
        }
        self.told(map, outcomes, &kept)
    }

    fn told(
        &self,
        map: &SemanticMap,
        outcomes: Vec<Vec<Outcome>>,
        kept: &Persisted,
    ) -> Result<Observations, StoreError> {
        let mut ids: HashMap<EntryId, ObjectId> = HashMap::new();
        let mut id_of = |entry: EntryId| {
            let entry = kept.final_entry(entry);
            if let Some(id) = ids.get(&entry) {
                return Ok::<_, StoreError>(id.clone());
            }
            let id = self.stored(object_key(entry))?.id;
            ids.insert(entry, id.clone());
            Ok(id)
        };
        let views =
            |entry: EntryId| map.state().entries.get(&kept.final_entry(entry)).map_or(0, Entry::views);
        let mut detections = Vec::with_capacity(outcomes.len());
        for outcomes in outcomes {
            let of_view = outcomes.into_iter().map(|outcome| {
                Ok::<_, StoreError>(match outcome {
                    Outcome::Refused(refusal) => Observed::Refused(refusal),
                    Outcome::Repeated { entry } => Observed::Repeated { object: id_of(entry)? },
                    Outcome::Joined { entry, divergence, .. } => Observed::Taken {
                        object: id_of(entry)?,
                        is_new: false,
                        divergence: Some(divergence),
                        views: views(entry),
                    },
                    Outcome::New { entry, .. } => Observed::Taken {
                        object: id_of(entry)?,
                        is_new: kept.created.contains(&entry),
                        divergence: None,
                        views: views(entry),
                    },
                })
            });
            detections.push(of_view.collect::<Result<_, _>>()?);
        }
        let mut moved = Vec::new();
        for change in &kept.history {
            if let Change::Moved(change) = change {
                let object = id_of(change.entry)?;
                moved.push(MovedObject { object, from: change.from, to: change.to, at: change.at });
            }
        }
        let mut perhaps_moved = Vec::new();
        for PerhapsMoved { newcomer, candidates } in map.perhaps_moved() {
            perhaps_moved.push(PerhapsMovedObject {
                object: id_of(newcomer)?,
                candidates: candidates.into_iter().map(&mut id_of).collect::<Result<_, _>>()?,
            });
        }
        Ok(Observations { detections, moved, perhaps_moved })
    }

    /// Writes down what has changed in the map and what it has changed by.
    fn persist(&self, map: &mut SemanticMap, arrivals: &[Arrival<'_>]) -> Result<Persisted, StoreError> {
        let news = map.news();
        let mut kept = Persisted { history: news.history, ..Persisted::default() };
        for change in &kept.history {
            match change {
                Change::Moved(moved) => kept.renamed.insert(moved.newcomer, moved.entry),
                Change::Merged { entry, other } => kept.renamed.insert(*other, *entry),
                Change::Split { .. } => None,
            };
        }
        for id in &news.changed {
            if let Some(entry) = map.state().entries.get(id)
                && self.put_entry(entry, map.state().undecided.contains(id))?
            {
                kept.created.insert(*id);
            }
        }
        for change in &kept.history {
            self.put_change(map, &kept, change)?;
        }
        self.put_sightings(&kept, arrivals)?;
        self.connection
            .prepare_cached(
                "UPDATE home SET map_revision = map_revision + 1, next_object = ?1, next_sighting = ?2",
            )?
            .execute((map.state().entries_so_far as i64, map.state().sightings_so_far as i64))?;
        Ok(kept)
    }

    /// Writes down a thing. Tells whether it is a new one.
    fn put_entry(&self, entry: &Entry, is_undecided: bool) -> Result<bool, StoreError> {
        let key = object_key(entry.id);
        let [x, y, z] = entry.place.position;
        let class = entry.class().map_or("thing", |class| class.as_str());
        let moved = self
            .connection
            .prepare_cached("UPDATE objects SET class = ?2, x = ?3, y = ?4, z = ?5 WHERE object_key = ?1")?
            .execute((key.0, class, x, y, z))?;
        let is_new = moved == 0;
        if is_new {
            self.connection
                .prepare_cached(
                    "INSERT INTO objects (object_key, id, class, x, y, z) VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                )?
                .execute((key.0, self.free_id(key)?, class, x, y, z))?;
        } else {
            self.keep_recorded_feature(key)?;
        }
        match entry.look.as_ref().and_then(Look::feature) {
            Some(feature) => self.put_feature(key, &feature)?,
            None => {
                self.connection
                    .prepare_cached("DELETE FROM features WHERE object_key = ?1")?
                    .execute([key.0])?;
            }
        }
        let look: Option<Vec<u8>> = entry
            .look
            .as_ref()
            .map(|look| look.sum().iter().flat_map(|component| component.to_le_bytes()).collect());
        self.connection
            .prepare_cached(
                "INSERT INTO map_entries
                     (object_key, weight, sightings, look, first_seen, last_seen, absences, undecided)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)
                 ON CONFLICT (object_key) DO UPDATE SET
                     weight = excluded.weight, sightings = excluded.sightings, look = excluded.look,
                     first_seen = excluded.first_seen, last_seen = excluded.last_seen,
                     absences = excluded.absences, undecided = excluded.undecided",
            )?
            .execute((
                key.0,
                entry.place.weight,
                entry.place.sightings as i64,
                look,
                milliseconds(entry.first_seen),
                milliseconds(entry.last_seen),
                entry.absences as i64,
                is_undecided,
            ))?;
        self.put_moves(key, entry)?;
        Ok(is_new)
    }

    fn put_moves(&self, key: ObjectKey, entry: &Entry) -> Result<(), StoreError> {
        self.connection.prepare_cached("DELETE FROM map_moves WHERE object_key = ?1")?.execute([key.0])?;
        for (number, moved) in entry.moves.iter().enumerate() {
            let [x, y, z] = moved.from;
            self.connection
                .prepare_cached(
                    "INSERT INTO map_moves (object_key, number, at, x, y, z) VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                )?
                .execute((key.0, number as i64, milliseconds(moved.at), x, y, z))?;
        }
        self.connection.prepare_cached("DELETE FROM told_apart WHERE object_key = ?1")?.execute([key.0])?;
        for other in &entry.told_apart {
            self.connection
                .prepare_cached("INSERT INTO told_apart (object_key, other_key) VALUES (?1, ?2)")?
                .execute((key.0, object_key(*other).0))?;
        }
        Ok(())
    }

    /// An id that no thing has or had.
    fn free_id(&self, key: ObjectKey) -> Result<String, StoreError> {
        let number = key.0;
        let mut id = format!("thing-{number}");
        let mut further = 1;
        while self.object_key(&id)?.is_some() {
            further += 1;
            id = format!("thing-{number}-{further}");
        }
        Ok(id)
    }

    fn put_change(&self, map: &SemanticMap, kept: &Persisted, change: &Change) -> Result<(), StoreError> {
        let (kind, entry, other, at) = match change {
            Change::Moved(moved) => (ChangeKind::Moved, moved.entry, moved.newcomer, Some(moved.at)),
            Change::Merged { entry, other } => (ChangeKind::Merged, *entry, *other, None),
            Change::Split { entry, into, .. } => (ChangeKind::Split, *entry, *into, None),
        };
        let entry = kept.final_entry(entry);
        let key = object_key(entry);
        let at = at.or_else(|| map.state().entries.get(&entry).map(|entry| entry.last_seen));
        let other_key = object_key(other);
        let id: Option<String> = self
            .connection
            .prepare_cached("SELECT id FROM objects WHERE object_key = ?1")?
            .query_row([other_key.0], |row| row.get(0))
            .optional()?;
        // A thing that was made and recognised by the same views never had an id.
        let Some(id) = id else { return Ok(()) };
        if let Change::Split { sightings, .. } = change {
            for number in sightings {
                self.connection
                    .prepare_cached(
                        "UPDATE sightings SET object_key = ?2 WHERE object_key = ?1 AND sighting = ?3",
                    )?
                    .execute((key.0, other_key.0, number.0 as i64))?;
            }
        } else {
            if kind == ChangeKind::Moved {
                self.connection
                    .prepare_cached(
                        "UPDATE objects SET room = (SELECT room FROM objects WHERE object_key = ?1) WHERE object_key = ?2",
                    )?
                    .execute((other_key.0, key.0))?;
            }
            self.absorb(other_key, key, &id)?;
        }
        self.connection
            .prepare_cached("INSERT INTO map_changes (object_key, kind, other, at) VALUES (?1, ?2, ?3, ?4)")?
            .execute((key.0, kind.as_str(), id, at.map_or(0, milliseconds)))?;
        Ok(())
    }

    fn put_views(&self, views: &[ViewInRooms]) -> Result<(), StoreError> {
        for id in views.iter().filter_map(|view| view.view.id.as_ref()) {
            self.connection
                .prepare_cached("INSERT INTO views (view) VALUES (?1) ON CONFLICT DO NOTHING")?
                .execute([&id.0])?;
        }
        Ok(())
    }

    fn put_sightings(&self, kept: &Persisted, arrivals: &[Arrival<'_>]) -> Result<(), StoreError> {
        let mut keys: HashMap<&ViewId, i64> = HashMap::new();
        // In the order of the table, insertions walk along its leaves instead of jumping from one to another.
        let mut order: Vec<(ObjectKey, &Arrival<'_>)> =
            arrivals.iter().map(|arrival| (object_key(kept.final_entry(arrival.entry)), arrival)).collect();
        order.sort_by_key(|(key, arrival)| (*key, arrival.number));
        for (key, arrival) in order {
            let view = match arrival.view {
                Some(view) => Some(match keys.get(view) {
                    Some(key) => *key,
                    None => {
                        let found: i64 = self
                            .connection
                            .prepare_cached("SELECT view_key FROM views WHERE view = ?1")?
                            .query_row([&view.0], |row| row.get(0))?;
                        keys.insert(view, found);
                        found
                    }
                }),
                None => None,
            };
            let Detection { class, position: [x, y, z], radius, at, .. } = arrival.detection;
            self.connection
                .prepare_cached(
                    "INSERT INTO sightings (object_key, sighting, class, x, y, z, radius, at, view_key, recorded)
                     VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, 0)",
                )?
                .execute((
                    key.0,
                    arrival.number.0 as i64,
                    class.as_str(),
                    x,
                    y,
                    z,
                    radius,
                    milliseconds(*at),
                    view,
                ))?;
            if let Some(room) = arrival.room {
                self.connection
                    .prepare_cached("UPDATE objects SET room = ?2 WHERE object_key = ?1")?
                    .execute((key.0, room))?;
            }
        }
        // Numbers grow as detections arrive, so that this table grows at its end.
        for arrival in arrivals {
            if let Some(feature) = &arrival.detection.feature {
                self.connection
                    .prepare_cached("INSERT INTO sighting_features (sighting, vector) VALUES (?1, ?2)")?
                    .execute((arrival.number.0 as i64, to_bytes(feature)))?;
            }
        }
        Ok(())
    }

    /// Keeps the feature of a thing of which nothing is known but what was recorded, before it is fused with others.
    pub(super) fn keep_recorded_feature(&self, key: ObjectKey) -> Result<(), StoreError> {
        self.connection
            .prepare_cached(
                "INSERT INTO sighting_features (sighting, vector)
                 SELECT sighting, vector FROM sightings JOIN features USING (object_key)
                 WHERE object_key = ?1 AND recorded
                     AND NOT EXISTS (SELECT 1 FROM map_entries WHERE map_entries.object_key = ?1)
                 ON CONFLICT DO NOTHING",
            )?
            .execute([key.0])?;
        Ok(())
    }
}

/// What was written down.
#[derive(Debug, Default)]
struct Persisted {
    history: Vec<Change>,
    /// What entries that are no more have become parts of.
    renamed: BTreeMap<EntryId, EntryId>,
    /// Things that were not there before.
    created: BTreeSet<EntryId>,
}

impl Persisted {
    /// The entry that one has become.
    fn final_entry(&self, mut entry: EntryId) -> EntryId {
        while let Some(next) = self.renamed.get(&entry) {
            entry = *next;
        }
        entry
    }
}
