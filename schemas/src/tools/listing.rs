//! Tools that list the people and the things of the home.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DEFAULT_LIMIT, ObjectRef};
use crate::household::{ObjectId, Owners, Position, Source, UserName};

fn default_limit() -> u32 {
    DEFAULT_LIMIT
}

/// Arguments of `list_objects`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ListObjects {
    /// Only things of this class.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub class: Option<String>,
    /// Only things that this person is held to own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub owner: Option<String>,
    /// Only things that are settled (true) or that are not (false).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool")]
    pub settled: Option<bool>,
    /// At most this many things; the next ones by cursor.
    #[serde(default = "default_limit")]
    #[schemars(range(min = 1, max = 500))]
    pub limit: u32,
    /// next_cursor of the page before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub cursor: Option<String>,
}

/// Result of `list_objects`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListObjectsResult {
    /// The things, by id.
    pub objects: Vec<ListedObject>,
    /// How many things match in all.
    pub total: u64,
    /// Hand it in as cursor for the next page; absent on the last one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub next_cursor: Option<String>,
}

/// A thing and what is believed of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListedObject {
    /// Its id.
    pub id: ObjectId,
    /// Its class label.
    pub name: String,
    /// `[x, y, z]` in metres.
    pub position: Position,
    /// The room that it is in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub room: Option<String>,
    /// Who is held to own it; empty where nothing is believed yet, or where somebody outside the household does.
    pub owners: Owners,
    /// Probability of that owner set, 0…1; 0 where nothing is believed yet.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
    /// Where the belief comes from; absent where nothing is believed yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Source")]
    pub source: Option<Source>,
}

/// Arguments of `list_users`: none.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ListUsers {}

/// Result of `list_users`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ListUsersResult {
    /// The members of the household, by name.
    pub users: Vec<ListedUser>,
}

/// A member of the household.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ListedUser {
    /// The name, as every other tool takes it.
    pub name: UserName,
    /// The person's place in the home.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub role: Option<String>,
    /// What the person does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub occupation: Option<String>,
}

/// Arguments of `add_user`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddUser {
    /// The person's name, as captions write it.
    pub name: String,
    /// The person's place in the home, such as father or flatmate. Default: unknown, or as it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub role: Option<String>,
    /// What the person does, such as office worker. Default: unknown, or as it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub occupation: Option<String>,
}

/// Result of `add_user`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct AddUserResult {
    /// The members of the household, by name.
    pub users: Vec<ListedUser>,
    /// How many captions without a known person turned out to be the newcomer's.
    pub attributed_events: u64,
    /// Things that were everybody's and are open again, because "everybody" may now mean the newcomer too.
    pub reopened: Vec<ObjectRef>,
}
