//! What `coin-server doctor --json` finds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// It is as it should be.
    Ok,
    /// It is worth knowing, and nothing has to be done.
    Note,
    /// It works, but something should be done.
    Warning,
    /// It does not work.
    Problem,
}

/// One thing that was looked at.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// How much it matters.
    pub level: Level,
    /// What was looked at: database, permissions, calibration, or the name of a host.
    pub subject: String,
    /// What was found.
    pub found: String,
    /// What to do next.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub next_step: Option<String>,
}

/// What a database holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct HomeSummary {
    /// The version of the database's form.
    pub version: u32,
    /// Who lives there.
    pub people: Vec<String>,
    /// How many things there are.
    pub things: u64,
    /// How many events were seen.
    pub events: u64,
    /// How many answers were given, those included that were taken back.
    pub answers: u64,
}

/// Everything that the doctor found. Nothing was changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// The version of the program.
    pub program_version: String,
    /// The database that was looked at.
    pub database: String,
    /// What it holds; absent where it cannot be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "HomeSummary")]
    pub home: Option<HomeSummary>,
    /// What was found, in the order in which it was looked at.
    pub findings: Vec<Finding>,
}

impl Diagnosis {
    /// The gravest level of all findings.
    pub fn level(&self) -> Level {
        self.findings.iter().map(|finding| finding.level).max().unwrap_or(Level::Ok)
    }
}
