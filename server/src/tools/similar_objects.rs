//! `similar_objects`: what looks like a thing.

use coin_schemas::tools::{MAX_K, SimilarObjects, SimilarObjectsResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene::{LookAlikes, Scene};
use crate::store::Store;

const NO_FEATURE: &str = "This object has no visual features, so nothing can be compared with it.";
const NO_OTHER_FEATURES: &str = "No other object has visual features, so nothing can be compared.";

pub(super) struct SimilarObjectsTool;

impl Tool for SimilarObjectsTool {
    const NAME: &'static str = "similar_objects";
    const TITLE: &'static str = "Things that look like a thing";
    const DESCRIPTION: &'static str = "The things that look most like a thing, with their similarity (cosine of \
        visual features, 1 is alike) and known_ownership where their owners are reliably known. One person's \
        things often look alike, so known owners of close look-alikes are evidence; it is weaker than use \
        (get_usage_summary). An object without visual features gets an empty list and a note.";
    const EXAMPLE: &'static str = r#"{"object_id": "3", "k": 5}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = SimilarObjects;
    type Output = SimilarObjectsResult;

    fn call(store: &Store, arguments: SimilarObjects) -> Result<SimilarObjectsResult, ToolError> {
        let k = fields::within("k", arguments.k, &(1..=MAX_K))? as usize;
        store.read(|reader| {
            let object = fields::object(reader, &arguments.object_id)?;
            let (similar_objects, note) = match Scene::new(reader)?.look_alikes(&object, k)? {
                LookAlikes::Found(found) => (found, None),
                LookAlikes::NeverSeen => (Vec::new(), Some(NO_FEATURE.to_owned())),
                LookAlikes::NothingToCompare => (Vec::new(), Some(NO_OTHER_FEATURES.to_owned())),
            };
            Ok(SimilarObjectsResult { object: fields::object_ref(&object), similar_objects, note })
        })
    }
}
