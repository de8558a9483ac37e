//! What each gate asks about, and in which order.

use std::cmp::Ordering;

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::owners::OwnerSet;
use crate::support::{id, set};

const CALIBRATED: Thresholds = Thresholds::Calibrated { q_alpha: 0.5, q_cp: 0.1, q_set: 0.5, lambda: 0.8 };

fn assessment(confidence: f64, uncertainty: f64, plausible_sets: usize) -> Assessment {
    Assessment {
        owners: set(&[0]),
        confidence,
        prediction_set: set(&[0]),
        uncertainty,
        plausible_sets,
        shared_owners: None,
        shared: false,
        settled: false,
    }
}

/// Each gate looks at its own figure alone: the other two would decide otherwise.
#[rstest]
#[case::risk_below(Gate::Risk, assessment(0.8_f64.next_down(), 0.0, 1), true)]
#[case::risk_at(Gate::Risk, assessment(0.8, 1.0, 7), false)]
#[case::paper_above(Gate::Paper, assessment(1.0, 0.1_f64.next_up(), 1), true)]
#[case::paper_at(Gate::Paper, assessment(0.0, 0.1, 7), false)]
#[case::set_of_two(Gate::Set, assessment(1.0, 0.0, 2), true)]
#[case::set_of_one(Gate::Set, assessment(0.0, 1.0, 1), false)]
#[case::set_of_none(Gate::Set, assessment(1.0, 0.0, 0), true)]
#[case::always(Gate::Always, assessment(1.0, 0.0, 1), true)]
#[case::never(Gate::Never, assessment(0.0, 1.0, 7), false)]
fn a_calibrated_gate(#[case] gate: Gate, #[case] assessment: Assessment, #[case] asks: bool) {
    assert_eq!(wants_to_ask(gate, &CALIBRATED, &assessment), asks);
}

/// Without a calibration the best owner set needs .95, whatever the gate would look at.
#[rstest]
fn a_gate_without_calibration_looks_at_the_confidence(
    #[values(Gate::Risk, Gate::Set, Gate::Paper)] gate: Gate,
) {
    let asks = |confidence, uncertainty, plausible_sets| {
        wants_to_ask(gate, &Thresholds::Uncalibrated, &assessment(confidence, uncertainty, plausible_sets))
    };
    assert!(asks(0.95_f64.next_down(), 0.0, 1));
    assert!(!asks(0.95, 1.0, 7));
}

#[rstest]
fn always_and_never_need_no_calibration(#[values(0.0, 1.0)] confidence: f64) {
    let assessment = assessment(confidence, 0.5, 2);
    assert!(wants_to_ask(Gate::Always, &Thresholds::Uncalibrated, &assessment));
    assert!(!wants_to_ask(Gate::Never, &Thresholds::Uncalibrated, &assessment));
}

#[rstest]
#[case("9", "10", Ordering::Less)]
#[case("10", "9", Ordering::Greater)]
#[case("007", "7", Ordering::Less)]
#[case("8", "007", Ordering::Greater)]
#[case("7", "7", Ordering::Equal)]
#[case("10", "cup", Ordering::Less)]
#[case("cup-10", "cup-9", Ordering::Less)]
#[case("-1", "0", Ordering::Greater)]
#[case("99999999999999999999", "3", Ordering::Greater)]
fn ids_are_ordered_as_a_person_expects(#[case] left: &str, #[case] right: &str, #[case] expected: Ordering) {
    assert_eq!(compare_ids(&id(left), &id(right)), expected);
}

proptest! {
    #[test]
    fn ids_have_a_total_order(
        texts in proptest::collection::vec(prop_oneof!["[0-9]{1,3}", "[a-c0-9]{1,3}", "0{0,2}[0-9]"], 3),
    ) {
        let [a, b, c] = [id(&texts[0]), id(&texts[1]), id(&texts[2])];
        prop_assert_eq!(compare_ids(&a, &b), compare_ids(&b, &a).reverse());
        prop_assert_eq!(compare_ids(&a, &b) == Ordering::Equal, a == b);
        if compare_ids(&a, &b) != Ordering::Greater && compare_ids(&b, &c) != Ordering::Greater {
            prop_assert_ne!(compare_ids(&a, &c), Ordering::Greater);
        }
        let (mut sorted, mut compared) = ([c.clone(), b.clone(), a.clone()], [a, b, c]);
        sort_ids(&mut sorted);
        compared.sort_by(compare_ids);
        prop_assert_eq!(sorted, compared);
    }
}

fn doubtful(confidence: f64, uncertainty: f64, prediction_set: OwnerSet) -> Assessment {
    Assessment { prediction_set, ..assessment(confidence, uncertainty, 2) }
}

/// The first of each pair is asked about first. By id it would come last.
#[rstest]
#[case::larger_cp(Gate::Paper, doubtful(0.9, 0.6, set(&[0])), doubtful(0.1, 0.5, set(&[0, 1])))]
#[case::larger_gamma(Gate::Paper, doubtful(0.9, 0.5, set(&[0, 1])), doubtful(0.1, 0.5, set(&[0])))]
#[case::less_sure(Gate::Risk, doubtful(0.4, 0.1, set(&[0])), doubtful(0.5, 0.9, set(&[0, 1])))]
#[case::less_sure(Gate::Set, doubtful(0.4, 0.1, set(&[0])), doubtful(0.5, 0.9, set(&[0, 1])))]
#[case::less_sure(Gate::Always, doubtful(0.4, 0.1, set(&[0])), doubtful(0.5, 0.9, set(&[0, 1])))]
#[case::less_sure(Gate::Never, doubtful(0.4, 0.1, set(&[0])), doubtful(0.5, 0.9, set(&[0, 1])))]
fn doubt_decides_the_order(#[case] gate: Gate, #[case] first: Assessment, #[case] second: Assessment) {
    assert_eq!(compare_priority(gate, (&id("10"), &first), (&id("9"), &second)), Ordering::Less);
    assert_eq!(compare_priority(gate, (&id("9"), &second), (&id("10"), &first)), Ordering::Greater);
}

#[rstest]
fn equal_doubt_goes_by_id(#[values(Gate::Risk, Gate::Set, Gate::Paper, Gate::Always)] gate: Gate) {
    let same = doubtful(0.4, 0.5, set(&[0, 1]));
    assert_eq!(compare_priority(gate, (&id("9"), &same), (&id("10"), &same)), Ordering::Less);
}
