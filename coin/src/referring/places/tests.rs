//! Heights, and the search among many places.

use coin_schemas::household::Position;
use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::id;

fn mapped(id: &coin_schemas::household::ObjectId, position: [f64; 3]) -> MappedThing<'_> {
    MappedThing { id, class: "thing", room: None, position: Position::new(position).unwrap(), likeness: None }
}

/// A thing so much higher than another at the same place of the floor plan.
#[rstest]
#[case::on_a_table_that_is_mapped_by_its_middle(Relation::Above, 0.4, 1.0)]
#[case::on_a_desk_that_is_mapped_by_its_top(Relation::Above, 0.04, 1.0)]
#[case::a_little_too_low(Relation::Above, -0.1, 0.606_530_659_712_633_4)]
#[case::under_it(Relation::Above, -0.3, 0.011_108_996_538_242_306)]
#[case::under_a_table(Relation::Below, -0.25, 1.0)]
#[case::as_high(Relation::Below, 0.0, 0.606_530_659_712_633_4)]
#[case::on_it(Relation::Below, 0.2, 0.011_108_996_538_242_306)]
fn heights_tell_on_from_under(#[case] relation: Relation, #[case] higher: f64, #[case] expected: f64) {
    let (thing, anchor) = (id("1"), id("2"));
    let fit =
        relation_fit(relation, &mapped(&thing, [0.0, 0.0, 1.0 + higher]), &mapped(&anchor, [0.0, 0.0, 1.0]));
    assert!((fit - expected).abs() < 1e-12, "{fit}");
}

proptest! {
    #[test]
    fn the_nearest_of_many_is_found(
        positions in proptest::collection::vec([-9.0..9.0, -9.0..9.0, 0.0..2.0], 2..30),
        relation in proptest::sample::select(vec![Relation::Near, Relation::Above, Relation::Below]),
    ) {
        let ids: Vec<_> = (0..positions.len()).map(|place| id(&place.to_string())).collect();
        let things: Vec<MappedThing<'_>> = ids.iter().zip(positions).map(|(id, position)| mapped(id, position)).collect();
        let anchors: Vec<usize> = (1..things.len()).collect();
        let place = Place::beside(&things, relation, anchors.clone());
        for thing in 0..things.len() {
            let every = anchors
                .iter()
                .filter(|&&anchor| anchor != thing)
                .map(|&anchor| relation_fit(relation, &things[thing], &things[anchor]))
                .fold(0.0, f64::max);
            // What is too far away to count may be left out.
            prop_assert!((place.fit(&things, thing) - every).abs() < 4e-4);
        }
    }
}
