//! `coin-server map`: the home to look at, on a page or in the terminal.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Failure, default_database, failed, print, refused, say};
use crate::map;
use crate::output_file::{OutputFile, OutputFileError};
use crate::store::{Access, Store, StoreError};

const EXAMPLES: &str = "\
Examples:
  coin-server map --db home.db                     # a table: rooms, things, owners, how sure
  coin-server map --db home.db --html home.html    # the plan; open it in a browser, or print it
  coin-server map --db home.db --json              # schemas/schema/home-map.schema.json says what the keys mean

Exit status: 0 done; 1 failed; 2 wrong use, or a database that cannot be opened or in which nobody lives.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Map {
    /// The home's database [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// Write a page to this file instead of the table: the plan of the home, and every thing in a table below it
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print JSON instead of the table
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Map) -> Result<(), Failure> {
    let database = match &arguments.db {
        Some(path) => path.clone(),
        None => default_database()?,
    };
    let store = Store::open(&database, Access::ReadOnly).map_err(refused)?;
    let page_file = match &arguments.html {
        Some(file) => Some((file, page_file(file, &database)?)),
        None => None,
    };
    let map = map::survey(&store).map_err(|source| match source {
        empty @ StoreError::NobodyLivesHere => refused(format!("{}: {empty}", database.display())),
        other => failed(other),
    })?;
    if arguments.json {
        print(&format!("{}\n", serde_json::to_string_pretty(&map).map_err(failed)?))?;
    } else if page_file.is_none() {
        print(&map::text(&map))?;
    }
    if let Some((path, file)) = page_file {
        file.write(&map::page(&map)).map_err(unwritable)?;
        say(&format!("Open {} in a browser.", path.display()));
    }
    Ok(())
}

/// The file for the page. It takes the place of an older page, but never that of the home itself.
fn page_file(path: &Path, database: &Path) -> Result<OutputFile, Failure> {
    let is_database = match (dunce::canonicalize(path), dunce::canonicalize(database)) {
        (Ok(page), Ok(home)) => page == home,
        _ => false,
    };
    if is_database {
        return Err(refused(format!(
            "cannot write {}: it is the home's database; name another file with --html",
            path.display()
        )));
    }
    OutputFile::create(path).map_err(unwritable)
}

fn unwritable(source: OutputFileError) -> Failure {
    match source {
        OutputFileError::Refused { .. } => refused(source),
        OutputFileError::Failed { .. } => failed(source),
    }
}
