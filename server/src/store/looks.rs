//! What things look like, kept in memory so that looking for what looks alike reads the database only for what has
//! changed.
//!
//! The features stand in the table `features`; triggers note every change of it, whichever process makes it, under a
//! revision that grows. [`KeptLooks`] holds the features as they were at one revision. A transaction that sees another
//! one (an older one, because it began before others looked, or a newer one, because it has written itself) reads what
//! differs and looks at it beside the rest. What is written is seen by others only after it was committed, so that only
//! those who do not write bring the kept looks up to date.

use std::collections::{BTreeSet, HashMap};
use std::sync::atomic::{AtomicI64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use coin::similarity::{QUICK_ERROR, SIDE_BY_SIDE, Shortlist, normalise, quick_cosine, quick_cosines};
use coin_schemas::episode::FEATURE_DIMENSIONS;

use super::lists::KeptLists;
use super::map::{ObjectKey, StoredObject, from_bytes};
use super::{Reader, Sight, StoreError};

/// How many looks stand together, half a megabyte. A change copies as many where somebody is looking at them.
const LOOKS_A_BLOCK: usize = 256;

/// From so many blocks on, several threads look through them; below, starting one takes longer than it saves.
const BLOCKS_FOR_THREADS: usize = 8;

/// The most threads that look for one call. The memory feeds no more.
const THREADS: usize = 4;

/// What looks like a thing.
#[derive(Debug)]
pub(crate) enum Alike {
    /// The thing itself was never seen.
    NeverSeen,
    /// The look of the thing, and others among which the most similar ones are.
    Found { look: Vec<f32>, others: Vec<Look> },
}

/// A thing and what it looks like: a feature of length 1.
#[derive(Debug)]
pub(crate) struct Look {
    pub(crate) object: StoredObject,
    pub(crate) look: Vec<f32>,
}

/// The looks of all things as they were at one revision, shared by the connections of a store.
#[derive(Debug, Default)]
pub(super) struct KeptLooks {
    kept: Mutex<Kept>,
    pub(super) lists: KeptLists,
    /// At which revision of the features the index is looked after next.
    pub(super) index_due: AtomicI64,
}

/// The looks, and what is needed to change them.
#[derive(Debug, Default)]
struct Kept {
    looks: Arc<Looks>,
    slots: HashMap<ObjectKey, Slot>,
    free: Vec<Slot>,
}

/// The looks at one revision.
#[derive(Debug, Default, Clone)]
struct Looks {
    revision: i64,
    blocks: Vec<Arc<Block>>,
    /// Which looks went, and at which revision that was noticed.
    gone: Vec<(i64, ObjectKey)>,
}

/// Some looks, one after the other.
#[derive(Debug, Default, Clone)]
struct Block {
    owners: Vec<Option<Owner>>,
    components: Vec<f32>,
}

/// Whose look stands in a slot.
#[derive(Debug, Clone, Copy)]
struct Owner {
    object: ObjectKey,
    /// When the look was last found to have changed.
    revision: i64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Slot {
    block: usize,
    place: usize,
}

impl Block {
    fn look(&self, place: usize) -> &[f32] {
        &self.components[place * FEATURE_DIMENSIONS..(place + 1) * FEATURE_DIMENSIONS]
    }
}

/// Another thing that may look like a thing, and its look.
pub(super) type OtherLook = (ObjectKey, Vec<f32>);

/// A change of a look: what it is now, or that there is none.
type Change = (ObjectKey, Option<Vec<f32>>);

impl Kept {
    /// Makes the looks those of a later revision.
    fn advance(&mut self, revision: i64, changes: Vec<Change>) {
        for (object, look) in changes {
            match (self.slots.get(&object).copied(), look) {
                (Some(slot), Some(look)) => self.put(slot, Owner { object, revision }, &look),
                (None, Some(look)) => {
                    let slot = self.free.pop().unwrap_or_else(|| self.new_slot());
                    self.put(slot, Owner { object, revision }, &look);
                    self.slots.insert(object, slot);
                }
                (Some(slot), None) => {
                    let looks = Arc::make_mut(&mut self.looks);
                    Arc::make_mut(&mut looks.blocks[slot.block]).owners[slot.place] = None;
                    looks.gone.push((revision, object));
                    self.slots.remove(&object);
                    self.free.push(slot);
                }
                // Who sees an earlier revision may still see it.
                (None, None) => Arc::make_mut(&mut self.looks).gone.push((revision, object)),
            }
        }
        Arc::make_mut(&mut self.looks).revision = revision;
    }

    fn new_slot(&mut self) -> Slot {
        let blocks = &mut Arc::make_mut(&mut self.looks).blocks;
        if blocks.last().is_none_or(|block| block.owners.len() == LOOKS_A_BLOCK) {
            blocks.push(Arc::default());
        }
        let last = blocks.len() - 1;
        let block = Arc::make_mut(&mut blocks[last]);
        block.owners.push(None);
        block.components.resize(block.owners.len() * FEATURE_DIMENSIONS, 0.0);
        Slot { block: last, place: block.owners.len() - 1 }
    }

    fn put(&mut self, slot: Slot, owner: Owner, look: &[f32]) {
        let block = Arc::make_mut(&mut Arc::make_mut(&mut self.looks).blocks[slot.block]);
        block.owners[slot.place] = Some(owner);
        block.components[slot.place * FEATURE_DIMENSIONS..(slot.place + 1) * FEATURE_DIMENSIONS]
            .copy_from_slice(look);
    }
}

impl Looks {
    /// Whose looks are others now than they were at an earlier revision.
    fn changed_since(&self, revision: i64) -> BTreeSet<ObjectKey> {
        let owners = self.blocks.iter().flat_map(|block| block.owners.iter().flatten());
        let changed = owners.filter(|owner| owner.revision > revision).map(|owner| owner.object);
        let gone = self.gone.iter().filter(|(at, _)| *at > revision).map(|(_, object)| *object);
        changed.chain(gone).collect()
    }

    /// The looks that may be among the `k` most similar ones, but for those that are not to be looked at.
    fn shortlist(&self, target: &[f32], k: usize, without: &BTreeSet<ObjectKey>) -> Shortlist<Slot> {
        let threads = if self.blocks.len() < BLOCKS_FOR_THREADS {
            1
        } else {
            thread::available_parallelism().map_or(1, usize::from).min(THREADS)
        };
        // Whoever has looked through a block takes the next one, so that nobody waits for a thread that is held up.
        let next = AtomicUsize::new(0);
        let look = || {
            let mut list = Shortlist::new(k, QUICK_ERROR);
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(block) = self.blocks.get(number) else { return list };
                look_through(block, number, target, without, &mut list);
            }
        };
        thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(look)).collect();
            let mut whole = look();
            for other in others {
                match other.join() {
                    Ok(list) => whole.join(list),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            whole
        })
    }
}

fn look_through(
    block: &Block,
    number: usize,
    target: &[f32],
    without: &BTreeSet<ObjectKey>,
    list: &mut Shortlist<Slot>,
) {
    let mut offer = |place: usize, score: f32| {
        let owner = block.owners[place];
        if list.admits(score) && owner.is_some_and(|owner| !without.contains(&owner.object)) {
            list.offer(score, Slot { block: number, place });
        }
    };
    // Looks that are measured together stand a part of the block apart, so that their memory is read side by side.
    let apart = block.owners.len() / SIDE_BY_SIDE;
    for first in 0..apart {
        let places: [usize; SIDE_BY_SIDE] = std::array::from_fn(|part| first + part * apart);
        let scores = quick_cosines(target, places.map(|place| block.look(place)));
        places.into_iter().zip(scores).for_each(|(place, score)| offer(place, score));
    }
    for place in apart * SIDE_BY_SIDE..block.owners.len() {
        offer(place, quick_cosine(target, block.look(place)));
    }
}

/// The looks that one transaction sees: those that are kept, and what differs from them.
#[derive(Debug)]
struct SeenLooks {
    kept: Arc<Looks>,
    different: Vec<Change>,
}

impl Reader<'_> {
    /// The look of a thing; `None` where it was never seen.
    pub(super) fn look(&self, object: ObjectKey) -> Result<Option<Vec<f32>>, StoreError> {
        Ok(self.feature(object)?.and_then(|feature| normalise(&feature)))
    }

    /// The looks that may be the `k` most similar ones to that of a thing.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn alike(&self, object: ObjectKey, k: usize) -> Result<Alike, StoreError> {
        let Some(look) = self.look(object)? else {
            return Ok(Alike::NeverSeen);
        };
        let others = match self.look_index()? {
            Some(index) => self.nearly_alike(index, object, &look, k)?,
            None => self.exactly_alike(object, &look, k)?,
        };
        let mut others = others
            .into_iter()
            .map(|(object, look)| Ok(Look { object: self.stored(object)?, look }))
            .collect::<Result<Vec<_>, StoreError>>()?;
        others.sort_by(|left, right| left.object.id.cmp(&right.object.id));
        Ok(Alike::Found { look, others })
    }

    fn exactly_alike(&self, object: ObjectKey, look: &[f32], k: usize) -> Result<Vec<OtherLook>, StoreError> {
        let seen = self.seen_looks()?;
        let mut without: BTreeSet<ObjectKey> = seen.different.iter().map(|(object, _)| *object).collect();
        without.insert(object);
        let slots = seen.kept.shortlist(look, k, &without).into_items();
        let kept = slots.into_iter().filter_map(|slot| {
            let block = &seen.kept.blocks[slot.block];
            block.owners[slot.place].map(|owner| (owner.object, block.look(slot.place).to_vec()))
        });
        let mut found: Vec<_> = kept.collect();
        let different = seen.different.into_iter().filter(|(other, _)| *other != object);
        found.extend(different.filter_map(|(object, look)| Some((object, look?))));
        Ok(found)
    }

    /// The last revision of the features.
    pub(super) fn feature_revision(&self) -> Result<i64, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT max(revision) FROM feature_changes")?;
        Ok(statement.query_row([], |row| row.get::<_, Option<i64>>(0))?.unwrap_or(0))
    }

    /// Whose features have changed after a revision.
    pub(super) fn features_changed_since(&self, revision: i64) -> Result<Vec<ObjectKey>, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT object_key FROM feature_changes WHERE revision > ?1")?;
        let keys = statement.query_map([revision], |row| Ok(ObjectKey(row.get(0)?)))?;
        Ok(keys.collect::<Result<_, _>>()?)
    }

    pub(super) fn changes_of(
        &self,
        objects: impl IntoIterator<Item = ObjectKey>,
    ) -> Result<Vec<Change>, StoreError> {
        objects
            .into_iter()
            .map(|object| {
                self.go_on()?;
                Ok((object, self.look(object)?))
            })
            .collect()
    }

    /// The looks of all things that ever had a feature.
    fn all_looks(&self) -> Result<Vec<Change>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, vector FROM feature_changes LEFT JOIN features USING (object_key)
             ORDER BY object_key",
        )?;
        let mut rows = statement.query([])?;
        let mut looks = Vec::new();
        while let Some(row) = rows.next()? {
            let vector = row.get_ref(1)?.as_blob_or_null();
            let vector = vector.map_err(|source| StoreError::damaged(source.to_string()))?;
            looks.push((ObjectKey(row.get(0)?), vector.and_then(|vector| normalise(&from_bytes(vector)))));
        }
        Ok(looks)
    }

    fn seen_looks(&self) -> Result<SeenLooks, StoreError> {
        let revision = self.feature_revision()?;
        let kept = {
            let mut kept = self.looks.kept.lock().unwrap_or_else(PoisonError::into_inner);
            if self.sight == Sight::Committed && kept.looks.revision < revision {
                // What is read may fail; nothing is changed before all of it is here.
                let changes = match kept.looks.revision {
                    0 => self.all_looks()?,
                    known => self.changes_of(self.features_changed_since(known)?)?,
                };
                kept.advance(revision, changes);
            }
            Arc::clone(&kept.looks)
        };
        let different = match kept.revision {
            known if known < revision => self.changes_of(self.features_changed_since(known)?)?,
            known if known > revision => self.changes_of(kept.changed_since(revision))?,
            _ => Vec::new(),
        };
        Ok(SeenLooks { kept, different })
    }
}
