//! Counting tokens with the o200k tokenizer.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use thiserror::Error;
use tiktoken_rs::{CoreBPE, o200k_base};

use crate::model::{ChatReply, ChatRequest, Message, ReplyFormat, ToolCall, ToolDefinition};

/// What the frame of a message takes beside its text, in tokens (the chat form of the models that use o200k).
pub(super) const TOKENS_PER_MESSAGE: u64 = 3;

/// So many bytes are counted within a few milliseconds; more are counted on a thread of their own, so that other
/// conversations go on.
const MOST_BYTES_AT_ONCE: usize = 16 * 1024;

/// The tokenizer gives up on very long runs of white space, so longer texts are counted in parts, in bytes. A cut makes
/// a token more or less.
const PART: usize = 64 * 1024;

/// The tokenizer's vocabulary does not load, which is a fault of this program.
#[derive(Debug, Error)]
#[error("the o200k tokenizer does not load: {0}; please report this")]
pub(crate) struct TokenizerError(String);

/// The vocabulary takes a while to load, and it is always the same.
static TOKENIZER: LazyLock<Result<CoreBPE, String>> =
    LazyLock::new(|| o200k_base().map_err(|error| error.to_string()));

/// Counts tokens. The vocabulary is loaded when the first text is counted: most providers count themselves.
#[derive(Default)]
pub(super) struct Counter {
    /// The same instructions, tools and results come again and again: their counts are kept.
    counts: Mutex<HashMap<String, u64>>,
}

impl Counter {
    /// What a request sends: the conversation, the tools as they are written into it, and the form of the reply.
    pub(super) async fn prompt(self: &Arc<Self>, request: &ChatRequest<'_>) -> Result<u64, TokenizerError> {
        let mut texts = Vec::new();
        for message in request.conversation {
            match message {
                Message::System { text } | Message::User { text } | Message::Tool { text, .. } => {
                    texts.push(Cow::Borrowed(text.as_str()));
                }
                Message::Assistant { text, tool_calls } => {
                    texts.extend(reply_texts(text.as_deref(), tool_calls));
                }
            }
        }
        texts.extend(request.tools.iter().flat_map(tool_texts));
        if let ReplyFormat::Json { schema, .. } = request.reply {
            texts.push(Cow::Owned(schema.to_string()));
        }
        Ok(TOKENS_PER_MESSAGE * request.conversation.len() as u64 + self.sum(&texts).await?)
    }

    /// What a reply says and calls.
    pub(super) async fn completion(self: &Arc<Self>, reply: &ChatReply) -> Result<u64, TokenizerError> {
        let texts: Vec<Cow<'_, str>> = reply_texts(reply.text.as_deref(), &reply.tool_calls).collect();
        self.sum(&texts).await
    }

    async fn sum(self: &Arc<Self>, texts: &[Cow<'_, str>]) -> Result<u64, TokenizerError> {
        let new: Vec<&str> =
            texts.iter().map(AsRef::as_ref).filter(|text| self.known(text).is_none()).collect();
        if new.iter().map(|text| text.len()).sum::<usize>() > MOST_BYTES_AT_ONCE {
            let new: Vec<String> = new.into_iter().map(str::to_owned).collect();
            let counter = Arc::clone(self);
            let counting = tokio::task::spawn_blocking(move || {
                new.iter().map(|text| counter.count(text)).for_each(drop);
            });
            if let Err(error) = counting.await {
                tracing::debug!(%error, "the tokens are counted once more");
            }
        }
        texts.iter().map(|text| self.count(text)).sum()
    }

    fn known(&self, text: &str) -> Option<u64> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner).get(text).copied()
    }

    fn count(&self, text: &str) -> Result<u64, TokenizerError> {
        if let Some(known) = self.known(text) {
            return Ok(known);
        }
        let tokenizer = TOKENIZER.as_ref().map_err(|error| TokenizerError(error.clone()))?;
        let count = parts(text).map(|part| tokenizer.count_ordinary(part) as u64).sum();
        self.counts.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_owned(), count);
        Ok(count)
    }
}

fn tool_texts(tool: &ToolDefinition) -> [Cow<'_, str>; 3] {
    let schema = serde_json::to_string(&tool.input_schema).unwrap_or_default();
    [Cow::Borrowed(tool.name.as_str()), Cow::Borrowed(tool.description.as_str()), Cow::Owned(schema)]
}

fn reply_texts<'a>(text: Option<&'a str>, tool_calls: &'a [ToolCall]) -> impl Iterator<Item = Cow<'a, str>> {
    let calls = tool_calls
        .iter()
        .flat_map(|call| [Cow::Borrowed(call.tool.as_str()), Cow::Owned(call.arguments.to_text())]);
    calls.chain(text.map(Cow::Borrowed))
}

fn parts(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let (part, after) = rest.split_at(rest.floor_char_boundary(PART));
        rest = after;
        Some(part)
    })
}
