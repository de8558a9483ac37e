//! `similar_objects`: what looks like a thing.

use coin::similarity::{most_similar, normalise};
use coin_schemas::tools::{LookAlike, MAX_K, SimilarObjects, SimilarObjectsResult, display_name};

use super::fields::{self, four_decimals};
use super::known_ownership::known_ownership;
use super::{Effect, Tool, ToolError};
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
            let household = fields::household(reader)?;
            let without = |note: &str| SimilarObjectsResult {
                object: fields::object_ref(&object),
                similar_objects: Vec::new(),
                note: Some(note.to_owned()),
            };
            let target = reader.feature(object.key)?.and_then(|feature| normalise(&feature));
            let Some(target) = target else { return Ok(without(NO_FEATURE)) };
            let objects = reader.objects()?;
            let features = reader.features()?;
            // Objects come by id, so their place stands for the id where similarities are equal.
            let others: Vec<(usize, Vec<f32>)> = objects
                .iter()
                .enumerate()
                .filter(|(_, other)| other.key != object.key)
                .filter_map(|(place, other)| Some((place, normalise(features.get(&other.key)?)?)))
                .collect();
            if others.is_empty() {
                return Ok(without(NO_OTHER_FEATURES));
            }
            let alike =
                most_similar(&target, others.iter().map(|(place, feature)| (*place, feature.as_slice())), k);
            let similar_objects = alike
                .into_iter()
                .map(|similar| {
                    let other = &objects[similar.item];
                    let belief = reader.belief(other.key)?;
                    Ok(LookAlike {
                        id: other.id.clone(),
                        name: display_name(&other.class),
                        similarity: four_decimals(similar.similarity),
                        known_ownership: belief
                            .and_then(|belief| known_ownership(household.roster(), &belief)),
                    })
                })
                .collect::<Result<_, ToolError>>()?;
            Ok(SimilarObjectsResult { object: fields::object_ref(&object), similar_objects, note: None })
        })
    }
}
