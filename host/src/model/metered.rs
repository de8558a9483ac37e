//! A model whose tokens are counted, and which may be given a budget of them.
//!
//! The embedded model reads the conversation as a language model would and is charged nothing for it. To compare
//! what schemes of asking cost, its conversations are counted with the o200k tokenizer, that of the paper's model.
//! What a model counts itself stays as it is.

mod budget;
mod counter;
#[cfg(test)]
mod tests;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use async_trait::async_trait;

pub use budget::{InvalidBudget, TokenBudget};
use counter::TokenizerError;

use super::{ChatModel, ChatReply, ChatRequest, ModelError, Origin, TokenUsage};
use counter::Counter;

/// A model whose tokens are counted.
///
/// With a budget, a request is refused where its prompt, those of the requests under way and what is spent already
/// are more than the budget together. So all the prompts that are let through fit into it, and it is overshot by the
/// replies to the requests under way at most.
pub struct Metered {
    model: Arc<dyn ChatModel>,
    counter: Arc<Counter>,
    budget: Option<TokenBudget>,
    account: Mutex<Account>,
}

#[derive(Debug, Default)]
struct Account {
    spent: TokenUsage,
    /// The prompts of the requests under way.
    reserved: u64,
}

impl Metered {
    /// Counts the conversations of this model, however many they are.
    pub fn new(model: Arc<dyn ChatModel>) -> Self {
        Self { model, counter: Arc::default(), budget: None, account: Mutex::default() }
    }

    /// Counts the conversations of this model and ends them with [`ModelError::OutOfBudget`] where they would take
    /// more than the budget. A model that charges nothing is held to what it would cost.
    pub fn with_budget(model: Arc<dyn ChatModel>, budget: TokenBudget) -> Self {
        Self { budget: Some(budget), ..Self::new(model) }
    }

    /// The tokens of all requests that ended so far; replies from memory cost nothing.
    pub fn spent(&self) -> TokenUsage {
        self.account().spent
    }

    fn account(&self) -> MutexGuard<'_, Account> {
        self.account.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts the prompt aside, if there is a budget.
    async fn reserve(&self, request: &ChatRequest<'_>) -> Result<Option<Reservation<'_>>, ModelError> {
        let Some(budget) = self.budget else { return Ok(None) };
        let prompt = self.counter.prompt(request).await?;
        let mut account = self.account();
        let limit = budget.tokens();
        if account.spent.total().saturating_add(account.reserved).saturating_add(prompt) > limit {
            return Err(ModelError::OutOfBudget { limit });
        }
        account.reserved += prompt;
        Ok(Some(Reservation { meter: self, prompt, ending: ReservationEnding::Spend }))
    }

    async fn usage(
        &self,
        request: &ChatRequest<'_>,
        reply: &ChatReply,
    ) -> Result<TokenUsage, TokenizerError> {
        if reply.origin == Origin::Memory || reply.usage != TokenUsage::default() {
            return Ok(reply.usage);
        }
        Ok(TokenUsage {
            prompt_tokens: self.counter.prompt(request).await?,
            completion_tokens: self.counter.completion(reply).await?,
        })
    }
}

impl From<TokenizerError> for ModelError {
    fn from(error: TokenizerError) -> Self {
        Self::Unusable { reason: error.to_string() }
    }
}

/// The prompt of a request under way.
struct Reservation<'a> {
    meter: &'a Metered,
    prompt: u64,
    ending: ReservationEnding,
}

/// What becomes of the tokens that were put aside.
enum ReservationEnding {
    /// Nobody waits for the reply any more, but the prompt was sent.
    Spend,
    /// The request failed, or its usage is known.
    Release,
}

impl Drop for Reservation<'_> {
    fn drop(&mut self) {
        let mut account = self.meter.account();
        account.reserved = account.reserved.saturating_sub(self.prompt);
        if matches!(self.ending, ReservationEnding::Spend) {
            account.spent.prompt_tokens += self.prompt;
        }
    }
}

#[async_trait]
impl ChatModel for Metered {
    fn name(&self) -> &str {
        self.model.name()
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let mut reservation = self.reserve(request).await?;
        let outcome = self.model.complete(request).await;
        let usage = match &outcome {
            Ok(reply) => self.usage(request, reply).await?,
            Err(_) => TokenUsage::default(),
        };
        if let Some(reservation) = &mut reservation {
            reservation.ending = ReservationEnding::Release;
        }
        let mut reply = outcome?;
        if reply.origin == Origin::Model {
            // Before the reservation is released, so that no other request sees the tokens as free in between.
            self.account().spent += usage;
        }
        drop(reservation);
        reply.usage = usage;
        Ok(reply)
    }
}
