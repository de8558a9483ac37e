//! A model whose replies are kept.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use async_trait::async_trait;
use coin_schemas::tape::Fingerprint;

use super::shelf::{Shelf, is_worth_keeping};
use super::{TapeError, exchange, fingerprint};
use crate::model::{ChatModel, ChatReply, ChatRequest, ModelError, Origin, TokenUsage};

/// A model that is asked each question once: its replies are kept in a file and given again at no cost.
///
/// Only whole replies are kept, never an error or a turn that was cut short or refused. A reply is on the disk before
/// it is handed on. Several processes may use one file. Equal requests that come together are put to the model once.
pub struct Cache {
    model: Arc<dyn ChatModel>,
    shelf: Arc<Mutex<Shelf>>,
    under_way: UnderWay,
}

impl Cache {
    /// Opens the file, or makes it so that only its owner can read it. A last line that was torn by a crash is cut off.
    ///
    /// # Errors
    /// If the file cannot be read and written, is no tape of this version, keeps replies of another model, or a line of
    /// it is damaged.
    pub fn open(model: Arc<dyn ChatModel>, path: impl AsRef<Path>) -> Result<Self, TapeError> {
        let shelf = Arc::new(Mutex::new(Shelf::open(path.as_ref(), model.name())?));
        Ok(Self { model, shelf, under_way: UnderWay::default() })
    }

    /// Works with the file on a thread that may wait for the disk. It works to the end even if nobody waits for it.
    async fn with_shelf<T: Send + 'static>(
        &self,
        work: impl FnOnce(&mut Shelf) -> Result<T, TapeError> + Send + 'static,
    ) -> Result<T, ModelError> {
        let shelf = Arc::clone(&self.shelf);
        let working = tokio::task::spawn_blocking(move || {
            work(&mut shelf.lock().unwrap_or_else(PoisonError::into_inner))
        });
        let done = working.await.map_err(|error| ModelError::Unusable {
            reason: format!("the kept replies cannot be worked with: {error}; please report this"),
        })?;
        Ok(done?)
    }
}

#[async_trait]
impl ChatModel for Cache {
    fn name(&self) -> &str {
        self.model.name()
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let fingerprint = fingerprint(self.name(), request)?;
        let turn = self.under_way.turn(fingerprint);
        let _alone = turn.lock().await;
        if let Some(reply) = self.with_shelf(move |shelf| shelf.find(fingerprint)).await? {
            return Ok(ChatReply { origin: Origin::Memory, usage: TokenUsage::default(), ..reply });
        }
        let outcome = self.model.complete(request).await;
        if outcome.as_ref().is_ok_and(is_worth_keeping) {
            let exchange = exchange(fingerprint, request, &outcome);
            self.with_shelf(move |shelf| shelf.keep(&exchange)).await?;
        }
        outcome
    }
}

/// The requests under way. Who comes with an equal one waits for its turn.
#[derive(Default)]
struct UnderWay(Mutex<HashMap<Fingerprint, Weak<tokio::sync::Mutex<()>>>>);

impl UnderWay {
    fn turn(&self, fingerprint: Fingerprint) -> Arc<tokio::sync::Mutex<()>> {
        let mut turns = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(turn) = turns.get(&fingerprint).and_then(Weak::upgrade) {
            return turn;
        }
        turns.retain(|_, turn| turn.strong_count() > 0);
        let turn = Arc::default();
        turns.insert(fingerprint, Arc::downgrade(&turn));
        turn
    }
}
