//! Conformal risk control of the share of wrong owner sets (Angelopoulos, Bates, Fisch, Lei and Schuster,
//! *Conformal Risk Control*, 2024).

use super::Level;

/// A calibration thing as risk control sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiskSample {
    /// conf(o): the probability of the most probable owner set, 0…1.
    pub confidence: f64,
    /// Whether that set is the true one.
    pub outcome: Outcome,
}

/// Whether the most probable owner set is the true one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// It is.
    Right,
    /// It is not.
    Wrong,
}

/// A threshold that no confidence reaches: everything is asked.
pub const ASK_EVERYTHING: f64 = 2.0;

/// λ̂: the smallest λ ≥ 0 with (Σ losses(λ) + 1)/(N + 1) ≤ ε, where a thing's loss is 1 when it is settled without a
/// question (confidence ≥ λ) and its set is wrong. [`ASK_EVERYTHING`] where no λ keeps the risk.
///
/// Losses fall as λ rises and change only just above the confidence of a wrong thing, so λ̂ is 0 or the next
/// number above such a confidence.
pub fn risk_threshold(samples: &[RiskSample], epsilon: Level) -> f64 {
    let Some(tolerated) = epsilon.allowed_losses(samples.len()).checked_sub(1) else {
        return ASK_EVERYTHING;
    };
    let mut wrong: Vec<f64> = samples
        .iter()
        .filter(|sample| sample.outcome == Outcome::Wrong)
        .map(|sample| sample.confidence)
        .collect();
    wrong.sort_by(|left, right| right.total_cmp(left));
    wrong.get(tolerated).map_or(0.0, |confidence| confidence.next_up())
}

#[cfg(test)]
mod tests;
