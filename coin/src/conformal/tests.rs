//! Ranks and quantiles: exact at every size, which floating point is not.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::level;

/// The two inequalities that define ⌈x/1000⌉ = rank, in integers.
fn is_ceiling_of_thousandths(rank: usize, thousandths: usize) -> bool {
    1000 * rank >= thousandths && 1000 * rank < thousandths + 1000
}

#[test]
fn ranks_are_exact_for_every_size_and_every_thousandth() {
    for j in 1..1000 {
        let level = level(j as f64 / 1000.0);
        for samples in 0..=2000 {
            let upper = level.upper_rank(samples);
            assert!(
                is_ceiling_of_thousandths(upper, (samples + 1) * (1000 - j)),
                "N = {samples}, α = {j}/1000"
            );
            assert!((1..=samples + 1).contains(&upper));
            let lower = level.lower_rank(samples);
            let in_range = is_ceiling_of_thousandths(lower, (samples + 1) * j) && lower <= samples;
            let clamped = lower == samples.max(1) && (samples + 1) * j > 1000 * samples;
            assert!(in_range || clamped, "N = {samples}, α = {j}/1000");
            let losses = level.allowed_losses(samples);
            assert!(1000 * losses <= (samples + 1) * j && 1000 * (losses + 1) > (samples + 1) * j);
        }
    }
}

#[test]
fn the_least_samples_are_the_first_with_which_a_rank_exists() {
    for j in 1..1000 {
        let level = level(j as f64 / 1000.0);
        let least = (0..).find(|&samples| level.upper_rank(samples) <= samples).unwrap();
        assert_eq!(level.least_samples(), least, "α = {j}/1000");
        assert_eq!((0..).find(|&samples| level.allowed_losses(samples) >= 1), Some(least), "α = {j}/1000");
    }
}

/// The equation as it stands, in floating point.
fn rounded_up(samples: usize, alpha: f64) -> usize {
    ((samples + 1) as f64 * (1.0 - alpha)).ceil() as usize
}

/// The same with the confidence as the given number and the rank counted from above, as some libraries have it.
fn counted_from_above(samples: usize, alpha: f64) -> usize {
    let confidence = 1.0 - alpha;
    samples + 1 - ((1.0 - confidence) * (samples + 1) as f64) as usize
}

/// Why ranks are integers: one too many costs an interval its exactness, and N + 1 all its content.
#[rstest]
#[case::all_content_lost(counted_from_above, 9, 0.1, 10, 9)]
#[case::the_papers_level(counted_from_above, 9, 0.2, 9, 8)]
#[case(counted_from_above, 19, 0.1, 19, 18)]
#[case::the_papers_level(counted_from_above, 99, 0.2, 81, 80)]
#[case(rounded_up, 9, 0.7, 4, 3)]
#[case(rounded_up, 19, 0.95, 2, 1)]
#[case(rounded_up, 99, 0.82, 19, 18)]
fn floating_point_is_one_rank_off(
    #[case] floating: fn(usize, f64) -> usize,
    #[case] samples: usize,
    #[case] alpha: f64,
    #[case] wrong: usize,
    #[case] right: usize,
) {
    assert_eq!(floating(samples, alpha), wrong);
    assert_eq!(level(alpha).upper_rank(samples), right);
}

/// How many of the levels 1/1000 … 999/1000 floating point gets wrong; counted with Python's `fractions`.
#[rstest]
#[case(9, 1, 2)]
#[case(19, 3, 2)]
#[case(99, 22, 16)]
fn levels_that_floating_point_gets_wrong(#[case] samples: usize, #[case] up: usize, #[case] above: usize) {
    let wrong = |floating: fn(usize, f64) -> usize| {
        (1..1000)
            .map(|j| f64::from(j) / 1000.0)
            .filter(|&alpha| floating(samples, alpha) != level(alpha).upper_rank(samples))
            .count()
    };
    assert_eq!((wrong(rounded_up), wrong(counted_from_above)), (up, above));
}

/// The least N at which a level can exclude anything is 1/α − 1, and there the quantile is the largest score.
#[rstest]
#[case(0.2, 4)]
#[case(0.1, 9)]
#[case(0.05, 19)]
#[case(0.01, 99)]
#[case(0.012, 83)]
fn too_few_samples_begin_just_below_the_boundary(#[case] alpha: f64, #[case] least: usize) {
    let scores: Vec<f64> = (1..=least).map(|place| place as f64 / 1000.0).collect();
    assert_eq!(quantile(&scores, level(alpha).upper_rank(least)), Quantile::Value(least as f64 / 1000.0));
    let fewer = &scores[1..];
    assert_eq!(quantile(fewer, level(alpha).upper_rank(least - 1)), Quantile::TooFewSamples);
    assert_eq!(quantile(&[], level(alpha).upper_rank(0)), Quantile::TooFewSamples);
}

#[test]
fn too_few_samples_exclude_nothing() {
    assert_eq!(Quantile::TooFewSamples.threshold(), 1.0);
    assert_eq!(Quantile::Value(0.25).threshold(), 0.25);
}

proptest! {
    #[test]
    fn a_quantile_has_as_many_samples_at_or_below_it_as_its_rank(
        samples in proptest::collection::vec(prop_oneof![0.0..1.0_f64, Just(0.5)], 0..40),
        rank in 0..45_usize,
    ) {
        match quantile(&samples, rank) {
            Quantile::TooFewSamples => prop_assert!(rank == 0 || rank > samples.len()),
            Quantile::Value(value) => {
                prop_assert!(samples.contains(&value));
                prop_assert!(samples.iter().filter(|&&sample| sample <= value).count() >= rank);
                prop_assert!(samples.iter().filter(|&&sample| sample < value).count() < rank);
            }
        }
    }

    #[test]
    fn a_level_is_kept_to_the_millionth(millionths in 1..1_000_000_u32) {
        let value = f64::from(millionths) / 1e6;
        prop_assert_eq!(level(value).value(), value);
    }

    #[test]
    fn a_stricter_level_never_has_a_lower_rank(a in 1..1_000_000_u32, b in 1..1_000_000_u32, samples in 0..5000_usize) {
        let (small, large) = (level(f64::from(a.min(b)) / 1e6), level(f64::from(a.max(b)) / 1e6));
        prop_assert!(small.upper_rank(samples) >= large.upper_rank(samples));
        prop_assert!(small.lower_rank(samples) <= large.lower_rank(samples));
        prop_assert!(small.allowed_losses(samples) <= large.allowed_losses(samples));
    }
}

#[rstest]
#[case(0.0, "a level lies strictly between 0 and 1, and 0 does not")]
#[case(1.0, "a level lies strictly between 0 and 1, and 1 does not")]
#[case(-0.2, "a level lies strictly between 0 and 1, and -0.2 does not")]
#[case(f64::NAN, "a level lies strictly between 0 and 1, and NaN does not")]
#[case(f64::INFINITY, "a level lies strictly between 0 and 1, and inf does not")]
#[case(0.000_000_1, "a level is a whole number of millionths, and 0.0000001 is not")]
#[case(0.999_999_9, "a level is a whole number of millionths, and 0.9999999 is not")]
#[case(0.333_333_3, "a level is a whole number of millionths, and 0.3333333 is not")]
fn what_is_no_level_is_refused(#[case] given: f64, #[case] text: &str) {
    assert_eq!(Level::new(given).unwrap_err().to_string(), text);
}
