//! Detections of a robot or camera that become things of the map.

use jiff::civil::DateTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::household::{ObjectId, Position};

/// Arguments of `observe_objects`.
///
/// Observations are read one by one, so that one that cannot be read does not keep the others out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObserveObjects {
    /// What was detected; at most 10000.
    #[schemars(with = "Vec<Observation>")]
    pub observations: Vec<Value>,
    /// What each view had in sight, so that a thing which it does not show is known to be gone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub views: Vec<SeenView>,
}

/// A detection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Observation {
    /// What the detector calls the thing.
    pub class: String,
    /// Its middle, `[x, y, z]` in metres.
    pub position: [f64; 3],
    /// Its extent, metres above 0.
    pub radius: f64,
    /// Its visual feature: 512 numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<f64>")]
    pub embedding: Option<Vec<f32>>,
    /// Local time.
    pub seen_at: String,
    /// Names the image: things of one view are never one thing. Default: a view of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub view: Option<String>,
    /// The room, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub room: Option<String>,
}

/// What a view had in sight: a box along the axes of the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeenView {
    /// The view, as the observations name it.
    pub view: String,
    /// When it was taken; needed where no observation is of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub seen_at: Option<String>,
    /// The corner with the smallest coordinates.
    pub least: [f64; 3],
    /// The corner with the largest coordinates.
    pub greatest: [f64; 3],
}

/// Result of `observe_objects`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObserveObjectsResult {
    /// What became of the observations that were taken in.
    pub results: Vec<SeenObject>,
    /// Observations that were refused; all others are stored.
    pub rejected: Vec<RejectedObservation>,
    /// Things that turned out to have been moved.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<MovedObject>,
    /// Things of which it cannot be told whether they are ones that are missing elsewhere; a person can.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub perhaps_moved: Vec<PerhapsMoved>,
}

/// The thing that an observation is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeenObject {
    /// The observation's place in the call, from 0.
    pub index: u64,
    /// The thing.
    pub object_id: ObjectId,
    /// Whether the map did not have it before.
    pub new: bool,
    /// How far the observation is from what the thing was before: the Jeffreys divergence in nats. Absent for a new thing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub divergence: Option<f64>,
    /// How often the thing was seen so far.
    pub views: u64,
}

/// An observation that was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RejectedObservation {
    /// Its place in the call, from 0.
    pub index: u64,
    /// What is wrong with it.
    pub reason: String,
}

/// A thing that was moved and kept its id.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MovedObject {
    /// The thing.
    pub object_id: ObjectId,
    /// Where it was, in metres.
    pub from: Position,
    /// Where it is, in metres.
    pub to: Position,
    /// When it was first seen there.
    #[schemars(with = "String")]
    pub at: DateTime,
}

/// A thing that may be one of several.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PerhapsMoved {
    /// The thing that was seen.
    pub object_id: ObjectId,
    /// The things that it may be.
    pub candidates: Vec<ObjectId>,
}
