//! Forms on their way through a client: sealed, so that nobody on the way changes what they are about.

use std::collections::BTreeMap;

use coin_schemas::tools::MAX_TEXT_BYTES;
use rmcp::model::{
    ElicitRequest, ElicitRequestParams, ElicitResult, ElicitationAction, ElicitationSchema, EnumSchema,
    InputRequest, InputRequests, InputRequiredResult, JsonObject, PrimitiveSchemaDefinition,
    RequestStateCodec, RequestStateError, SealOptions, StringSchema,
};
use serde_json::Value;
use thiserror::Error;

use crate::store::{FORM_KEY_BYTES, Store, StoreError};
use crate::tools::{FORM_LIFETIME, Form, FormState, Reply};

/// The name of the one form of a result, under which the client brings it back.
const FORM: &str = "whose_is_this";

/// Why a form cannot be sealed or opened.
#[derive(Debug, Error)]
pub(super) enum SealError {
    /// What the client brought back is no form of this home for this call.
    #[error(
        "requestState: {0}. It must come back as it was given, with the same tool and arguments; \
         call the tool again without it for a new form"
    )]
    State(#[from] RequestStateError),
    /// The key could not be read or made.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The operating system gives no random numbers.
    #[error("no form can be made, because the operating system gives no random numbers: {0}")]
    NoRandomness(getrandom::Error),
}

/// Seals a form's state for the call of this tool with these arguments. It opens for no other.
pub(super) fn seal(
    store: &Store,
    tool: &str,
    arguments: &JsonObject,
    state: &FormState,
) -> Result<String, SealError> {
    let bound = bound_to(tool, arguments);
    let options = SealOptions::new().associated_data(&bound).ttl(FORM_LIFETIME);
    Ok(RequestStateCodec::try_new(key(store)?.to_vec())?.seal_json_with(state, &options)?)
}

/// Opens what [`seal`] has sealed, unless it has expired.
pub(super) fn open(
    store: &Store,
    tool: &str,
    arguments: &JsonObject,
    sealed: &str,
) -> Result<FormState, SealError> {
    // Where there is no key yet, no form was ever sealed.
    let key = known_key(store)?.ok_or(RequestStateError::UnknownKeyId)?;
    let codec = RequestStateCodec::try_new(key.to_vec())?;
    Ok(codec.open_json_with(sealed, &bound_to(tool, arguments))?)
}

/// The tool and its arguments as bytes, whatever order the client wrote them in.
fn bound_to(tool: &str, arguments: &JsonObject) -> Vec<u8> {
    let sorted: BTreeMap<&String, &Value> = arguments.iter().collect();
    format!("{tool}\0{}", serde_json::to_string(&sorted).unwrap_or_default()).into_bytes()
}

fn known_key(store: &Store) -> Result<Option<[u8; FORM_KEY_BYTES]>, SealError> {
    store.read(|reader| Ok(reader.form_key()?))
}

/// The home's key, which is made when the first form is.
fn key(store: &Store) -> Result<[u8; FORM_KEY_BYTES], SealError> {
    if let Some(key) = known_key(store)? {
        return Ok(key);
    }
    let mut proposed = [0; FORM_KEY_BYTES];
    getrandom::fill(&mut proposed).map_err(SealError::NoRandomness)?;
    Ok(store.write(|writer| writer.propose_form_key(&proposed))?)
}

/// The form as both protocols ask for it.
pub(super) fn request(form: &Form) -> ElicitRequestParams {
    let choice = EnumSchema::builder(form.choices.clone()).title("Whose is it?").build();
    let own_words = StringSchema::new()
        .title("In your own words (optional)")
        .max_length(u32::try_from(MAX_TEXT_BYTES).unwrap_or(u32::MAX));
    let mut schema = ElicitationSchema::builder()
        .required_enum_schema(Form::CHOICE, choice)
        .property(Form::OWN_WORDS, PrimitiveSchemaDefinition::String(own_words))
        .build_unchecked();
    schema.property_order = Some(vec![Form::CHOICE.to_owned(), Form::OWN_WORDS.to_owned()]);
    ElicitRequestParams::FormElicitationParams {
        meta: None,
        message: form.message.clone(),
        requested_schema: schema,
    }
}

/// The result that asks a client of 2026 to show the form and to call again.
pub(super) fn required(form: &Form, sealed: String) -> InputRequiredResult {
    let request = InputRequest::Elicitation(ElicitRequest::new(request(form)));
    InputRequiredResult::new(Some(InputRequests::from([(FORM.to_owned(), request)])), Some(sealed))
}

/// What the person made of the form, by a client of 2026; `None` where it does not say.
pub(super) fn brought_back(responses: Option<&BTreeMap<String, Value>>) -> Option<Reply> {
    let response = responses?.get(FORM)?;
    reply(serde_json::from_value(response.clone()).ok()?)
}

/// What the person made of the form; `None` where it was accepted without being filled in.
pub(super) fn reply(result: ElicitResult) -> Option<Reply> {
    match (result.action, result.content) {
        (ElicitationAction::Accept, Some(Value::Object(content))) => Some(Reply::Accepted(content)),
        (ElicitationAction::Decline, _) => Some(Reply::Declined),
        (ElicitationAction::Cancel, _) => Some(Reply::Cancelled),
        _ => None,
    }
}
