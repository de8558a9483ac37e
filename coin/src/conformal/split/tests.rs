//! Laws of the prediction set over members and of cp_s.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::{any_scores, any_set, level, scores, set, values};

fn household() -> impl Strategy<Value = (Vec<Score>, OwnerSet)> {
    (1..=6_usize).prop_flat_map(|members| (any_scores(members..=members), any_set(members)))
}

proptest! {
    /// The whole of the two guarantees in one equivalence each; exchangeability does the rest.
    #[test]
    fn the_prediction_set_holds_an_owner_exactly_where_the_score_is_within_the_threshold(
        (scores, owners) in household(), q in 0.0..=1.0_f64,
    ) {
        let gamma = prediction_set(&scores, q);
        let any = nonconformity(NonconformityScore::AnyOwner, &scores, owners);
        prop_assert_eq!(!gamma.intersection(owners).is_empty(), any.is_some_and(|score| score <= q));
        let all = nonconformity(NonconformityScore::AllOwners, &scores, owners);
        prop_assert_eq!(owners.is_subset(gamma), all.is_none_or(|score| score <= q));
    }

    #[test]
    fn an_owner_at_the_threshold_is_held((scores, owners) in household()) {
        prop_assume!(!owners.is_empty());
        let any = nonconformity(NonconformityScore::AnyOwner, &scores, owners).unwrap();
        prop_assert!(!prediction_set(&scores, any).intersection(owners).is_empty());
        let all = nonconformity(NonconformityScore::AllOwners, &scores, owners).unwrap();
        prop_assert!(owners.is_subset(prediction_set(&scores, all)));
    }

    #[test]
    fn nonconformity_is_one_minus_the_best_or_the_worst_owner((scores, owners) in household()) {
        let of_owners: Vec<f64> = owners.iter().map(|user| scores[user.place()].value()).collect();
        let best = of_owners.iter().copied().reduce(f64::max).map(|score| 1.0 - score);
        let worst = of_owners.iter().copied().reduce(f64::min).map(|score| 1.0 - score);
        prop_assert_eq!(nonconformity(NonconformityScore::AnyOwner, &scores, owners), best);
        prop_assert_eq!(nonconformity(NonconformityScore::AllOwners, &scores, owners), worst);
        prop_assert!(best <= worst);
        prop_assert!(worst.is_none_or(|score| (0.0..=1.0).contains(&score)));
        prop_assert_eq!(best.is_none(), owners.is_empty());
    }

    #[test]
    fn prediction_sets_are_nested(scores in any_scores(1..=6), a in 0.0..=1.0_f64, b in 0.0..=1.0_f64) {
        prop_assert!(prediction_set(&scores, a.min(b)).is_subset(prediction_set(&scores, a.max(b))));
        prop_assert_eq!(prediction_set(&scores, 1.0).len(), scores.len());
    }

    #[test]
    fn uncertainty_is_one_minus_the_mean_score(scores in any_scores(1..=6), q in 0.0..=1.0_f64) {
        let gamma = prediction_set(&scores, q);
        let cp = uncertainty(&scores, gamma);
        let held: Vec<f64> = gamma.iter().map(|user| scores[user.place()].value()).collect();
        let expected = if held.is_empty() { 1.0 } else { held.iter().map(|score| 1.0 - score).sum::<f64>() / held.len() as f64 };
        prop_assert!((0.0..=1.0).contains(&cp));
        prop_assert!((cp - expected).abs() < 1e-12);
        prop_assert!(gamma.is_empty() || cp <= q + 1e-12);
    }

    #[test]
    fn a_larger_alpha_never_has_a_larger_threshold(
        samples in proptest::collection::vec(0.0..=1.0_f64, 1..60), a in 1..1000_u32, b in 1..1000_u32,
    ) {
        let threshold = |j: u32| coverage_threshold(&samples, level(f64::from(j) / 1000.0)).threshold();
        prop_assert!(threshold(a.max(b)) <= threshold(a.min(b)));
    }
}

#[test]
fn an_empty_prediction_set_is_wholly_uncertain() {
    let low = scores(&[0.3, 0.2]);
    assert_eq!(prediction_set(&low, 0.5), OwnerSet::EMPTY);
    assert_eq!(uncertainty(&low, OwnerSet::EMPTY), 1.0);
}

#[test]
fn nobody_of_the_household_has_no_nonconformity() {
    for score in [NonconformityScore::AnyOwner, NonconformityScore::AllOwners] {
        assert_eq!(nonconformity(score, &scores(&[0.9, 0.1]), OwnerSet::EMPTY), None);
    }
}

/// `s ≥ 1 − q` would lose this owner: 1 − (1 − 0.3) is above 0.3 in binary.
#[test]
fn a_score_that_equals_a_calibration_sample_is_held() {
    let sample = scores(&[0.3, 0.1]);
    let q = nonconformity(NonconformityScore::AnyOwner, &sample, set(&[0])).unwrap();
    assert!(values(&sample)[0] < 1.0 - q);
    assert_eq!(prediction_set(&sample, q), set(&[0]));
}

/// ⌈(N+1)α_cp⌉ for α_cp = .05: the smallest of up to 19 cp_s, the second of 20 to 39.
#[rstest]
#[case(1, 0.01)]
#[case(19, 0.01)]
#[case(20, 0.02)]
#[case(39, 0.02)]
#[case(40, 0.03)]
fn the_stopping_threshold_is_a_low_quantile(#[case] samples: u32, #[case] expected: f64) {
    let falling: Vec<f64> = (1..=samples).rev().map(|place| f64::from(place) / 100.0).collect();
    assert_eq!(stopping_threshold(&falling, level(0.05)), Quantile::Value(expected));
}

/// Clamped to N where α_cp is large: ⌈4 · 0.9⌉ = 4 > 3.
#[test]
fn the_stopping_threshold_is_never_beyond_the_samples() {
    assert_eq!(stopping_threshold(&[0.3, 0.1, 0.2], level(0.9)), Quantile::Value(0.3));
    assert_eq!(stopping_threshold(&[], level(0.9)), Quantile::TooFewSamples);
}
