//! Attempts that are repeated while a server is busy or out of reach.

use std::time::{Duration, SystemTime};

use backon::{ExponentialBuilder, Retryable};
use reqwest::header::{HeaderMap, RETRY_AFTER};

use super::failure::Failure;

/// By how much every pause is longer than the one before.
const FACTOR: f32 = 2.0;

/// How often and when an attempt is repeated.
#[derive(Debug, Clone, PartialEq)]
pub struct RetryPolicy {
    /// How often at most.
    pub retries: usize,
    /// The pause before the first repetition. Every further one is twice as long, and each is lengthened by chance,
    /// at most to its double, so that calls do not come back together.
    pub base: Duration,
    /// The longest pause that a server may ask for; if it asks for more, the call is given up at once.
    pub longest_wait: Duration,
    /// After how many failed attempts in a row, of all calls together, none is made for a while.
    pub breaker_failures: u32,
    /// For how long.
    pub breaker_pause: Duration,
}

impl Default for RetryPolicy {
    fn default() -> Self {
        Self {
            retries: 3,
            base: Duration::from_millis(500),
            longest_wait: Duration::from_secs(60),
            // As many as the four calls that go on at once make before they give up, so that a server that is away for a
            // second is waited for and not left alone.
            breaker_failures: 16,
            breaker_pause: Duration::from_secs(30),
        }
    }
}

/// The last failure of a request that is not tried any more.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct GivenUp {
    pub(super) failure: Failure,
    /// How many attempts were made.
    pub(super) attempts: usize,
}

/// Makes an attempt, and again while it fails in a way that may pass.
pub(super) async fn persist<T, Attempt>(
    policy: &RetryPolicy,
    mut attempt: impl FnMut() -> Attempt,
) -> Result<T, GivenUp>
where
    Attempt: Future<Output = Result<T, Failure>>,
{
    let pauses = ExponentialBuilder::new()
        .with_min_delay(policy.base)
        .with_factor(FACTOR)
        .with_max_delay(policy.longest_wait)
        .with_max_times(policy.retries)
        .with_jitter();
    let mut attempts = 0;
    let mut counted = || {
        attempts += 1;
        attempt()
    };
    (&mut counted)
        .retry(pauses)
        .sleep(tokio::time::sleep)
        .when(|failure| {
            failure.may_pass() && failure.retry_after().is_none_or(|wait| wait <= policy.longest_wait)
        })
        .adjust(|failure, pause| pause.map(|pause| failure.retry_after().unwrap_or(pause)))
        .notify(|failure, pause| {
            tracing::info!(%failure, pause_seconds = pause.as_secs_f64(), "trying again");
        })
        .await
        .map_err(|failure| GivenUp { failure, attempts })
}

/// How long a server wants to be left alone, by `retry-after-ms` or `Retry-After` in seconds or as a date.
pub(super) fn retry_after(headers: &HeaderMap, now: SystemTime) -> Option<Duration> {
    let text = |name: &str| headers.get(name).and_then(|value| value.to_str().ok()).map(str::trim);
    let milliseconds = text("retry-after-ms").and_then(|text| text.parse::<f64>().ok());
    if let Some(wait) = milliseconds.and_then(|milliseconds| seconds(milliseconds / 1000.0)) {
        return Some(wait);
    }
    let text = text(RETRY_AFTER.as_str())?;
    match text.parse::<f64>() {
        Ok(number) => seconds(number),
        Err(_) => httpdate::parse_http_date(text)
            .ok()
            .map(|date| date.duration_since(now).unwrap_or(Duration::ZERO)),
    }
}

/// A number of seconds; `None` where it is no number that can be waited for.
fn seconds(number: f64) -> Option<Duration> {
    number.is_finite().then(|| Duration::try_from_secs_f64(number.max(0.0)).unwrap_or(Duration::MAX))
}
