//! A model that counts tokens where the model itself counts none.
//!
//! The embedded model reads the conversation as a language model would and is charged nothing for it. To compare
//! what schemes of asking cost, its conversations are counted with the o200k tokenizer, that of the paper's model.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use async_trait::async_trait;
use thiserror::Error;
use tiktoken_rs::{CoreBPE, o200k_base};

use super::{
    ChatModel, ChatReply, ChatRequest, Message, ModelError, ReplyFormat, TokenUsage, ToolDefinition,
};

/// What the frame of a message takes beside its text, in tokens (the chat form of the models that use o200k).
const TOKENS_PER_MESSAGE: u64 = 3;

/// The tokenizer's vocabulary does not load, which is a fault of this program.
#[derive(Debug, Error)]
#[error("the o200k tokenizer does not load: {0}; please report this")]
pub struct TokenizerError(String);

/// A model whose conversations are counted.
pub struct Counted {
    model: Arc<dyn ChatModel>,
    tokenizer: CoreBPE,
    /// The same instructions, tools and results come again and again: their counts are kept.
    counts: Mutex<HashMap<String, u64>>,
}

impl Counted {
    /// Counts the conversations of this model.
    ///
    /// # Errors
    /// If the vocabulary that the program carries is damaged.
    pub fn new(model: Arc<dyn ChatModel>) -> Result<Self, TokenizerError> {
        let tokenizer = o200k_base().map_err(|error| TokenizerError(error.to_string()))?;
        Ok(Self { model, tokenizer, counts: Mutex::new(HashMap::new()) })
    }

    fn count(&self, text: &str) -> u64 {
        let known = self.counts.lock().unwrap_or_else(PoisonError::into_inner).get(text).copied();
        known.unwrap_or_else(|| {
            let count = self.tokenizer.count_ordinary(text) as u64;
            self.counts.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_owned(), count);
            count
        })
    }

    /// The tools as they are written into a request.
    fn tools(&self, tools: &[ToolDefinition]) -> u64 {
        tools
            .iter()
            .map(|tool| {
                let schema = serde_json::Value::Object(tool.input_schema.clone()).to_string();
                self.count(&tool.name) + self.count(&tool.description) + self.count(&schema)
            })
            .sum()
    }

    fn message(&self, message: &Message) -> u64 {
        TOKENS_PER_MESSAGE
            + match message {
                Message::System { text } | Message::User { text } | Message::Tool { text, .. } => {
                    self.count(text)
                }
                Message::Assistant { text, tool_calls } => self.reply(text.as_deref(), tool_calls),
            }
    }

    fn reply(&self, text: Option<&str>, tool_calls: &[super::ToolCall]) -> u64 {
        let calls: u64 = tool_calls
            .iter()
            .map(|call| self.count(&call.tool) + self.count(&call.arguments.to_text()))
            .sum();
        calls + text.map_or(0, |text| self.count(text))
    }

    fn usage(&self, request: &ChatRequest<'_>, reply: &ChatReply) -> TokenUsage {
        let format = match request.reply {
            ReplyFormat::Text => 0,
            ReplyFormat::Json { schema, .. } => self.count(&schema.to_string()),
        };
        let conversation: u64 = request.conversation.iter().map(|message| self.message(message)).sum();
        TokenUsage {
            prompt_tokens: conversation + self.tools(request.tools) + format,
            completion_tokens: self.reply(reply.text.as_deref(), &reply.tool_calls),
        }
    }
}

#[async_trait]
impl ChatModel for Counted {
    fn name(&self) -> &str {
        self.model.name()
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let reply = self.model.complete(request).await?;
        if reply.usage != TokenUsage::default() {
            return Ok(reply);
        }
        let usage = self.usage(request, &reply);
        Ok(ChatReply { usage, ..reply })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Says one thing and charges what it is told to.
    struct Says(TokenUsage);

    #[async_trait]
    impl ChatModel for Says {
        fn name(&self) -> &str {
            "says"
        }

        async fn complete(&self, _request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
            Ok(ChatReply { usage: self.0, ..ChatReply::words("hello world") })
        }
    }

    async fn charged(usage: TokenUsage) -> TokenUsage {
        let conversation = [Message::System { text: "hello world".to_owned() }];
        let request = ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text };
        Counted::new(Arc::new(Says(usage))).unwrap().complete(&request).await.unwrap().usage
    }

    /// "hello world" is the two tokens 24912 and 2375 of o200k.
    #[tokio::test]
    async fn a_conversation_is_counted_where_the_model_counts_nothing() {
        let counted = charged(TokenUsage::default()).await;
        assert_eq!(counted, TokenUsage { prompt_tokens: 2 + TOKENS_PER_MESSAGE, completion_tokens: 2 });
    }

    #[tokio::test]
    async fn what_the_model_counts_itself_stays() {
        let own = TokenUsage { prompt_tokens: 70, completion_tokens: 7 };
        assert_eq!(charged(own).await, own);
    }
}
