//! From values to coordinates.

/// A linear scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Where the low value lies.
    pub(super) low_at: f64,
    pub(super) high_at: f64,
}

impl Scale {
    /// The values that fall outside are drawn at the edge.
    pub(super) fn at(&self, value: f64) -> f64 {
        let span = self.high - self.low;
        let part = if span > 0.0 { (value - self.low) / span } else { 0.5 };
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
        self.low_at + part * (self.high_at - self.low_at)
    }
}

/// The tenth below the least of some shares, where an axis may begin that ends at 1.
pub(crate) fn tenth_below(shares: impl Iterator<Item = f64>) -> f64 {
    ((shares.fold(1.0, f64::min) * 10.0).floor() / 10.0).clamp(0.0, 0.9)
}

/// Round values between two ends, about five, with their texts.
pub(super) fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return vec![(low, short(low, 0))];
    }
    let rough = span / 5.0;
    let magnitude = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * magnitude)
        .find(|step| *step >= rough)
        .unwrap_or(magnitude * 10.0);
    let decimals = if step >= 1.0 {
        0
    } else {
        (-step.log10()).ceil() as usize + usize::from(step * 100.0 % 10.0 == 5.0 && step < 0.1)
    };
    let first = (low / step).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|count| count as f64 * step).map(|value| (value, short(value, decimals))).collect()
}

fn short(value: f64, decimals: usize) -> String {
    format!("{:.decimals$}", value + 0.0)
}
