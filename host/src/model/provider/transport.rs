//! One attempt: a request over HTTP, and its answer read within limits.

use std::time::{Duration, SystemTime};

use reqwest::header::{ACCEPT, AUTHORIZATION, CONTENT_TYPE, HeaderMap, HeaderName, HeaderValue};
use reqwest::{Client, Response, redirect};
use serde_json::Value;

use super::Provider;
use super::endpoint::Endpoint;
use super::failure::{Failure, Refusal};
use super::retry::retry_after;
use crate::model::ModelError;

/// How long connecting may take.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);

/// The longest answer that is read, in bytes.
const MOST_BYTES: usize = 8 * 1024 * 1024;

/// The version of Anthropic's API that is spoken.
const ANTHROPIC_VERSION: &str = "2023-06-01";

/// Sends requests to one endpoint.
#[derive(Debug)]
pub(super) struct Transport {
    endpoint: Endpoint,
    client: Client,
    headers: HeaderMap,
    timeout: Duration,
}

impl Transport {
    /// A transport whose attempts take at most `timeout`.
    pub(super) fn new(endpoint: Endpoint, timeout: Duration) -> Result<Self, ModelError> {
        // Ignored where another part of the process has chosen a provider first.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let builder = Client::builder()
            .user_agent(concat!("coin-host/", env!("CARGO_PKG_VERSION")))
            .connect_timeout(CONNECT_TIMEOUT)
            // The key would be sent to wherever a redirect points.
            .redirect(redirect::Policy::none())
            .retry(reqwest::retry::never());
        // A proxy has another loopback than this machine.
        let builder = if endpoint.is_loopback() { builder.no_proxy() } else { builder };
        let client = builder.build().map_err(|error| ModelError::Unusable {
            reason: format!("HTTP cannot be set up: {error}; check the system's certificates"),
        })?;
        Ok(Self { headers: headers(&endpoint), endpoint, client, timeout })
    }

    /// Where requests go.
    pub(super) fn endpoint(&self) -> &Endpoint {
        &self.endpoint
    }

    /// Posts a body and reads the answer with `read`.
    pub(super) async fn post<T>(
        &self,
        body: &str,
        read: impl Fn(&Value) -> Result<T, String>,
    ) -> Result<T, Failure> {
        let exchange = async {
            let request = self.client.post(self.endpoint.url.clone()).headers(self.headers.clone());
            let response = request
                .body(body.to_owned())
                .send()
                .await
                .map_err(|error| Failure::no_response(&error, CONNECT_TIMEOUT))?;
            self.read(response, read).await
        };
        let in_time = tokio::time::timeout(self.timeout, exchange).await;
        in_time.unwrap_or(Err(Failure::TimedOut(self.timeout)))
    }

    async fn read<T>(
        &self,
        response: Response,
        read: impl Fn(&Value) -> Result<T, String>,
    ) -> Result<T, Failure> {
        let status = response.status();
        let retry_after = retry_after(response.headers(), SystemTime::now());
        let body = self.body(response).await?;
        if !status.is_success() {
            return Err(Failure::Status(Refusal::read(status.as_u16(), &self.text(&body), retry_after)));
        }
        let garbled = |reason: &str| Failure::garbled(&self.endpoint.without_key(reason), &self.text(&body));
        let answer: Value = serde_json::from_slice(&body).map_err(|_| garbled("the answer is not JSON"))?;
        read(&answer).map_err(|reason| garbled(&reason))
    }

    async fn body(&self, mut response: Response) -> Result<Vec<u8>, Failure> {
        let mut body = Vec::new();
        while let Some(chunk) = response.chunk().await.map_err(|error| Failure::broken_off(&error))? {
            if body.len() + chunk.len() > MOST_BYTES {
                let reason = format!("the answer is longer than {} MiB", MOST_BYTES / (1024 * 1024));
                return Err(Failure::garbled(&reason, &self.text(&body)));
            }
            body.extend_from_slice(&chunk);
        }
        Ok(body)
    }

    /// A body as it may be quoted.
    fn text(&self, body: &[u8]) -> String {
        self.endpoint.without_key(&String::from_utf8_lossy(body))
    }
}

fn headers(endpoint: &Endpoint) -> HeaderMap {
    let json = HeaderValue::from_static("application/json");
    let mut headers = HeaderMap::from_iter([(CONTENT_TYPE, json.clone()), (ACCEPT, json)]);
    let (name, scheme) = match endpoint.provider() {
        Provider::OpenAi => (AUTHORIZATION, "Bearer "),
        Provider::Anthropic => {
            let version = HeaderValue::from_static(ANTHROPIC_VERSION);
            headers.insert(HeaderName::from_static("anthropic-version"), version);
            (HeaderName::from_static("x-api-key"), "")
        }
    };
    if let Some(value) = endpoint.key.as_ref().and_then(|key| key.header(scheme)) {
        headers.insert(name, value);
    }
    headers
}
