//! Conformal prediction and risk control, with ranks in integer arithmetic.
//!
//! The guarantees are marginal and hold under exchangeability of calibration and test samples. The things of
//! one home are not exchangeable with that home's own answers, so calibration uses other households.

pub mod label_set;
pub mod risk;
pub mod split;

use thiserror::Error;

/// Why a number is no level.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InvalidLevel {
    /// It does not lie strictly between 0 and 1.
    #[error("a level lies strictly between 0 and 1, and {given} does not")]
    Range {
        /// The number.
        given: f64,
    },
    /// It is finer than a millionth.
    #[error("a level is a whole number of millionths, and {given} is not")]
    Precision {
        /// The number.
        given: f64,
    },
}

/// A level such as α = 0.2, kept as a whole number of millionths: ⌈(N+1)(1−α)⌉ in floating point is one rank off
/// at N = 9, 19 and 99 for common levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Level {
    millionths: u64,
}

const MILLION: u64 = 1_000_000;

impl Level {
    /// Takes a number strictly between 0 and 1 with at most six decimals.
    pub fn new(value: f64) -> Result<Self, InvalidLevel> {
        if !(value > 0.0 && value < 1.0) {
            return Err(InvalidLevel::Range { given: value });
        }
        let millionths = (value * MILLION as f64).round();
        if (millionths / MILLION as f64 - value).abs() > 1e-12
            || millionths < 1.0
            || millionths >= MILLION as f64
        {
            return Err(InvalidLevel::Precision { given: value });
        }
        Ok(Self { millionths: millionths as u64 })
    }

    /// The level as a number.
    pub fn value(self) -> f64 {
        self.millionths as f64 / MILLION as f64
    }

    /// ⌈(N+1)(1−α)⌉, the rank of the conformal quantile among N samples; N + 1 or more where N is too small.
    pub fn upper_rank(self, samples: usize) -> usize {
        ((samples as u64 + 1) * (MILLION - self.millionths)).div_ceil(MILLION) as usize
    }

    /// ⌈(N+1)α⌉, clamped to 1…N (method note: the stopping threshold is a heuristic, not a coverage bound).
    pub fn lower_rank(self, samples: usize) -> usize {
        let rank = ((samples as u64 + 1) * self.millionths).div_ceil(MILLION) as usize;
        rank.clamp(1, samples.max(1))
    }

    /// The least N with ⌈(N+1)(1−α)⌉ ≤ N, which is also the least with ⌊α(N+1)⌋ ≥ 1: ⌈1/α⌉ − 1. With fewer
    /// samples no finite threshold keeps the level.
    pub fn least_samples(self) -> usize {
        (MILLION.div_ceil(self.millionths) - 1) as usize
    }

    /// ⌊ε(N+1)⌋, the number of losses out of N + 1 that the level allows.
    pub fn allowed_losses(self, samples: usize) -> usize {
        ((samples as u64 + 1) * self.millionths / MILLION) as usize
    }
}

/// A conformal quantile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantile {
    /// The nonconformity score of the required rank.
    Value(f64),
    /// There are too few calibration samples for the level: nothing can be excluded.
    TooFewSamples,
}

impl Quantile {
    /// The threshold; 1, which excludes nothing, where the samples are too few.
    pub fn threshold(self) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::TooFewSamples => 1.0,
        }
    }
}

/// The rank-th smallest of the samples, rank from 1; too few samples where the rank is beyond them.
pub fn quantile(samples: &[f64], rank: usize) -> Quantile {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    rank.checked_sub(1)
        .and_then(|place| sorted.get(place))
        .map_or(Quantile::TooFewSamples, |&value| Quantile::Value(value))
}

#[cfg(test)]
mod tests;
