//! What the tool server tells of the things of a home, fetched for a page that shows why something is believed.

use std::collections::BTreeMap;

use coin::space::Neighbourhood;
use coin_schemas::household::ObjectId;
use coin_schemas::tools::{
    DEFAULT_K, DEFAULT_WINDOW_DAYS, GetUsageSummary, LookAlike, NearbyObjects, NearbyObjectsResult,
    Neighbour, SimilarObjects, SimilarObjectsResult, UsageSummary,
};
use futures::{StreamExt, TryStreamExt};
use jiff::civil::DateTime;

use crate::client::{ServerError, ToolServer};

/// How many captions of each person are shown.
const EXAMPLES: u32 = 3;

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
        .map(|thing| async move { Ok((thing.clone(), about(server, thing, as_of).await?)) })
        .buffered(CONCURRENCY)
        .try_collect()
        .await
}

async fn about(server: &ToolServer, thing: &ObjectId, as_of: DateTime) -> Result<Evidence, ServerError> {
    let object_id = thing.to_string();
    let usage = GetUsageSummary {
        object_id: object_id.clone(),
        window_days: DEFAULT_WINDOW_DAYS,
        as_of: Some(as_of.to_string()),
        max_examples: EXAMPLES,
    };
    let Neighbourhood { sigma, gamma, min_weight, .. } = Neighbourhood::default();
    let nearby = NearbyObjects { object_id: object_id.clone(), k: DEFAULT_K, sigma, gamma, min_weight };
    let similar = SimilarObjects { object_id, k: DEFAULT_K };
    let usage = server.call("get_usage_summary", &usage).await?;
    let nearby: NearbyObjectsResult = server.call("nearby_objects", &nearby).await?;
    let similar: SimilarObjectsResult = server.call("similar_objects", &similar).await?;
    Ok(Evidence { usage, nearby: nearby.nearby_objects, similar: similar.similar_objects })
}
