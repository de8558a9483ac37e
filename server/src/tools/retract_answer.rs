//! `retract_answer`: what a person said does not count any more.

use coin_schemas::tools::{RetractAnswer, RetractAnswerResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene;
use crate::store::{Belief, Retraction, Store};

pub(super) struct RetractAnswerTool;

impl Tool for RetractAnswerTool {
    const NAME: &'static str = "retract_answer";
    const TITLE: &'static str = "Take a person's answer back";
    const DESCRIPTION: &'static str = "Takes back the answer that is believed about a thing, as if it had not \
        been given, and tells what is believed then: what was last handed in with record_scores, if anything; \
        an answer from before does not count again. The history keeps the answer and when it was taken back. \
        Call it when a person says that the last answer was a slip and does not give the right one; otherwise \
        call record_answer with the right one, which replaces it.";
    const EXAMPLE: &'static str = r#"{"object_id": "3"}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = RetractAnswer;
    type Output = RetractAnswerResult;

    fn call(store: &Store, arguments: RetractAnswer) -> Result<RetractAnswerResult, ToolError> {
        store.write(|writer| {
            let object = fields::object(writer, &arguments.object_id)?;
            let present = scene::present(writer)?;
            if writer.retract_answer(object.key, present)? == Retraction::NothingToRetract {
                return Err(ToolError::field(
                    "object_id",
                    format!(
                        "there is no answer to take back: what is believed of object {} was not said by a person. \
                         list_objects tells as source where a belief comes from.",
                        fields::quoted(object.id.as_str())
                    ),
                ));
            }
            let belief = writer.belief(object.key)?;
            let belief = belief.as_ref();
            Ok(RetractAnswerResult {
                object: fields::object_ref(&object),
                owners: belief.map(|belief| belief.owners().clone()).unwrap_or_default(),
                confidence: belief.map_or(0.0, Belief::confidence),
                settled: belief.is_some_and(Belief::is_settled),
                source: belief.map(Belief::source),
            })
        })
    }
}
