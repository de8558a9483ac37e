//! Calls of tools, and the forms that a person fills in between two of them.

use std::sync::{Arc, LazyLock};

use rmcp::model::{
    CallToolRequestParams, CallToolResponse, CallToolResult, ContentBlock, ElicitationCapability, JsonObject,
    ProtocolVersion,
};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer};
use serde_json::Value;

use super::work;
use super::{CallError, CoinService, forms};
use crate::store::{Call, Store};
use crate::tools::{Entry, FORM_LIFETIME, Form, Person, ToolError, Turn};

/// How a client shows forms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Forms {
    /// Not at all.
    None,
    /// When a result asks for it; it then makes the call again (2026-07-28).
    BetweenCalls,
    /// When it is asked to while the call is under way (before).
    DuringCalls,
}

/// What a tool has come to.
enum Outcome {
    Done(Value),
    /// A form, and its state sealed for the client to keep.
    Ask(Form, String),
}

/// Why a call has come to nothing.
enum Failure {
    /// The request itself is wrong.
    Request(String),
    /// The tool refused it or failed.
    Tool(String),
}

impl CoinService {
    pub(super) async fn answer(
        &self,
        request: CallToolRequestParams,
        context: &RequestContext<RoleServer>,
    ) -> Result<CallToolResponse, ErrorData> {
        let forms = forms_of(context);
        // A call may hold fifty thousand captions, which are not copied to the thread that works on them.
        let request = Arc::new(request);
        let outcome = match self.run(&request, forms, None, context).await {
            Ok(Outcome::Ask(form, _)) if forms == Forms::DuringCalls => {
                let person = self.put(form, context).await;
                self.run(&request, Forms::None, Some(person), context).await
            }
            outcome => outcome,
        };
        match outcome {
            Ok(Outcome::Done(result)) => Ok(CallToolResult::structured(result).into()),
            Ok(Outcome::Ask(form, sealed)) => Ok(forms::required(&form, sealed).into()),
            Err(Failure::Tool(message)) => {
                Ok(CallToolResult::error(vec![ContentBlock::text(message)]).into())
            }
            Err(Failure::Request(message)) => Err(ErrorData::invalid_params(message, None)),
        }
    }

    /// Shows a form while the call is under way. A client that cannot show it after all is one that shows none.
    async fn put(&self, form: Form, context: &RequestContext<RoleServer>) -> Person {
        let asked = context.peer.create_elicitation_with_timeout(forms::request(&form), Some(FORM_LIFETIME));
        let answered = tokio::select! {
            answered = asked => answered.ok(),
            () = context.ct.cancelled() => None,
        };
        match answered.and_then(forms::reply) {
            Some(reply) => Person::Replied { state: form.state, reply },
            None => Person::OutOfReach,
        }
    }

    /// Runs a tool. One that panics is answered like one that failed.
    async fn run(
        &self,
        request: &Arc<CallToolRequestParams>,
        forms: Forms,
        person: Option<Person>,
        context: &RequestContext<RoleServer>,
    ) -> Result<Outcome, Failure> {
        let done = if person.is_none() && self.is_brief(request) {
            work::run_brief(|| self.act(&self.store, request, person, forms))
        } else {
            let (service, request) = (self.clone(), Arc::clone(request));
            let act = move |call: &Call| service.act(&service.store.during(call), &request, person, forms);
            work::run(&self.places, context, act).await
        };
        done.map_err(|undone| Failure::Tool(undone.to_string()))?
    }

    /// Whether a call is over before it could be handed to another thread: the tool looks at one thing only, and a
    /// connection is free for it.
    fn is_brief(&self, request: &CallToolRequestParams) -> bool {
        self.tools.get(&request.name).is_some_and(Entry::is_brief) && self.store.is_free_to_read()
    }

    fn act(
        &self,
        store: &Store,
        request: &CallToolRequestParams,
        person: Option<Person>,
        forms: Forms,
    ) -> Result<Outcome, Failure> {
        let person = person.map_or_else(|| self.person(store, request, forms), Ok)?;
        self.turn(store, request, person)
    }

    /// How the person can be reached, or what the client brings from the person.
    fn person(
        &self,
        store: &Store,
        request: &CallToolRequestParams,
        forms: Forms,
    ) -> Result<Person, Failure> {
        let without_reply = match forms {
            Forms::None => Person::OutOfReach,
            Forms::BetweenCalls | Forms::DuringCalls => Person::WithinReach,
        };
        let asks = self.tools.get(&request.name).is_some_and(Entry::asks);
        let Some(sealed) = request.request_state.as_ref().filter(|_| asks) else { return Ok(without_reply) };
        let state = forms::open(store, &request.name, arguments_of(request), sealed)
            .map_err(|source| Failure::Request(source.to_string()))?;
        Ok(match forms::brought_back(request.input_responses.as_ref()) {
            Some(reply) => Person::Replied { state, reply },
            None => without_reply,
        })
    }

    fn turn(
        &self,
        store: &Store,
        request: &CallToolRequestParams,
        person: Person,
    ) -> Result<Outcome, Failure> {
        let tool = self
            .tools
            .get(&request.name)
            .ok_or_else(|| Failure::Request(self.tools.unknown(&request.name).to_string()))?;
        let arguments = arguments_of(request);
        match tool.call(store, arguments, person) {
            Ok(Turn::Done(result)) => Ok(Outcome::Done(result)),
            Ok(Turn::Ask(form)) => {
                let sealed = forms::seal(store, &request.name, arguments, &form.state)
                    .map_err(|source| Failure::Tool(source.to_string()))?;
                Ok(Outcome::Ask(form, sealed))
            }
            Err(stale @ ToolError::StaleForm { .. }) => {
                Err(Failure::Request(format!("requestState: {stale}")))
            }
            Err(error) => Err(Failure::Tool(error.to_string())),
        }
    }

    /// Calls a tool on this thread, which may wait for the disk, without the protocol around it and without a person to
    /// ask.
    ///
    /// # Errors
    /// If there is no such tool, or if it refuses the call; the text says why.
    pub fn call(&self, tool: &str, arguments: &JsonObject) -> Result<Value, CallError> {
        let tool = self.tools.get(tool).ok_or_else(|| CallError::Unknown(self.tools.unknown(tool)))?;
        let turn = tool.call(&self.store, arguments, Person::OutOfReach);
        match turn.map_err(|error| CallError::Refused(error.to_string()))? {
            Turn::Done(result) => Ok(result),
            Turn::Ask(form) => Err(CallError::Refused(form.message)),
        }
    }
}

/// What a call is given; nothing where it says nothing of it.
fn arguments_of(request: &CallToolRequestParams) -> &JsonObject {
    static NONE: LazyLock<JsonObject> = LazyLock::new(JsonObject::new);
    request.arguments.as_ref().unwrap_or(&NONE)
}

/// Whether the protocol of a request is that of 2026, in which every request stands on its own.
pub(super) fn is_modern(context: &RequestContext<RoleServer>) -> bool {
    context.protocol_version().is_some_and(|version| version >= ProtocolVersion::V_2026_07_28)
}

fn forms_of(context: &RequestContext<RoleServer>) -> Forms {
    let capability = context.client_capabilities().and_then(|capabilities| capabilities.elicitation);
    // A client that names no kind of elicitation is one from before there were two.
    let shows = |capability: &ElicitationCapability| capability.form.is_some() || capability.url.is_none();
    match capability.is_some_and(|capability| shows(&capability)) {
        false => Forms::None,
        true if is_modern(context) => Forms::BetweenCalls,
        true => Forms::DuringCalls,
    }
}
