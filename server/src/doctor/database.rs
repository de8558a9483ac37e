//! Whether the database is there, ours and whole.

use std::path::Path;

use coin_schemas::doctor::{Finding, HomeSummary, Level};

use super::{advice, finding};
use crate::store::{Inspection, StoreError};

const SUBJECT: &str = "database";

pub(super) fn examine(path: &Path) -> (Option<HomeSummary>, Vec<Finding>) {
    match Inspection::of(path) {
        Ok(inspection) => {
            let findings = findings(path, &inspection);
            let Inspection { version, people, things, events, answers, .. } = inspection;
            (Some(HomeSummary { version, people, things, events, answers }), findings)
        }
        Err(error) => (None, vec![unreadable(path, &error)]),
    }
}

fn findings(path: &Path, inspection: &Inspection) -> Vec<Finding> {
    let Inspection { version, damage, people, things, events, answers } = inspection;
    let whole = if damage.is_empty() {
        finding(Level::Ok, SUBJECT, format!("{} is whole and of version {version}", path.display()))
    } else {
        let found = format!("{} is damaged: {}", path.display(), damage.join("; "));
        advice(Level::Problem, SUBJECT, found, "restore it from a copy")
    };
    let home = if people.is_empty() || *things == 0 {
        let found = format!(
            "nobody lives there yet, or there are no things: people {}, things {things}",
            people.len()
        );
        advice(Level::Warning, SUBJECT, found, import(path))
    } else {
        let found =
            format!("people {}; things {things}, events {events}, answers {answers}", people.join(", "));
        finding(Level::Ok, SUBJECT, found)
    };
    vec![whole, home]
}

fn unreadable(path: &Path, error: &StoreError) -> Finding {
    let reason = match error {
        StoreError::Open { source, .. } => source,
        other => other,
    };
    match reason {
        StoreError::Missing => {
            advice(Level::Warning, SUBJECT, format!("{} does not exist yet", path.display()), import(path))
        }
        StoreError::TooOld { .. } => advice(
            Level::Warning,
            SUBJECT,
            reason.to_string(),
            format!("start coin-server --db {path:?} once without --read-only; that brings it up to date"),
        ),
        _ => finding(Level::Problem, SUBJECT, error.to_string()),
    }
}

fn import(path: &Path) -> String {
    format!("coin-server import --episode DIR --db {path:?}")
}
