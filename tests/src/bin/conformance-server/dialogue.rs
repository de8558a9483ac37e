//! Requests that need input before they can be answered: the client brings it with the next try (2026-07-28).

use std::collections::BTreeMap;

use rmcp::ErrorData;
use rmcp::model::{
    ClientCapabilities, InputRequest, InputRequests, InputRequiredResult, InputResponses, RequestStateCodec,
};
use serde_json::{Value, json};

use crate::content;

/// What is asked for in each round. The last round is followed by the answer.
pub(crate) struct Dialogue {
    rounds: Vec<Value>,
}

/// Where a dialogue stands.
pub(crate) enum Stand {
    /// More is needed.
    Asks(InputRequiredResult),
    /// Everything is there.
    Ends {
        /// The last answers, in words.
        said: String,
    },
}

/// The dialogue of a tool or prompt that has one.
pub(crate) fn of(name: &str) -> Option<Dialogue> {
    let rounds = match name {
        "test_input_required_result_elicitation" | "test_streaming_elicitation" => {
            vec![json!({"user_name": form("What is your name?", "name", "string")})]
        }
        "test_input_required_result_sampling" => {
            vec![json!({"capital_question": sampling("What is the capital of France?", 100)})]
        }
        "test_input_required_result_list_roots" => vec![json!({"client_roots": roots()})],
        "test_input_required_result_request_state" | "test_input_required_result_tampered_state" => {
            vec![json!({"confirm": form("Please confirm", "ok", "boolean")})]
        }
        "test_input_required_result_multiple_inputs" | "test_input_required_result_capabilities" => {
            vec![json!({
                "user_name": form("What is your name?", "name", "string"),
                "greeting": sampling("Generate a greeting", 50),
                "client_roots": roots(),
            })]
        }
        "test_input_required_result_multi_round" => vec![
            json!({"step1": form("Step 1: What is your name?", "name", "string")}),
            json!({"step2": form("Step 2: What is your favorite color?", "color", "string")}),
        ],
        "test_input_required_result_prompt" => {
            vec![json!({"user_context": form("What context should the prompt use?", "context", "string")})]
        }
        _ => return None,
    };
    Some(Dialogue { rounds })
}

/// The tools that have a dialogue.
pub(crate) const TOOLS: [&str; 9] = [
    "test_input_required_result_elicitation",
    "test_input_required_result_sampling",
    "test_input_required_result_list_roots",
    "test_input_required_result_request_state",
    "test_input_required_result_multiple_inputs",
    "test_input_required_result_multi_round",
    "test_input_required_result_tampered_state",
    "test_input_required_result_capabilities",
    "test_streaming_elicitation",
];

/// The prompt that has one.
pub(crate) const PROMPT: &str = "test_input_required_result_prompt";

impl Dialogue {
    /// Goes on with what the client brought. Only what it can do is asked for; what it brings beyond that is
    /// passed over, and what is missing is asked for again.
    pub(crate) fn go_on(
        &self,
        codec: &RequestStateCodec,
        able: &ClientCapabilities,
        state: Option<&str>,
        brought: Option<&InputResponses>,
    ) -> Result<Stand, ErrorData> {
        let round: usize = match state {
            None => 0,
            Some(sealed) => codec
                .open_json(sealed)
                .map_err(|source| ErrorData::invalid_params(format!("requestState: {source}"), None))?,
        };
        let wanted = |round: usize| Some(requests(self.rounds.get(round)?, able));
        let Some(requests) = wanted(round) else { return Ok(end(state, brought)) };
        let is_there = |name| brought.and_then(|brought| brought.get(name)).is_some_and(Value::is_object);
        let next = if requests.keys().all(is_there) { round + 1 } else { round };
        let Some(requests) = wanted(next) else { return Ok(end(state, brought)) };
        let sealed = codec.seal_json(&next).expect("a number can be sealed");
        Ok(Stand::Asks(InputRequiredResult::new(Some(requests), Some(sealed))))
    }
}

fn end(state: Option<&str>, brought: Option<&InputResponses>) -> Stand {
    let state = state.map_or("no state", |_| "state-ok");
    let brought = brought.cloned().unwrap_or_else(BTreeMap::new);
    Stand::Ends { said: format!("{state}: {}", json!(brought)) }
}

/// Those requests of a round that the client can meet.
fn requests(round: &Value, able: &ClientCapabilities) -> InputRequests {
    let mut requests: InputRequests = content::of(round.clone());
    requests.retain(|_, request| match request {
        InputRequest::Elicitation(_) => able.elicitation.is_some(),
        InputRequest::CreateMessage(_) => able.sampling.is_some(),
        InputRequest::ListRoots(_) => able.roots.is_some(),
        _ => false,
    });
    requests
}

fn form(message: &str, field: &str, kind: &str) -> Value {
    let schema = json!({"type": "object", "properties": {field: {"type": kind}}, "required": [field]});
    json!({"method": "elicitation/create", "params": {"message": message, "requestedSchema": schema}})
}

fn sampling(text: &str, tokens: u32) -> Value {
    let message = json!({"role": "user", "content": {"type": "text", "text": text}});
    json!({"method": "sampling/createMessage", "params": {"messages": [message], "maxTokens": tokens}})
}

fn roots() -> Value {
    json!({"method": "roots/list", "params": {}})
}
