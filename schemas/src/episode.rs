//! An episode: a folder that holds a home, what was seen there and, for judging, the truth.

use std::collections::BTreeMap;

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::household::{ClassLabel, ObjectId, Owners, Position, UsageType, Users};

/// The number of components of a visual feature (the CLIP image encoder of the paper).
pub const FEATURE_DIMENSIONS: usize = 512;

/// `episode.json`: the home and the names of the files beside it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Episode {
    /// A short name for reports.
    pub name: String,
    /// What the episode shows and how it was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub description: Option<String>,
    /// The members of the household, by name.
    pub users: Users,
    /// The things in the home's map.
    pub objects: Vec<EpisodeObject>,
    /// The file of usage captions, relative to the folder: JSON Lines of [`CaptionLine`].
    pub captions: String,
    /// The file of visual features, relative to the folder: NumPy float32 `[objects, 512]` in C order; row i
    /// belongs to `objects[i]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub embeddings: Option<String>,
    /// The file of true owners, relative to the folder: one [`Truth`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub truth: Option<String>,
    /// The moment at which the question "whose is this?" is put, in the home's local time.
    #[schemars(with = "String")]
    pub now: DateTime,
    /// The end of the first part, where an experiment splits the history in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub train_until: Option<DateTime>,
}

/// A thing in the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EpisodeObject {
    /// Its id, unique in the episode.
    pub id: ObjectId,
    /// Its class label.
    pub class: ClassLabel,
    /// Where it is, in metres.
    pub position: Position,
    /// The room that it is in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub room: Option<String>,
}

/// One line of the caption file: something that was seen to be done with a thing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CaptionLine {
    /// The thing.
    pub object_id: ObjectId,
    /// `YYYY-MM-DD HH:MM[:SS] TEXT`, the time being the home's local time.
    pub caption: String,
}

/// `truth.json`: who really owns what. It reaches the simulated person and the scorer only.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Truth {
    /// The owners of every thing.
    pub owners: BTreeMap<ObjectId, Owners>,
    /// How every thing is used, for results by usage type.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "BTreeMap<ObjectId, UsageType>")]
    pub usage_type: Option<BTreeMap<ObjectId, UsageType>>,
}
