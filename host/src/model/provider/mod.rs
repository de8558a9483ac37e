//! Language models behind HTTP: OpenAI's chat completions, which many servers speak, and Anthropic's messages; and
//! encoders of words, in OpenAI's form.
//!
//! A request is made and an answer read by pure functions (`openai`, `anthropic`). Between them stands one way
//! of sending: with a time limit, retries, a circuit breaker over all calls, and parameters that are taken back
//! where a server refuses them.

mod anthropic;
mod breaker;
mod concessions;
mod connection;
mod encoder;
mod endpoint;
mod explanation;
mod failure;
mod openai;
mod retry;
mod transport;

use std::collections::BTreeSet;
use std::fmt;
use std::time::Duration;

use async_trait::async_trait;
use serde_json::Value;

use self::concessions::{Concessions, Offer};
use self::connection::Connection;
pub use self::encoder::{EncoderName, RemoteEncoder, UnknownEncoder};
use self::endpoint::{Endpoint, KeyNeed, Service};
use self::retry::GivenUp;
pub use self::retry::RetryPolicy;
use super::{ChatModel, ChatReply, ChatRequest, Message, ModelError};

/// How long a model may take for one answer unless something else is set.
pub const DEFAULT_TIMEOUT: Duration = Duration::from_secs(120);

/// The most tokens that a model may say in one turn.
const MOST_COMPLETION_TOKENS: u64 = 8192;

/// Low, because judgements are wanted, not ideas.
const TEMPERATURE: f64 = 0.2;

/// Whose way of speaking HTTP a model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Provider {
    /// OpenAI's chat completions; also Ollama, llama.cpp, vLLM and others.
    OpenAi,
    /// Anthropic's messages.
    Anthropic,
}

impl Provider {
    /// What stands before the colon in a model's name.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::OpenAi => "openai",
            Self::Anthropic => "anthropic",
        }
    }

    /// The environment variable that holds the key.
    pub fn key_variable(self) -> &'static str {
        match self {
            Self::OpenAi => "OPENAI_API_KEY",
            Self::Anthropic => "ANTHROPIC_API_KEY",
        }
    }

    /// The environment variable that holds the base URL.
    pub fn url_variable(self) -> &'static str {
        match self {
            Self::OpenAi => "OPENAI_BASE_URL",
            Self::Anthropic => "ANTHROPIC_BASE_URL",
        }
    }

    /// The base URL unless the variable says otherwise.
    pub fn default_url(self) -> &'static str {
        match self {
            Self::OpenAi => "https://api.openai.com/v1",
            Self::Anthropic => "https://api.anthropic.com",
        }
    }

    fn key_need(self) -> KeyNeed {
        match self {
            Self::OpenAi => KeyNeed::OwnService,
            Self::Anthropic => KeyNeed::Always,
        }
    }

    fn body(self, model: &str, request: &ChatRequest<'_>, offer: &Offer, seed: u64) -> Value {
        match self {
            Self::OpenAi => openai::body(model, request, offer, seed),
            Self::Anthropic => anthropic::body(model, request, offer),
        }
    }

    fn reply(self, body: &Value, taken: BTreeSet<String>) -> Result<ChatReply, String> {
        match self {
            Self::OpenAi => openai::reply(body, taken),
            Self::Anthropic => anthropic::reply(body, taken),
        }
    }
}

impl fmt::Display for Provider {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::OpenAi => "OpenAI",
            Self::Anthropic => "Anthropic",
        })
    }
}

/// How a provider is spoken to.
#[derive(Debug, Clone, PartialEq)]
pub struct ProviderSettings {
    /// Makes answers repeatable where the provider offers that.
    pub seed: u64,
    /// How long one attempt may take, from connecting to the last byte of the answer.
    pub timeout: Duration,
    /// How often and when an attempt is repeated.
    pub retry: RetryPolicy,
}

impl Default for ProviderSettings {
    fn default() -> Self {
        Self { seed: 0, timeout: DEFAULT_TIMEOUT, retry: RetryPolicy::default() }
    }
}

/// A tool's name as providers take it back. A model may have invented one with letters that its own provider refuses,
/// and no further word could be said in that conversation.
fn echoed_name(tool: &str) -> String {
    const LONGEST: usize = 64;
    let allowed = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    match tool.chars().take(LONGEST).map(|letter| if allowed(letter) { letter } else { '_' }).collect() {
        name if String::is_empty(&name) => "nameless".to_owned(),
        name => name,
    }
}

/// A language model that is reached over HTTP.
#[derive(Debug)]
pub struct RemoteModel {
    /// The provider's prefix, a colon, and the model's name there.
    name: String,
    /// The model's name at the provider.
    model: String,
    seed: u64,
    connection: Connection,
    concessions: Concessions,
}

impl RemoteModel {
    /// A model of a provider whose key and base URL are in the environment.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] if the key is missing or a variable is malformed.
    pub fn from_environment(
        provider: Provider,
        model_name: &str,
        settings: &ProviderSettings,
    ) -> Result<Self, ModelError> {
        Self::of(Endpoint::from_environment(Service::Conversation(provider))?, model_name, settings)
    }

    /// A model at a base URL, such as `http://127.0.0.1:11434/v1`, with a key where the server wants one.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] as for [`RemoteModel::from_environment`].
    pub fn at(
        provider: Provider,
        model_name: &str,
        base_url: &str,
        key: Option<&str>,
        settings: &ProviderSettings,
    ) -> Result<Self, ModelError> {
        Self::of(Endpoint::new(Service::Conversation(provider), base_url, key)?, model_name, settings)
    }

    fn of(endpoint: Endpoint, model_name: &str, settings: &ProviderSettings) -> Result<Self, ModelError> {
        let provider = endpoint.provider();
        Ok(Self {
            name: format!("{}:{model_name}", provider.prefix()),
            model: model_name.to_owned(),
            concessions: Concessions::new(provider),
            connection: Connection::new(endpoint, settings)?,
            seed: settings.seed,
        })
    }

    fn provider(&self) -> Provider {
        self.connection.endpoint().provider()
    }

    async fn send(&self, body: &Value, taken: &BTreeSet<String>) -> Result<ChatReply, GivenUp> {
        self.connection.send(body, |answer| self.provider().reply(answer, taken.clone())).await
    }
}

#[async_trait]
impl ChatModel for RemoteModel {
    fn name(&self) -> &str {
        &self.name
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let taken = call_ids(request.conversation);
        let mut offer = self.concessions.offer();
        loop {
            let body = self.provider().body(&self.model, request, &offer, self.seed);
            let given_up = match self.send(&body, &taken).await {
                Ok(reply) => {
                    self.concessions.accepted(&offer, &body);
                    return Ok(reply);
                }
                Err(given_up) => given_up,
            };
            let Some(less) = self.concessions.less(&offer, &body, &given_up.failure) else {
                return Err(self.connection.explain(&given_up, &self.model));
            };
            let failure = &given_up.failure;
            tracing::info!(model = self.name, %failure, "a parameter was refused; going on without it");
            offer = less;
        }
    }
}

/// The ids of all calls so far. Some servers count them anew in every turn, and others refuse ids that come twice.
fn call_ids(conversation: &[Message]) -> BTreeSet<String> {
    conversation
        .iter()
        .filter_map(|message| match message {
            Message::Assistant { tool_calls, .. } => Some(tool_calls),
            _ => None,
        })
        .flatten()
        .map(|call| call.id.clone())
        .collect()
}

/// An id for a call: its own, unless that is missing or taken.
fn unique_id(own: Option<&str>, taken: &mut BTreeSet<String>) -> String {
    let own = own.filter(|id| !id.is_empty() && !taken.contains(*id)).map(str::to_owned);
    let id = own.unwrap_or_else(|| {
        let free = (1..).map(|number| format!("call_{number}")).find(|id| !taken.contains(id));
        free.unwrap_or_default()
    });
    taken.insert(id.clone());
    id
}

#[cfg(test)]
mod tests;
