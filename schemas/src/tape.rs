//! The tape: what was said to a model and what it said back, in a file (`host --record FILE`).
//!
//! It is JSON Lines: a [`TapeHeader`], then one [`Exchange`] a line in the order in which they ended. A run can be
//! played back from it without the model, and replies that were paid for can be kept in it. It holds conversations
//! alone: keys and headers belong to the providers, which are below it.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::chat::{ChatReply, Message, ModelError, Origin};

/// The version of the file's form.
pub const TAPE_VERSION: u32 = 1;

/// The first line of a tape.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TapeHeader {
    /// The version of the file's form; this program reads version 1.
    pub tape_version: u32,
    /// The model that gave the replies, by the name under which it is calibrated and reported.
    pub model: String,
    /// The program and version that made the file.
    pub created_with: String,
}

/// A request to a model and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exchange {
    /// Tells requests apart. Equal ones may get different replies; their order is that of the lines.
    pub fingerprint: Fingerprint,
    /// The conversation so far.
    pub conversation: Vec<Message>,
    /// The names of the tools that could be called.
    pub tools: Vec<String>,
    /// What the final words were to be: `text`, or the name of a JSON Schema.
    pub reply_format: String,
    /// Where the reply comes from.
    #[serde(default, skip_serializing_if = "is_from_the_model")]
    pub origin: Origin,
    /// What the model did.
    pub outcome: Outcome,
}

/// What a model did with a request.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It took its turn.
    Reply(ChatReply),
    /// It did not.
    Error(ModelError),
}

fn is_from_the_model(origin: &Origin) -> bool {
    *origin == Origin::Model
}

/// The SHA-256 digest of a request: the model's name, the conversation, the whole definitions of the tools and the
/// form of the reply, as JSON with sorted keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Fingerprint([u8; 32]);

/// The text is no fingerprint.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("a fingerprint has 64 digits from 0 to 9 and a to f, and {given:?} has not")]
pub struct InvalidFingerprint {
    /// The text.
    given: String,
}

impl Fingerprint {
    /// A fingerprint that was computed.
    pub fn from_digest(digest: [u8; 32]) -> Self {
        Self(digest)
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
    }
}

impl From<Fingerprint> for String {
    fn from(fingerprint: Fingerprint) -> Self {
        fingerprint.to_string()
    }
}

impl TryFrom<String> for Fingerprint {
    type Error = InvalidFingerprint;

    fn try_from(text: String) -> Result<Self, InvalidFingerprint> {
        let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        if text.len() != 64 || !text.bytes().all(is_digit) {
            return Err(InvalidFingerprint { given: text });
        }
        let mut digest = [0; 32];
        for (place, byte) in digest.iter_mut().enumerate() {
            *byte = u8::from_str_radix(&text[2 * place..2 * place + 2], 16).unwrap_or_default();
        }
        Ok(Self(digest))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_fingerprint_reads_back(digest in any::<[u8; 32]>()) {
            let fingerprint = Fingerprint::from_digest(digest);
            let text = serde_json::to_string(&fingerprint).unwrap();
            prop_assert_eq!(serde_json::from_str::<Fingerprint>(&text).unwrap(), fingerprint);
        }

        #[test]
        fn nothing_else_is_a_fingerprint(text in "[0-9a-f]{0,63}|[0-9a-f]{65,70}|[0-9a-f]{63}[A-Fg-zä+ ]") {
            prop_assert!(Fingerprint::try_from(text).is_err());
        }
    }
}
