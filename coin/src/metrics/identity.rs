//! How well identities were kept: identification precision, recall and IDF1 (Ristani, Solera, Zou, Cucchiara and
//! Tomasi, *Performance Measures and a Data Set for Multi-Target, Multi-Camera Tracking*, 2016).

use std::collections::BTreeMap;

use crate::assignment::least_cost;

/// Counts of detections under the one-to-one matching of true and computed identities that explains most of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct IdentityScores {
    /// IDTP: detections whose computed identity is the one matched to their true identity.
    pub true_positives: usize,
    /// IDFP: detections with a computed identity that is not matched to what they show.
    pub false_positives: usize,
    /// IDFN: detections of something true that did not get the identity matched to it.
    pub false_negatives: usize,
}

impl IdentityScores {
    /// IDP = IDTP / (IDTP + IDFP); 0/0 counts as 0.
    pub fn precision(&self) -> f64 {
        super::ratio(self.true_positives, self.true_positives + self.false_positives)
    }

    /// IDR = IDTP / (IDTP + IDFN); 0/0 counts as 0.
    pub fn recall(&self) -> f64 {
        super::ratio(self.true_positives, self.true_positives + self.false_negatives)
    }

    /// IDF1 = 2 IDTP / (2 IDTP + IDFP + IDFN); 0/0 counts as 0.
    pub fn f1(&self) -> f64 {
        let found = 2 * self.true_positives;
        super::ratio(found, found + self.false_positives + self.false_negatives)
    }
}

/// Scores of detections, each given as its true identity (`None`: it shows nothing that exists) and its computed one
/// (`None`: it was given none).
///
/// The truth-to-result matching of Ristani et al. minimises IDFP + IDFN. As every detection counts once on either side,
/// that is the matching with the most detections on its pairs.
pub fn identity_scores<T: Ord + Copy, C: Ord + Copy>(
    detections: &[(Option<T>, Option<C>)],
) -> IdentityScores {
    let truths = places(detections.iter().filter_map(|(truth, _)| *truth));
    let computed = places(detections.iter().filter_map(|(_, computed)| *computed));
    let mut gains = vec![vec![0.0; computed.len()]; truths.len()];
    let mut of_truth = 0;
    let mut of_computed = 0;
    for (truth, identity) in detections {
        let truth = truth.and_then(|truth| truths.get(&truth));
        let identity = identity.and_then(|identity| computed.get(&identity));
        of_truth += usize::from(truth.is_some());
        of_computed += usize::from(identity.is_some());
        if let (Some(&row), Some(&column)) = (truth, identity) {
            gains[row][column] -= 1.0;
        }
    }
    let matched = least_cost(&gains, 0.0);
    let true_positives = gains
        .iter()
        .zip(&matched)
        .filter_map(|(row, column)| column.map(|column| -row[column] as usize))
        .sum();
    IdentityScores {
        true_positives,
        false_positives: of_computed - true_positives,
        false_negatives: of_truth - true_positives,
    }
}

/// The place of each value among the distinct ones.
fn places<V: Ord>(values: impl Iterator<Item = V>) -> BTreeMap<V, usize> {
    let mut places: BTreeMap<V, usize> = values.map(|value| (value, 0)).collect();
    for (place, of_value) in places.values_mut().enumerate() {
        *of_value = place;
    }
    places
}

#[cfg(test)]
mod tests;
