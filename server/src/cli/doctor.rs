//! `coin-server doctor`: what is wrong, and what to do about it.

use std::path::PathBuf;

use clap::Args;
use coin_schemas::doctor::Level;

use super::{Exit, Failure, default_database, failed, print};
use crate::doctor;
use crate::hosts::place::{Environment, Platform};

const EXAMPLES: &str = "\
Examples:
  coin-server doctor
  coin-server doctor --db home.db --json   # schemas/schema/diagnosis.schema.json says what the keys mean

Exit status: 0 where no problem was found, warnings or not; 1 where one was.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Doctor {
    /// The home's database [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// Write JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Doctor) -> Result<Exit, Failure> {
    let default = default_database()?;
    let database = match &arguments.db {
        Some(path) => std::path::absolute(path).map_err(failed)?,
        None => default.clone(),
    };
    let platform = Platform::present();
    let surroundings = doctor::Surroundings {
        program: std::env::current_exe().and_then(dunce::canonicalize).map_err(failed)?,
        database,
        default_database: default,
        platform,
        environment: Environment::present(platform),
    };
    let diagnosis = doctor::examine(&surroundings);
    if arguments.json {
        print(&format!("{}\n", serde_json::to_string_pretty(&diagnosis).map_err(failed)?))?;
    } else {
        print(&doctor::text::render(&diagnosis))?;
    }
    Ok(if diagnosis.level() == Level::Problem { Exit::Failed } else { Exit::Done })
}
