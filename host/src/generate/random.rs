//! Seeded draws. Only sums, products and comparisons are used, no transcendental function: the same seed gives
//! the same bytes on every platform.

use std::ops::Range;

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The concern that a stream of random numbers serves. Each has its own stream, so that a change in how captions
/// are worded leaves the sessions of a seed as they were.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stream {
    Habits,
    People,
    Belongings,
    Plans,
    Sessions,
    Floor,
    Features,
    Sightings,
    Words,
    HandDowns,
    Schedule,
}

/// The random numbers of one concern of one home. The key is the seed followed by the name of the kind of home, so
/// that the same seed gives unrelated homes of two kinds.
pub(super) fn stream(protocol: &str, seed: u64, stream: Stream) -> ChaCha8Rng {
    let mut key = [0_u8; 32];
    key.iter_mut()
        .zip(seed.to_le_bytes().into_iter().chain(protocol.bytes()))
        .for_each(|(to, from)| *to = from);
    let mut generator = ChaCha8Rng::from_seed(key);
    generator.set_stream(stream as u64);
    generator
}

/// A number drawn evenly from a range; its start where the range is empty.
pub(super) fn between(range: &Range<f64>, generator: &mut ChaCha8Rng) -> f64 {
    if range.is_empty() { range.start } else { generator.random_range(range.clone()) }
}

/// A nearly standard normal number: the sum of eight even bytes, centred and scaled (Irwin–Hall).
pub(super) fn normal(generator: &mut ChaCha8Rng) -> f64 {
    const MEAN: f64 = 8.0 * 127.5;
    // The square root of 8 · (256² − 1) / 12.
    const DEVIATION: f64 = 209.022_327_388_2;
    let sum: u32 = generator.next_u64().to_le_bytes().into_iter().map(u32::from).sum();
    (f64::from(sum) - MEAN) / DEVIATION
}

/// An index drawn with the given weights (not negative); `None` where they sum to nothing.
pub(super) fn weighted(weights: &[f64], generator: &mut ChaCha8Rng) -> Option<usize> {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let mut left = generator.random_range(0.0..total);
    for (index, weight) in weights.iter().enumerate() {
        left -= weight;
        if left < 0.0 {
            return Some(index);
        }
    }
    weights.iter().rposition(|&weight| weight > 0.0)
}
