//! From what the tools tell of a thing to the numbers that the evidence model weighs.

use coin_schemas::household::{ClassLabel, Source};
use coin_schemas::model::GivenContext;
use coin_schemas::tools::{KnownOwnership, display_name};

use super::{
    EvidenceParameters, KnownRelative, Opinion, Relation, least_confidence, likeness_counts, posterior,
};
use crate::owners::OwnerSetDistribution;
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

    /// The least probability that the best owner set can be left with: see [`least_confidence`].
    pub fn least_confidence(&self, parameters: &EvidenceParameters) -> f64 {
        least_confidence(&self.sessions, &self.relatives, parameters)
    }
}
