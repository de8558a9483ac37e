//! From what the tools tell of a thing to the numbers that the evidence model weighs.

use std::collections::BTreeMap;

use coin_schemas::household::{ClassLabel, ObjectId, Source};
use coin_schemas::model::GivenContext;
use coin_schemas::tools::{KnownOwnership, display_name};

use super::home::SeenThing;
use super::{EvidenceParameters, KnownRelative, Opinion, Relation, likeness_counts, posterior};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::{Roster, RosterError};

/// The sessions of every member with a thing, and the things with answered owners that bear on it.
#[derive(Debug, Clone, PartialEq)]
pub struct WeighedContext {
    /// The sessions, in the order of the roster.
    pub sessions: Vec<u64>,
    /// The things.
    pub relatives: Vec<KnownRelative>,
}

impl WeighedContext {
    /// What a context tells of a thing of this class.
    ///
    /// Only what a person said of other things counts: an inferred owner rests on the same evidence as the thing in
    /// question, and feeding it back would count that evidence twice.
    ///
    /// # Errors
    /// If the context names people who are not of the household.
    pub fn new(roster: &Roster, class: &ClassLabel, context: &GivenContext) -> Result<Self, RosterError> {
        let mut sessions = vec![0; roster.len()];
        for usage in context.usage.iter().flat_map(|summary| &summary.user_summary) {
            sessions[roster.index_of(usage.user_id.as_str())?.place()] = usage.sessions;
        }
        let near = context.nearby_objects.iter().map(|neighbour| {
            (neighbour.known_ownership.as_ref(), Relation::Near { weight: neighbour.weight })
        });
        let class = display_name(class);
        let alike = context.similar_objects.iter().filter(|other| likeness_counts(&class, &other.name)).map(
            |other| (other.known_ownership.as_ref(), Relation::LooksAlike { similarity: other.similarity }),
        );
        let mut relatives = Vec::new();
        for (known, relation) in near.chain(alike) {
            if let Some(KnownOwnership { owners, source: Source::Answer, .. }) = known {
                relatives.push(KnownRelative { owners: roster.owner_set(owners)?, relation });
            }
        }
        Ok(Self { sessions, relatives })
    }

    /// What the evidence model makes of it: see [`posterior`].
    pub fn posterior(&self, opinion: Opinion<'_>, parameters: &EvidenceParameters) -> OwnerSetDistribution {
        posterior(&self.sessions, opinion, &self.relatives, parameters)
    }
}

impl SeenThing {
    /// What a context tells of a thing of this class in a home whose things stand at these places. What lies near or looks
    /// alike and has no place there is passed over, and so is whose it is: that is told of every thing for itself.
    ///
    /// # Errors
    /// If the context names people who are not of the household.
    pub fn in_context(
        roster: &Roster,
        class: &ClassLabel,
        context: &GivenContext,
        places: &BTreeMap<ObjectId, usize>,
    ) -> Result<Self, RosterError> {
        let users = context.usage.iter().flat_map(|summary| &summary.session_order);
        let sessions = users.map(|user| roster.index_of(user.as_str())).collect::<Result<_, _>>()?;
        let near = context.nearby_objects.iter().map(|near| (&near.id, near.weight));
        let alike = context.similar_objects.iter().map(|alike| (&alike.id, alike.similarity));
        let placed = |(id, number): (&ObjectId, f64)| Some((*places.get(id)?, number));
        Ok(Self {
            class: display_name(class),
            sessions,
            near: near.filter_map(placed).collect(),
            alike: alike.filter_map(placed).collect(),
            candidates: roster.everyone(),
            latecomers: OwnerSet::EMPTY,
        })
    }
}
