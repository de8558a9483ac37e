//! Tests and intervals: known answers of SciPy and lifelines, and laws.

use proptest::collection::vec;
use proptest::prelude::*;
use serde_json::Value;

use super::*;

const TOLERANCE: f64 = 1e-9;

fn answers(name: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../../tests/known_answers/statistics.json")).unwrap();
    let rows = all[name].as_array().unwrap().clone();
    assert!(!rows.is_empty());
    rows
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= TOLERANCE * expected.abs().max(1e-3)
}

#[test]
fn kruskal_wallis_is_that_of_scipy() {
    for row in answers("kruskal_wallis") {
        let groups: Vec<Vec<f64>> = row["groups"].as_array().unwrap().iter().map(numbers).collect();
        let found = kruskal_wallis(&groups.iter().map(Vec::as_slice).collect::<Vec<_>>()).unwrap();
        assert_eq!(found.degrees_of_freedom, groups.len() - 1);
        assert!(close(found.h, number(&row["h"])) && close(found.p, number(&row["p"])), "{found:?} in {row}");
    }
}

#[test]
fn mann_whitney_is_that_of_scipy() {
    for row in answers("mann_whitney") {
        let found = mann_whitney(&numbers(&row["one"]), &numbers(&row["other"]));
        assert!(close(found.u, number(&row["u"])) && close(found.p, number(&row["p"])), "{found:?} in {row}");
    }
}

#[test]
fn holms_correction_is_that_of_statsmodels() {
    for row in answers("holm") {
        let found = holm(&numbers(&row["p"]));
        let expected = numbers(&row["corrected"]);
        assert_eq!(found.len(), expected.len());
        assert!(
            found.iter().zip(expected).all(|(&found, expected)| close(found, expected)),
            "{found:?} in {row}"
        );
    }
}

#[test]
fn kaplan_meier_is_that_of_lifelines() {
    for row in answers("kaplan_meier") {
        let observations: Vec<Observation> = row["observations"]
            .as_array()
            .unwrap()
            .iter()
            .map(|pair| {
                let pair = numbers(pair);
                let outcome = if pair[1] == 1.0 { Outcome::Reached } else { Outcome::Censored };
                Observation { step: pair[0] as usize, outcome }
            })
            .collect();
        let found = serde_json::to_value(kaplan_meier(&observations)).unwrap();
        let (found, expected) = (found.as_array().unwrap(), row["steps"].as_array().unwrap());
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            for key in ["step", "survival", "at_risk", "reached", "censored"] {
                assert!(close(number(&found[key]), number(&expected[key])), "{key} of {found} in {row}");
            }
        }
    }
}

#[test]
fn clopper_pearson_is_that_of_scipy() {
    for row in answers("clopper_pearson") {
        let whole = |key: &str| row[key].as_u64().unwrap() as usize;
        let (low, high) = clopper_pearson(whole("count"), whole("trials"), 0.95);
        assert!(
            (low - number(&row["low"])).abs() < 1e-6 && (high - number(&row["high"])).abs() < 1e-6,
            "{low} … {high} in {row}"
        );
    }
    assert_eq!(clopper_pearson(0, 0, 0.95), (0.0, 1.0));
}

#[test]
fn nothing_to_tell_apart_is_no_difference() {
    assert_eq!(kruskal_wallis(&[&[1.0, 1.0], &[1.0]]), None);
    assert_eq!(kruskal_wallis(&[&[1.0, 2.0], &[]]), None);
    assert_eq!(kruskal_wallis(&[]), None);
    assert_eq!(mann_whitney(&[1.0; 10], &[1.0; 10]).p, 1.0);
    assert_eq!(mann_whitney(&[], &[1.0]).p, 1.0);
    assert_eq!(mean_and_deviation(&[]), (0.0, 0.0));
    assert_eq!(mean_and_deviation(&[0.1; 3]), (0.1, 0.0));
    assert_eq!(mean_and_deviation(&[1.0, 3.0]), (2.0, 2.0_f64.sqrt()));
}

/// Values among which ties are common.
fn any_group() -> impl Strategy<Value = Vec<f64>> {
    vec((0..12_u32).prop_map(f64::from), 1..12)
}

proptest! {
    #[test]
    fn only_the_order_of_values_counts(one in any_group(), other in any_group()) {
        let stretched = |group: &[f64]| group.iter().map(|value| value.exp() + 5.0).collect::<Vec<_>>();
        let (far, wide) = (stretched(&one), stretched(&other));
        prop_assert_eq!(mann_whitney(&one, &other), mann_whitney(&far, &wide));
        prop_assert_eq!(kruskal_wallis(&[&one, &other]), kruskal_wallis(&[&far, &wide]));
    }

    #[test]
    fn the_two_sides_see_the_same(one in any_group(), other in any_group()) {
        let (there, back) = (mann_whitney(&one, &other), mann_whitney(&other, &one));
        prop_assert!((there.p - back.p).abs() < 1e-12);
        prop_assert!((there.u + back.u - (one.len() * other.len()) as f64).abs() < 1e-9);
        prop_assert!(there.p > 0.0 && there.p <= 1.0);
    }

    #[test]
    fn a_correction_keeps_the_order_and_raises_all(p_values in vec(0.0..=1.0_f64, 0..10)) {
        let corrected = holm(&p_values);
        for (i, (&raw, &held)) in p_values.iter().zip(&corrected).enumerate() {
            prop_assert!(held >= raw && held <= 1.0);
            for (j, &other) in p_values.iter().enumerate() {
                prop_assert!(raw > other || corrected[i] <= corrected[j]);
            }
        }
    }

    #[test]
    fn without_censoring_survival_is_the_share_that_is_left(steps in vec(0..20_usize, 1..30)) {
        let runs: Vec<Observation> =
            steps.iter().map(|&step| Observation { step, outcome: Outcome::Reached }).collect();
        for row in kaplan_meier(&runs) {
            let left = steps.iter().filter(|&&step| step > row.step).count() as f64 / steps.len() as f64;
            prop_assert!((row.survival - left).abs() < 1e-12);
        }
    }

    #[test]
    fn an_interval_holds_its_share(trials in 1..500_usize, part in 0.0..=1.0_f64) {
        let count = (part * trials as f64) as usize;
        let (low, high) = clopper_pearson(count, trials, 0.95);
        let share = count as f64 / trials as f64;
        prop_assert!((0.0..=share).contains(&low) && (share..=1.0).contains(&high));
    }
}
