//! The chat-model interface: a conversation and a tool list go in, words or tool calls come out.
//!
//! The embedded model stands behind it exactly as a language model does, so that everything above it, from the
//! tool-calling loop to the report, is the same for both.

pub mod embedded;
pub mod metered;
pub mod tape;

use async_trait::async_trait;

pub use coin_schemas::chat::{
    ChatReply, Ending, Message, ModelError, Origin, ReplyFormat, TokenUsage, ToolArguments, ToolCall,
    ToolDefinition,
};

/// A request to a model.
#[derive(Debug, Clone, Copy)]
pub struct ChatRequest<'a> {
    /// The conversation so far. It ends with a user or tool message, or with a correction.
    pub conversation: &'a [Message],
    /// The tools that may be called.
    pub tools: &'a [ToolDefinition],
    /// What form the final words must have.
    pub reply: &'a ReplyFormat,
}

/// A model that talks and calls tools.
#[async_trait]
pub trait ChatModel: Send + Sync {
    /// The name under which it is calibrated and reported.
    fn name(&self) -> &str;

    /// Takes one turn.
    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError>;
}
