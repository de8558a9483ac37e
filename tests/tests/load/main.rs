//! Many clients on one database at once: every call is answered, nothing that was acknowledged is lost, and who only
//! looks is not held up by who writes.
//!
//! The figures need optimised programs and a minute: `COIN_SLOW_TESTS=1 cargo test --release -p coin-tests --test load
//! -- --nocapture --test-threads=1`. Otherwise the same is done for some seconds, and times are judged mildly.

mod clients;
mod crowd;
mod readers;

use std::time::Duration;

/// The middle, the slowest of a hundred and the slowest of all, in words.
fn distribution(times: &mut [Duration]) -> String {
    times.sort_unstable();
    let milliseconds = |share: f64| {
        let place = ((times.len().saturating_sub(1)) as f64 * share).round() as usize;
        times.get(place).copied().unwrap_or_default().as_secs_f64() * 1e3
    };
    format!(
        "{} calls, median {:.1} ms, 99th percentile {:.1} ms, longest {:.1} ms",
        times.len(),
        milliseconds(0.5),
        milliseconds(0.99),
        milliseconds(1.0)
    )
}
