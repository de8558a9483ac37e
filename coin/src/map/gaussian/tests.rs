//! The divergences against numerical integration, and their laws.

use proptest::prelude::*;

use super::*;

fn any_gaussian() -> impl Strategy<Value = Gaussian> {
    ([-0.5..0.5_f64, -0.5..0.5, -0.5..0.5], 0.003..0.1_f64)
        .prop_map(|(mean, variance)| Gaussian { mean, variance })
}

fn log_density(at: f64, mean: f64, variance: f64) -> f64 {
    -0.5 * ((at - mean) * (at - mean) / variance + (std::f64::consts::TAU * variance).ln())
}

/// ∫ p ln(p/q) on each axis by the trapezoidal rule over ten standard deviations; independent axes add up.
fn by_integration(from: &Gaussian, to: &Gaussian) -> f64 {
    const STEPS: i32 = 4000;
    let deviation = from.variance.sqrt();
    (0..3)
        .map(|axis| {
            let step = 20.0 * deviation / f64::from(STEPS);
            (0..=STEPS)
                .map(|number| {
                    let at = from.mean[axis] + (f64::from(number) * step - 10.0 * deviation);
                    let log_from = log_density(at, from.mean[axis], from.variance);
                    log_from.exp() * (log_from - log_density(at, to.mean[axis], to.variance)) * step
                })
                .sum::<f64>()
        })
        .sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn kl_is_its_integral(from in any_gaussian(), to in any_gaussian()) {
        let integral = by_integration(&from, &to);
        prop_assert!((kl(&from, &to) - integral).abs() < 1e-8 * (1.0 + integral), "{} {integral}", kl(&from, &to));
    }

    #[test]
    fn jeffreys_is_both_directions(a in any_gaussian(), b in any_gaussian()) {
        let sum = kl(&a, &b) + kl(&b, &a);
        prop_assert!((jeffreys(&a, &b) - sum).abs() < 1e-9 * (1.0 + sum));
        prop_assert_eq!(jeffreys(&a, &b), jeffreys(&b, &a));
        prop_assert!(jeffreys(&a, &b) >= 0.0 && kl(&a, &b) >= -1e-12);
        prop_assert_eq!(jeffreys(&a, &a), 0.0);
    }
}

#[test]
fn a_cup_is_not_the_table_it_stands_on() {
    let ball = |radius: f64| Gaussian { mean: [0.0; 3], variance: 0.15 * radius };
    assert!((kl(&ball(0.05), &ball(0.6)) - 2.35).abs() < 0.01);
    assert!((jeffreys(&ball(0.05), &ball(0.6)) - 15.125).abs() < 1e-9);
}
