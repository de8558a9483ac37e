//! A model that says again what is on a tape.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use async_trait::async_trait;
use coin_schemas::model::{Task, TaskObject};
use coin_schemas::tape::{Exchange, Fingerprint, Outcome};
use coin_server::display::excerpt;

use super::lines::{Line, next_line, read_exchange, read_header};
use super::{TapeError, fingerprint, open_private};
use crate::model::{ChatModel, ChatReply, ChatRequest, Message, ModelError, Origin};

/// A model that says again what another one said, without it.
///
/// Equal requests get the recorded outcomes in their order, and the last one from then on. So the order in which
/// different requests come makes no difference.
#[derive(Debug)]
pub struct Replay {
    path: PathBuf,
    model: String,
    recorded: Mutex<HashMap<Fingerprint, Recorded>>,
}

/// What became of equal requests.
#[derive(Debug, Default)]
struct Recorded {
    outcomes: Vec<Result<ChatReply, ModelError>>,
    given: usize,
}

impl Recorded {
    fn next(&mut self) -> Option<Result<ChatReply, ModelError>> {
        let outcome = self.outcomes.get(self.given).or(self.outcomes.last()).cloned();
        self.given += 1;
        outcome
    }
}

impl Replay {
    /// Reads and checks the whole tape. A last line that was torn by a crash is passed over.
    ///
    /// # Errors
    /// If the file cannot be read, is no tape of this version, or a line of it is damaged.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, TapeError> {
        let path = path.as_ref().to_owned();
        let mut reader = BufReader::new(open_private(&path, OpenOptions::new().read(true))?);
        let header = match next_line(&path, &mut reader)? {
            Some(Line::Whole(line) | Line::Torn(line)) => read_header(&path, &line)?,
            None => return Err(TapeError::OtherFile { path }),
        };
        let recorded = Mutex::new(read_outcomes(&path, reader)?);
        Ok(Self { path, model: header.model, recorded })
    }
}

/// Reads the lines after the first one.
fn read_outcomes(
    path: &Path,
    mut reader: BufReader<File>,
) -> Result<HashMap<Fingerprint, Recorded>, TapeError> {
    let mut recorded: HashMap<Fingerprint, Recorded> = HashMap::new();
    for number in 2.. {
        let exchange = match next_line(path, &mut reader)? {
            None => break,
            Some(Line::Whole(line)) => read_exchange(path, number, &line)?,
            Some(Line::Torn(line)) => read_exchange(path, number, &line).unwrap_or_else(|_| {
                tracing::warn!(tape = %path.display(), line = number, "the last line is torn and passed over");
                None
            }),
        };
        if let Some(Exchange { fingerprint, origin, outcome, .. }) = exchange {
            recorded.entry(fingerprint).or_default().outcomes.push(said(outcome, origin));
        }
    }
    Ok(recorded)
}

fn said(outcome: Outcome, origin: Origin) -> Result<ChatReply, ModelError> {
    match outcome {
        Outcome::Reply(reply) => Ok(ChatReply { origin, ..reply }),
        Outcome::Error(error) => Err(error),
    }
}

#[async_trait]
impl ChatModel for Replay {
    fn name(&self) -> &str {
        &self.model
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let fingerprint = fingerprint(&self.model, request)?;
        let mut recorded = self.recorded.lock().unwrap_or_else(PoisonError::into_inner);
        recorded.get_mut(&fingerprint).and_then(Recorded::next).unwrap_or_else(|| {
            let reason = format!(
                "the tape {} holds no reply to this request, {}: the episode, the settings or the program differ from \
                 those of the recording; use the same ones, or record anew with --record FILE",
                self.path.display(),
                subject(request.conversation),
            );
            Err(ModelError::Unusable { reason })
        })
    }
}

/// What a conversation is about, for people who look for what differs.
fn subject(conversation: &[Message]) -> String {
    let task = conversation.iter().rev().find_map(|message| match message {
        Message::User { text } => Some(text),
        _ => None,
    });
    let Some(text) = task else { return "a conversation without a task".to_owned() };
    match serde_json::from_str(text) {
        Ok(Task::InferOwnership { object, .. }) => format!("infer_ownership of {}", thing(&object)),
        Ok(Task::InferSeveral { things, .. }) => {
            let things: Vec<String> = things.iter().map(|known| thing(&known.object)).collect();
            format!("infer_several of {}", excerpt(&things.join(", ")))
        }
        Ok(Task::AskQuestion { object, .. }) => format!("ask_question about {}", thing(&object)),
        Ok(Task::ReadAnswer { answer, .. }) => format!("read_answer {:?}", excerpt(&answer)),
        Ok(Task::JudgeSharing { classes }) => format!("judge_sharing of {} classes", classes.len()),
        Err(_) => excerpt(text),
    }
}

fn thing(object: &TaskObject) -> String {
    format!("thing {} ({})", object.id, object.class)
}
