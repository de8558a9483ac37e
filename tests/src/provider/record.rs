//! What a scripted provider remembers.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use coin_host::model::TokenUsage;
use coin_host::model::provider::Provider;
use serde_json::Value;

use super::faults::Fault;

/// A request that came, and what became of it.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// Which one it is, from 1.
    pub number: usize,
    /// When it came.
    pub at: Instant,
    /// Whose form it had, if any.
    pub provider: Option<Provider>,
    /// Its path.
    pub path: String,
    /// Its headers, with names in lower case.
    pub headers: BTreeMap<String, String>,
    /// Its body; null where it is no JSON.
    pub body: Value,
    /// What is wrong with it by the rules that the providers publish.
    pub violations: Vec<String>,
    /// What went wrong with the answer.
    pub fault: Option<Fault>,
    /// Whether the brain was asked.
    pub was_thought_about: bool,
    /// The tokens that were charged.
    pub usage: TokenUsage,
    /// The status of the answer, once there is one.
    pub status: Option<u16>,
    /// Whether the client left before it was answered.
    pub was_abandoned: bool,
}

#[derive(Debug, Default)]
struct Entries {
    requests: Vec<Recorded>,
    under_way: usize,
    most_at_once: usize,
    /// How often each body came.
    times: BTreeMap<String, usize>,
}

/// All that is remembered, shared by the server and its handle.
#[derive(Debug, Default)]
pub(super) struct Log(Mutex<Entries>);

/// One request that is under way.
#[derive(Debug)]
pub(super) struct Entry {
    log: Arc<Log>,
    pub(super) number: usize,
    /// How often the same body came before.
    pub(super) repetitions: usize,
}

impl Log {
    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn requests(&self) -> Vec<Recorded> {
        self.entries().requests.clone()
    }

    pub(super) fn most_at_once(&self) -> usize {
        self.entries().most_at_once
    }

    pub(super) fn under_way(&self) -> usize {
        self.entries().under_way
    }

    pub(super) fn begin(
        self: &Arc<Self>,
        provider: Option<Provider>,
        path: &str,
        headers: BTreeMap<String, String>,
        body: Value,
    ) -> Entry {
        let mut entries = self.entries();
        let number = entries.requests.len() + 1;
        let times = entries.times.entry(body.to_string()).or_default();
        let repetitions = *times;
        *times += 1;
        entries.under_way += 1;
        entries.most_at_once = entries.most_at_once.max(entries.under_way);
        entries.requests.push(Recorded {
            number,
            at: Instant::now(),
            provider,
            path: path.to_owned(),
            headers,
            body,
            violations: Vec::new(),
            fault: None,
            was_thought_about: false,
            usage: TokenUsage::default(),
            status: None,
            was_abandoned: false,
        });
        Entry { log: Arc::clone(self), number, repetitions }
    }
}

impl Entry {
    /// Notes something about the request.
    pub(super) fn note(&self, note: impl FnOnce(&mut Recorded)) {
        note(&mut self.log.entries().requests[self.number - 1]);
    }
}

/// The answer is dropped when it was sent, and also when nobody waits for it any more.
impl Drop for Entry {
    fn drop(&mut self) {
        let mut entries = self.log.entries();
        entries.under_way -= 1;
        let request = &mut entries.requests[self.number - 1];
        request.was_abandoned = request.status.is_none();
    }
}
