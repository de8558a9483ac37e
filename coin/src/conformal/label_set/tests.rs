//! Laws of the prediction set over owner sets.

use coin_schemas::model::OwnerSetProbability;
use proptest::prelude::*;

use super::*;
use crate::owners::candidate_sets;
use crate::support::{any_scores, any_set, roster, set};

proptest! {
    #[test]
    fn it_holds_the_true_set_exactly_where_the_score_is_within_the_threshold(
        (scores, owners) in (1..=4_usize).prop_flat_map(|n| (any_scores(n..=n), any_set(n))), q in 0.0..=1.0_f64,
    ) {
        let distribution = OwnerSetDistribution::from_scores(&scores);
        let score = nonconformity(&distribution, owners);
        prop_assert!((0.0..=1.0).contains(&score));
        prop_assert!((score + distribution.probability(owners) - 1.0).abs() < 1e-15);
        let held = prediction_set(&distribution, q).contains(&owners);
        prop_assert_eq!(held, !owners.is_empty() && score <= q);
    }

    #[test]
    fn prediction_sets_are_nested(scores in any_scores(1..=4), a in 0.0..=1.0_f64, b in 0.0..=1.0_f64) {
        let distribution = OwnerSetDistribution::from_scores(&scores);
        let larger = prediction_set(&distribution, a.max(b));
        prop_assert!(prediction_set(&distribution, a.min(b)).iter().all(|owners| larger.contains(owners)));
        prop_assert_eq!(prediction_set(&distribution, 1.0), candidate_sets(scores.len()));
    }

    #[test]
    fn a_single_set_is_the_best_one(scores in any_scores(1..=4), q in 0.0..=1.0_f64) {
        let distribution = OwnerSetDistribution::from_scores(&scores);
        let held = prediction_set(&distribution, q);
        let best = distribution.best().1;
        let holds_best = held.iter().any(|&owners| distribution.probability(owners) == best);
        prop_assert_eq!(holds_best, !held.is_empty());
    }
}

/// A model that swears by one set mentions no other; too few samples still exclude nothing.
#[test]
fn a_threshold_of_one_holds_sets_that_the_model_left_out() {
    let roster = roster(&["Ann", "Bob"]);
    let owners = roster.owners(set(&[0]));
    let sworn =
        OwnerSetDistribution::from_named(&roster, &[OwnerSetProbability { owners, probability: 1.0 }])
            .unwrap();
    assert_eq!(prediction_set(&sworn, Quantile::TooFewSamples.threshold()), candidate_sets(2));
    assert_eq!(prediction_set(&sworn, 0.99), [set(&[0])]);
}

#[test]
fn the_threshold_has_the_upper_rank() {
    let scores = [0.9, 0.1, 0.4, 0.2];
    let alpha = crate::support::level(0.2);
    assert_eq!(coverage_threshold(&scores, alpha), Quantile::Value(0.9));
    assert_eq!(coverage_threshold(&scores[1..], alpha), Quantile::TooFewSamples);
}
