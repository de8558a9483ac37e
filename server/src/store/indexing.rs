//! Keeping the approximate index of looks in step.
//!
//! After a change was committed, whoever made it looks whether the index is due. Up to [`EXACT`] features there is none.
//! Beyond, it is made; from then on a few dozen changes at a time are entered into it, and when there are
//! [`GROWTH`] times as many features as it was made from, it is made anew. Making it reads one state of the home and
//! holds up nobody; what changes meanwhile is found beside it, as ever, until it is entered.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::Ordering;
use std::thread;

use coin::similarity::{Code, middles, nearest, normalise, quick_cosine};

use super::lists::{CODE_BYTES, LookIndex, codes_in};
use super::map::{ObjectKey, from_bytes};
use super::{Reader, Store, StoreError, Writer};

/// Up to so many features are all looked at.
const EXACT: i64 = 100_000;

/// So many changes are entered at once; as many are looked at beside the index.
const CHANGES: i64 = 64;

/// How many times as many features as before are worth a new index.
const GROWTH: i64 = 4;

/// The square root of the number of features, so many times, is the number of lists.
const LISTS: f64 = 4.0;

/// So many features of each list are the sample that it is found from.
const SAMPLE: usize = 32;

/// So many features of each group of lists are enough to find the group.
const GROUP_SAMPLE: usize = 128;

/// In so many groups the list of a feature is sought.
const GROUPS_SOUGHT: usize = 3;

/// So many codes stand in one row.
const CODES_A_PACK: usize = 128;

/// So many features are read before several threads find their lists.
const BATCH: usize = 4096;

/// What became of the index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LookIndexing {
    /// So few features need none, or it is in step.
    Nothing,
    /// So many changes were entered.
    Entered(usize),
    /// It was made of so many features.
    Made(usize),
}

impl Store {
    /// Makes the index of looks where there are so many that it pays, or brings it in step with what has changed. It is
    /// done after changes by itself; nobody has to call this.
    ///
    /// # Errors
    /// Failures of the database.
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the methods' paths are not general enough"
    )]
    pub fn index_looks(&self) -> Result<LookIndexing, StoreError> {
        match self.read(|reader| reader.task())? {
            Task::Nothing { due } => {
                self.looks.index_due.store(due, Ordering::Relaxed);
                Ok(LookIndexing::Nothing)
            }
            Task::Enter => self.change(|writer| writer.enter_changes()).map(LookIndexing::Entered),
            Task::Make { features } => {
                tracing::info!("the index of {features} looks is made");
                self.make_index(features).map(LookIndexing::Made)
            }
        }
    }

    pub(super) fn make_index(&self, features: i64) -> Result<usize, StoreError> {
        let made = self.read(|reader| NewIndex::make(reader, features))?;
        self.change(|writer| writer.put_index(&made))?;
        Ok(made.codes)
    }

    /// Looks after the index where the features came to a revision at which that is due. The change that brought them
    /// there was committed, so that a failure is no failure of it, and the next change tries again.
    pub(super) fn look_after_index(&self, revision: i64) {
        if revision < self.looks.index_due.load(Ordering::Relaxed) {
            return;
        }
        if let Err(source) = self.index_looks() {
            tracing::warn!("the index of looks was not brought in step: {source}");
        }
    }
}

/// What there is to do.
enum Task {
    /// Nothing, before the features come to this revision.
    Nothing { due: i64 },
    /// Changes are to be entered.
    Enter,
    /// An index of so many features is to be made.
    Make { features: i64 },
}

impl Reader<'_> {
    fn task(&self) -> Result<Task, StoreError> {
        let revision = self.feature_revision()?;
        let index = self.look_index()?;
        if let Some(index) = index
            && revision < index.revision + CHANGES
        {
            return Ok(Task::Nothing { due: index.revision + CHANGES });
        }
        // It has a row for each feature, and narrow ones.
        let features: i64 =
            self.connection.query_row("SELECT count(*) FROM feature_changes", [], |row| row.get(0))?;
        let enough = index.map_or(EXACT + 1, |index| index.trained_on * GROWTH);
        Ok(match index {
            _ if features >= enough => Task::Make { features },
            Some(_) => Task::Enter,
            None => Task::Nothing { due: revision + enough - features },
        })
    }

    fn each_look(
        &self,
        mut take: impl FnMut(ObjectKey, Vec<f32>) -> Result<(), StoreError>,
    ) -> Result<(), StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT object_key, vector FROM features")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let blob = row.get_ref(1)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
            if let Some(look) = normalise(&from_bytes(blob)) {
                take(ObjectKey(row.get(0)?), look)?;
            }
        }
        Ok(())
    }

    /// So many looks in an order that has nothing to do with theirs.
    fn sample(&self, count: usize) -> Result<Vec<Vec<f32>>, StoreError> {
        let mut keys = self.features_changed_since(0)?;
        keys.sort_unstable_by_key(|key| scattered(key.0));
        let mut looks = Vec::new();
        for key in keys {
            if looks.len() == count {
                break;
            }
            self.go_on()?;
            looks.extend(self.look(key)?);
        }
        Ok(looks)
    }
}

/// A number that looks random (SplitMix64; Steele, Lea and Flood 2014).
fn scattered(number: i64) -> u64 {
    let mut mixed = number.cast_unsigned().wrapping_add(0x9E37_79B9_7F4A_7C15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

/// An index that is not in the database yet.
struct NewIndex {
    index: LookIndex,
    groups: Vec<Group>,
    /// The codes of each list.
    lists: Vec<Vec<u8>>,
    codes: usize,
}

/// Lists that are near to each other.
struct Group {
    middle: Vec<f32>,
    /// The number of the first list.
    first: usize,
    lists: Vec<Vec<f32>>,
}

impl NewIndex {
    fn make(reader: &Reader<'_>, features: i64) -> Result<Self, StoreError> {
        let generation = i64::from_le_bytes(random()?);
        let index = LookIndex { generation, revision: reader.feature_revision()?, trained_on: features };
        let lists = (LISTS * (features as f64).sqrt()).ceil() as usize;
        let groups = grouped(&reader.sample(lists * SAMPLE)?, lists, reader)?;
        let count = groups.iter().map(|group| group.lists.len()).sum();
        let mut new = Self { index, groups, lists: vec![Vec::new(); count], codes: 0 };
        let mut batch = Vec::with_capacity(BATCH);
        reader.each_look(|object, look| {
            batch.push((object, look));
            if batch.len() == BATCH {
                reader.go_on()?;
                new.file(&batch);
                batch.clear();
            }
            Ok(())
        })?;
        new.file(&batch);
        Ok(new)
    }

    /// Puts looks into their lists.
    fn file(&mut self, looks: &[(ObjectKey, Vec<f32>)]) {
        let groups = &self.groups;
        let code = |(object, look): &(ObjectKey, Vec<f32>)| (list_of(groups, look), code_of(*object, look));
        for (list, code) in in_parallel(looks, code) {
            self.lists[list].extend_from_slice(&code);
            self.codes += 1;
        }
    }
}

/// The lists of a sample, in groups: looking for a list among groups first takes a fraction of the time.
fn grouped(sample: &[Vec<f32>], lists: usize, reader: &Reader<'_>) -> Result<Vec<Group>, StoreError> {
    let count = (lists as f64).sqrt().round() as usize;
    let group_middles = middles(&sample[..sample.len().min(count * GROUP_SAMPLE)], count);
    let mut members: Vec<Vec<&[f32]>> = vec![Vec::new(); group_middles.len()];
    let place = |look: &Vec<f32>| nearest(look, group_middles.iter().map(Vec::as_slice));
    for (look, group) in sample.iter().zip(in_parallel(sample, place)) {
        if let Some(group) = group {
            members[group].push(look);
        }
    }
    reader.go_on()?;
    let parted = in_parallel(&members, |members| {
        middles(members, (members.len() * lists).div_ceil(sample.len().max(1)))
    });
    let mut first = 0;
    let mut groups = Vec::with_capacity(parted.len());
    for (middle, lists) in group_middles.into_iter().zip(parted) {
        let count = lists.len();
        groups.push(Group { middle, first, lists });
        first += count;
    }
    groups.retain(|group| !group.lists.is_empty());
    Ok(groups)
}

/// The list that a look belongs to.
fn list_of(groups: &[Group], look: &[f32]) -> usize {
    let mut by_similarity: Vec<(f32, &Group)> =
        groups.iter().map(|group| (quick_cosine(look, &group.middle), group)).collect();
    by_similarity.sort_unstable_by(|left, right| right.0.total_cmp(&left.0));
    by_similarity.truncate(GROUPS_SOUGHT);
    let numbered = by_similarity.iter().flat_map(|(_, group)| (group.first..).zip(&group.lists));
    let (numbers, lists): (Vec<usize>, Vec<&[f32]>) =
        numbered.map(|(number, list)| (number, list.as_slice())).unzip();
    nearest(look, lists).map_or(0, |place| numbers[place])
}

/// The results of work on each item, in order; two threads or more do it.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let share = items.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let work = &work;
        let parts: Vec<_> = items
            .chunks(share)
            .map(|part| scope.spawn(move || part.iter().map(work).collect::<Vec<R>>()))
            .collect();
        let results = parts.into_iter().flat_map(|part| match part.join() {
            Ok(results) => results,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        results.collect()
    })
}

fn code_of(object: ObjectKey, look: &[f32]) -> Vec<u8> {
    let code = Code::of(look);
    let mut bytes = Vec::with_capacity(CODE_BYTES);
    bytes.extend(object.0.to_le_bytes());
    bytes.extend(code.step.to_le_bytes());
    bytes.extend(code.steps.iter().map(|step| step.cast_unsigned()));
    bytes
}

fn random() -> Result<[u8; 8], StoreError> {
    let mut bytes = [0; 8];
    getrandom::fill(&mut bytes).map_err(|source| StoreError::damaged(source.to_string()))?;
    Ok(bytes)
}

impl Writer<'_> {
    fn put_index(&self, new: &NewIndex) -> Result<(), StoreError> {
        // Without lists there would be nowhere to enter anything.
        if new.lists.is_empty() {
            return Ok(());
        }
        self.connection
            .execute_batch("DELETE FROM look_codes; DELETE FROM look_lists; DELETE FROM look_index;")?;
        let middles = new.groups.iter().flat_map(|group| &group.lists);
        for ((list, middle), codes) in (0_i64..).zip(middles).zip(&new.lists) {
            let bytes: Vec<u8> = middle.iter().flat_map(|component| component.to_le_bytes()).collect();
            self.connection
                .prepare_cached("INSERT INTO look_lists (list, middle) VALUES (?1, ?2)")?
                .execute((list, bytes))?;
            for (number, pack) in (0_i64..).zip(codes.chunks(CODES_A_PACK * CODE_BYTES)) {
                self.put_pack(list, number, pack)?;
            }
        }
        self.connection.execute(
            "INSERT INTO look_index (id, generation, revision, trained_on) VALUES (1, ?1, ?2, ?3)",
            (new.index.generation, new.index.revision, new.index.trained_on),
        )?;
        Ok(())
    }

    fn put_pack(&self, list: i64, number: i64, codes: &[u8]) -> Result<(), StoreError> {
        self.connection
            .prepare_cached(
                "INSERT INTO look_codes (list, pack, codes) VALUES (?1, ?2, ?3)
                 ON CONFLICT (list, pack) DO UPDATE SET codes = excluded.codes",
            )?
            .execute((list, number, codes))?;
        Ok(())
    }

    /// Enters into the index what has changed since its revision; how many changes that were.
    pub(super) fn enter_changes(&self) -> Result<usize, StoreError> {
        let Some(index) = self.look_index()? else {
            return Ok(0);
        };
        let revision = self.feature_revision()?;
        let lists = self.lists(index)?;
        let changes = self.changes_of(self.features_changed_since(index.revision)?)?;
        let count = changes.len();
        let mut by_list: BTreeMap<i64, Vec<(ObjectKey, Vec<f32>)>> = BTreeMap::new();
        for (object, look) in changes {
            // What is gone leaves its code behind, which a search passes over.
            if let Some((list, look)) = look.and_then(|look| Some((lists.nearest(&look)?, look))) {
                by_list.entry(list).or_default().push((object, look));
            }
        }
        for (list, looks) in by_list {
            self.go_on()?;
            self.enter(list, &looks)?;
        }
        self.connection.execute("UPDATE look_index SET revision = ?1", [revision])?;
        Ok(count)
    }

    /// Enters looks into a list, in the place of codes that it has of the same things.
    fn enter(&self, list: i64, looks: &[(ObjectKey, Vec<f32>)]) -> Result<(), StoreError> {
        let entered: BTreeSet<ObjectKey> = looks.iter().map(|(object, _)| *object).collect();
        let mut changed: BTreeMap<i64, Vec<u8>> = BTreeMap::new();
        let (mut last, mut open) = (0, Vec::new());
        let mut statement = self
            .connection
            .prepare_cached("SELECT pack, codes FROM look_codes WHERE list = ?1 ORDER BY pack")?;
        let mut rows = statement.query([list])?;
        while let Some(row) = rows.next()? {
            let pack = row.get_ref(1)?.as_blob().map_err(|source| StoreError::damaged(source.to_string()))?;
            (last, open) = (row.get(0)?, Vec::with_capacity(pack.len()));
            for (code, bytes) in codes_in(pack).zip(pack.chunks_exact(CODE_BYTES)) {
                if !entered.contains(&code.object) {
                    open.extend_from_slice(bytes);
                }
            }
            if open.len() < pack.len() {
                changed.insert(last, open.clone());
            }
        }
        drop(rows);
        for (object, look) in looks {
            open.extend(code_of(*object, look));
        }
        changed.extend((last..).zip(open.chunks(CODES_A_PACK * CODE_BYTES).map(<[u8]>::to_vec)));
        for (number, codes) in changed {
            self.put_pack(list, number, &codes)?;
        }
        Ok(())
    }
}
