//! Sessions of clients of 2025-11-25: as many as fit, and none for ever.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use futures::Stream;
use lru::LruCache;
use rmcp::model::{ClientJsonRpcMessage, ServerJsonRpcMessage};
use rmcp::transport::streamable_http_server::session::local::{
    LocalSessionManager, LocalSessionManagerError, SessionTransport,
};
use rmcp::transport::streamable_http_server::session::{ServerSseMessage, SessionId, SessionManager};

/// rmcp's sessions, of which the one that was silent for longest ends when there is no room for another.
#[derive(Debug)]
pub(super) struct Sessions {
    sessions: LocalSessionManager,
    used: Mutex<LruCache<SessionId, ()>>,
}

impl Sessions {
    pub(super) fn new(limit: NonZeroUsize, idle: Duration) -> Self {
        let mut sessions = LocalSessionManager::default();
        sessions.session_config.keep_alive = Some(idle);
        Self { sessions, used: Mutex::new(LruCache::new(limit)) }
    }

    /// Ends a session without waiting for it: its client may have stopped reading.
    async fn end(&self, id: &SessionId) {
        if let Some(session) = self.sessions.sessions.write().await.remove(id) {
            tokio::spawn(async move { session.close().await });
        }
    }

    fn used<T>(&self, work: impl FnOnce(&mut LruCache<SessionId, ()>) -> T) -> T {
        work(&mut self.used.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl SessionManager for Sessions {
    type Error = LocalSessionManagerError;
    type Transport = SessionTransport;

    async fn create_session(&self) -> Result<(SessionId, Self::Transport), Self::Error> {
        let (id, transport) = self.sessions.create_session().await?;
        if let Some((silent, ())) = self.used(|used| used.push(id.clone(), ())) {
            tracing::debug!(
                "there is no room for another session, so the one that was silent for longest ends"
            );
            self.end(&silent).await;
        }
        Ok((id, transport))
    }

    async fn initialize_session(
        &self,
        id: &SessionId,
        message: ClientJsonRpcMessage,
    ) -> Result<ServerJsonRpcMessage, Self::Error> {
        self.sessions.initialize_session(id, message).await
    }

    /// Every request of a session begins here.
    async fn has_session(&self, id: &SessionId) -> Result<bool, Self::Error> {
        self.used(|used| used.promote(id));
        self.sessions.has_session(id).await
    }

    async fn close_session(&self, id: &SessionId) -> Result<(), Self::Error> {
        self.used(|used| used.pop(id));
        self.sessions.close_session(id).await
    }

    async fn create_stream(
        &self,
        id: &SessionId,
        message: ClientJsonRpcMessage,
    ) -> Result<impl Stream<Item = ServerSseMessage> + Send + Sync + 'static, Self::Error> {
        self.sessions.create_stream(id, message).await
    }

    async fn accept_message(&self, id: &SessionId, message: ClientJsonRpcMessage) -> Result<(), Self::Error> {
        self.sessions.accept_message(id, message).await
    }

    async fn create_standalone_stream(
        &self,
        id: &SessionId,
    ) -> Result<impl Stream<Item = ServerSseMessage> + Send + Sync + 'static, Self::Error> {
        self.sessions.create_standalone_stream(id).await
    }

    async fn resume(
        &self,
        id: &SessionId,
        last_event_id: String,
    ) -> Result<impl Stream<Item = ServerSseMessage> + Send + Sync + 'static, Self::Error> {
        self.sessions.resume(id, last_event_id).await
    }
}
