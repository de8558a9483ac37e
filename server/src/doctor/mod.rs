//! Looking at everything that the server needs, without changing any of it.

mod calibration;
mod database;
mod hosts;
mod permissions;
pub(crate) mod text;

use std::path::PathBuf;

use coin_schemas::doctor::{Diagnosis, Finding, Level};

use crate::hosts::Host;
use crate::hosts::place::{Environment, Platform};

/// What the doctor looks at.
#[derive(Debug)]
pub(crate) struct Surroundings {
    /// The running program.
    pub(crate) program: PathBuf,
    /// The database.
    pub(crate) database: PathBuf,
    /// The database that a server uses to which none is named.
    pub(crate) default_database: PathBuf,
    /// Where hosts keep their files.
    pub(crate) platform: Platform,
    /// Where this user keeps them.
    pub(crate) environment: Environment,
}

/// Looks at the database, its permissions, the calibration and every host.
pub(crate) fn examine(surroundings: &Surroundings) -> Diagnosis {
    let (home, mut findings) = database::examine(&surroundings.database);
    findings.extend(permissions::examine(&surroundings.database));
    findings.push(calibration::examine());
    findings.extend(Host::ALL.into_iter().flat_map(|host| hosts::examine(host, surroundings)));
    Diagnosis {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        database: surroundings.database.display().to_string(),
        home,
        findings,
    }
}

fn finding(level: Level, subject: &str, found: impl Into<String>) -> Finding {
    Finding { level, subject: subject.to_owned(), found: found.into(), next_step: None }
}

fn advice(level: Level, subject: &str, found: impl Into<String>, next_step: impl Into<String>) -> Finding {
    Finding { next_step: Some(next_step.into()), ..finding(level, subject, found) }
}
