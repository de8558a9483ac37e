//! `coin-server import`: an episode becomes a home.

use std::path::PathBuf;

use clap::Args;

use super::{Failure, failed, open, refused, say};
use crate::episode;
use crate::store::{Access, StoreError};

#[derive(Debug, Args)]
pub(super) struct Import {
    /// The episode's folder: it holds an episode.json
    #[arg(long, value_name = "DIR")]
    episode: PathBuf,
    /// The database; it is created where it is missing [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
}

pub(super) fn run(import: &Import) -> Result<(), Failure> {
    let loaded = episode::load(&import.episode).map_err(refused)?;
    let store = open(import.db.as_deref(), Access::ReadWrite)?;
    let summary = store.import(&loaded).map_err(|source| match source {
        other_home @ StoreError::OtherHome { .. } => refused(other_home),
        other => failed(other),
    })?;
    say(&format!(
        "Imported {:?}: users {}, objects {}, captions {} new ({} without a known person) and {} already there.",
        loaded.episode.name,
        summary.users,
        summary.objects,
        summary.usage.recorded,
        summary.usage.unattributed,
        summary.usage.duplicates,
    ));
    Ok(())
}
