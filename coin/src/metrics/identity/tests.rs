//! IDF1 on cases worked out by hand, and its laws.

use proptest::prelude::*;
use rstest::rstest;

use super::*;

type Detections = Vec<(Option<u8>, Option<u8>)>;

fn repeated(parts: &[(Option<u8>, Option<u8>, usize)]) -> Detections {
    parts.iter().flat_map(|&(truth, computed, times)| vec![(truth, computed); times]).collect()
}

#[rstest]
#[case::perfect(&[(Some(1), Some(7), 4), (Some(2), Some(3), 2)], 6, 0, 0)]
// One thing in two entries: the larger one counts, the other is missing and too much.
#[case::broken_in_two(&[(Some(1), Some(1), 8), (Some(1), Some(2), 2)], 8, 2, 2)]
// Two things in one entry: it can stand for one of them only.
#[case::merged(&[(Some(1), Some(1), 5), (Some(2), Some(1), 5)], 5, 5, 5)]
#[case::false_detections(&[(Some(1), Some(1), 5), (None, Some(2), 3)], 5, 3, 0)]
#[case::not_reported(&[(Some(1), Some(1), 5), (Some(1), None, 3)], 5, 0, 3)]
// Both truths prefer entry 1; 6 + 4 beats 7 + 0.
#[case::both_want_one(&[(Some(1), Some(1), 7), (Some(1), Some(2), 4), (Some(2), Some(1), 6)], 10, 7, 7)]
#[case::nothing(&[], 0, 0, 0)]
fn is_what_the_definition_says(
    #[case] parts: &[(Option<u8>, Option<u8>, usize)],
    #[case] true_positives: usize,
    #[case] false_positives: usize,
    #[case] false_negatives: usize,
) {
    assert_eq!(
        identity_scores(&repeated(parts)),
        IdentityScores { true_positives, false_positives, false_negatives }
    );
}

#[test]
fn the_measures_are_the_published_quotients() {
    let scores = IdentityScores { true_positives: 6, false_positives: 2, false_negatives: 4 };
    assert_eq!((scores.precision(), scores.recall(), scores.f1()), (0.75, 0.6, 12.0 / 18.0));
    assert_eq!(IdentityScores::default().f1(), 0.0);
}

proptest! {
    #[test]
    fn names_do_not_matter(detections in proptest::collection::vec(
        (proptest::option::of(0..5_u8), proptest::option::of(0..5_u8)), 0..40,
    )) {
        let renamed: Detections =
            detections.iter().map(|&(truth, computed)| (truth.map(|t| 9 - t), computed.map(|c| c ^ 3))).collect();
        prop_assert_eq!(identity_scores(&detections), identity_scores(&renamed));
    }

    /// Swapping truth and result swaps precision and recall.
    #[test]
    fn is_symmetric(detections in proptest::collection::vec(
        (proptest::option::of(0..5_u8), proptest::option::of(0..4_u8)), 0..40,
    )) {
        let swapped: Detections = detections.iter().map(|&(truth, computed)| (computed, truth)).collect();
        let (there, back) = (identity_scores(&detections), identity_scores(&swapped));
        prop_assert_eq!(there.true_positives, back.true_positives);
        prop_assert_eq!(there.false_positives, back.false_negatives);
        prop_assert_eq!(there.f1(), back.f1());
    }
}
