//! Laws of the metrics. `coin/tests/method/known_answers.rs` has figures that were computed elsewhere.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::{any_order, any_set, moved, set};

const EXACT: f64 = 1e-12;

fn judged(estimate: &[usize], truth: &[usize]) -> Judged {
    Judged { estimate: set(estimate), truth: set(truth) }
}

fn any_judged() -> impl Strategy<Value = Vec<Judged>> {
    let one = (any_set(4), any_set(4)).prop_map(|(estimate, truth)| Judged { estimate, truth });
    proptest::collection::vec(one, 0..20)
}

fn figures(summary: &MetricsSummary) -> [f64; 5] {
    let MetricsSummary { subset_accuracy, mean_jaccard, micro_precision, micro_recall, micro_f1, .. } =
        *summary;
    [subset_accuracy, mean_jaccard, micro_precision, micro_recall, micro_f1]
}

proptest! {
    #[test]
    fn every_figure_is_a_share(judged in any_judged()) {
        let summary = summarise(&judged);
        prop_assert_eq!(summary.objects, judged.len());
        prop_assert!(figures(&summary).iter().all(|figure| (0.0..=1.0).contains(figure)));
        prop_assert!(summary.subset_accuracy <= summary.mean_jaccard + EXACT);
        let least = summary.micro_precision.min(summary.micro_recall);
        let most = summary.micro_precision.max(summary.micro_recall);
        prop_assert!((least - EXACT..=most + EXACT).contains(&summary.micro_f1));
    }

    #[test]
    fn the_f1_is_the_harmonic_mean(judged in any_judged()) {
        let MetricsSummary { micro_precision: p, micro_recall: r, micro_f1, .. } = summarise(&judged);
        let expected = if p + r > 0.0 { 2.0 * p * r / (p + r) } else { 0.0 };
        prop_assert!((micro_f1 - expected).abs() < EXACT);
    }

    #[test]
    fn neither_the_order_of_things_nor_of_people_matters(
        (judged, shuffled) in any_judged().prop_flat_map(|judged| (Just(judged.clone()), Just(judged).prop_shuffle())),
        order in any_order(4),
    ) {
        let renamed: Vec<Judged> = shuffled
            .iter()
            .map(|thing| Judged { estimate: moved(thing.estimate, &order), truth: moved(thing.truth, &order) })
            .collect();
        for (before, after) in figures(&summarise(&judged)).into_iter().zip(figures(&summarise(&renamed))) {
            prop_assert!((before - after).abs() < EXACT);
        }
    }

    #[test]
    fn swapping_estimate_and_truth_swaps_precision_and_recall(judged in any_judged()) {
        let swapped: Vec<Judged> =
            judged.iter().map(|thing| Judged { estimate: thing.truth, truth: thing.estimate }).collect();
        let [accuracy, jaccard, precision, recall, f1] = figures(&summarise(&judged));
        prop_assert_eq!(figures(&summarise(&swapped)), [accuracy, jaccard, recall, precision, f1]);
    }

    #[test]
    fn truth_judged_by_itself_is_perfect(truths in proptest::collection::vec(any_set(4), 1..10)) {
        prop_assume!(truths.iter().any(|truth| !truth.is_empty()));
        let judged: Vec<Judged> = truths.iter().map(|&truth| Judged { estimate: truth, truth }).collect();
        prop_assert_eq!(figures(&summarise(&judged)), [1.0; 5]);
    }
}

#[rstest]
#[case::both_empty(&[], &[], 1.0)]
#[case::only_an_estimate(&[0], &[], 0.0)]
#[case::only_a_truth(&[], &[0], 0.0)]
#[case::disjoint(&[0], &[1], 0.0)]
#[case::equal(&[0, 2], &[0, 2], 1.0)]
#[case::part(&[0], &[0, 1], 0.5)]
#[case::overlap(&[0, 1], &[1, 2], 1.0 / 3.0)]
fn the_jaccard_index(#[case] estimate: &[usize], #[case] truth: &[usize], #[case] expected: f64) {
    assert_eq!(jaccard(judged(estimate, truth)), expected);
}

/// 0/0 counts as 0, but ∅ against ∅ is a perfect match.
#[rstest]
#[case::no_things(&[], [0.0, 0.0, 0.0, 0.0, 0.0])]
#[case::nobody_owns_and_nobody_is_named(&[judged(&[], &[])], [1.0, 1.0, 0.0, 0.0, 0.0])]
#[case::nobody_is_named(&[judged(&[], &[0])], [0.0, 0.0, 0.0, 0.0, 0.0])]
#[case::nobody_owns(&[judged(&[0], &[])], [0.0, 0.0, 0.0, 0.0, 0.0])]
fn nothing_over_nothing(#[case] things: &[Judged], #[case] expected: [f64; 5]) {
    assert_eq!(figures(&summarise(things)), expected);
}
