//! Laws of distance, weight and neighbourhood.

use proptest::prelude::*;
use rstest::rstest;

use super::*;

fn at(metres: [f64; 3]) -> Position {
    Position::new(metres).unwrap()
}

fn any_position() -> impl Strategy<Value = Position> {
    [-50.0..50.0_f64, -50.0..50.0, -5.0..5.0].prop_map(at)
}

const ROUNDING: f64 = 1e-9;

proptest! {
    #[test]
    fn distance_is_a_metric(a in any_position(), b in any_position(), c in any_position(), gamma in 0.1..4.0_f64) {
        prop_assert_eq!(distance(a, a, gamma), 0.0);
        prop_assert!(distance(a, b, gamma) >= 0.0);
        prop_assert_eq!(distance(a, b, gamma) > 0.0, a != b);
        prop_assert_eq!(distance(a, b, gamma), distance(b, a, gamma));
        prop_assert!(distance(a, c, gamma) <= distance(a, b, gamma) + distance(b, c, gamma) + ROUNDING);
    }

    #[test]
    fn distance_is_the_papers_square_root(a in any_position(), b in any_position(), gamma in 0.0..4.0_f64) {
        let ([x, y, z], [u, v, w]) = (a.metres(), b.metres());
        let squares = (u - x).powi(2) + (v - y).powi(2) + (gamma * (w - z)).powi(2);
        prop_assert!((distance(a, b, gamma) - squares.sqrt()).abs() < ROUNDING);
    }

    #[test]
    fn nothing_beyond_the_radius_has_the_least_weight(
        sigma in 0.001..1000.0_f64,
        exponent in 0.0..744.0_f64,
        beyond in 1.0..2.0_f64,
    ) {
        let reach = Neighbourhood { sigma, min_weight: libm::exp(-exponent), ..Neighbourhood::default() };
        prop_assert!(weight(reach.radius() * beyond, sigma) < reach.min_weight);
        // It is no more than a hundredth too large, but for weights next to 1.
        prop_assert!(exponent < 1e-4 || weight(reach.radius() / 1.01, sigma) >= reach.min_weight);
    }

    #[test]
    fn gamma_scales_height_alone(a in any_position(), height in -5.0..5.0_f64, gamma in 0.0..4.0_f64) {
        let [x, y, z] = a.metres();
        prop_assert!((distance(a, at([x, y, z + height]), gamma) - gamma * height.abs()).abs() < ROUNDING);
        prop_assert!((distance(a, at([x + height, y, z]), gamma) - height.abs()).abs() < ROUNDING);
    }

    #[test]
    fn weight_falls_with_distance_and_grows_with_reach(d in 0.0..3.0_f64, more in 0.001..1.0_f64, sigma in 0.2..2.0_f64) {
        prop_assert!((0.0..=1.0).contains(&weight(d, sigma)));
        prop_assert!(weight(d + more, sigma) < weight(d, sigma));
        prop_assert!(weight(d, sigma + more) >= weight(d, sigma));
    }

    #[test]
    fn neighbours_are_the_best_of_a_full_ranking(
        target in any_position(),
        others in proptest::collection::vec([-1.5..1.5_f64, -1.5..1.5, -1.0..1.0], 0..30),
        k in 0..8_usize,
    ) {
        let [x, y, z] = target.metres();
        let others: Vec<(usize, Position)> =
            others.iter().map(|[u, v, w]| at([x + u, y + v, z + w])).enumerate().collect();
        let reach = Neighbourhood { k, ..Neighbourhood::default() };
        let near = neighbours(target, others.iter().copied(), &reach);
        let eligible =
            others.iter().filter(|(_, position)| weight(distance(target, *position, 1.0), 0.5) >= 0.01).count();
        prop_assert_eq!(near.len(), k.min(eligible));
        prop_assert!(near.is_sorted_by(|left, right| left.weight >= right.weight));
        let farthest = near.last().map_or(0.0, |last| last.distance);
        for (item, position) in others {
            let distance = distance(target, position, 1.0);
            let chosen = near.iter().find(|near| near.item == item);
            prop_assert!(chosen.is_some() || near.len() < k || distance >= farthest);
            prop_assert!(chosen.is_none_or(|near| near.distance == distance && near.weight == weight(distance, 0.5)));
        }
    }

    #[test]
    fn the_order_of_the_others_does_not_matter(
        others in Just((0..12_u32).collect::<Vec<_>>()).prop_shuffle(),
    ) {
        let place = |item: u32| at([f64::from(item / 2) * 0.1, 0.0, 0.0]);
        let near = neighbours(at([0.0; 3]), others.into_iter().map(|item| (item, place(item))), &Neighbourhood::default());
        prop_assert_eq!(near.iter().map(|near| near.item).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    }
}

#[test]
fn the_defaults_are_the_papers() {
    let expected = Neighbourhood { k: 5, sigma: 0.5, gamma: 1.0, min_weight: 0.01 };
    assert_eq!(Neighbourhood::default(), expected);
}

/// exp(−d²/2σ²), to twelve digits with Python's `math.exp(-d*d/(2*sigma*sigma))`.
#[rstest]
#[case(0.0, 0.5, 1.0)]
#[case(0.25, 0.5, 0.882496902585)]
#[case(0.5, 0.5, 0.606530659713)]
#[case(1.0, 0.5, 0.135335283237)]
#[case(1.5, 0.5, 0.011108996538)]
#[case(1.6, 0.5, 0.005976022895)]
#[case(1.0, 1.0, 0.606530659713)]
#[case(2.3, 1.7, 0.400426554626)]
fn weight_has_the_values_of_the_formula(#[case] d: f64, #[case] sigma: f64, #[case] expected: f64) {
    assert!((weight(d, sigma) - expected).abs() < 1e-12);
}

/// A weight of exactly the least one stays; the next smaller goes.
#[test]
fn only_smaller_weights_are_discarded() {
    let distance = 0.75;
    let kept = Neighbourhood { min_weight: weight(distance, 0.5), ..Neighbourhood::default() };
    let thing = || [("cup", at([distance, 0.0, 0.0]))];
    assert_eq!(neighbours(at([0.0; 3]), thing(), &kept).len(), 1);
    let discarded = Neighbourhood { min_weight: kept.min_weight.next_up(), ..kept };
    assert_eq!(neighbours(at([0.0; 3]), thing(), &discarded).len(), 0);
}

/// Far away every weight is 0 and says nothing about the order any more.
#[test]
fn equal_weights_go_by_distance_then_by_item() {
    let everything = Neighbourhood { min_weight: 0.0, ..Neighbourhood::default() };
    let things = [(3, [90.0, 0.0, 0.0]), (2, [80.0, 0.0, 0.0]), (9, [0.0, 70.0, 0.0]), (4, [70.0, 0.0, 0.0])];
    let near = neighbours(at([0.0; 3]), things.map(|(item, metres)| (item, at(metres))), &everything);
    assert!(near.iter().all(|near| near.weight == 0.0));
    assert_eq!(near.iter().map(|near| near.item).collect::<Vec<_>>(), [4, 9, 2, 3]);
}
