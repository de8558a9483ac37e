//! What the steps of a run cost.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use coin_schemas::report::Cost;

use crate::model::{ChatReply, ModelError, Origin};

/// Counts. Steps run concurrently, so the counts are atomic.
#[derive(Debug, Default)]
pub(super) struct Meter {
    model_calls: AtomicU64,
    remembered_replies: AtomicU64,
    tool_calls: AtomicU64,
    prompt_tokens: AtomicU64,
    completion_tokens: AtomicU64,
    out_of_budget: AtomicBool,
}

impl Meter {
    pub(super) fn note(&self, answered: &Result<ChatReply, ModelError>) {
        let calls = match answered {
            Ok(ChatReply { origin: Origin::Memory, .. }) => &self.remembered_replies,
            Err(ModelError::OutOfBudget { .. }) => {
                self.out_of_budget.store(true, Ordering::Relaxed);
                return;
            }
            Ok(_) | Err(_) => &self.model_calls,
        };
        calls.fetch_add(1, Ordering::Relaxed);
        if let Ok(ChatReply { usage, .. }) = answered {
            self.prompt_tokens.fetch_add(usage.prompt_tokens, Ordering::Relaxed);
            self.completion_tokens.fetch_add(usage.completion_tokens, Ordering::Relaxed);
        }
    }

    pub(super) fn note_tool_call(&self) {
        self.tool_calls.fetch_add(1, Ordering::Relaxed);
    }

    pub(super) fn is_out_of_budget(&self) -> bool {
        self.out_of_budget.load(Ordering::Relaxed)
    }

    pub(super) fn cost(&self) -> Cost {
        Cost {
            model_calls: self.model_calls.load(Ordering::Relaxed),
            remembered_replies: self.remembered_replies.load(Ordering::Relaxed),
            tool_calls: self.tool_calls.load(Ordering::Relaxed),
            prompt_tokens: self.prompt_tokens.load(Ordering::Relaxed),
            completion_tokens: self.completion_tokens.load(Ordering::Relaxed),
            seconds: 0.0,
        }
    }
}
