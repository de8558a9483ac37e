//! `whose_is`: whose a thing is held to be, how surely, and why.

use coin_schemas::tools::{WhoseIs, WhoseIsResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene::{Moment, Scene};
use crate::store::Store;

pub(super) struct WhoseIsTool;

impl Tool for WhoseIsTool {
    const NAME: &'static str = "whose_is";
    const TITLE: &'static str = "Whose is this?";
    const DESCRIPTION: &'static str = "Tells who most probably owns a thing, how sure that is, and in two sentences \
        why: a person's answer, or else what COIN concludes from who used the thing, what lies near it and what \
        looks like it. Find the id with list_objects first. If settled is true, go by owners. If it is false, do \
        not guess: call ask_owner with the same id. It needs no judgement of yours; to hand in your own, see \
        record_scores.";
    const EXAMPLE: &'static str = r#"{"object_id": "3"}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = WhoseIs;
    type Output = WhoseIsResult;

    fn call(store: &Store, arguments: WhoseIs) -> Result<WhoseIsResult, ToolError> {
        let as_of = fields::time("as_of", arguments.as_of.as_deref())?;
        let moment = as_of.map_or(Moment::Present, Moment::Past);
        store.read(|reader| {
            let object = fields::object(reader, &arguments.object_id)?;
            let scene = Scene::new(reader)?;
            let judgement = scene.judge(&object, moment)?;
            let roster = scene.household().roster();
            Ok(WhoseIsResult {
                object: fields::object_ref(&object),
                owners: roster.owners(judgement.reading.owners),
                owner_outside_household: judgement.reading.outside_household,
                confidence: judgement.confidence,
                scores: roster.scores(&judgement.scores),
                prediction_set: roster.owners(judgement.assessment.prediction_set),
                uncertainty: judgement.assessment.uncertainty,
                settled: judgement.is_settled(),
                source: judgement.source(),
                evidence: scene.evidence(&object, &judgement),
                explanation: scene.explanation(&object, &judgement),
            })
        })
    }
}
