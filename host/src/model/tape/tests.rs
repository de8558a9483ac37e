//! Tapes in real files, whole and damaged.

mod cache;
mod fingerprints;
mod recorder;
mod replay;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use async_trait::async_trait;
use coin_schemas::tape::Exchange;
use tempfile::TempDir;

use super::*;
use crate::model::{ChatModel, Ending, TokenUsage};

const USAGE: TokenUsage = TokenUsage { prompt_tokens: 7, completion_tokens: 3 };

/// Answers every question with its text and the number of the call, after a moment, and fails or breaks off where the
/// question says so.
#[derive(Default)]
struct Echo {
    calls: AtomicUsize,
    /// How often it fails before it answers.
    failures: AtomicUsize,
    asked: Mutex<Vec<String>>,
}

impl Echo {
    fn new() -> Arc<Self> {
        Arc::default()
    }

    fn failing(times: usize) -> Arc<Self> {
        Arc::new(Self { failures: AtomicUsize::new(times), ..Self::default() })
    }

    fn calls(&self) -> usize {
        self.calls.load(Ordering::SeqCst)
    }
}

#[async_trait]
impl ChatModel for Echo {
    fn name(&self) -> &str {
        "echo"
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let number = self.calls.fetch_add(1, Ordering::SeqCst) + 1;
        let Some(Message::User { text }) = request.conversation.last() else { panic!("a question") };
        self.asked.lock().unwrap().push(text.clone());
        tokio::time::sleep(Duration::from_micros(100 * (text.len() as u64 % 7))).await;
        let failures = self.failures.load(Ordering::SeqCst);
        if failures > 0 {
            self.failures.store(failures - 1, Ordering::SeqCst);
            return Err(ModelError::Unanswered { reason: format!("busy {number}") });
        }
        let ending = match text.as_str() {
            "break off" => Ending::CutShort,
            "refuse" => Ending::Refused { reason: "no".to_owned() },
            _ => Ending::Finished,
        };
        Ok(ChatReply { usage: USAGE, ending, ..ChatReply::words(format!("{text} {number}")) })
    }
}

async fn ask(model: &dyn ChatModel, text: &str) -> Result<ChatReply, ModelError> {
    let conversation =
        [Message::System { text: "Answer.".to_owned() }, Message::User { text: text.to_owned() }];
    model.complete(&ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text }).await
}

async fn words(model: &dyn ChatModel, text: &str) -> String {
    ask(model, text).await.unwrap().text.unwrap()
}

fn file() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tape.jsonl");
    (folder, path)
}

/// The file with the folder's random name taken out of an error.
fn told(error: &impl std::fmt::Display, path: &Path) -> String {
    error.to_string().replace(&path.display().to_string(), "tape.jsonl")
}

/// The lines of a tape, each of which must be whole.
fn lines(path: &Path) -> (TapeHeader, Vec<Exchange>) {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.ends_with('\n'));
    let mut lines = text.lines();
    let header = serde_json::from_str(lines.next().unwrap()).unwrap();
    (header, lines.map(|line| serde_json::from_str(line).unwrap()).collect())
}

#[cfg(unix)]
fn mode(path: &Path) -> u32 {
    std::os::unix::fs::PermissionsExt::mode(&std::fs::metadata(path).unwrap().permissions()) & 0o777
}

/// A tape of these questions, each asked once.
async fn recorded(path: &Path, questions: &[&str]) {
    let recorder = Recorder::create(Echo::new(), path).unwrap();
    for question in questions {
        ask(&recorder, question).await.unwrap();
    }
}
