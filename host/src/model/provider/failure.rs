//! What went wrong with one attempt, without the key.

use std::error::Error;
use std::io::ErrorKind;
use std::time::Duration;

use coin_server::display::excerpt;
use serde_json::Value;
use thiserror::Error;

/// How an attempt failed. No text in it holds the key: what comes from a server is cleared of it before.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum Failure {
    /// No server was reached, or it hung up without a word.
    #[error("{0}")]
    NoResponse(String),
    /// The answer broke off.
    #[error("the answer broke off: {0}")]
    BrokenOff(String),
    /// The whole answer did not come in time.
    #[error("no whole answer came within {} s", .0.as_secs_f64())]
    TimedOut(Duration),
    /// The server answered with an error.
    #[error("{0}")]
    Status(Refusal),
    /// The answer is not in the provider's form.
    #[error("{reason}: {excerpt}")]
    Garbled {
        /// What is wrong with it.
        reason: String,
        /// How it begins.
        excerpt: String,
    },
    /// So many attempts have failed in a row that none is made for a while.
    #[error(
        "not tried: the last {failures} attempts failed ({last}); the next one is made in {} s",
        .wait.as_secs_f64().ceil()
    )]
    NotTried {
        /// How many attempts have failed in a row.
        failures: u32,
        /// How the last one did.
        last: String,
        /// How long it is until one is made again.
        wait: Duration,
    },
}

/// An answer that is an error.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{status}{}", if .excerpt.is_empty() { String::new() } else { format!(": {excerpt}") })]
pub(super) struct Refusal {
    /// The HTTP status.
    pub(super) status: u16,
    /// The server's words, shortened.
    pub(super) excerpt: String,
    /// The server's words in lower case, or only the names of the parameters that it refuses where it names them.
    names: String,
    /// Whether no more can be had for what was paid.
    pub(super) quota: Quota,
    /// How long the server wants to be left alone.
    pub(super) retry_after: Option<Duration>,
}

/// What an error says of the money.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quota {
    /// Nothing.
    Unmentioned,
    /// It is used up, and waiting does not help.
    UsedUp,
}

impl Refusal {
    /// Reads an error's body, which must be free of the key.
    pub(super) fn read(status: u16, body: &str, retry_after: Option<Duration>) -> Self {
        let json = serde_json::from_str::<Value>(body).unwrap_or_default();
        // OpenRouter and Google wrap the object in a list.
        let json = json.get(0).unwrap_or(&json);
        let error = json.get("error").unwrap_or(json);
        let message = [error.get("message"), Some(error), json.get("message"), json.get("detail")]
            .into_iter()
            .flatten()
            .find_map(Value::as_str)
            .unwrap_or(body);
        let kinds = ["code", "type"].map(|key| error.get(key).and_then(Value::as_str).unwrap_or_default());
        let used_up = ["insufficient_quota", "billing_error", "billing_hard_limit_reached"];
        let is_used_up = status == 402
            || kinds.iter().any(|kind| used_up.contains(kind))
            || message.contains("credit balance is too low");
        Self {
            status,
            excerpt: excerpt(message),
            names: named_parameters(error, json).unwrap_or_else(|| message.to_owned()).to_lowercase(),
            quota: if is_used_up { Quota::UsedUp } else { Quota::Unmentioned },
            retry_after,
        }
    }
}

/// The parameters that an error points at, where it does so in a field of their own.
fn named_parameters(error: &Value, whole: &Value) -> Option<String> {
    if let Some(parameter) = error.get("param").and_then(Value::as_str).filter(|name| !name.is_empty()) {
        return Some(parameter.to_owned());
    }
    // Servers that check requests with Pydantic list where each problem is.
    let details = whole.get("detail")?.as_array()?;
    let places: Vec<&str> = details
        .iter()
        .filter_map(|detail| detail.get("loc")?.as_array())
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    (!places.is_empty()).then(|| places.join(" "))
}

impl Failure {
    /// A text that is not in the provider's form, and must be free of the key.
    pub(super) fn garbled(reason: &str, text: &str) -> Self {
        Self::Garbled { reason: excerpt(reason), excerpt: excerpt(text) }
    }

    /// Why the request failed before an answer began.
    pub(super) fn no_response(error: &reqwest::Error, connect_timeout: Duration) -> Self {
        Self::NoResponse(if error.is_connect() && error.is_timeout() {
            format!("no connection within {} s", connect_timeout.as_secs_f64())
        } else {
            innermost(error)
        })
    }

    /// Why the answer did not come to its end.
    pub(super) fn broken_off(error: &reqwest::Error) -> Self {
        Self::BrokenOff(innermost(error))
    }

    /// Whether the same request may be answered when it is made again.
    pub(super) fn may_pass(&self) -> bool {
        match self {
            Self::NoResponse(_) | Self::BrokenOff(_) | Self::TimedOut(_) | Self::Garbled { .. } => true,
            Self::Status(refusal) => {
                refusal.quota == Quota::Unmentioned
                    && matches!(refusal.status, 408 | 409 | 425 | 429 | 500..=599)
            }
            Self::NotTried { .. } => false,
        }
    }

    /// How long the server wants to be left alone.
    pub(super) fn retry_after(&self) -> Option<Duration> {
        match self {
            Self::Status(refusal) => refusal.retry_after,
            _ => None,
        }
    }

    /// What the server says against the request itself, in lower case.
    pub(super) fn objection(&self) -> Option<&str> {
        match self {
            Self::Status(refusal)
                if matches!(refusal.status, 400 | 422) && refusal.quota == Quota::Unmentioned =>
            {
                Some(&refusal.names)
            }
            _ => None,
        }
    }
}

/// What lies at the bottom of an error. The upper layers only say that a request failed, and name the URL.
fn innermost(error: &reqwest::Error) -> String {
    let mut cause: &dyn Error = error;
    loop {
        match cause.downcast_ref::<std::io::Error>().map(std::io::Error::kind) {
            Some(ErrorKind::ConnectionRefused) => return "connection refused".to_owned(),
            Some(ErrorKind::ConnectionReset) => return "connection reset".to_owned(),
            _ => {}
        }
        match cause.source() {
            Some(source) => cause = source,
            None => return excerpt(&cause.to_string()),
        }
    }
}
