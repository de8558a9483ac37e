//! The things of a home that are judged together.

use std::collections::{BTreeMap, BTreeSet};

use coin::captions::civil_seconds;
use coin::common_sense::expect;
use coin::evidence::home::{HomeEvidence, SeenThing, Told};
use coin::evidence::{Arrivals, EvidenceParameters};
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::space::Neighbourhood;
use coin_schemas::model::GivenContext;
use coin_schemas::tools::{MAX_K, MAX_SESSIONS};
use jiff::civil::DateTime;

use super::usage::Listed;
use super::{LookAlikes, Moment, Scene, Window, filled};
use crate::store::{ObjectKey, StoreError, StoredObject};

/// In a home of many things, one is judged with so many that look like it and with what lies near. What more things tell
/// of people's habits is not worth reading all of them for one answer.
const COMPANY: usize = 40;

/// How probable every owner set is, by thing.
pub(super) type Distributions = BTreeMap<ObjectKey, OwnerSetDistribution>;

impl Scene<'_> {
    /// What the evidence makes of a thing at a moment.
    pub(super) fn weigh(
        &self,
        object: &StoredObject,
        moment: Moment,
        as_of: DateTime,
    ) -> Result<OwnerSetDistribution, StoreError> {
        if moment == Moment::Present && (self.distributions.get().is_some() || self.has_few_objects()?) {
            let all = self.weigh_all()?;
            return all.get(&object.key).cloned().ok_or_else(|| missing(object));
        }
        let company = match self.has_few_objects()? {
            true => self.objects()?.to_vec(),
            false => self.company(object)?,
        };
        self.weigh_together(&company, moment, as_of)?.remove(&object.key).ok_or_else(|| missing(object))
    }

    /// What the evidence makes of every thing at present, worked out once.
    pub(super) fn weigh_all(&self) -> Result<&Distributions, StoreError> {
        filled(&self.distributions, || self.weigh_together(self.objects()?, Moment::Present, self.present()?))
    }

    /// A thing of a large home, and those that tell most about it.
    fn company(&self, object: &StoredObject) -> Result<Vec<StoredObject>, StoreError> {
        let near = self.nearby(object, &Neighbourhood::default())?.into_iter().map(|near| near.id);
        let alike = match self.look_alikes(object, COMPANY)? {
            LookAlikes::Found(found) => found,
            LookAlikes::NeverSeen | LookAlikes::NothingToCompare => Vec::new(),
        };
        let ids: BTreeSet<_> = near.chain(alike.into_iter().map(|alike| alike.id)).collect();
        let others = ids.iter().map(|id| self.reader.object(id.as_str()));
        let mut company: Vec<StoredObject> =
            others.filter_map(Result::transpose).collect::<Result<_, StoreError>>()?;
        company.push(object.clone());
        Ok(company)
    }

    fn weigh_together(
        &self,
        objects: &[StoredObject],
        moment: Moment,
        as_of: DateTime,
    ) -> Result<Distributions, StoreError> {
        let roster = self.household.roster();
        let places = objects.iter().map(|object| object.id.clone()).zip(0..).collect();
        let mut things = Vec::with_capacity(objects.len());
        let mut answers: Vec<Option<OwnerSet>> = Vec::with_capacity(objects.len());
        for object in objects {
            self.reader.go_on()?;
            let context = self.all_of(object, objects.len(), as_of)?;
            let seen = SeenThing::in_context(roster, &object.class, &context, &places)?;
            things.push(seen.after(self.arrivals(object, as_of)?));
            answers.push(match self.answer(object.key, moment)? {
                Some(answer) if self.outdated(object, &answer, as_of)?.is_none() => {
                    Some(roster.owner_set(&answer.owners())?)
                }
                _ => None,
            });
        }
        let expectations: Vec<_> =
            objects.iter().map(|object| expect(object.class.as_str(), roster)).collect();
        let told: Vec<Told<'_>> = answers
            .iter()
            .zip(&expectations)
            .map(|(&answer, expectation)| Told { answer, opinion: expectation.as_ref().into() })
            .collect();
        let judgement = HomeEvidence::new(things, EvidenceParameters::default()).judge(&told);
        let distributions = judgement.distributions().iter().cloned();
        Ok(objects.iter().map(|object| object.key).zip(distributions).collect())
    }

    /// All that is weighed of a thing among so many.
    fn all_of(
        &self,
        object: &StoredObject,
        things: usize,
        as_of: DateTime,
    ) -> Result<GivenContext, StoreError> {
        let listed = Listed { examples: 0, sessions: MAX_SESSIONS as usize };
        let similar_objects = match self.look_alikes(object, things.min(MAX_K as usize))? {
            LookAlikes::Found(found) => found,
            LookAlikes::NeverSeen | LookAlikes::NothingToCompare => Vec::new(),
        };
        Ok(GivenContext {
            usage: Some(self.usage(object, Window::usual(as_of), listed)?),
            nearby_objects: self.nearby(object, &Neighbourhood::default())?,
            similar_objects,
        })
    }

    fn arrivals(&self, object: &StoredObject, as_of: DateTime) -> Result<Arrivals, StoreError> {
        let first_used = self.reader.first_used(object.key)?;
        Ok(Arrivals {
            absent: self.household.newcomers_after(civil_seconds(as_of)),
            newcomers: first_used.map(|first| self.household.newcomers_after(first)).unwrap_or_default(),
        })
    }
}

fn missing(object: &StoredObject) -> StoreError {
    StoreError::damaged(format!("thing {} is not among the things of the home", object.id))
}
