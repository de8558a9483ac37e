//! `coin-server uninstall`: the entry for this server goes from a host's configuration.

use clap::Args;

use super::install::{open, say_backup, unchangeable};
use super::{Failure, failed, say};
use crate::hosts::Host;
use crate::hosts::edit::{self, Remainder};

const EXAMPLES: &str = "\
Examples:
  coin-server uninstall claude-desktop
  coin-server uninstall cursor --name office";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Uninstall {
    /// The program that shall no longer use the server
    host: Host,
    /// The name of the server in the host's configuration
    #[arg(long, default_value = "coin")]
    name: String,
}

pub(super) fn run(uninstall: &Uninstall) -> Result<(), Failure> {
    let Uninstall { host, name } = uninstall;
    let file = open(*host)?;
    let text = file.text().unwrap_or_default();
    let backup = file.backup();
    let remainder = edit::remove(text, backup.as_deref(), *host, name);
    let kept = match remainder.map_err(|source| unchangeable(&file, &source))? {
        Remainder::Unchanged => {
            say(&format!("{} has no server {name:?}; nothing was changed.", host.title()));
            return Ok(());
        }
        Remainder::Text(text) => file.replace(&text),
        Remainder::Nothing => file.remove(),
    };
    say_backup(kept.map_err(failed)?);
    say(&format!("Removed the server {name:?} from {}.", file.path().display()));
    say(&format!("Next: {}. The database is kept.", host.restart()));
    Ok(())
}
