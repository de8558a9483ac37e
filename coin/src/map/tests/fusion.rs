//! What an entry is made of its sightings, and that their order does not matter.

use proptest::prelude::*;

use super::*;
use crate::map::detection::Sighting;
use crate::similarity::normalise;

/// Rounding of sums of a few dozen numbers of the size of a home.
const ROUNDING: f64 = 1e-9;

fn any_home() -> impl Strategy<Value = Vec<View>> {
    // Six equal cups 80 cm apart; every view sees some of them, each up to 5 cm off on every axis.
    let seen = proptest::option::weighted(
        0.7,
        ([-0.05..0.05_f64, -0.05..0.05, -0.05..0.05], 0.03..0.06_f64, -0.3..0.3_f32),
    );
    let one = proptest::collection::vec(seen, 6);
    proptest::collection::vec(one, 1..12).prop_map(|views| {
        let detection = |(place, seen): (usize, Option<([f64; 3], f64, f32)>)| {
            seen.map(|([x, y, z], radius, shade)| Detection {
                radius,
                ..looking(cup([0.8 * place as f64 + x, y, z]), [1.0, shade, 0.0, 0.0])
            })
        };
        let of_view = |seen: Vec<_>| seen.into_iter().enumerate().filter_map(detection).collect();
        views.into_iter().enumerate().map(|(minute, seen)| view(minute as i64, of_view(seen))).collect()
    })
}

type MadeOf = Vec<(ViewId, [f64; 3])>;

/// The entries, each with the views and places that it was made from, in the order of their places.
fn partition(map: &SemanticMap) -> Vec<(MadeOf, &Entry)> {
    let mut parts: Vec<_> = map
        .state()
        .entries
        .values()
        .map(|entry| {
            let mut made_of: Vec<_> = entry
                .sightings
                .values()
                .map(|sighting| (sighting.view.clone().unwrap(), sighting.position.metres()))
                .collect();
            made_of.sort_by(|left, right| left.0.cmp(&right.0));
            (made_of, entry)
        })
        .collect();
    parts.sort_by(|left, right| left.1.place.position[0].total_cmp(&right.1.place.position[0]));
    parts
}

/// What was detected in the view of a sighting at its place, at length 1.
fn look_of(views: &[View], sighting: &Sighting) -> Vec<f32> {
    let view = views.iter().find(|view| view.id == sighting.view).unwrap();
    let at_place = |detection: &&Detection| detection.position == sighting.position.metres();
    normalise(view.detections.iter().find(at_place).unwrap().feature.as_ref().unwrap()).unwrap()
}

proptest! {
    /// Where look-alikes are further apart than the largest divergence reaches, any order of views and of detections in
    /// them gives the same entries, at the same places within 1 nm and with the same look.
    #[test]
    fn order_of_arrival_does_not_matter(
        (views, shuffled) in any_home().prop_flat_map(|views| (Just(views.clone()), Just(views).prop_shuffle())),
    ) {
        let (mut one, mut other) = (map(), map());
        for view in &views {
            one.observe(view);
        }
        for view in shuffled {
            let detections = view.detections.iter().rev().cloned().collect();
            other.observe(&View { detections, ..view });
        }
        let (one, other) = (partition(&one), partition(&other));
        prop_assert_eq!(one.len(), other.len());
        for ((made_of, entry), (also_made_of, same)) in one.iter().zip(&other) {
            prop_assert_eq!(made_of, also_made_of);
            for axis in 0..3 {
                prop_assert!((entry.place.position[axis] - same.place.position[axis]).abs() < ROUNDING);
            }
            prop_assert!((entry.place.radius() - same.place.radius()).abs() < ROUNDING);
            prop_assert_eq!((&entry.classes, entry.first_seen, entry.last_seen), (&same.classes, same.first_seen, same.last_seen));
            let (look, same_look) = (entry.look.as_ref().unwrap(), same.look.as_ref().unwrap());
            prop_assert!((look.cosine_with(same_look) - 1.0).abs() < ROUNDING);
        }
    }

    /// The entry is the precision-weighted mean, the harmonic mean of the radii, and the normalised weighted mean of the
    /// features, computed at once and not step by step.
    #[test]
    fn an_entry_is_the_weighted_mean_of_its_sightings(views in any_home()) {
        let mut map = map();
        for view in &views {
            map.observe(view);
        }
        for entry in map.state().entries.values() {
            let weights: f64 = entry.sightings.values().map(|sighting| 1.0 / sighting.radius).sum();
            for axis in 0..3 {
                let sum: f64 = entry.sightings.values().map(|s| s.position.metres()[axis] / s.radius).sum();
                prop_assert!((entry.place.position[axis] - sum / weights).abs() < ROUNDING);
            }
            prop_assert!((entry.place.radius() - entry.views() as f64 / weights).abs() < ROUNDING);
            let features: Vec<(Vec<f32>, f64)> =
                entry.sightings.values().map(|sighting| (look_of(&views, sighting), sighting.radius)).collect();
            let mean: Vec<f64> = (0..4)
                .map(|axis| features.iter().map(|(feature, radius)| f64::from(feature[axis]) / radius).sum())
                .collect();
            let length = mean.iter().map(|component| component * component).sum::<f64>().sqrt();
            for (component, fused) in mean.iter().zip(entry.look.as_ref().unwrap().feature().unwrap()) {
                prop_assert!((component / length - f64::from(fused)).abs() < 1e-6);
            }
        }
    }
}

/// Of all Gaussians, the entry's has the least sum of KL(G ‖ G_i); a search finds none better.
#[test]
fn the_entry_is_nearest_to_its_sightings() {
    use crate::map::gaussian::{Gaussian, kl};
    let mut map = map();
    for (minute, (x, radius)) in [(0.0, 0.03), (0.05, 0.06), (0.02, 0.045)].into_iter().enumerate() {
        map.observe(&view(minute as i64, vec![Detection { radius, ..cup([x, 0.0, 0.0]) }]));
    }
    let entry = entry(&map, 0);
    let parts: Vec<Gaussian> = entry
        .sightings
        .values()
        .map(|sighting| Gaussian { mean: sighting.position.metres(), variance: 0.15 * sighting.radius })
        .collect();
    let total = |gaussian: &Gaussian| parts.iter().map(|part| kl(gaussian, part)).sum::<f64>();
    let own = entry.place.gaussian(0.15);
    for (shift, factor) in [(0.001, 1.0), (-0.001, 1.0), (0.0, 1.01), (0.0, 0.99), (0.003, 1.02)] {
        let [x, y, z] = own.mean;
        let other = Gaussian { mean: [x + shift, y, z], variance: own.variance * factor };
        assert!(total(&own) < total(&other));
    }
}
