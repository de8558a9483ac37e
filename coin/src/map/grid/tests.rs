//! The grid against looking at everything.

use proptest::prelude::*;
use rstest::rstest;

use super::*;

fn any_place() -> impl Strategy<Value = [f64; 3]> {
    [-4.0..4.0_f64, -4.0..4.0, -1.0..2.0].prop_map(Into::into)
}

fn holds(least: [f64; 3], greatest: [f64; 3], at: [f64; 3]) -> bool {
    (0..3).all(|axis| least[axis] <= at[axis] && at[axis] <= greatest[axis])
}

proptest! {
    #[test]
    fn nothing_in_the_box_is_overlooked(
        places in proptest::collection::vec(any_place(), 0..40),
        middle in any_place(),
        reach in 0.0..6.0_f64,
    ) {
        let mut grid = Grid::default();
        for (number, &at) in places.iter().enumerate() {
            grid.insert(EntryId(number as u64), at);
        }
        let (least, greatest) = (middle.map(|m| m - reach), middle.map(|m| m + reach));
        let found: BTreeSet<EntryId> = grid.around(least, greatest).into_iter().collect();
        let wider = (least.map(|m| m - CELL), greatest.map(|m| m + CELL));
        for (number, &at) in places.iter().enumerate() {
            let is_found = found.contains(&EntryId(number as u64));
            prop_assert!(is_found || !holds(least, greatest, at), "overlooked {at:?}");
            prop_assert!(!is_found || holds(wider.0, wider.1, at), "{at:?} is far away");
        }
        for (number, &at) in places.iter().enumerate() {
            grid.remove(EntryId(number as u64), at);
        }
        prop_assert_eq!(grid, Grid::default());
    }
}

#[rstest]
#[case::endless([f64::NEG_INFINITY; 3], [f64::INFINITY; 3], 2)]
#[case::huge([-1e300; 3], [1e300; 3], 2)]
#[case::inside_out([1.0; 3], [-1.0; 3], 0)]
fn a_box_without_sense_takes_no_time(
    #[case] least: [f64; 3],
    #[case] greatest: [f64; 3],
    #[case] found: usize,
) {
    let mut grid = Grid::default();
    grid.insert(EntryId(1), [0.1; 3]);
    grid.insert(EntryId(2), [1e299; 3]);
    assert_eq!(grid.around(least, greatest).len(), found);
}
