//! The tape: exchanges with a model in a file, to play them back, and to pay for each reply once.
//!
//! [`Recorder`] writes what is said, [`Replay`] says it again without the model, and [`Cache`] keeps replies for the
//! next time. All three stand above the providers, so that no key and no header can get into a file. The form of the
//! file is [`coin_schemas::tape`].

mod cache;
mod error;
mod lines;
mod recorder;
mod replay;
mod shelf;
#[cfg(test)]
mod tests;

use std::fs::{File, OpenOptions};
use std::path::Path;

use coin_schemas::tape::{Exchange, Fingerprint, Outcome, TAPE_VERSION, TapeHeader};
use serde::Serialize;
use sha2::{Digest, Sha256};

pub use cache::Cache;
pub use error::TapeError;
pub use recorder::Recorder;
pub use replay::Replay;

use super::{ChatReply, ChatRequest, Message, ModelError, Origin, ReplyFormat, ToolDefinition};

/// Everything of a request that a reply may depend on.
#[derive(Serialize)]
struct Question<'a> {
    model: &'a str,
    conversation: &'a [Message],
    tools: &'a [ToolDefinition],
    reply: &'a ReplyFormat,
}

/// Tells requests apart; see [`Fingerprint`].
fn fingerprint(model: &str, request: &ChatRequest<'_>) -> Result<Fingerprint, ModelError> {
    let ChatRequest { conversation, tools, reply } = *request;
    let mut question = serde_json::to_value(Question { model, conversation, tools, reply })
        .map_err(|error| ModelError::Conversation { reason: format!("it cannot be written: {error}") })?;
    question.sort_all_objects();
    Ok(Fingerprint::from_digest(Sha256::digest(question.to_string()).into()))
}

fn exchange(
    fingerprint: Fingerprint,
    request: &ChatRequest<'_>,
    outcome: &Result<ChatReply, ModelError>,
) -> Exchange {
    Exchange {
        fingerprint,
        conversation: request.conversation.to_vec(),
        tools: request.tools.iter().map(|tool| tool.name.clone()).collect(),
        reply_format: match request.reply {
            ReplyFormat::Text => "text".to_owned(),
            ReplyFormat::Json { name, .. } => name.clone(),
        },
        origin: outcome.as_ref().map_or(Origin::Model, |reply| reply.origin),
        outcome: match outcome {
            Ok(reply) => Outcome::Reply(reply.clone()),
            Err(error) => Outcome::Error(error.clone()),
        },
    }
}

fn header(model: &str) -> TapeHeader {
    TapeHeader {
        tape_version: TAPE_VERSION,
        model: model.to_owned(),
        created_with: concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).to_owned(),
    }
}

/// Opens a file so that, if it is new, only its owner can read it: conversations tell what a family does all day.
fn open_private(path: &Path, options: &mut OpenOptions) -> Result<File, TapeError> {
    if path.is_dir() {
        return Err(TapeError::Folder { path: path.to_owned() });
    }
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(options, 0o600);
    options.open(path).map_err(|source| TapeError::Open { path: path.to_owned(), source })
}
