//! The truth of an episode, for the simulated person and the scorer alone.

use std::path::Path;

use coin_schemas::episode::{Episode, Truth};
use coin_schemas::household::{ObjectId, UserName};

use super::error::EpisodeError;
use super::files::Folder;
use super::{MAX_JSON_BYTES, json};
use crate::near_miss;

/// Loads the truth that an episode names; `None` where it names none.
///
/// An empty list of owners means that somebody outside the household owns the thing.
///
/// # Errors
/// The first thing that is wrong, by key: an unknown object or user, an object without owners, malformed JSON.
pub fn load_truth(folder: &Path, episode: &Episode) -> Result<Option<Truth>, EpisodeError> {
    let Some(name) = episode.truth.as_deref() else { return Ok(None) };
    let bytes = Folder::open(folder)?.read(name, MAX_JSON_BYTES)?;
    let truth: Truth = json::parse_document(name, &bytes)?;
    for (id, owners) in &truth.owners {
        check_object(name, "owners", id, episode)?;
        for owner in owners {
            if !episode.users.contains_key(owner) {
                return Err(EpisodeError::at_key(
                    name,
                    format!("owners.{id}"),
                    format!(
                        "{:?} is no user of episode.json.{}",
                        owner.as_str(),
                        near_miss::hint(owner.as_str(), episode.users.keys().map(UserName::as_str))
                    ),
                ));
            }
        }
    }
    for object in &episode.objects {
        if !truth.owners.contains_key(&object.id) {
            return Err(EpisodeError::at_key(
                name,
                "owners",
                format!(
                    "object {:?} is missing; every object of episode.json needs its owners",
                    object.id.as_str()
                ),
            ));
        }
    }
    for id in truth.usage_type.iter().flat_map(|types| types.keys()) {
        check_object(name, "usage_type", id, episode)?;
    }
    Ok(Some(truth))
}

fn check_object(file: &str, key: &str, id: &ObjectId, episode: &Episode) -> Result<(), EpisodeError> {
    let mut ids = episode.objects.iter().map(|object| &object.id);
    if ids.any(|other| other == id) {
        return Ok(());
    }
    let ids = episode.objects.iter().map(|object| object.id.as_str());
    Err(EpisodeError::at_key(
        file,
        format!("{key}.{id}"),
        format!("{:?} is no object of episode.json.{}", id.as_str(), near_miss::hint(id.as_str(), ids)),
    ))
}
