//! What the tool server tells of a thing, and what the evidence model makes of it.

use std::collections::{BTreeMap, BTreeSet};

use coin::evidence::{EvidenceParameters, KnownRelative, Opinion, Relation, likeness_counts, posterior};
use coin::owners::OwnerSetDistribution;
use coin::roster::{Roster, RosterError};
use coin::space::Neighbourhood;
use coin_schemas::household::{ClassLabel, ObjectId, Owners, Source};
use coin_schemas::model::{GivenContext, RelatedObjects};
use coin_schemas::report::Withheld;
use coin_schemas::tools::{
    DEFAULT_K, DEFAULT_WINDOW_DAYS, GetUsageSummary, KnownOwnership, LookAlike, NearbyObjects,
    NearbyObjectsResult, Neighbour, SimilarObjects, SimilarObjectsResult, UsageSummary, display_name,
};
use futures::{StreamExt, TryStreamExt};
use jiff::civil::DateTime;

use crate::client::{ServerError, ToolServer};

/// How many captions of each person a page shows.
const EXAMPLES_ON_A_PAGE: u32 = 3;

/// How many things are asked for at once.
const CONCURRENCY: usize = 4;

/// The evidence about one thing, as a model would have been told it at the end of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// Who used it.
    pub usage: UsageSummary,
    /// What lies near it, nearest first.
    pub nearby: Vec<Neighbour>,
    /// What looks like it, most similar first.
    pub similar: Vec<LookAlike>,
}

/// Fetches the evidence about every thing, as it stood at `as_of`.
pub async fn collect<'a>(
    server: &ToolServer,
    things: impl Iterator<Item = &'a ObjectId>,
    as_of: DateTime,
) -> Result<BTreeMap<ObjectId, Evidence>, ServerError> {
    futures::stream::iter(things)
        .map(|thing| async move {
            let usage = usage(server, thing, as_of, EXAMPLES_ON_A_PAGE).await?;
            let evidence = Evidence {
                usage,
                nearby: nearby(server, thing).await?,
                similar: similar(server, thing).await?,
            };
            Ok((thing.clone(), evidence))
        })
        .buffered(CONCURRENCY)
        .try_collect()
        .await
}

/// Fetches what the tools tell of a thing, with so many captions of each person, but not what is withheld.
pub async fn context(
    server: &ToolServer,
    thing: &ObjectId,
    as_of: DateTime,
    withheld: &BTreeSet<Withheld>,
    max_examples: u32,
) -> Result<GivenContext, ServerError> {
    let usage = match withheld.contains(&Withheld::Usage) {
        true => None,
        false => Some(usage(server, thing, as_of, max_examples).await?),
    };
    let (nearby_objects, similar_objects) = (nearby(server, thing).await?, similar(server, thing).await?);
    Ok(GivenContext { usage, nearby_objects, similar_objects })
}

/// What a context tells of where a thing lies: its neighbours, without whose they are.
pub fn surroundings(context: &GivenContext) -> GivenContext {
    let mut nearby_objects = context.nearby_objects.clone();
    nearby_objects.iter_mut().for_each(|neighbour| neighbour.known_ownership = None);
    GivenContext { nearby_objects, ..GivenContext::default() }
}

async fn usage(
    server: &ToolServer,
    thing: &ObjectId,
    as_of: DateTime,
    max_examples: u32,
) -> Result<UsageSummary, ServerError> {
    let arguments = GetUsageSummary {
        object_id: thing.to_string(),
        window_days: DEFAULT_WINDOW_DAYS,
        as_of: Some(as_of.to_string()),
        max_examples,
    };
    server.call("get_usage_summary", &arguments).await
}

async fn nearby(server: &ToolServer, thing: &ObjectId) -> Result<Vec<Neighbour>, ServerError> {
    let Neighbourhood { sigma, gamma, min_weight, .. } = Neighbourhood::default();
    let arguments = NearbyObjects { object_id: thing.to_string(), k: DEFAULT_K, sigma, gamma, min_weight };
    let found: NearbyObjectsResult = server.call("nearby_objects", &arguments).await?;
    Ok(found.nearby_objects)
}

async fn similar(server: &ToolServer, thing: &ObjectId) -> Result<Vec<LookAlike>, ServerError> {
    let arguments = SimilarObjects { object_id: thing.to_string(), k: DEFAULT_K };
    let found: SimilarObjectsResult = server.call("similar_objects", &arguments).await?;
    Ok(found.similar_objects)
}

/// The things whose known owners a context shows.
pub fn related(context: &GivenContext) -> RelatedObjects {
    let near = context.nearby_objects.iter().map(|neighbour| neighbour.id.clone());
    near.chain(context.similar_objects.iter().map(|look_alike| look_alike.id.clone())).collect()
}

/// What the evidence model makes of a thing of this class in this context.
///
/// # Errors
/// If the context names people who are not of the household.
pub fn judge(
    roster: &Roster,
    class: &ClassLabel,
    context: &GivenContext,
    opinion: Opinion<'_>,
    parameters: &EvidenceParameters,
) -> Result<OwnerSetDistribution, RosterError> {
    let (sessions, relatives) = weighed(roster, class, context)?;
    Ok(posterior(&sessions, opinion, &relatives, parameters))
}

/// The least probability that the best owner set can be left with by a language model, whatever it says.
///
/// # Errors
/// If the context names people who are not of the household.
pub fn least_confidence(
    roster: &Roster,
    class: &ClassLabel,
    context: &GivenContext,
    parameters: &EvidenceParameters,
) -> Result<f64, RosterError> {
    let (sessions, relatives) = weighed(roster, class, context)?;
    Ok(coin::evidence::least_confidence(&sessions, &relatives, parameters))
}

/// The sessions of every member, and the things with answered owners that bear on this one.
fn weighed(
    roster: &Roster,
    class: &ClassLabel,
    context: &GivenContext,
) -> Result<(Vec<u64>, Vec<KnownRelative>), RosterError> {
    let mut sessions = vec![0; roster.len()];
    for usage in context.usage.iter().flat_map(|summary| &summary.user_summary) {
        sessions[roster.index_of(usage.user_id.as_str())?.place()] = usage.sessions;
    }
    let mut relatives = Vec::new();
    for neighbour in &context.nearby_objects {
        let relation = Relation::Near { weight: neighbour.weight };
        relatives.extend(answered(roster, neighbour.known_ownership.as_ref(), relation)?);
    }
    for look_alike in &context.similar_objects {
        if likeness_counts(&display_name(class), &look_alike.name) {
            let relation = Relation::LooksAlike { similarity: look_alike.similarity };
            relatives.extend(answered(roster, look_alike.known_ownership.as_ref(), relation)?);
        }
    }
    Ok((sessions, relatives))
}

/// Only what a person said is passed on: an inferred owner rests on the same evidence as the thing in question,
/// and feeding it back would count that evidence twice.
fn answered(
    roster: &Roster,
    known: Option<&KnownOwnership>,
    relation: Relation,
) -> Result<Option<KnownRelative>, RosterError> {
    let owners: &Owners = match known {
        Some(KnownOwnership { owners, source: Source::Answer, .. }) => owners,
        _ => return Ok(None),
    };
    Ok(Some(KnownRelative { owners: roster.owner_set(owners)?, relation }))
}
