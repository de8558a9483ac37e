//! The assignment against every assignment there is.

use proptest::prelude::*;

use super::*;

/// The least sum by trying everything.
fn by_brute_force(costs: &[Vec<f64>], alone: f64, taken: &mut Vec<usize>) -> f64 {
    let Some((row, rest)) = costs.split_first() else { return 0.0 };
    let mut best = alone + by_brute_force(rest, alone, taken);
    for (column, &cost) in row.iter().enumerate() {
        if !taken.contains(&column) {
            taken.push(column);
            best = best.min(cost + by_brute_force(rest, alone, taken));
            taken.pop();
        }
    }
    best
}

fn total(costs: &[Vec<f64>], alone: f64, columns: &[Option<usize>]) -> f64 {
    costs.iter().zip(columns).map(|(row, column)| column.map_or(alone, |column| row[column])).sum()
}

fn any_costs() -> impl Strategy<Value = Vec<Vec<f64>>> {
    let cost = prop_oneof![4 => -5.0..20.0_f64, 1 => Just(f64::INFINITY)];
    (0..6_usize, 0..6_usize).prop_flat_map(move |(rows, columns)| {
        proptest::collection::vec(proptest::collection::vec(cost.clone(), columns), rows)
    })
}

proptest! {
    #[test]
    fn is_as_cheap_as_the_best_of_all(costs in any_costs(), alone in -2.0..15.0_f64) {
        let columns = least_cost(&costs, alone);
        prop_assert_eq!(columns.len(), costs.len());
        let mut used: Vec<usize> = columns.iter().flatten().copied().collect();
        used.sort_unstable();
        prop_assert!(used.windows(2).all(|pair| pair[0] < pair[1]), "no column twice");
        let best = by_brute_force(&costs, alone, &mut Vec::new());
        prop_assert!((total(&costs, alone, &columns) - best).abs() < 1e-9);
    }
}

/// Taking the cheapest pair first would cost 1 + 100; together 2 + 3 is better.
#[test]
fn the_cheapest_pair_may_have_to_wait() {
    assert_eq!(least_cost(&[vec![1.0, 2.0], vec![3.0, 100.0]], 1000.0), [Some(1), Some(0)]);
}

#[test]
fn what_costs_more_than_being_alone_is_left() {
    assert_eq!(least_cost(&[vec![9.0], vec![f64::INFINITY]], 4.0), [None, None]);
    assert_eq!(least_cost(&[], 4.0), []);
}
