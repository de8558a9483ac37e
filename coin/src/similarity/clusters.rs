//! Clusters of looks.

use super::{normalise, quick_cosine};

/// How often middles are moved. After a few times they hardly move any more.
const ROUNDS: usize = 8;

/// The middles of clusters by spherical k-means (Dhillon and Modha 2001): features of length 1, each the direction of the
/// sum of the looks that are more similar to it than to any other middle. The first `count` looks are where it begins, so
/// that they should come in a random order.
pub fn middles<L: AsRef<[f32]>>(looks: &[L], count: usize) -> Vec<Vec<f32>> {
    let mut middles: Vec<Vec<f32>> = looks.iter().take(count).map(|look| look.as_ref().to_vec()).collect();
    for _ in 0..ROUNDS {
        let mut sums: Vec<Vec<f32>> = middles.iter().map(|middle| vec![0.0; middle.len()]).collect();
        for look in looks {
            let look = look.as_ref();
            if let Some(nearest) = nearest(look, middles.iter().map(Vec::as_slice)) {
                sums[nearest].iter_mut().zip(look).for_each(|(sum, component)| *sum += component);
            }
        }
        for (middle, sum) in middles.iter_mut().zip(&sums) {
            // A middle that nothing is near to stays where it is.
            if let Some(moved) = normalise(sum) {
                *middle = moved;
            }
        }
    }
    middles
}

/// The place of the most similar one; the first of several.
pub fn nearest<'a>(look: &[f32], middles: impl IntoIterator<Item = &'a [f32]>) -> Option<usize> {
    let mut best: Option<(f32, usize)> = None;
    for (place, middle) in middles.into_iter().enumerate() {
        let similarity = quick_cosine(look, middle);
        if best.is_none_or(|(highest, _)| similarity > highest) {
            best = Some((similarity, place));
        }
    }
    best.map(|(_, place)| place)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn clusters_far_from_each_other_are_found() {
        // Three directions in the plane, each with a look 0.1 to either side: the middle is the direction itself.
        let angles = [0.0_f64, 2.0, 4.0];
        let at = |angle: f64| vec![libm::cos(angle) as f32, libm::sin(angle) as f32];
        let mut looks: Vec<Vec<f32>> = angles.map(|angle| at(angle - 0.1)).to_vec();
        looks.extend(angles.map(|angle| at(angle + 0.1)));
        let found = middles(&looks, 3);
        for (middle, angle) in found.iter().zip(angles) {
            assert!(quick_cosine(middle, &at(angle)) > 0.999_999, "{middle:?}");
        }
    }

    proptest! {
        #[test]
        fn middles_have_length_one_and_are_as_many_as_asked_for(
            features in proptest::collection::vec(proptest::collection::vec(-1.0..1.0_f32, 8), 1..40),
            count in 1..10_usize,
        ) {
            let looks: Vec<Vec<f32>> = features.iter().filter_map(|feature| normalise(feature)).collect();
            let found = middles(&looks, count);
            prop_assert_eq!(found.len(), count.min(looks.len()));
            for middle in found {
                prop_assert!((quick_cosine(&middle, &middle) - 1.0).abs() < 1e-5);
            }
        }
    }
}
