//! What lies near a thing, and what looks like it.

use coin::similarity::most_similar;
use coin::space::{Neighbourhood, neighbours};
use coin_schemas::tools::{LookAlike, Neighbour, display_name};

use super::Scene;
use super::known_ownership::known_ownership;
use crate::store::{Alike, StoreError, StoredObject};

/// What came of looking for things that look like a thing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LookAlikes {
    /// The most similar ones, most similar first.
    Found(Vec<LookAlike>),
    /// The thing itself was never looked at.
    NeverSeen,
    /// No other thing was.
    NothingToCompare,
}

impl Scene<'_> {
    /// The things near a thing, largest weight first.
    pub(crate) fn nearby(
        &self,
        object: &StoredObject,
        reach: &Neighbourhood,
    ) -> Result<Vec<Neighbour>, StoreError> {
        let around;
        // They come by id, so their place stands for the id where weights and distances are equal.
        let objects = if self.has_few_objects()? {
            self.objects()?
        } else {
            around = self.reader.around(object, reach)?;
            &around
        };
        let others = objects.iter().enumerate().filter(|(_, other)| other.key != object.key);
        let near = neighbours(object.position, others.map(|(place, other)| (place, other.position)), reach);
        near.into_iter()
            .map(|near| {
                let other = &objects[near.item];
                let belief = self.belief(other.key)?;
                Ok(Neighbour {
                    id: other.id.clone(),
                    name: display_name(&other.class),
                    distance: four_decimals(near.distance),
                    weight: four_decimals(near.weight),
                    known_ownership: belief
                        .and_then(|belief| known_ownership(self.household.roster(), &belief)),
                })
            })
            .collect()
    }

    /// The things that look like a thing, most similar first.
    pub(crate) fn look_alikes(&self, object: &StoredObject, k: usize) -> Result<LookAlikes, StoreError> {
        let (look, others) = match self.reader.alike(object.key, k)? {
            Alike::NeverSeen => return Ok(LookAlikes::NeverSeen),
            Alike::Found { others, .. } if others.is_empty() => return Ok(LookAlikes::NothingToCompare),
            Alike::Found { look, others } => (look, others),
        };
        // They come by id, so their place stands for the id where similarities are equal.
        let alike = most_similar(&look, others.iter().map(|other| other.look.as_slice()).enumerate(), k);
        let found = alike.into_iter().map(|similar| {
            let other = &others[similar.item].object;
            let belief = self.belief(other.key)?;
            Ok(LookAlike {
                id: other.id.clone(),
                name: display_name(&other.class),
                similarity: four_decimals(similar.similarity),
                known_ownership: belief.and_then(|belief| known_ownership(self.household.roster(), &belief)),
            })
        });
        Ok(LookAlikes::Found(found.collect::<Result<_, StoreError>>()?))
    }
}

/// A number to four decimals, as distances, weights and similarities are given.
pub(crate) fn four_decimals(number: f64) -> f64 {
    // Adding zero turns -0.0 into 0.0.
    (number * 1e4).round() / 1e4 + 0.0
}
