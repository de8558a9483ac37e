//! Who thinks behind a scripted provider.

use std::fmt;

use coin_host::model::embedded::EmbeddedModel;
use coin_host::model::{ChatModel, ChatReply, ChatRequest, Message, ReplyFormat, ToolDefinition};
use futures::FutureExt;
use serde_json::Value;

/// A request, translated back from the provider's form.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// The conversation. The first words of the user are the task; all later ones are corrections.
    pub conversation: Vec<Message>,
    /// The tools that may be called.
    pub tools: Vec<ToolDefinition>,
    /// The form of the reply. Anthropic's requests have none but words.
    pub reply: ReplyFormat,
}

impl Turn {
    /// The task as JSON, or null where there is none.
    pub fn task(&self) -> Value {
        let text = self.conversation.iter().find_map(|message| match message {
            Message::User { text } => Some(text.as_str()),
            _ => None,
        });
        text.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default()
    }
}

/// Takes a model's turn.
pub trait Brain: Send + Sync {
    /// The turn, or why none can be taken, which is answered with 500.
    fn think(&self, turn: &Turn) -> Result<ChatReply, String>;
}

impl<Thought: Fn(&Turn) -> ChatReply + Send + Sync> Brain for Thought {
    fn think(&self, turn: &Turn) -> Result<ChatReply, String> {
        Ok(self(turn))
    }
}

/// The project's own evidence model. As no language model does, it does not tell its owner sets.
#[derive(Default)]
pub struct EmbeddedBrain(EmbeddedModel);

impl Brain for EmbeddedBrain {
    fn think(&self, turn: &Turn) -> Result<ChatReply, String> {
        let request =
            ChatRequest { conversation: &turn.conversation, tools: &turn.tools, reply: &turn.reply };
        let answered =
            self.0.complete(&request).now_or_never().expect("the embedded model waits for nothing");
        let mut reply = answered.map_err(|error| error.to_string())?;
        if let Some(Ok(Value::Object(mut words))) = reply.text.as_deref().map(serde_json::from_str) {
            words.shift_remove("owner_sets");
            reply.text = Some(Value::Object(words).to_string());
        }
        Ok(reply)
    }
}

impl fmt::Debug for EmbeddedBrain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("EmbeddedBrain")
    }
}
