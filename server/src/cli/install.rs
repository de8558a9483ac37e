//! `coin-server install`: an entry for this server comes into a host's configuration.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::{Failure, default_database, failed, print, refused, say};
use crate::hosts::Host;
use crate::hosts::edit;
use crate::hosts::entry::Entry;
use crate::hosts::file::ConfigurationFile;
use crate::hosts::place::{Environment, Platform, configuration};
use crate::tools::ToolSelection;

const EXAMPLES: &str = "\
Examples:
  coin-server install claude-desktop                  # with the database in the user's data folder
  coin-server install vscode --db home.db --print     # look first; nothing is written
  coin-server install cursor --name office --db office.db --tools core";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Install {
    /// The program that shall use the server
    host: Host,
    /// The home's database [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// The name of the server in the host's configuration
    #[arg(long, default_value = "coin")]
    name: String,
    /// The tools to offer: all, core, or names [default: all]
    #[arg(long, value_name = "all|core|NAME,…", value_parser = tools)]
    tools: Option<String>,
    /// Show the file and the entry, and write nothing
    #[arg(long)]
    print: bool,
}

/// Names of tools are checked here and handed on as they were given.
fn tools(text: &str) -> Result<String, String> {
    let checked: Result<ToolSelection, _> = text.parse();
    checked.map(|_| text.to_owned()).map_err(|error| error.to_string())
}

pub(super) fn run(install: &Install) -> Result<(), Failure> {
    let Install { host, name, .. } = install;
    let database = match &install.db {
        Some(path) => std::path::absolute(path).map_err(failed)?,
        None => default_database()?,
    };
    let entry = entry(&database, install.tools.as_deref())?;
    let file = open(*host)?;
    let text = file.text().unwrap_or_default();
    let changed = edit::enter(text, *host, name, &entry).map_err(|source| unchangeable(&file, &source))?;
    if install.print {
        let whole = json!({host.servers_key(): {name: entry.keys(host.transport())}});
        return print(&format!("{}\n{whole:#}\n", file.path().display()));
    }
    if changed == text {
        say(&format!("{} has the server {name:?} already; nothing was changed.", host.title()));
    } else {
        let backup = file.replace(&changed).map_err(failed)?;
        say(&format!("Entered the server {name:?} into {}.", file.path().display()));
        say_backup(backup);
    }
    if !database.exists() {
        say(&format!(
            "Warning: the database {0} does not exist yet. Import a home first: coin-server import --episode DIR --db {0:?}",
            database.display(),
        ));
    }
    say(&format!("Next: {}, and ask “whose is the marker on the desk?”.", host.restart()));
    Ok(())
}

/// The configuration file of a host.
pub(super) fn open(host: Host) -> Result<ConfigurationFile, Failure> {
    let platform = Platform::present();
    let path = configuration(host, platform, &Environment::present(platform)).map_err(refused)?;
    ConfigurationFile::read(path).map_err(failed)
}

/// A host starts its servers wherever it happens to be, so that only absolute paths can be found.
fn entry(database: &Path, tools: Option<&str>) -> Result<Entry, Failure> {
    let program = std::env::current_exe().and_then(dunce::canonicalize).map_err(failed)?;
    let text = |path: &Path| {
        let text = path.to_str().map(str::to_owned);
        text.ok_or_else(|| refused(format!("{} is no Unicode text, and JSON cannot hold it", path.display())))
    };
    let mut args = vec!["--db".to_owned(), text(database)?];
    if let Some(tools) = tools {
        args.extend(["--tools".to_owned(), tools.to_owned()]);
    }
    Ok(Entry { command: text(&program)?, args })
}

pub(super) fn unchangeable(file: &ConfigurationFile, source: &edit::EditError) -> Failure {
    refused(format!("{} was not changed: {source}", file.path().display()))
}

pub(super) fn say_backup(backup: Option<PathBuf>) {
    if let Some(backup) = backup {
        say(&format!("What was there before is in {}.", backup.display()));
    }
}
