//! The approximate index of looks: they are parted into lists of what looks alike, and a search measures only what is in
//! the lists that are nearest, by codes of 8 bits; the best of that are measured by their features.
//!
//! All of it stands in the database, so that every process has it and starting takes no time. The index tells what was
//! so at its revision; what has changed since is measured beside it. It finds nearly always the same as a look at
//! everything; see `docs/scale.md`.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use coin::similarity::{Probe, QUICK_ERROR, Shortlist, quick_cosine};
use coin_schemas::episode::FEATURE_DIMENSIONS;
use rusqlite::OptionalExtension;

use super::looks::OtherLook;
use super::map::{ObjectKey, from_bytes};
use super::{Reader, StoreError};

/// How long a code is: the key, the size of a step, and the steps.
pub(super) const CODE_BYTES: usize = 8 + 4 + FEATURE_DIMENSIONS;

/// So many codes are measured at least, list by list, the nearest first.
const CODES_A_SEARCH: usize = 2048;

/// So many looks are measured by their features at least, and so many times as many as are asked for.
const MEASURED: usize = 64;
const MEASURED_FOR_EACH: usize = 4;

/// What the database says of the index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LookIndex {
    /// Tells one index from another.
    pub(super) generation: i64,
    /// The features that it was last brought in step with.
    pub(super) revision: i64,
    /// How many looks the lists were made from.
    pub(super) trained_on: i64,
}

/// The middles of the lists, one after the other.
#[derive(Debug, Default)]
pub(super) struct Lists {
    numbers: Vec<i64>,
    components: Vec<f32>,
}

/// The middles of the index that was last searched.
#[derive(Debug, Default)]
pub(super) struct KeptLists {
    kept: Mutex<Option<(i64, Arc<Lists>)>>,
}

impl Lists {
    /// The numbers of all lists, the most similar first.
    fn nearest_first(&self, look: &[f32]) -> Vec<i64> {
        let middles = self.components.chunks_exact(FEATURE_DIMENSIONS);
        let mut scored: Vec<(f32, i64)> = middles
            .zip(&self.numbers)
            .map(|(middle, &number)| (quick_cosine(look, middle), number))
            .collect();
        scored.sort_unstable_by(|left, right| right.0.total_cmp(&left.0));
        scored.into_iter().map(|(_, number)| number).collect()
    }

    /// The number of the most similar list.
    pub(super) fn nearest(&self, look: &[f32]) -> Option<i64> {
        let middles = self.components.chunks_exact(FEATURE_DIMENSIONS);
        coin::similarity::nearest(look, middles).map(|place| self.numbers[place])
    }
}

/// A code, as it stands in a pack.
pub(super) struct StoredCode<'a> {
    pub(super) object: ObjectKey,
    step: f32,
    steps: &'a [u8],
}

/// The codes of a pack.
pub(super) fn codes_in(pack: &[u8]) -> impl Iterator<Item = StoredCode<'_>> {
    pack.as_chunks::<CODE_BYTES>().0.iter().filter_map(|code| {
        let (key, rest) = code.split_first_chunk::<8>()?;
        let (step, steps) = rest.split_first_chunk::<4>()?;
        let object = ObjectKey(i64::from_le_bytes(*key));
        Some(StoredCode { object, step: f32::from_le_bytes(*step), steps })
    })
}

impl Reader<'_> {
    /// The index, where there is one.
    pub(super) fn look_index(&self) -> Result<Option<LookIndex>, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT generation, revision, trained_on FROM look_index")?;
        let index = statement.query_row([], |row| {
            Ok(LookIndex { generation: row.get(0)?, revision: row.get(1)?, trained_on: row.get(2)? })
        });
        Ok(index.optional()?)
    }

    /// The middles of the lists of an index that the transaction sees.
    pub(super) fn lists(&self, index: LookIndex) -> Result<Arc<Lists>, StoreError> {
        let mut kept = self.looks.lists.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((generation, lists)) = kept.as_ref()
            && *generation == index.generation
        {
            return Ok(Arc::clone(lists));
        }
        let mut lists = Lists::default();
        let mut statement = self.connection.prepare_cached("SELECT list, middle FROM look_lists")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let middle =
                row.get_ref(1)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
            lists.numbers.push(row.get(0)?);
            lists.components.extend(from_bytes(middle));
        }
        if lists.components.len() != lists.numbers.len() * FEATURE_DIMENSIONS {
            return Err(StoreError::damaged("the index of looks has lists of another dimension".to_owned()));
        }
        let lists = Arc::new(lists);
        *kept = Some((index.generation, Arc::clone(&lists)));
        Ok(lists)
    }

    /// Looks that are nearly always the `k` most similar ones, and some more.
    pub(super) fn nearly_alike(
        &self,
        index: LookIndex,
        object: ObjectKey,
        look: &[f32],
        k: usize,
    ) -> Result<Vec<OtherLook>, StoreError> {
        let changed = self.features_changed_since(index.revision)?;
        let mut without: BTreeSet<ObjectKey> = changed.iter().copied().collect();
        without.insert(object);
        let mut measured: BTreeSet<ObjectKey> =
            changed.into_iter().filter(|other| *other != object).collect();
        measured.extend(self.nearest_codes(index, look, k, &without)?);
        let mut best = Shortlist::new(k, QUICK_ERROR);
        for other in measured {
            // A code may be that of a feature that is gone.
            if let Some(its_look) = self.look(other)? {
                best.offer(quick_cosine(look, &its_look), (other, its_look));
            }
        }
        Ok(best.into_items())
    }

    /// Whose codes are the most similar ones.
    fn nearest_codes(
        &self,
        index: LookIndex,
        look: &[f32],
        k: usize,
        without: &BTreeSet<ObjectKey>,
    ) -> Result<Vec<ObjectKey>, StoreError> {
        let probe = Probe::of(look);
        let mut nearest = Shortlist::new(MEASURED.max(MEASURED_FOR_EACH * k), 0.0);
        let (mut codes, mut kept) = (0, 0);
        let mut statement = self.connection.prepare_cached("SELECT codes FROM look_codes WHERE list = ?1")?;
        for list in self.lists(index)?.nearest_first(look) {
            if codes >= CODES_A_SEARCH && kept >= k {
                break;
            }
            self.go_on()?;
            let mut rows = statement.query([list])?;
            while let Some(row) = rows.next()? {
                let pack =
                    row.get_ref(0)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
                for code in codes_in(pack) {
                    codes += 1;
                    let score = probe.cosine(code.step, code.steps);
                    if nearest.admits(score) && !without.contains(&code.object) {
                        nearest.offer(score, code.object);
                        kept += 1;
                    }
                }
            }
        }
        Ok(nearest.into_items())
    }
}
