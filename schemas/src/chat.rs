//! A conversation with a language model: what is said, which tools are wanted, and what a turn cost.
//!
//! Providers translate these into their own forms; a tape (`host --record FILE`) holds them as they stand here.

use std::ops::AddAssign;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use thiserror::Error;

/// One turn of a conversation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "from", rename_all = "snake_case")]
pub enum Message {
    /// What the model is to do; the only place for instructions. Later ones correct the model's last words.
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
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "String")]
        text: Option<String>,
        /// The tools that it wants called.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
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
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        is_error: bool,
    },
}

/// A model's wish to have a tool called.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToolCall {
    /// Tells the calls of one turn apart.
    pub id: String,
    /// The tool.
    pub tool: String,
    /// Its arguments.
    pub arguments: ToolArguments,
}

/// The arguments of a tool call as the model gave them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ToolArguments {
    /// A JSON object.
    Object(Map<String, Value>),
    /// Something else; the model is told so and may call again.
    Malformed(String),
}

impl ToolArguments {
    /// The arguments as JSON text, or the malformed text as it came.
    pub fn to_text(&self) -> String {
        match self {
            Self::Object(arguments) => serde_json::to_string(arguments).unwrap_or_default(),
            Self::Malformed(text) => text.clone(),
        }
    }
}

/// A tool as a model sees it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToolDefinition {
    /// Its name.
    pub name: String,
    /// What it does and when to call it.
    pub description: String,
    /// JSON Schema of its arguments.
    pub input_schema: Map<String, Value>,
}

/// What form the final words must have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "form", rename_all = "snake_case")]
pub enum ReplyFormat {
    /// Plain words.
    Text,
    /// A JSON object of this schema.
    Json {
        /// A short name for the schema: letters, digits and underscores.
        name: String,
        /// The JSON Schema. Every object in it lists all its properties as required and allows no others.
        schema: Value,
    },
}

/// A model's turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChatReply {
    /// Its words, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub text: Option<String>,
    /// The tools that it wants called; none where the turn is final.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tool_calls: Vec<ToolCall>,
    /// How the turn ended.
    #[serde(default)]
    pub ending: Ending,
    /// The tokens that the turn took.
    pub usage: TokenUsage,
    /// Where the words come from.
    #[serde(skip)]
    pub origin: Origin,
}

impl ChatReply {
    /// A finished turn of these words, at no cost.
    pub fn words(text: impl Into<String>) -> Self {
        Self {
            text: Some(text.into()),
            tool_calls: Vec::new(),
            ending: Ending::Finished,
            usage: TokenUsage::default(),
            origin: Origin::Model,
        }
    }

    /// A turn that wants these tools called, at no cost.
    pub fn calls(tool_calls: Vec<ToolCall>) -> Self {
        Self { text: None, tool_calls, ..Self::words(String::new()) }
    }
}

/// How a model's turn ended.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "how", rename_all = "snake_case")]
pub enum Ending {
    /// The model was done.
    #[default]
    Finished,
    /// The provider cut the turn short, because it reached the largest length.
    CutShort,
    /// The model, or its provider's filter, would not answer.
    Refused {
        /// Its words, or the provider's.
        reason: String,
    },
}

/// Where a reply comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The model gave it just now.
    #[default]
    Model,
    /// The model gave it before to the same conversation, and it was kept.
    Memory,
}

/// Tokens of language-model traffic.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct TokenUsage {
    /// Sent to the model.
    pub prompt_tokens: u64,
    /// Received from it.
    pub completion_tokens: u64,
}

impl TokenUsage {
    /// Both together.
    pub fn total(self) -> u64 {
        self.prompt_tokens.saturating_add(self.completion_tokens)
    }
}

impl AddAssign for TokenUsage {
    fn add_assign(&mut self, other: Self) {
        self.prompt_tokens = self.prompt_tokens.saturating_add(other.prompt_tokens);
        self.completion_tokens = self.completion_tokens.saturating_add(other.completion_tokens);
    }
}

/// Why a model did not answer.
#[derive(Debug, Clone, PartialEq, Eq, Error, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "why", rename_all = "snake_case")]
pub enum ModelError {
    /// The embedded model cannot read the conversation.
    #[error("the model cannot work with the conversation: {reason}")]
    Conversation {
        /// What is missing or malformed.
        reason: String,
    },
    /// This request came to nothing, whatever was tried; another one may succeed.
    #[error("the model did not answer: {reason}")]
    Unanswered {
        /// What happened, without a key or a header.
        reason: String,
    },
    /// No request can succeed, such as with a wrong key: the run cannot go on.
    #[error("{reason}")]
    Unusable {
        /// What is wrong and what to do next, without a key or a header.
        reason: String,
    },
    /// The tokens that may be spent are spent.
    #[error("the budget of {limit} tokens is spent")]
    OutOfBudget {
        /// The budget.
        limit: u64,
    },
}
