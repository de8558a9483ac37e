//! Laws of conformal risk control. `coin/tests/method/known_answers.rs` has thresholds found by search.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::level;

fn sample(confidence: f64, outcome: Outcome) -> RiskSample {
    RiskSample { confidence, outcome }
}

fn any_samples() -> impl Strategy<Value = Vec<RiskSample>> {
    let confidence =
        prop_oneof![0.0..=1.0_f64, (0..=20_u32).prop_map(|twentieths| f64::from(twentieths) / 20.0)];
    let outcome = prop_oneof![3 => Just(Outcome::Right), 1 => Just(Outcome::Wrong)];
    proptest::collection::vec((confidence, outcome), 0..80).prop_map(|samples| {
        samples.into_iter().map(|(confidence, outcome)| sample(confidence, outcome)).collect()
    })
}

/// (Σ losses(λ) + 1)/(N + 1) ≤ ε, in integers: ε is a number of thousandths.
fn keeps_the_risk(samples: &[RiskSample], lambda: f64, thousandths: usize) -> bool {
    let losses = samples
        .iter()
        .filter(|sample| sample.outcome == Outcome::Wrong && sample.confidence >= lambda)
        .count();
    1000 * (losses + 1) <= thousandths * (samples.len() + 1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn it_keeps_the_risk_and_nothing_smaller_does(samples in any_samples(), thousandths in 1..1000_usize) {
        let lambda = risk_threshold(&samples, level(thousandths as f64 / 1000.0));
        let possible = keeps_the_risk(&samples, f64::INFINITY, thousandths);
        prop_assert_eq!(lambda == ASK_EVERYTHING, !possible);
        prop_assert_eq!(keeps_the_risk(&samples, lambda, thousandths), possible);
        let smaller = samples.iter().map(|sample| sample.confidence).chain([0.0, lambda.next_down()]);
        for smaller in smaller.filter(|&smaller| (0.0..lambda).contains(&smaller)) {
            prop_assert!(!keeps_the_risk(&samples, smaller, thousandths), "{smaller} < {lambda} keeps it too");
        }
    }

    #[test]
    fn more_tolerance_never_asks_more(samples in any_samples(), a in 1..1000_u32, b in 1..1000_u32) {
        let threshold = |thousandths: u32| risk_threshold(&samples, level(f64::from(thousandths) / 1000.0));
        prop_assert!(threshold(a.max(b)) <= threshold(a.min(b)));
    }

    #[test]
    fn the_order_of_the_samples_does_not_matter(
        (samples, shuffled) in any_samples().prop_flat_map(|samples| (Just(samples.clone()), Just(samples).prop_shuffle())),
        thousandths in 1..1000_u32,
    ) {
        let epsilon = level(f64::from(thousandths) / 1000.0);
        prop_assert_eq!(risk_threshold(&samples, epsilon), risk_threshold(&shuffled, epsilon));
    }
}

/// Even without a single loss, (0 + 1)/(N + 1) has to be within ε: N ≥ 1/ε − 1 samples, 83 for the paper's .012.
#[rstest]
#[case(0.012, 82, ASK_EVERYTHING)]
#[case(0.012, 83, 0.0)]
#[case(0.1, 8, ASK_EVERYTHING)]
#[case(0.1, 9, 0.0)]
#[case(0.05, 18, ASK_EVERYTHING)]
#[case(0.05, 19, 0.0)]
#[case(0.01, 98, ASK_EVERYTHING)]
#[case(0.01, 99, 0.0)]
fn without_a_loss_everything_is_settled_once_there_are_enough(
    #[case] epsilon: f64,
    #[case] samples: usize,
    #[case] expected: f64,
) {
    let right = vec![sample(0.6, Outcome::Right); samples];
    assert_eq!(risk_threshold(&right, level(epsilon)), expected);
}

#[test]
fn a_wrong_thing_is_excluded_by_the_next_number_above_its_confidence() {
    let mut samples = vec![sample(0.6, Outcome::Right); 8];
    samples.push(sample(0.75, Outcome::Wrong));
    assert_eq!(risk_threshold(&samples, level(0.1)), 0.75_f64.next_up());
}

/// A model that is wrong and certain cannot be told from one that is right and certain: everything is asked.
#[test]
fn certain_errors_beyond_the_tolerance_settle_nothing() {
    let mut samples = vec![sample(1.0, Outcome::Right); 17];
    samples.extend([sample(1.0, Outcome::Wrong); 2]);
    let lambda = risk_threshold(&samples, level(0.1));
    assert!(lambda > 1.0);
}
