//! Completion: what a person may mean who has typed the beginning of an id or of a name.

use coin_schemas::household::UserName;
use rmcp::ErrorData;
use rmcp::model::{CompleteRequestParams, CompletionInfo, Reference};

use super::prompts::{ANSWERED_BY, OBJECT_ID};
use super::resources::internal;
use super::{prompts, resources};
use crate::store::{Household, Store, StoreError, StoredObject};
use crate::tools::Registry;

/// The values that go on from what was typed, best first. A thing is found by its id and by the name of its class.
pub(super) fn complete(
    store: &Store,
    tools: &Registry,
    request: &CompleteRequestParams,
) -> Result<CompletionInfo, ErrorData> {
    let known = match &request.r#ref {
        Reference::Prompt(prompt) => prompts::list(tools).iter().any(|known| known.name == prompt.name),
        Reference::Resource(template) => {
            resources::templates().iter().any(|known| known.uri_template == template.uri)
        }
        _ => false,
    };
    if !known {
        return Err(ErrorData::invalid_params("ref: there is no such prompt or resource template", None));
    }
    let typed = request.argument.value.trim().to_lowercase();
    let values = match request.argument.name.as_str() {
        OBJECT_ID => store.read(|reader| Ok::<_, StoreError>(things(&reader.objects()?, &typed))),
        ANSWERED_BY => store.read(|reader| Ok::<_, StoreError>(people(reader.household()?.as_ref(), &typed))),
        _ => Ok(Vec::new()),
    };
    let mut values = values.map_err(|source| internal(&source))?;
    let total = values.len();
    values.truncate(CompletionInfo::MAX_VALUES);
    let has_more = total > values.len();
    CompletionInfo::with_pagination(values, u32::try_from(total).ok(), has_more)
        .map_err(|message| ErrorData::internal_error(message, None))
}

/// Ids that begin so, then ids of things whose class begins so, then of those whose class holds it.
fn things(objects: &[StoredObject], typed: &str) -> Vec<String> {
    let rank = |object: &StoredObject| {
        let (id, class) = (object.id.as_str().to_lowercase(), object.class.as_str().to_lowercase());
        if id.starts_with(typed) {
            Some(0)
        } else if class.starts_with(typed) {
            Some(1)
        } else {
            class.contains(typed).then_some(2)
        }
    };
    let mut found: Vec<(i32, &StoredObject)> =
        objects.iter().filter_map(|object| Some((rank(object)?, object))).collect();
    // The sort is stable, so that things of one rank stay in the order of their ids.
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, object)| object.id.to_string()).collect()
}

fn people(household: Option<&Household>, typed: &str) -> Vec<String> {
    let names = household.into_iter().flat_map(|household| household.roster().names());
    names.map(UserName::to_string).filter(|name| name.to_lowercase().starts_with(typed)).collect()
}
