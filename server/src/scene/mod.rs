//! One state of the home, looked at for one call: what was seen of a thing, what lies near it, what looks like it, and
//! what all of it says of its owners.

mod home;
mod judgement;
mod known_ownership;
mod likeness;
mod next_question;
mod surroundings;
mod usage;

use std::cell::OnceCell;
use std::collections::BTreeMap;

use jiff::Zoned;
use jiff::civil::DateTime;

use crate::store::{Belief, Household, ObjectKey, Reader, StoreError, StoredObject};

pub(crate) use judgement::{Basis, Judgement, Moment, thresholds_of};
pub(crate) use surroundings::{LookAlikes, four_decimals};
pub(crate) use usage::{Listed, Window};

/// A home, as it is in one transaction. What a call needs is read once, when it is first needed.
pub(crate) struct Scene<'a> {
    reader: &'a Reader<'a>,
    household: Household,
    objects: OnceCell<Vec<StoredObject>>,
    has_few_objects: OnceCell<bool>,
    beliefs: OnceCell<BTreeMap<ObjectKey, Belief>>,
    distributions: OnceCell<home::Distributions>,
}

impl<'a> Scene<'a> {
    /// The home that the reader sees.
    ///
    /// # Errors
    /// If nobody lives there, and failures of the database.
    pub(crate) fn new(reader: &'a Reader<'a>) -> Result<Self, StoreError> {
        let household = reader.household()?.ok_or(StoreError::NobodyLivesHere)?;
        Ok(Self {
            reader,
            household,
            objects: OnceCell::new(),
            has_few_objects: OnceCell::new(),
            beliefs: OnceCell::new(),
            distributions: OnceCell::new(),
        })
    }

    /// The people.
    pub(crate) fn household(&self) -> &Household {
        &self.household
    }

    /// What the home is read with.
    pub(crate) fn reader(&self) -> &Reader<'a> {
        self.reader
    }

    /// All things, by id.
    pub(crate) fn objects(&self) -> Result<&[StoredObject], StoreError> {
        Ok(filled(&self.objects, || self.reader.objects())?)
    }

    /// Whether there are so few things that it is quickest to read all of them.
    fn has_few_objects(&self) -> Result<bool, StoreError> {
        filled(&self.has_few_objects, || self.reader.has_few_objects()).copied()
    }

    /// Reads all beliefs at once, for a call that looks at every thing.
    fn beliefs(&self) -> Result<&BTreeMap<ObjectKey, Belief>, StoreError> {
        filled(&self.beliefs, || self.reader.beliefs())
    }

    /// What is recorded of a thing's owners.
    fn belief(&self, object: ObjectKey) -> Result<Option<Belief>, StoreError> {
        match self.beliefs.get() {
            Some(beliefs) => Ok(beliefs.get(&object).cloned()),
            None => self.reader.belief(object),
        }
    }

    /// The home's present: that of the recording that it was imported from, moved on by what was recorded since;
    /// otherwise the wall clock's local time.
    pub(crate) fn present(&self) -> Result<DateTime, StoreError> {
        present(self.reader)
    }
}

/// The home's present; see [`Scene::present`].
pub(crate) fn present(reader: &Reader<'_>) -> Result<DateTime, StoreError> {
    Ok(match reader.clock()? {
        Some(clock) => clock,
        None => whole_seconds(Zoned::now().datetime()),
    })
}

fn whole_seconds(time: DateTime) -> DateTime {
    time.with().subsec_nanosecond(0).build().unwrap_or(time)
}

/// The content of a cell, which is made when it is first needed.
fn filled<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T, StoreError>) -> Result<&T, StoreError> {
    match cell.get() {
        Some(content) => Ok(content),
        None => {
            let made = make()?;
            Ok(cell.get_or_init(|| made))
        }
    }
}
