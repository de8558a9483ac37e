//! How much things look like what a request describes, on the scale of label matches.
//!
//! Features of words and of pictures lie in one space, but a cosine in it means little by itself: with one encoder the
//! right thing has 0.3 and any other 0.2, with another 0.15 and 0.02. What counts is how far a thing stands out from the
//! rest of the home, and whether chance would not make some thing stand out as far. That is measured by the false
//! discovery rate, which is the same if all cosines are shifted or stretched:
//!
//! * The rest is described by the median of the cosines and by the root-mean-square distance from it of those below it,
//!   which is the standard deviation of a normal distribution. Things that stand out above hardly move either of them.
//! * Of n things that have nothing to do with the request, n · (1 − Φ(z)) are expected to stand out by z or more. Divided
//!   by how many things really do, this is the share of them that chance alone explains (Benjamini and Hochberg 1995; Efron
//!   2004). It is at most 1, and no larger for a thing that stands out more.
//! * A share F becomes the likeness α / (α + F) with α = [`TOLERATED`].

use coin_schemas::household::Score;

/// The share of chance finds at which a thing looks half like what is described. A thing reaches
/// [`LEAST_MATCH`](super::LEAST_MATCH) where chance explains at most one find in sixty. In a home of few things the rest
/// is known less exactly, so that chance fools this in about one home of fifteen.
const TOLERATED: f64 = 0.025;

/// So many things have to be compared before one can stand out from the rest.
pub const LEAST_COMPARED: usize = 8;

/// The likeness of every thing from the cosine of its feature with the request's; `None` where there is no cosine, and
/// everywhere if fewer than [`LEAST_COMPARED`] things have one or if none of these is below the median.
pub fn likenesses(cosines: &[Option<f64>]) -> Vec<Option<Score>> {
    let nothing = || vec![None; cosines.len()];
    let mut known: Vec<(usize, f64)> =
        cosines.iter().enumerate().filter_map(|(place, cosine)| Some((place, (*cosine)?))).collect();
    if known.len() < LEAST_COMPARED {
        return nothing();
    }
    known.sort_by(|left, right| right.1.total_cmp(&left.1));
    let half = known.len() / 2;
    let middle = match known.len() % 2 {
        1 => known[half].1,
        _ => 0.5 * (known[half - 1].1 + known[half].1),
    };
    let below = &known[known.len() - half..];
    let spread =
        (below.iter().map(|&(_, cosine)| (middle - cosine).powi(2)).sum::<f64>() / half as f64).sqrt();
    if spread <= 0.0 {
        return nothing();
    }
    let count = known.len() as f64;
    let mut likenesses = nothing();
    // From the least to the most alike, so that whoever stands out more is explained by chance no better.
    let mut share: f64 = 1.0;
    for (rank, &(place, cosine)) in known.iter().enumerate().rev() {
        let by_chance =
            count * 0.5 * libm::erfc((cosine - middle) / spread * std::f64::consts::FRAC_1_SQRT_2);
        share = share.min(by_chance / (rank + 1) as f64);
        likenesses[place] = Score::new(TOLERATED / (TOLERATED + share)).ok();
    }
    likenesses
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rstest::rstest;

    use super::super::LEAST_MATCH;
    use super::*;

    /// Cosines of unrelated things: normal, as sums of twelve even ones are.
    fn unrelated(generator: &mut ChaCha8Rng, count: usize, mean: f64, deviation: f64) -> Vec<Option<f64>> {
        (0..count)
            .map(|_| {
                let normal = (0..12).map(|_| generator.random::<f64>()).sum::<f64>() - 6.0;
                Some(mean + deviation * normal)
            })
            .collect()
    }

    fn matching(cosines: &[Option<f64>]) -> Vec<usize> {
        let likenesses = likenesses(cosines);
        (0..cosines.len())
            .filter(|&place| likenesses[place].is_some_and(|likeness| likeness.value() >= LEAST_MATCH))
            .collect()
    }

    /// Means and deviations as encoders have them: CLIP's 0.18 ± 0.025, and one whose cosines lie about nothing.
    #[rstest]
    #[case(34, 0.18, 0.025)]
    #[case(34, 0.0, 0.1)]
    #[case(300, 0.18, 0.025)]
    #[case(3_000, -0.05, 0.01)]
    fn chance_makes_a_match_in_one_home_of_ten_at_most(
        #[case] things: usize,
        #[case] mean: f64,
        #[case] deviation: f64,
    ) {
        let mut generator = ChaCha8Rng::seed_from_u64(7);
        let homes = 200;
        let fooled = (0..homes)
            .filter(|_| !matching(&unrelated(&mut generator, things, mean, deviation)).is_empty())
            .count();
        assert!(fooled * 10 <= homes, "{fooled} of {homes}");
    }

    #[rstest]
    #[case::one(34, 1, 5.0)]
    #[case::some(34, 5, 5.0)]
    #[case::one_of_many(3_000, 1, 6.0)]
    #[case::many_of_many(3_000, 60, 5.0)]
    fn what_stands_out_matches(#[case] things: usize, #[case] meant: usize, #[case] deviations: f64) {
        let mut generator = ChaCha8Rng::seed_from_u64(11);
        let mut cosines = unrelated(&mut generator, things - meant, 0.18, 0.025);
        cosines.extend(vec![Some(0.18 + 0.025 * deviations); meant]);
        let found = matching(&cosines);
        let right = found.iter().filter(|&&place| place >= things - meant).count();
        assert_eq!(right, meant);
        assert!(found.len() - right <= 1 + meant / 10, "{} besides", found.len() - right);
    }

    #[test]
    fn few_or_equal_cosines_say_nothing() {
        assert!(likenesses(&[Some(0.9), Some(0.1), None]).iter().all(Option::is_none));
        assert!(likenesses(&[Some(0.2); 20]).iter().all(Option::is_none));
    }

    proptest! {
        #[test]
        fn the_scale_of_an_encoder_means_nothing(
            cosines in proptest::collection::vec(proptest::option::of(-1.0..1.0), 0..60),
            shift in -0.5..0.5,
            stretch in 0.01..0.9,
        ) {
            let moved: Vec<Option<f64>> =
                cosines.iter().map(|cosine| cosine.map(|cosine| shift + stretch * cosine)).collect();
            for (one, other) in likenesses(&cosines).into_iter().zip(likenesses(&moved)) {
                let difference = one.map_or(2.0, Score::value) - other.map_or(2.0, Score::value);
                prop_assert!(difference.abs() < 1e-6);
            }
        }

        #[test]
        fn what_looks_more_alike_is_no_less_alike(
            cosines in proptest::collection::vec(-1.0..1.0_f64, 8..60),
        ) {
            let likenesses = likenesses(&cosines.iter().copied().map(Some).collect::<Vec<_>>());
            for (one, left) in cosines.iter().zip(&likenesses) {
                for (other, right) in cosines.iter().zip(&likenesses) {
                    if let (Some(left), Some(right)) = (left, right) && one <= other {
                        prop_assert!(left.value() <= right.value());
                    }
                }
            }
        }
    }
}
