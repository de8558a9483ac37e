//! Laws of DETECT-SHARE.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::{any_order, any_scores, moved, scores, set, values};

/// Every k ≥ 2 for which the paper's three inequalities hold, straight from the equations.
fn all_k(scores: &[Score], thresholds: &ShareThresholds) -> Vec<usize> {
    let mut falling = values(scores);
    falling.sort_by(|left, right| right.total_cmp(left));
    falling.push(0.0);
    (2..falling.len())
        .filter(|&k| {
            falling[k - 1] >= thresholds.least_score - ROUNDING
                && falling[0] - falling[k - 1] <= thresholds.largest_spread + ROUNDING
                && falling[k - 1] - falling[k] >= thresholds.least_gap - ROUNDING
        })
        .collect()
}

/// Scores near the thresholds: hundredths from .5 to 1, some low.
fn close_scores() -> impl Strategy<Value = Vec<Score>> {
    proptest::collection::vec(prop_oneof![4 => 70..=100_u32, 1 => 0..=70_u32], 1..=8)
        .prop_map(|hundredths| scores(&hundredths.iter().map(|&h| f64::from(h) / 100.0).collect::<Vec<_>>()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// If j < k both fit, ε_out ≤ s_(j) − s_(j+1) ≤ s_(1) − s_(k) ≤ ε_in, against ε_out > ε_in.
    #[test]
    fn at_most_one_k_fits(scores in prop_oneof![close_scores(), any_scores(1..=8)]) {
        prop_assert!(all_k(&scores, &ShareThresholds::default()).len() <= 1);
    }

    #[test]
    fn at_most_one_k_fits_whatever_the_thresholds(
        scores in close_scores(), least_score in 0.0..1.0_f64, largest_spread in 0.0..0.3_f64, more in 0.001..0.3_f64,
    ) {
        let thresholds = ShareThresholds { least_score, largest_spread, least_gap: largest_spread + more };
        prop_assert!(all_k(&scores, &thresholds).len() <= 1);
    }

    #[test]
    fn the_shared_owners_are_the_top_k(scores in prop_oneof![close_scores(), any_scores(1..=8)]) {
        let thresholds = ShareThresholds::default();
        let shared = detect_share(&scores, &thresholds);
        prop_assert_eq!(shared.map(OwnerSet::len), all_k(&scores, &thresholds).first().copied());
        let owners = owner_set(&scores, &thresholds);
        prop_assert_eq!(owners, shared.unwrap_or(owners));
        prop_assert_eq!(owners.len(), shared.map_or(1, OwnerSet::len));
        let least = owners.iter().map(|user| scores[user.place()].value()).fold(1.0, f64::min);
        for (place, score) in scores.iter().enumerate() {
            prop_assert!(score.value() <= least || owners.contains(UserIndex::new(place).unwrap()));
        }
    }

    /// A shared set ends in a gap, so no tie crosses its edge and the order of the members cannot matter.
    #[test]
    fn names_do_not_decide_who_shares(
        (scores, order) in (2..=6_usize).prop_flat_map(|n| (any_scores(n..=n), any_order(n))),
    ) {
        let mut permuted = scores.clone();
        for (place, &score) in scores.iter().enumerate() {
            permuted[order[place]] = score;
        }
        let thresholds = ShareThresholds::default();
        let expected = detect_share(&scores, &thresholds).map(|shared| moved(shared, &order));
        prop_assert_eq!(detect_share(&permuted, &thresholds), expected);
    }
}

/// Without ε_out > ε_in the claim is false; the smallest k is taken.
#[test]
fn two_k_may_fit_where_the_gap_may_be_smaller_than_the_spread() {
    let loose = ShareThresholds { least_score: 0.5, largest_spread: 0.3, least_gap: 0.1 };
    let scores = scores(&[0.95, 0.9, 0.75, 0.2]);
    assert_eq!(all_k(&scores, &loose), [2, 3]);
    assert_eq!(detect_share(&scores, &loose), Some(set(&[0, 1])));
}

#[rstest]
#[case::two_of_three(&[0.9, 0.1, 0.85], Some(set(&[0, 2])), &[0, 2])]
#[case::everyone(&[0.9, 0.88, 0.85], Some(set(&[0, 1, 2])), &[0, 1, 2])]
#[case::one_is_not_shared(&[0.9, 0.1, 0.1], None, &[0])]
#[case::too_low(&[0.79, 0.79, 0.1], None, &[0])]
#[case::too_spread(&[0.95, 0.86, 0.1], None, &[0])]
#[case::no_gap(&[0.9, 0.88, 0.7], None, &[0])]
#[case::ties_go_to_the_roster(&[0.2, 0.7, 0.7], None, &[1])]
#[case::nothing_known(&[0.0, 0.0], None, &[0])]
#[case::one_member(&[0.95], None, &[0])]
#[case::nobody(&[], None, &[])]
fn the_owner_set(#[case] given: &[f64], #[case] shared: Option<OwnerSet>, #[case] owners: &[usize]) {
    let (given, thresholds) = (scores(given), ShareThresholds::default());
    assert_eq!(detect_share(&given, &thresholds), shared);
    assert_eq!(owner_set(&given, &thresholds), set(owners));
}

/// The inequalities are not strict, and 1.0 − 0.8 < 0.2 and 0.9 − 0.82 > 0.08 in binary.
#[rstest]
#[case::least_score(&[0.8, 0.8, 0.1])]
#[case::spread(&[0.9, 0.82, 0.1])]
#[case::gap(&[1.0, 1.0, 0.8])]
#[case::all_three(&[0.88, 0.8, 0.6])]
fn scores_on_the_thresholds_share(#[case] given: &[f64]) {
    assert_eq!(detect_share(&scores(given), &ShareThresholds::default()), Some(set(&[0, 1])));
}

/// A hundredth beyond a threshold is beyond it.
#[rstest]
#[case::least_score(&[0.8, 0.79, 0.1])]
#[case::spread(&[0.9, 0.81, 0.1])]
#[case::gap(&[1.0, 1.0, 0.81])]
fn scores_beyond_the_thresholds_do_not(#[case] given: &[f64]) {
    assert_eq!(detect_share(&scores(given), &ShareThresholds::default()), None);
}

#[test]
fn minus_zero_ties_with_zero() {
    assert_eq!(owner_set(&scores(&[-0.0, 0.0]), &ShareThresholds::default()), set(&[0]));
}
