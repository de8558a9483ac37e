//! Laws of features and of looks.

use proptest::prelude::*;
use rstest::rstest;

use super::*;

fn any_feature() -> impl Strategy<Value = Vec<f32>> {
    proptest::collection::vec(-10.0..10.0_f32, 16).prop_filter("a zero feature has no direction", |feature| {
        feature.iter().any(|&component| component != 0.0)
    })
}

const SINGLE: f64 = 1e-6;

proptest! {
    #[test]
    fn normalising_keeps_the_direction_and_makes_the_length_one(feature in any_feature(), scale in 0.01..100.0_f32) {
        let unit = normalise(&feature).unwrap();
        let length = unit.iter().map(|&component| f64::from(component).powi(2)).sum::<f64>().sqrt();
        prop_assert!((length - 1.0).abs() < SINGLE);
        let factor = f64::from(feature[0]) / f64::from(unit[0]);
        prop_assert!(feature[0] == 0.0 || factor > 0.0);
        for (&component, &of_unit) in feature.iter().zip(&unit) {
            prop_assert!((f64::from(component) - f64::from(of_unit) * feature_length(&feature)).abs() < 1e-4);
        }
        let scaled: Vec<f32> = feature.iter().map(|component| component * scale).collect();
        let same = normalise(&scaled).unwrap();
        prop_assert!(unit.iter().zip(&same).all(|(a, b)| f64::from(a - b).abs() < SINGLE));
    }

    #[test]
    fn cosine_is_symmetric_and_bounded(left in any_feature(), right in any_feature()) {
        let (left, right) = (normalise(&left).unwrap(), normalise(&right).unwrap());
        let opposite: Vec<f32> = left.iter().map(|component| -component).collect();
        prop_assert_eq!(cosine(&left, &right), cosine(&right, &left));
        prop_assert!((-1.0..=1.0).contains(&cosine(&left, &right)));
        prop_assert!((cosine(&left, &left) - 1.0).abs() < SINGLE);
        prop_assert!((cosine(&left, &opposite) + 1.0).abs() < SINGLE);
        // For features of length 1: |a − b|² = 2 − 2 cos.
        let squared: f64 = left.iter().zip(&right).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum();
        prop_assert!((squared - (2.0 - 2.0 * cosine(&left, &right))).abs() < 4.0 * SINGLE);
    }

    #[test]
    fn the_most_similar_are_the_head_of_a_full_ranking(
        features in proptest::collection::vec(any_feature(), 1..12),
        k in 0..8_usize,
    ) {
        let features: Vec<Vec<f32>> = features.iter().filter_map(|feature| normalise(feature)).collect();
        let others = || features.iter().enumerate().skip(1).map(|(item, feature)| (item, feature.as_slice()));
        let similar = most_similar(&features[0], others(), k);
        let full = most_similar(&features[0], others(), usize::MAX);
        prop_assert_eq!(similar.len(), k.min(features.len() - 1));
        prop_assert_eq!(&similar[..], &full[..similar.len()]);
        let in_order = |left: &Similar<usize>, right: &Similar<usize>| {
            left.similarity > right.similarity || left.similarity == right.similarity && left.item < right.item
        };
        prop_assert!(full.is_sorted_by(in_order));
        for found in &full {
            prop_assert_eq!(found.similarity, cosine(&features[0], &features[found.item]));
        }
    }
}

fn feature_length(feature: &[f32]) -> f64 {
    feature.iter().map(|&component| f64::from(component).powi(2)).sum::<f64>().sqrt()
}

#[rstest]
#[case::three_four(&[3.0, 4.0], Some(vec![0.6, 0.8]))]
#[case::tiny(&[f32::MIN_POSITIVE / 4.0, 0.0], Some(vec![1.0, 0.0]))]
#[case::huge(&[f32::MAX, 0.0], Some(vec![1.0, 0.0]))]
#[case::zero(&[0.0, 0.0], None)]
#[case::empty(&[], None)]
#[case::infinite(&[f32::INFINITY, 0.0], None)]
#[case::no_number(&[f32::NAN, 1.0], None)]
fn only_a_finite_feature_other_than_zero_has_a_direction(
    #[case] feature: &[f32],
    #[case] expected: Option<Vec<f32>>,
) {
    assert_eq!(normalise(feature), expected);
}

/// A right angle is 0 whatever the signs of its zeros, so the lower item comes first and no file shows "-0.0".
#[test]
fn equal_similarities_go_by_item() {
    let target = [1.0_f32, 0.0];
    let (up, down) = ([0.0_f32, 1.0], [-0.0_f32, -1.0]);
    let similar = most_similar(&target, [("b", up.as_slice()), ("a", down.as_slice())], 2);
    assert_eq!(similar.iter().map(|similar| similar.item).collect::<Vec<_>>(), ["a", "b"]);
    assert!(similar.iter().all(|similar| similar.similarity.to_bits() == 0));
}

#[test]
#[should_panic(expected = "features of one home have one dimension")]
fn features_of_two_dimensions_do_not_compare() {
    cosine(&[1.0], &[1.0, 0.0]);
}
