//! The paper's tests and intervals: Kruskal–Wallis, Mann–Whitney U with Holm's correction, Kaplan–Meier, and the
//! exact binomial interval.

mod ranks;
mod survival;
#[cfg(test)]
mod tests;

use coin_schemas::experiment::KruskalWallis;
use statrs::distribution::{Beta, ChiSquared, ContinuousCDF, Normal};

use ranks::{Ranks, ranks};
pub use survival::{Observation, Outcome, kaplan_meier};

/// Up to this many values in the smaller group the Mann–Whitney p-value is exact, where no values are tied.
pub const LARGEST_EXACT_GROUP: usize = 8;

/// Mean and sample standard deviation (n − 1); 0 and 0 for no value, deviation 0 for one.
pub fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    match values {
        [] => (0.0, 0.0),
        [value] => (*value, 0.0),
        // Values that are all the same have no deviation, and a mean that rounding must not move.
        [first, rest @ ..] if rest.iter().all(|value| value == first) => (*first, 0.0),
        _ => {
            let mean = values.iter().sum::<f64>() / count;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (mean, (squares / (count - 1.0)).sqrt())
        }
    }
}

/// The Kruskal–Wallis test of whether groups come from one distribution: H with the correction for ties, and its
/// p-value by the χ² approximation (Kruskal and Wallis, 1952). `None` where fewer than two groups have a value or
/// all values are equal, because then H is not defined.
pub fn kruskal_wallis(groups: &[&[f64]]) -> Option<KruskalWallis> {
    let groups: Vec<&[f64]> = groups.iter().copied().filter(|group| !group.is_empty()).collect();
    let pooled: Vec<f64> = groups.concat();
    let Ranks { ranks, tie_sum } = ranks(&pooled);
    let count = pooled.len() as f64;
    let correction = 1.0 - tie_sum / (count.powi(3) - count);
    if groups.len() < 2 || correction <= 0.0 || correction.is_nan() {
        return None;
    }
    let mut rest = ranks.as_slice();
    let mut sum = 0.0;
    for group in &groups {
        let (own, others) = rest.split_at(group.len());
        sum += own.iter().sum::<f64>().powi(2) / group.len() as f64;
        rest = others;
    }
    let h = (12.0 / (count * (count + 1.0)) * sum - 3.0 * (count + 1.0)) / correction;
    let degrees_of_freedom = groups.len() - 1;
    let p = ChiSquared::new(degrees_of_freedom as f64).map_or(1.0, |chi| chi.sf(h.max(0.0)));
    Some(KruskalWallis { h, degrees_of_freedom, p })
}

/// A two-sided Mann–Whitney U test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MannWhitney {
    /// U of the first group: how many pairs it wins, a tie counting half.
    pub u: f64,
    /// The p-value.
    pub p: f64,
}

/// The two-sided Mann–Whitney U test (Mann and Whitney, 1947). The p-value is exact where no values are tied and the
/// smaller group has at most [`LARGEST_EXACT_GROUP`] values; else it is the normal approximation with the correction
/// for ties and for continuity. It is 1 where a group is empty or all values are equal.
pub fn mann_whitney(one: &[f64], other: &[f64]) -> MannWhitney {
    let pooled = [one, other].concat();
    let Ranks { ranks, tie_sum } = ranks(&pooled);
    let (n1, n2) = (one.len() as f64, other.len() as f64);
    let u = ranks.iter().take(one.len()).sum::<f64>() - n1 * (n1 + 1.0) / 2.0;
    let larger = u.max(n1 * n2 - u);
    if one.is_empty() || other.is_empty() {
        return MannWhitney { u, p: 1.0 };
    }
    if tie_sum == 0.0 && one.len().min(other.len()) <= LARGEST_EXACT_GROUP {
        return MannWhitney { u, p: (2.0 * exact_upper_tail(one.len(), other.len(), larger)).min(1.0) };
    }
    let count = n1 + n2;
    let variance = n1 * n2 / 12.0 * (count + 1.0 - tie_sum / (count * (count - 1.0)));
    if variance <= 0.0 {
        return MannWhitney { u, p: 1.0 };
    }
    let z = (larger - n1 * n2 / 2.0 - 0.5) / variance.sqrt();
    MannWhitney { u, p: (2.0 * Normal::standard().sf(z)).min(1.0) }
}

/// P(U ≥ u) under the null hypothesis, by counting the orders of n1 and n2 distinct values with each U: the last value
/// belongs to the one group, and wins against all n2 of the other, or to the other.
fn exact_upper_tail(n1: usize, n2: usize, u: f64) -> f64 {
    let most = n1 * n2;
    // counts[i][k]: orders of i values of the first group and the j of the present round with U = k.
    let mut counts = vec![vec![0.0; most + 1]; n1 + 1];
    for row in &mut counts {
        row[0] = 1.0;
    }
    for j in 1..=n2 {
        let mut next = vec![vec![0.0; most + 1]; n1 + 1];
        next[0][0] = 1.0;
        for i in 1..=n1 {
            for k in 0..=most {
                let last_is_first = if k >= j { next[i - 1][k - j] } else { 0.0 };
                next[i][k] = last_is_first + counts[i][k];
            }
        }
        counts = next;
    }
    let total: f64 = counts[n1].iter().sum();
    let tail: f64 =
        counts[n1].iter().enumerate().filter(|&(k, _)| k as f64 >= u).map(|(_, count)| count).sum();
    tail / total
}

/// Holm's step-down correction of p-values for the number of comparisons (Holm, 1979), in the order given.
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&left, &right| p_values[left].total_cmp(&p_values[right]));
    let mut corrected = vec![0.0; p_values.len()];
    let mut least: f64 = 0.0;
    for (place, &index) in order.iter().enumerate() {
        least = least.max(((p_values.len() - place) as f64 * p_values[index]).min(1.0));
        corrected[index] = least;
    }
    corrected
}

/// The exact two-sided binomial interval of a share (Clopper and Pearson, 1934) at a confidence level in 0…1; 0…1 where
/// nothing was tried.
pub fn clopper_pearson(count: usize, trials: usize, confidence_level: f64) -> (f64, f64) {
    let tail = (1.0 - confidence_level) / 2.0;
    let quantile = |a: usize, b: usize, probability: f64| {
        Beta::new(a as f64, b as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(probability))
    };
    let misses = trials.saturating_sub(count);
    let low = if count == 0 { 0.0 } else { quantile(count, misses + 1, tail) };
    let high = if misses == 0 { 1.0 } else { quantile(count + 1, misses, 1.0 - tail) };
    (low, high)
}
