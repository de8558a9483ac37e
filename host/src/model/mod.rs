//! The chat-model interface: a conversation and a tool list go in, words or tool calls come out.
//!
//! The embedded model stands behind it exactly as a language model does, so that everything above it, from the
//! tool-calling loop to the report, is the same for both.

pub mod counted;
pub mod embedded;

use async_trait::async_trait;
use serde_json::{Map, Value};
use thiserror::Error;

/// One turn of a conversation.
#[derive(Debug, Clone, PartialEq)]
pub enum Message {
    /// What the model is to do; the only place for instructions.
    System {
        /// The instructions.
        text: String,
    },
    /// The task's slots as JSON; data, not instructions.
    User {
        /// The JSON.
        text: String,
    },
    /// What the model said.
    Assistant {
        /// Its words, if any.
        text: Option<String>,
        /// The tools that it wants called.
        tool_calls: Vec<ToolCall>,
    },
    /// What a tool answered; data, not instructions.
    Tool {
        /// The call that is answered.
        call_id: String,
        /// The tool.
        tool: String,
        /// The answer: JSON, or an error in words.
        text: String,
        /// Whether it is an error.
        is_error: bool,
    },
}

/// A model's wish to have a tool called.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolCall {
    /// Tells the calls of one turn apart.
    pub id: String,
    /// The tool.
    pub tool: String,
    /// Its arguments.
    pub arguments: Map<String, Value>,
}

/// A tool as a model sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolDefinition {
    /// Its name.
    pub name: String,
    /// What it does and when to call it.
    pub description: String,
    /// JSON Schema of its arguments.
    pub input_schema: Map<String, Value>,
}

/// What form the final words must have.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplyFormat {
    /// Plain words.
    Text,
    /// A JSON object of this schema.
    Json {
        /// A short name for the schema.
        name: &'static str,
        /// The JSON Schema.
        schema: Value,
    },
}

/// A request to a model.
#[derive(Debug, Clone)]
pub struct ChatRequest<'a> {
    /// The conversation so far; it ends with a user or tool message.
    pub conversation: &'a [Message],
    /// The tools that may be called.
    pub tools: &'a [ToolDefinition],
    /// What form the final words must have.
    pub reply: &'a ReplyFormat,
}

/// A model's turn.
#[derive(Debug, Clone, PartialEq)]
pub struct ChatReply {
    /// Its words, if any.
    pub text: Option<String>,
    /// The tools that it wants called; none where the turn is final.
    pub tool_calls: Vec<ToolCall>,
    /// The tokens that the turn took.
    pub usage: TokenUsage,
}

/// Tokens of language-model traffic.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TokenUsage {
    /// Sent to the model.
    pub prompt_tokens: u64,
    /// Received from it.
    pub completion_tokens: u64,
}

/// Why a model did not answer.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ModelError {
    /// The conversation does not hold what the model needs.
    #[error("the model cannot work with the conversation: {reason}")]
    Conversation {
        /// What is missing or malformed.
        reason: String,
    },
}

/// A model that talks and calls tools.
#[async_trait]
pub trait ChatModel: Send + Sync {
    /// The name under which it is calibrated and reported.
    fn name(&self) -> &str;

    /// Takes one turn.
    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError>;
}
