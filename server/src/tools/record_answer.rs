//! `record_answer`: what a person said about the owner of a thing.

use coin::owners::OwnerSet;
use coin_schemas::report::AnswerStatus;
use coin_schemas::tools::{RecordAnswer, RecordAnswerResult};
use jiff::civil::DateTime;

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene;
use crate::store::{Household, RecordedAnswer, Store, StoreError, StoredObject, Writer};

pub(super) struct RecordAnswerTool;

impl Tool for RecordAnswerTool {
    const NAME: &'static str = "record_answer";
    const TITLE: &'static str = "Record a person's answer";
    const DESCRIPTION: &'static str = "Stores what a person answered when asked whose a thing is, with your \
        reading of the answer: true for every member of the household whom it makes an owner (several may own \
        a thing together; members left out are false). From then on the answer is what is believed of the \
        thing, until there is another answer or retract_answer takes it back. If the answer names nobody (\"I don't know\"), leave all false: \
        the status is then unresolved, and you may ask somebody else. If the owner is a guest or a neighbour, \
        set owner_outside_household. Call it only after a person has answered; what you conclude yourself \
        belongs into record_scores.";
    const EXAMPLE: &'static str = r#"{"object_id": "3", "question": "Whose marker is this?", "answer": "It is Bob's.", "ownership": {"Bob": true}}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = RecordAnswer;
    type Output = RecordAnswerResult;

    fn call(store: &Store, arguments: RecordAnswer) -> Result<RecordAnswerResult, ToolError> {
        let as_of = fields::time("as_of", arguments.as_of.as_deref())?;
        fields::text("question", &arguments.question)?;
        fields::text("answer", &arguments.answer)?;
        store.write(|writer| {
            let object = fields::object(writer, &arguments.object_id)?;
            let household = fields::household(writer)?;
            let present = scene::present(writer)?;
            let (answer, owners) = read_answer(&arguments, &household, as_of.unwrap_or(present))?;
            keep(writer, &household, &object, &answer, as_of)?;
            Ok(RecordAnswerResult {
                object: fields::object_ref(&object),
                owners: household.roster().owners(owners),
                scores: household.roster().indicator(owners),
                status: answer.status,
            })
        })
    }
}

/// Adds an answer to the history of a thing, unless it repeats the latest one. `as_of` is the time that the caller
/// gave, where one was given.
pub(super) fn keep(
    writer: &Writer<'_>,
    household: &Household,
    object: &StoredObject,
    answer: &RecordedAnswer,
    as_of: Option<DateTime>,
) -> Result<(), StoreError> {
    let history = writer.answers(household, object.key)?;
    if !history.last().is_some_and(|latest| repeats(answer, latest, as_of)) {
        writer.add_answer(household, object.key, answer)?;
    }
    Ok(())
}

fn read_answer(
    arguments: &RecordAnswer,
    household: &Household,
    at: DateTime,
) -> Result<(RecordedAnswer, OwnerSet), ToolError> {
    let roster = household.roster();
    let mut owners = OwnerSet::EMPTY;
    for (name, &owns) in &arguments.ownership {
        let user = fields::user(household, "ownership", name)?;
        if owns {
            owners = owners.with(user);
        }
    }
    let answered_by = arguments
        .answered_by
        .as_deref()
        .map(|name| fields::user(household, "answered_by", name).map(|user| roster.name(user).clone()))
        .transpose()?;
    let status = if owners.is_empty() && !arguments.owner_outside_household {
        AnswerStatus::Unresolved
    } else {
        AnswerStatus::Answered
    };
    let answer = RecordedAnswer {
        question: arguments.question.clone(),
        answer: arguments.answer.clone(),
        ownership: roster.ownership(owners),
        owner_outside_household: arguments.owner_outside_household,
        answered_by,
        at,
        status,
        retracted_at: None,
        reopened_at: None,
    };
    Ok((answer, owners))
}

/// Whether a call repeats the latest answer about the thing. A call that leaves the time to the server repeats
/// it whatever the time is by now. A call that repeats an older answer does not count, nor one that repeats an
/// answer that was taken back: somebody changed their mind, and changed it back.
fn repeats(answer: &RecordedAnswer, latest: &RecordedAnswer, as_of: Option<DateTime>) -> bool {
    let at = as_of.unwrap_or(latest.at);
    RecordedAnswer { at, ..answer.clone() } == *latest
}
