//! What the tool server tells of a thing.

use std::collections::{BTreeMap, BTreeSet};

use coin::space::Neighbourhood;
use coin_schemas::household::ObjectId;
use coin_schemas::model::{GivenContext, RelatedObjects};
use coin_schemas::report::Withheld;
use coin_schemas::tools::{
    DEFAULT_K, DEFAULT_WINDOW_DAYS, GetUsageSummary, LookAlike, MAX_K, MAX_SESSIONS, NearbyObjects,
    NearbyObjectsResult, Neighbour, SimilarObjects, SimilarObjectsResult, UsageSummary,
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
            let usage =
                usage(server, thing, as_of, Shown { examples: EXAMPLES_ON_A_PAGE, sessions: 0 }).await?;
            let evidence = Evidence {
                usage,
                nearby: nearby(server, thing).await?,
                similar: similar(server, thing, DEFAULT_K).await?,
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
        false => Some(usage(server, thing, as_of, Shown { examples: max_examples, sessions: 0 }).await?),
    };
    let (nearby_objects, similar_objects) =
        (nearby(server, thing).await?, similar(server, thing, DEFAULT_K).await?);
    Ok(GivenContext { usage, nearby_objects, similar_objects })
}

/// Fetches all that the tools tell of a thing and the evidence model weighs, but not what is withheld: every session,
/// and as many look-alikes as there are.
pub async fn whole_context(
    server: &ToolServer,
    thing: &ObjectId,
    as_of: DateTime,
    withheld: &BTreeSet<Withheld>,
) -> Result<GivenContext, ServerError> {
    let usage = match withheld.contains(&Withheld::Usage) {
        true => None,
        false => Some(usage(server, thing, as_of, Shown { examples: 0, sessions: MAX_SESSIONS }).await?),
    };
    let (nearby_objects, similar_objects) =
        (nearby(server, thing).await?, similar(server, thing, MAX_K).await?);
    Ok(GivenContext { usage, nearby_objects, similar_objects })
}

/// Fetches where a thing lies: its neighbours, without whose they are.
pub async fn surroundings(server: &ToolServer, thing: &ObjectId) -> Result<GivenContext, ServerError> {
    let mut nearby_objects = nearby(server, thing).await?;
    nearby_objects.iter_mut().for_each(|neighbour| neighbour.known_ownership = None);
    Ok(GivenContext { nearby_objects, ..GivenContext::default() })
}

/// How much of a usage is listed.
struct Shown {
    examples: u32,
    sessions: u32,
}

async fn usage(
    server: &ToolServer,
    thing: &ObjectId,
    as_of: DateTime,
    shown: Shown,
) -> Result<UsageSummary, ServerError> {
    let arguments = GetUsageSummary {
        object_id: thing.to_string(),
        window_days: DEFAULT_WINDOW_DAYS,
        as_of: Some(as_of.to_string()),
        max_examples: shown.examples,
        max_sessions: shown.sessions,
    };
    server.call("get_usage_summary", &arguments).await
}

async fn nearby(server: &ToolServer, thing: &ObjectId) -> Result<Vec<Neighbour>, ServerError> {
    let Neighbourhood { sigma, gamma, min_weight, .. } = Neighbourhood::default();
    let arguments = NearbyObjects { object_id: thing.to_string(), k: DEFAULT_K, sigma, gamma, min_weight };
    let found: NearbyObjectsResult = server.call("nearby_objects", &arguments).await?;
    Ok(found.nearby_objects)
}

async fn similar(server: &ToolServer, thing: &ObjectId, k: u32) -> Result<Vec<LookAlike>, ServerError> {
    let arguments = SimilarObjects { object_id: thing.to_string(), k };
    let found: SimilarObjectsResult = server.call("similar_objects", &arguments).await?;
    Ok(found.similar_objects)
}

/// The things whose known owners a context shows.
pub fn related(context: &GivenContext) -> RelatedObjects {
    let near = context.nearby_objects.iter().map(|neighbour| neighbour.id.clone());
    near.chain(context.similar_objects.iter().map(|look_alike| look_alike.id.clone())).collect()
}
