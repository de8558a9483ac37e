//! `coin-server import`: an episode becomes a home.

use std::path::PathBuf;

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use super::{Failure, failed, open, refused, say};
use crate::episode;
use crate::store::{Access, Call, StoreError};

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
    let store = open(import.db.as_deref(), Access::ReadWrite)?.during(&shown_call());
    let summary = store.import(&loaded).map_err(|source| match source {
        other_home @ StoreError::OtherHome { .. } => refused(other_home),
        other => failed(other),
    })?;
    // The bar goes before the message comes.
    drop(store);
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

/// A call that draws how far it has come, where there is a terminal to draw on.
fn shown_call() -> Call {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
        .with_finish(ProgressFinish::AndClear);
    if let Ok(style) = ProgressStyle::with_template("  {bar:30} {msg}") {
        bar.set_style(style.progress_chars("━━─"));
    }
    Call::with_listener(move |progress| {
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        bar.set_message(progress.to_string());
    })
}
