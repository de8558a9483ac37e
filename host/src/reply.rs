//! Reading what a model wrote: the JSON object or the one sentence that was asked for.
//!
//! Models wrap their words in code fences, in thoughts and in courtesies. That is taken off. What they *say* is never
//! mended: a score of "high", 90% or 1.5 is no score, and the model is told so.

mod json;
mod sentence;
#[cfg(test)]
mod tests;

pub use json::{JsonFault, read_json};
pub use sentence::{MOST_CHARACTERS, SentenceFault, read_sentence};

use thiserror::Error;

/// The longest reply that is read, in bytes.
pub const MOST_BYTES: usize = 1024 * 1024;

/// Why a reply cannot be read, in words for the model that gave it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnreadableReply {
    /// It is longer than [`MOST_BYTES`].
    #[error("the reply has {bytes} bytes, and at most {MOST_BYTES} are read; answer briefly")]
    TooLong {
        /// Its length.
        bytes: usize,
    },
    /// It is not the JSON object that was asked for.
    #[error("the reply is not the JSON that was asked for: {0}")]
    Json(JsonFault),
    /// It is not the one question that was asked for.
    #[error("the reply is not the one question that was asked for: {0}")]
    Sentence(SentenceFault),
}

fn check_length(text: &str) -> Result<(), UnreadableReply> {
    match text.len() {
        bytes if bytes > MOST_BYTES => Err(UnreadableReply::TooLong { bytes }),
        _ => Ok(()),
    }
}
