//! `ask_owner`: a person is asked whose a thing is, through the client's own form.

use std::time::Duration;

use coin::dialogue::{Meaning, Reading, choices, meaning_of, read_answer};
use coin_schemas::household::Owners;
use coin_schemas::report::AnswerStatus;
use coin_schemas::tools::{AskOutcome, AskOwner, AskOwnerResult};
use jiff::Timestamp;
use rmcp::model::JsonObject;
use serde_json::Value;

use super::conversation::{Form, FormState, Person, Reply, Turn};
use super::fields::{self, quoted};
use super::record_answer::keep;
use super::{Effect, Tool, ToolError};
use crate::scene::{Basis, Judgement, Moment, Scene};
use crate::store::{
    FormSerial, RecordedAnswer, Refusal, SERIAL_BYTES, Spending, Store, StoredObject, Writer,
};

/// How long a form may lie open: a person may be away from the screen for a while.
pub(crate) const FORM_LIFETIME: Duration = Duration::from_secs(3600);

/// How many of the likeliest owner sets a form offers in a household with too many sets to offer all.
const LIKELY_SETS: usize = 4;

pub(super) struct AskOwnerTool;

impl Tool for AskOwnerTool {
    const NAME: &'static str = "ask_owner";
    const TITLE: &'static str = "Ask a person whose a thing is";
    const DESCRIPTION: &'static str = "Asks the person whose a thing is, in a form of this application, then reads \
        and records the answer. Call it when whose_is says that a thing is not settled, or without object_id for \
        the thing that is most worth a question. If no form can be shown it fails and tells the question: ask it \
        in the chat, then call again with object_id and, as owner, what the person said. If the status is declined, \
        do not ask about that thing again; unresolved: the answer names nobody, somebody else may know.";
    const EXAMPLE: &'static str = r#"{"object_id": "3"}"#;
    const EFFECT: Effect = Effect::Asks;

    type Arguments = AskOwner;
    type Output = AskOwnerResult;

    fn call(store: &Store, arguments: AskOwner) -> Result<AskOwnerResult, ToolError> {
        match &arguments.owner {
            Some(words) => told(store, arguments.object_id.as_deref(), words),
            None => match question(store, arguments.object_id.as_deref())? {
                Turn::Done(result) => Ok(result),
                Turn::Ask(Form { state: FormState { question, object_id, .. }, .. }) => {
                    Err(ToolError::Unreachable { question, object_id: object_id.to_string() })
                }
            },
        }
    }

    fn converse(
        store: &Store,
        arguments: AskOwner,
        person: Person,
    ) -> Result<Turn<AskOwnerResult>, ToolError> {
        match (&arguments.owner, person) {
            (None, Person::Replied { state, reply }) => conclude(store, &state, reply).map(Turn::Done),
            (None, Person::WithinReach) => question(store, arguments.object_id.as_deref()),
            (Some(_), _) | (None, Person::OutOfReach) => Self::call(store, arguments).map(Turn::Done),
        }
    }
}

/// The thing in question: the one that is named, or the one that is most worth a question.
fn subject(
    scene: &Scene<'_>,
    object_id: Option<&str>,
) -> Result<Option<(StoredObject, Judgement)>, ToolError> {
    match object_id {
        Some(id) => {
            let object = fields::object(scene.reader(), id)?;
            let judgement = scene.judge(&object, Moment::Present)?;
            Ok(Some((object, judgement)))
        }
        None => Ok(scene.next_question()?.ask.map(|(object, judgement)| (object.clone(), judgement))),
    }
}

/// The form about a thing, unless there is nothing to ask or the person would not say.
fn question(store: &Store, object_id: Option<&str>) -> Result<Turn<AskOwnerResult>, ToolError> {
    store.read(|reader| {
        let scene = Scene::new(reader)?;
        let Some((object, judgement)) = subject(&scene, object_id)? else {
            return Ok(Turn::Done(nothing_to_ask()));
        };
        let question = scene.question(&object, &judgement)?;
        if scene.is_declined(&object)? {
            return Ok(Turn::Done(refused(&object, question, AskOutcome::Declined)));
        }
        let roster = scene.household().roster();
        let likely = judgement.likely_sets().take(LIKELY_SETS);
        let choices = choices(roster, likely).into_iter().map(|choice| choice.words).collect();
        let expires_at = Timestamp::now().as_second().saturating_add(FORM_LIFETIME.as_secs().cast_signed());
        let state = FormState::new(object.id, question.clone(), roster.len(), new_serial()?, expires_at);
        Ok(Turn::Ask(Form { message: question, choices, state }))
    })
}

fn new_serial() -> Result<FormSerial, ToolError> {
    let mut serial = [0; SERIAL_BYTES];
    getrandom::fill(&mut serial).map_err(|source| ToolError::NoRandomness { reason: source.to_string() })?;
    Ok(FormSerial(serial))
}

/// Records what the person made of a form. A form counts once.
fn conclude(store: &Store, state: &FormState, reply: Reply) -> Result<AskOwnerResult, ToolError> {
    store.write(|writer| {
        let now = Timestamp::now().as_second();
        if state.expires_at < now {
            return Err(ToolError::StaleForm { reason: "has expired" });
        }
        if writer.spend_form(state.serial(), state.expires_at, now)? == Spending::Repeated {
            return Err(ToolError::StaleForm { reason: "has been answered before, and a form counts once" });
        }
        if fields::household(writer)?.roster().len() != state.members {
            return Err(ToolError::StaleForm { reason: "was made before somebody joined the household" });
        }
        let object = fields::object(writer, state.object_id.as_str())?;
        let refusal = match reply {
            Reply::Accepted(content) => {
                let (reading, answer) = read_form(writer, state, &content)?;
                return record(writer, &object, &state.question, answer, reading);
            }
            Reply::Declined => (Refusal::Declined, AskOutcome::Declined),
            Reply::Cancelled => (Refusal::Cancelled, AskOutcome::Cancelled),
        };
        let present = Scene::new(writer)?.present()?;
        writer.add_refusal(object.key, &state.question, refusal.0, present)?;
        Ok(refused(&object, state.question.clone(), refusal.1))
    })
}

/// What a form says, and in what words.
fn read_form(
    writer: &Writer<'_>,
    state: &FormState,
    content: &JsonObject,
) -> Result<(Reading, String), ToolError> {
    let household = fields::household(writer)?;
    let text = |field: &str| match content.get(field) {
        None | Some(Value::Null) => Ok(""),
        Some(Value::String(text)) => fields::text(field, text.trim()),
        Some(other) => Err(ToolError::field(field, format!("{other} is given; a text is expected"))),
    };
    let (choice, own_words) = (text(Form::CHOICE)?, text(Form::OWN_WORDS)?);
    let meaning = meaning_of(household.roster(), choice).ok_or_else(|| {
        ToolError::field(
            Form::CHOICE,
            format!("{} is none of the choices of the form; pick one of them", quoted(choice)),
        )
    })?;
    match (meaning, own_words) {
        (Meaning::OwnWords, "") => Err(ToolError::field(
            Form::OWN_WORDS,
            "it is empty, although the choice says that the answer stands there",
        )),
        (Meaning::OwnWords, words) => {
            Ok((read_answer(household.roster(), &state.question, words, None), words.to_owned()))
        }
        (Meaning::Says(reading), "") => Ok((reading, choice.to_owned())),
        (Meaning::Says(reading), words) => Ok((reading, format!("{choice} ({words})"))),
    }
}

/// Records what the person said in the chat. It has to be said of which thing: another one may be the most worth a
/// question by now.
fn told(store: &Store, object_id: Option<&str>, words: &str) -> Result<AskOwnerResult, ToolError> {
    let words = fields::text("owner", words.trim())?;
    let object_id = object_id.ok_or_else(|| {
        ToolError::field(
            "object_id",
            "it is missing; with owner, give the id of the thing that was asked about",
        )
    })?;
    store.write(|writer| {
        let scene = Scene::new(writer)?;
        let object = fields::object(writer, object_id)?;
        let judgement = scene.judge(&object, Moment::Present)?;
        let question = match &judgement.basis {
            // Whoever repeats what is believed answers the question that was answered before.
            Basis::Answer(answer) if answer.answer == words => answer.question.clone(),
            _ => scene.question(&object, &judgement)?,
        };
        let reading = read_answer(scene.household().roster(), &question, words, None);
        record(writer, &object, &question, words.to_owned(), reading)
    })
}

fn record(
    writer: &Writer<'_>,
    object: &StoredObject,
    question: &str,
    answer: String,
    reading: Reading,
) -> Result<AskOwnerResult, ToolError> {
    let household = fields::household(writer)?;
    let roster = household.roster();
    let Reading { owners, outside_household } = reading;
    let (status, outcome) = if reading.is_unresolved() {
        (AnswerStatus::Unresolved, AskOutcome::Unresolved)
    } else {
        (AnswerStatus::Answered, AskOutcome::Answered)
    };
    let recorded = RecordedAnswer {
        question: question.to_owned(),
        answer,
        ownership: roster.ownership(owners),
        owner_outside_household: outside_household,
        answered_by: None,
        at: Scene::new(writer)?.present()?,
        status,
        retracted_at: None,
        reopened_at: None,
    };
    keep(writer, &household, object, &recorded, None)?;
    Ok(AskOwnerResult {
        status: outcome,
        object: Some(fields::object_ref(object)),
        question: Some(recorded.question),
        answer: Some(recorded.answer),
        owners: roster.owners(owners),
        owner_outside_household: outside_household,
        scores: Some(roster.indicator(owners)),
    })
}

fn refused(object: &StoredObject, question: String, outcome: AskOutcome) -> AskOwnerResult {
    AskOwnerResult {
        object: Some(fields::object_ref(object)),
        question: Some(question),
        ..without_answer(outcome)
    }
}

fn nothing_to_ask() -> AskOwnerResult {
    without_answer(AskOutcome::NothingToAsk)
}

fn without_answer(status: AskOutcome) -> AskOwnerResult {
    AskOwnerResult {
        status,
        object: None,
        question: None,
        answer: None,
        owners: Owners::new(),
        owner_outside_household: false,
        scores: None,
    }
}
