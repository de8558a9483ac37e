//! What `coin-server map --json` shows of a home.

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::household::{ClassLabel, ObjectId, Owners, Position, Source, Users};

/// A thing on the map, and whose it is held to be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MappedObject {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub class: ClassLabel,
    /// The room that it is in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub room: Option<String>,
    /// Where it is, in metres.
    pub position: Position,
    /// Who is held to own it; empty where somebody outside the household does.
    pub owners: Owners,
    /// Whether a person said that somebody outside the household owns it, alone or with the owners.
    pub owner_outside_household: bool,
    /// The probability of that owner set, 0…1; 1 where a person said so.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
    /// Whether a person said so.
    pub source: Source,
}

/// A home: who lives there, what is in it and whose that is held to be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HomeMap {
    /// The name of the recording that it was imported from; absent where it was not imported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub name: Option<String>,
    /// The home's present, in its local time.
    #[schemars(with = "String")]
    pub as_of: DateTime,
    /// The members of the household, by name.
    pub users: Users,
    /// The things by room, class and id; those that are in no room come last.
    pub objects: Vec<MappedObject>,
}
