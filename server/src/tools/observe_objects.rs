//! `observe_objects`: what a robot or a camera detected becomes things of the map.

use coin_schemas::tools::{MAX_OBSERVATIONS, ObserveObjects, ObserveObjectsResult};

use super::{Effect, Tool, ToolError};
use crate::observations::Batch;
use crate::store::Store;

/// After so many observations it is looked whether somebody still waits.
const OBSERVATIONS_BETWEEN_LOOKS: usize = 100;

pub(super) struct ObserveObjectsTool;

impl Tool for ObserveObjectsTool {
    const NAME: &'static str = "observe_objects";
    const TITLE: &'static str = "Put detections on the map";
    const DESCRIPTION: &'static str = "Stores what a robot or camera detected. A detection joins the thing that it is \
        another sighting of, by place, extent, class and look, or becomes a new thing. A thing that was moved keeps its \
        id and its owner. Detections that cannot be stored are listed in rejected, and all others are stored together.";
    const EXAMPLE: &'static str = r#"{"observations": [{"class": "cup", "position": [1.2, 0.4, 0.8], "radius": 0.05, "seen_at": "2025-01-19T19:00:00", "view": "kitchen-17"}]}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = ObserveObjects;
    type Output = ObserveObjectsResult;

    fn call(store: &Store, arguments: ObserveObjects) -> Result<ObserveObjectsResult, ToolError> {
        let ObserveObjects { observations, views } = arguments;
        if observations.len() > MAX_OBSERVATIONS {
            return Err(ToolError::field(
                "observations",
                format!("{} are given; at most {MAX_OBSERVATIONS} are allowed in a call", observations.len()),
            ));
        }
        let mut batch = Batch::new();
        for (index, observation) in observations.iter().enumerate() {
            if index % OBSERVATIONS_BETWEEN_LOOKS == 0 {
                store.call().go_on()?;
            }
            batch.add_value(index as u64, observation);
        }
        for (place, view) in views.iter().enumerate() {
            batch.add_view(view).map_err(|problem| ToolError::field(format!("views[{place}]"), problem))?;
        }
        Ok(batch.observe(store)?)
    }
}
