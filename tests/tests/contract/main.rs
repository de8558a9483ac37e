//! The contract of every tool, over real pipes, with the built server.
//!
//! Expected values are worked out by hand here, never by the code under test. Every successful call of every test
//! is also checked for what holds of all of them: text and structured content are the same JSON, and it satisfies
//! the tool's output schema (`coin_tests::ServerProcess::call`).

mod answers;
mod definitions;
mod finding;
mod finding_expressions;
mod judging;
mod lists;
mod map;
mod observing;
mod protocol;
mod recording;
mod refusals;
mod retractions;
mod scores;
mod surroundings;
mod usage_summary;

use coin_tests::{EpisodeBuilder, Home};
use serde_json::{Value, json};

/// Bob's marker, two mugs and a coffee table, nobody knows whose; nothing was seen yet.
fn furnished() -> EpisodeBuilder {
    EpisodeBuilder::new()
        .object("marker", "marker", [0.0, 0.0, 0.8])
        .object("mug-blue", "mug", [0.0, 0.0, 1.3])
        .object("mug-red", "mug", [0.3, 0.4, 0.8])
        .object("table", "coffee table", [1.6, 0.0, 0.8])
}

fn furnished_home() -> Home {
    Home::of(&furnished())
}

/// An answer that names `owner`.
fn answer(object_id: &str, owner: &str) -> Value {
    json!({
        "object_id": object_id,
        "question": "Whose is this?",
        "answer": format!("It is {owner}'s."),
        "ownership": {owner: true},
    })
}
