//! `next_question`: which thing is most worth asking a person about.

use coin_schemas::tools::{NextQuestion, NextQuestionResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene::Scene;
use crate::store::Store;

pub(super) struct NextQuestionTool;

impl Tool for NextQuestionTool {
    const NAME: &'static str = "next_question";
    const TITLE: &'static str = "The question most worth asking";
    const DESCRIPTION: &'static str = "Goes over all things and tells which one a person should be asked about \
        first, with the question ready to be asked, or that no question is worth it (done). To settle a whole home, \
        call ask_owner and next_question in turn until done; every answer also makes other things clearer. Things \
        that somebody would not tell about are passed over, and none is proposed more than twice.";
    const EXAMPLE: &'static str = "{}";
    const EFFECT: Effect = Effect::Reads;

    type Arguments = NextQuestion;
    type Output = NextQuestionResult;

    fn call(store: &Store, _: NextQuestion) -> Result<NextQuestionResult, ToolError> {
        store.read(|reader| {
            let scene = Scene::new(reader)?;
            let next = scene.next_question()?;
            let Some((object, judgement)) = next.ask else {
                return Ok(NextQuestionResult {
                    done: true,
                    unsettled: next.unsettled,
                    ..NextQuestionResult::default()
                });
            };
            let roster = scene.household().roster();
            Ok(NextQuestionResult {
                done: false,
                unsettled: next.unsettled,
                object: Some(fields::object_ref(object)),
                candidates: Some(roster.owners(judgement.candidates(roster))),
                scores: Some(roster.scores(&judgement.scores)),
                uncertainty: Some(judgement.assessment.uncertainty),
                why: Some(scene.explanation(object, &judgement)),
                question: Some(scene.question(object, &judgement)?),
            })
        })
    }
}
