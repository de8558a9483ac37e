//! The method as other crates see it: known answers, coverage by repetition, and whole runs of the agent.
#![expect(clippy::unwrap_used, reason = "clippy.toml allows it in test functions, not in what they share")]

#[path = "../support/mod.rs"]
mod support;

mod adaptive;
mod algorithm_1;
mod confirmation;
mod coverage;
mod exceptions;
mod known_answers;
mod outdated;
mod reinference;
mod run;
mod run_laws;
mod together;
