//! The forms that replies must have, as JSON Schemas that name every member of the household: a provider that enforces
//! them lets no member be left out and none be invented.

use std::collections::BTreeSet;

use coin::roster::Roster;
use coin_schemas::household::{ClassLabel, ObjectId, UserName};
use serde_json::{Map, Value, json};

use crate::model::ReplyFormat;

/// The forms of one household.
pub(super) struct Formats {
    members: Vec<String>,
}

impl Formats {
    pub(super) fn of(roster: &Roster) -> Self {
        Self { members: roster.names().map(UserName::to_string).collect() }
    }

    fn scores(&self) -> Value {
        closed(
            self.members
                .iter()
                .map(|name| (name.as_str(), json!({"type": "number", "minimum": 0, "maximum": 1}))),
        )
    }

    /// Scores for one thing.
    pub(super) fn ownership(&self) -> ReplyFormat {
        format("ownership", closed([("ownership_distribution", self.scores())]))
    }

    /// Scores for several things.
    pub(super) fn ownerships(&self, things: &[ObjectId]) -> ReplyFormat {
        let of_things = closed(things.iter().map(|thing| (thing.as_str(), self.scores())));
        format("ownerships", closed([("ownership_distributions", of_things)]))
    }

    /// What an answer says.
    pub(super) fn reading(&self) -> ReplyFormat {
        let owners = closed(self.members.iter().map(|name| (name.as_str(), json!({"type": "boolean"}))));
        let outside = json!({"type": "boolean"});
        format("reading", closed([("ownership_boolean", owners), ("owner_outside_household", outside)]))
    }

    /// Which classes are everybody's.
    pub(super) fn sharing(&self, classes: &BTreeSet<ClassLabel>) -> ReplyFormat {
        let of_classes = closed(classes.iter().map(|class| (class.as_str(), json!({"type": "boolean"}))));
        format("sharing", closed([("shared_classes", of_classes)]))
    }
}

fn format(name: &str, schema: Value) -> ReplyFormat {
    ReplyFormat::Json { name: name.to_owned(), schema }
}

/// An object with exactly these properties.
fn closed<'a>(properties: impl IntoIterator<Item = (&'a str, Value)>) -> Value {
    let properties: Map<String, Value> =
        properties.into_iter().map(|(name, schema)| (name.to_owned(), schema)).collect();
    let required: Vec<&String> = properties.keys().collect();
    json!({"type": "object", "required": required, "additionalProperties": false, "properties": properties})
}
