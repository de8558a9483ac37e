//! Whether a host is set up to start the server, and with which database.

use std::path::Path;

use coin_schemas::doctor::{Finding, Level};

use super::{Surroundings, advice, finding};
use crate::hosts::Host;
use crate::hosts::entry::Entry;
use crate::hosts::file::ConfigurationFile;
use crate::hosts::{edit, place};

pub(super) fn examine(host: Host, surroundings: &Surroundings) -> Vec<Finding> {
    let subject = host.title();
    let path = match place::configuration(host, surroundings.platform, &surroundings.environment) {
        Ok(path) => path,
        Err(unplaced) => return vec![finding(Level::Note, subject, unplaced.to_string())],
    };
    let file = match ConfigurationFile::read(path) {
        Ok(file) => file,
        Err(error) => return vec![finding(Level::Problem, subject, error.to_string())],
    };
    let install = format!("coin-server install {}", host.argument());
    match edit::entries(file.text().unwrap_or_default(), host) {
        Err(error) => {
            vec![finding(Level::Problem, subject, format!("{}: {error}", file.path().display()))]
        }
        Ok(entries) if entries.is_empty() => {
            let found = format!("{} has no coin-server", file.path().display());
            vec![advice(Level::Note, subject, found, install)]
        }
        Ok(entries) => {
            entries.iter().map(|(name, entry)| judge(subject, name, entry, surroundings, &install)).collect()
        }
    }
}

/// The gravest thing about one entry. To be entered again, it keeps its database, unless that is what is wrong.
fn judge(subject: &str, name: &str, entry: &Entry, surroundings: &Surroundings, install: &str) -> Finding {
    let program = entry.program();
    let database = entry.database().unwrap_or_else(|| surroundings.default_database.clone());
    let tools = entry.tools().map_or(String::new(), |tools| format!(" --tools {tools}"));
    let again = |database: &Path| format!("{install} --name {name:?} --db {database:?}{tools}");
    let at_fault = |level, found: String, database: &Path| {
        advice(level, subject, format!("{name:?} {found}"), again(database))
    };
    if program.is_relative() || database.is_relative() {
        let found = "names its program or its database without a folder; the host may not find it";
        return at_fault(Level::Warning, found.to_owned(), &surroundings.database);
    }
    if !program.exists() {
        let found = format!("starts {}, which does not exist", program.display());
        return at_fault(Level::Problem, found, &database);
    }
    if !database.exists() {
        let found = format!("uses the database {}, which does not exist yet", database.display());
        let next = format!("coin-server import --episode DIR --db {database:?}");
        return advice(Level::Warning, subject, format!("{name:?} {found}"), next);
    }
    if !same(&database, &surroundings.database) {
        let found = format!("uses another database, {}", database.display());
        return at_fault(Level::Note, found, &surroundings.database);
    }
    if !same(program, &surroundings.program) {
        let found = format!("starts another program than this one, {}", program.display());
        return at_fault(Level::Note, found, &database);
    }
    finding(Level::Ok, subject, format!("{name:?} starts this program with this database"))
}

fn same(one: &Path, other: &Path) -> bool {
    let whole = |path: &Path| dunce::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    whole(one) == whole(other)
}
