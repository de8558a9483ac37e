//! What a caller is told of a request that was given up: what happened, and what to do next.

use super::breaker::History;
use super::endpoint::Endpoint;
use super::failure::{Failure, Quota, Refusal};
use super::retry::{GivenUp, RetryPolicy};
use crate::model::ModelError;

/// Says why a request was given up. That no request can succeed is only said where it is certain.
pub(super) fn explain(
    given_up: &GivenUp,
    endpoint: &Endpoint,
    model: &str,
    policy: &RetryPolicy,
    history: History,
) -> ModelError {
    let tried = match given_up.attempts {
        0 | 1 => String::new(),
        attempts => format!(" (tried {attempts} times)"),
    };
    match (&given_up.failure, history) {
        (Failure::NoResponse(reason) | Failure::NotTried { last: reason, .. }, History::NeverAnswered) => {
            nobody_there(endpoint, reason)
        }
        (not_tried @ Failure::NotTried { .. }, _) => unanswered(not_tried.to_string()),
        (Failure::Status(refusal), _) => refused(refusal, endpoint, model, policy, &tried),
        (failure @ Failure::NoResponse(_), _) => {
            unanswered(format!("{} is out of reach: {failure}{tried}", endpoint.shown))
        }
        (failure, _) => unanswered(format!("{failure}{tried}")),
    }
}

fn nobody_there(endpoint: &Endpoint, reason: &str) -> ModelError {
    let first = if endpoint.is_own_service() { "check the connection to the internet" } else { "start it" };
    unusable(format!(
        "no model answers at {}: {reason}; {first}, set {}, or {}",
        endpoint.shown,
        endpoint.provider().url_variable(),
        endpoint.service.without()
    ))
}

fn refused(
    refusal: &Refusal,
    endpoint: &Endpoint,
    model: &str,
    policy: &RetryPolicy,
    tried: &str,
) -> ModelError {
    let Endpoint { service, shown, .. } = endpoint;
    let provider = service.provider();
    let (key, url) = (provider.key_variable(), provider.url_variable());
    let status = refusal.status;
    if refusal.quota == Quota::UsedUp {
        return unusable(format!(
            "the quota is used up ({refusal}); add credit to the account of the key in {key}, or {}",
            service.without()
        ));
    }
    match (status, refusal.retry_after) {
        // The words of a refused key may repeat a part of it.
        (401, _) if endpoint.key.is_some() => {
            unusable(format!("the key in {key} was refused (401); set it to a valid key"))
        }
        (401, _) => unusable(format!("{shown} wants a key (401); set {key} to one")),
        (403, _) => unusable(format!(
            "the key in {key} was refused ({refusal}); set it to a key that may use the model {model}"
        )),
        (404 | 405, _) => unusable(format!(
            "the model {model} is not known at {shown} ({refusal}); choose one that is there, or set {url} to \
             where it is"
        )),
        (300..=399, _) => unusable(format!(
            "{shown} sends requests elsewhere ({status}), and the key is not taken along; set {url} to the new \
             address"
        )),
        (_, Some(wait)) if wait > policy.longest_wait => unanswered(format!(
            "{refusal}; the server wants to be left alone for {:.0} s, longer than the {:.0} s that are waited \
             for at most; try again later",
            wait.as_secs_f64(),
            policy.longest_wait.as_secs_f64()
        )),
        _ => unanswered(format!("the server answered {refusal}{tried}")),
    }
}

fn unanswered(reason: String) -> ModelError {
    ModelError::Unanswered { reason }
}

fn unusable(reason: String) -> ModelError {
    ModelError::Unusable { reason }
}
