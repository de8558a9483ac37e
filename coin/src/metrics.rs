//! The paper's metrics (Appendix E), and that of the map: [`identity`].

pub mod identity;

use coin_schemas::report::MetricsSummary;

use crate::owners::OwnerSet;

/// A thing's estimated and true owner set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Judged {
    /// The estimate.
    pub estimate: OwnerSet,
    /// The truth.
    pub truth: OwnerSet,
}

/// |U ∩ Û| / |U ∪ Û|; 1 where both are empty.
pub fn jaccard(judged: Judged) -> f64 {
    let union = judged.estimate.union(judged.truth).len();
    if union == 0 { 1.0 } else { judged.estimate.intersection(judged.truth).len() as f64 / union as f64 }
}

fn ratio(numerator: usize, denominator: usize) -> f64 {
    if denominator == 0 { 0.0 } else { numerator as f64 / denominator as f64 }
}

/// Subset Accuracy, Mean Jaccard and micro-averaged precision, recall and F1 (0/0 counts as 0).
pub fn summarise(judged: &[Judged]) -> MetricsSummary {
    let exact = judged.iter().filter(|thing| thing.estimate == thing.truth).count();
    let true_positives: usize =
        judged.iter().map(|thing| thing.estimate.intersection(thing.truth).len()).sum();
    let estimated: usize = judged.iter().map(|thing| thing.estimate.len()).sum();
    let owned: usize = judged.iter().map(|thing| thing.truth.len()).sum();
    MetricsSummary {
        objects: judged.len(),
        subset_accuracy: ratio(exact, judged.len()),
        mean_jaccard: if judged.is_empty() {
            0.0
        } else {
            judged.iter().map(|&thing| jaccard(thing)).sum::<f64>() / judged.len() as f64
        },
        micro_precision: ratio(true_positives, estimated),
        micro_recall: ratio(true_positives, owned),
        // 2PR/(P+R) with the precisions written out, which is exact where the quotients are not.
        micro_f1: ratio(2 * true_positives, estimated + owned),
    }
}

#[cfg(test)]
mod tests;
