//! Visual context: which things look like a thing (the paper's Section 4.3, "Visually Similar Object Retrieval").

mod clusters;
mod quick;

pub use clusters::{middles, nearest};
pub use quick::{Code, Probe, QUICK_ERROR, SIDE_BY_SIDE, Shortlist, quick_cosine, quick_cosines};

/// A thing that looks like another.
#[derive(Debug, Clone, PartialEq)]
pub struct Similar<T> {
    /// The thing.
    pub item: T,
    /// Cosine of the features, −1…1.
    pub similarity: f64,
}

/// The feature at length 1; `None` where it is zero or not finite and so has no direction.
pub fn normalise(feature: &[f32]) -> Option<Vec<f32>> {
    let length =
        feature.iter().map(|&component| f64::from(component) * f64::from(component)).sum::<f64>().sqrt();
    (length.is_finite() && length > 0.0)
        .then(|| feature.iter().map(|&component| (f64::from(component) / length) as f32).collect())
}

/// sim(o, i) = f̂_oᵀ f̂_i of two features of length 1. Rounding may carry it past ±1; it is cut there.
///
/// # Panics
/// If the features differ in dimension.
pub fn cosine(left: &[f32], right: &[f32]) -> f64 {
    assert!(left.len() == right.len(), "features of one home have one dimension");
    let product: f64 = left.iter().zip(right).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum();
    // Adding 0 turns −0 into 0, so that two features at a right angle tie.
    product.clamp(-1.0, 1.0) + 0.0
}

/// The `k` most similar of `others` (which must not hold the target itself): largest cosine first, then lowest
/// item.
pub fn most_similar<'a, T: Ord>(
    target: &[f32],
    others: impl IntoIterator<Item = (T, &'a [f32])>,
    k: usize,
) -> Vec<Similar<T>> {
    let mut similar: Vec<Similar<T>> = others
        .into_iter()
        .map(|(item, feature)| Similar { item, similarity: cosine(target, feature) })
        .collect();
    similar.sort_by(|left, right| {
        right.similarity.total_cmp(&left.similarity).then_with(|| left.item.cmp(&right.item))
    });
    similar.truncate(k);
    similar
}

#[cfg(test)]
mod tests;
