//! `nearby_objects`: what lies close to a thing.

use coin::space::Neighbourhood;
use coin_schemas::tools::{MAX_K, NearbyObjects, NearbyObjectsResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene::Scene;
use crate::store::Store;

const SIGMAS: std::ops::RangeInclusive<f64> = 0.001..=1000.0;
const GAMMAS: std::ops::RangeInclusive<f64> = 0.0..=1000.0;
const WEIGHTS: std::ops::RangeInclusive<f64> = 0.0..=1.0;

pub(super) struct NearbyObjectsTool;

impl Tool for NearbyObjectsTool {
    const NAME: &'static str = "nearby_objects";
    const TITLE: &'static str = "Things near a thing";
    const DESCRIPTION: &'static str = "The things that lie close to a thing, with distance (metres), a weight \
        from 0 to 1, and known_ownership where their owners are reliably known. People keep their things \
        together, so known owners of neighbours with a large weight are evidence; it is weaker than use \
        (get_usage_summary). The defaults suit a home.";
    const EXAMPLE: &'static str = r#"{"object_id": "3", "k": 5}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = NearbyObjects;
    type Output = NearbyObjectsResult;

    fn call(store: &Store, arguments: NearbyObjects) -> Result<NearbyObjectsResult, ToolError> {
        let neighbourhood = Neighbourhood {
            k: fields::within("k", arguments.k, &(1..=MAX_K))? as usize,
            sigma: fields::within("sigma", arguments.sigma, &SIGMAS)?,
            gamma: fields::within("gamma", arguments.gamma, &GAMMAS)?,
            min_weight: fields::within("min_weight", arguments.min_weight, &WEIGHTS)?,
        };
        store.read(|reader| {
            let object = fields::object(reader, &arguments.object_id)?;
            let nearby_objects = Scene::new(reader)?.nearby(&object, &neighbourhood)?;
            Ok(NearbyObjectsResult { object: fields::placed_object_ref(&object), nearby_objects })
        })
    }
}
