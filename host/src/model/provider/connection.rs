//! Sending bodies to an endpoint until they are answered or given up.

use serde_json::Value;

use super::ProviderSettings;
use super::breaker::Breaker;
use super::endpoint::Endpoint;
use super::explanation;
use super::retry::{self, GivenUp, RetryPolicy};
use super::transport::Transport;
use crate::model::ModelError;

/// A way to one endpoint, with retries and a circuit breaker over all calls.
#[derive(Debug)]
pub(super) struct Connection {
    transport: Transport,
    retry: RetryPolicy,
    breaker: Breaker,
}

impl Connection {
    /// A way to `endpoint`. A key that others can read on the way is warned of.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] if HTTP cannot be set up.
    pub(super) fn new(endpoint: Endpoint, settings: &ProviderSettings) -> Result<Self, ModelError> {
        endpoint.warn_of_plain_text();
        Ok(Self {
            breaker: Breaker::new(settings.retry.breaker_failures, settings.retry.breaker_pause),
            transport: Transport::new(endpoint, settings.timeout)?,
            retry: settings.retry.clone(),
        })
    }

    /// Where requests go.
    pub(super) fn endpoint(&self) -> &Endpoint {
        self.transport.endpoint()
    }

    /// Sends one body until its answer is read by `read` or it is given up.
    pub(super) async fn send<T>(
        &self,
        body: &Value,
        read: impl Fn(&Value) -> Result<T, String>,
    ) -> Result<T, GivenUp> {
        let body = body.to_string();
        retry::persist(&self.retry, || async {
            let permit = self.breaker.permit()?;
            let outcome = self.transport.post(&body, &read).await;
            permit.settle(outcome.as_ref().err());
            outcome
        })
        .await
    }

    /// What a caller is told of a request that was given up.
    pub(super) fn explain(&self, given_up: &GivenUp, model: &str) -> ModelError {
        explanation::explain(given_up, self.endpoint(), model, &self.retry, self.breaker.history())
    }
}
