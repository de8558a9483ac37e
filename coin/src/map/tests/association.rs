//! Which detections join, and which do not.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::map::detection::Refusal;

#[test]
fn what_is_seen_again_joins_and_what_is_elsewhere_is_new() {
    let mut map = map();
    map.observe(&view(0, vec![cup([0.0; 3])]));
    let outcomes = map.observe(&view(1, vec![cup([0.06, 0.0, 0.0]), cup([1.0, 0.0, 0.0])])).outcomes;
    let Outcome::Joined { entry, divergence, sighting } = outcomes[0] else { panic!("{outcomes:?}") };
    assert_eq!((entry, sighting), (EntryId(0), SightingId(1)));
    // Of two Gaussians of one variance α r, it is |Δ|² / α r.
    assert!((divergence - 0.06 * 0.06 / (0.15 * CUP)).abs() < 1e-12, "{divergence}");
    assert_eq!(outcomes[1], Outcome::New { entry: EntryId(1), sighting: SightingId(2) });
}

/// Nine centimetres apart they touch, and one divergence alone would join them.
#[test]
fn two_equal_cups_side_by_side_stay_two() {
    let mut map = map();
    for minute in 0..20 {
        let shake = 0.02 * f64::from(minute as u8 % 3);
        map.observe(&view(minute, vec![red_cup(shake), red_cup(0.09 - shake)]));
    }
    assert_eq!(all_ids(&map), [0, 1]);
    assert_eq!((entry(&map, 0).views(), entry(&map, 1).views()), (20, 20));
}

/// Both detections are nearest to the first cup; only together can they be given out well.
#[rstest]
#[case([0.08, -0.02], [Some(1), Some(0)])]
#[case([-0.02, 0.08], [Some(0), Some(1)])]
fn a_view_is_assigned_as_a_whole(#[case] seen: [f64; 2], #[case] expected: [Option<u64>; 2]) {
    let mut map = map();
    map.observe(&view(0, vec![red_cup(0.0), red_cup(0.2)]));
    let outcomes = map.observe(&view(1, seen.map(red_cup).to_vec())).outcomes;
    assert_eq!(ids(&outcomes), expected);
}

#[test]
fn height_separates_what_stands_on_a_shelf() {
    let mut map = map();
    map.observe(&view(0, vec![cup([0.0, 0.0, 0.4])]));
    map.observe(&view(1, vec![cup([0.0, 0.0, 0.75])]));
    assert_eq!(all_ids(&map), [0, 1]);
}

#[test]
fn a_small_thing_does_not_vanish_in_a_large_one() {
    let mut map = map();
    let table = Detection { radius: 0.6, ..cup([0.0; 3]) };
    map.observe(&view(0, vec![table]));
    assert_eq!(ids(&map.observe(&view(1, vec![cup([0.0; 3])])).outcomes), [Some(1)]);
}

#[rstest]
#[case::another_look_of_the_class("cup", Some(BLUE), 1)]
#[case::the_look_under_another_class("mug", Some(RED), 0)]
#[case::the_class_alone("cup", None, 0)]
#[case::another_class_alone("mug", None, 1)]
fn appearance_decides_where_it_is_known_and_else_the_class(
    #[case] name: &str,
    #[case] feature: Option<[f32; 4]>,
    #[case] expected: u64,
) {
    let mut map = map();
    map.observe(&view(0, vec![red_cup(0.0)]));
    let seen = Detection { class: class(name), feature: feature.map(Vec::from), ..cup([0.02, 0.0, 0.0]) };
    assert_eq!(ids(&map.observe(&view(1, vec![seen])).outcomes), [Some(expected)]);
}

#[test]
fn bad_detections_are_refused_one_by_one_and_the_rest_is_kept() {
    let good = red_cup(0.0);
    let bad = |change: fn(&mut Detection)| {
        let mut detection = red_cup(1.0);
        change(&mut detection);
        detection
    };
    let mut seen = view(
        3,
        vec![
            bad(|detection| detection.position[1] = f64::NAN),
            good.clone(),
            bad(|detection| detection.radius = -0.1),
            bad(|detection| detection.radius = f64::NAN),
            bad(|detection| detection.radius = 5e-324),
            bad(|detection| detection.feature = Some(vec![0.0; 4])),
            bad(|detection| detection.feature = Some(vec![f32::NAN; 4])),
            bad(|detection| detection.feature = Some(vec![1.0; 3])),
            good.clone(),
            bad(|_| {}),
        ],
    );
    seen.detections[9].at = clock(4);
    let outcomes = map().observe(&seen).outcomes;
    let Outcome::Refused(Refusal::Position { given }) = &outcomes[0] else { panic!("{:?}", outcomes[0]) };
    assert!(given[1].is_nan());
    assert_eq!(outcomes[1], Outcome::New { entry: EntryId(0), sighting: SightingId(0) });
    assert_eq!(outcomes[2], Outcome::Refused(Refusal::Radius { given: -0.1 }));
    assert!(matches!(outcomes[3], Outcome::Refused(Refusal::Radius { .. })));
    assert!(matches!(outcomes[4], Outcome::Refused(Refusal::Radius { .. })));
    assert_eq!(outcomes[5], Outcome::Refused(Refusal::Feature));
    assert_eq!(outcomes[6], Outcome::Refused(Refusal::Feature));
    assert_eq!(outcomes[7], Outcome::Refused(Refusal::Dimension { given: 3, expected: 4 }));
    assert_eq!(outcomes[8], Outcome::Repeated { entry: EntryId(0) });
    assert_eq!(outcomes[9], Outcome::Refused(Refusal::Future { at: clock(4), taken_at: clock(3) }));
}

#[test]
fn a_view_that_comes_twice_changes_nothing() {
    let mut map = map();
    map.observe(&view(0, vec![cup([5.0, 0.0, 0.0])]));
    let seen = covering(view(1, vec![red_cup(0.0), red_cup(0.1)]), -1.0, 6.0);
    map.observe(&seen);
    let before = map.clone();
    let outcomes = map.observe(&seen).outcomes;
    assert_eq!(outcomes, [1, 2].map(|id| Outcome::Repeated { entry: EntryId(id) }));
    assert_eq!(map, before);
}

#[test]
fn the_rest_of_a_view_that_comes_later_is_of_other_things() {
    let mut map = map();
    map.observe(&view(0, vec![red_cup(0.0)]));
    assert_eq!(ids(&map.observe(&view(0, vec![red_cup(0.05)])).outcomes), [Some(1)]);
}

fn any_view() -> impl Strategy<Value = Vec<Detection>> {
    let detection = ([-0.4..0.4_f64, -0.4..0.4, -0.1..0.1], 0.02..0.2_f64, 0..3_usize, 0..2_usize).prop_map(
        |(position, radius, feature, name)| Detection {
            class: class(["cup", "mug"][name]),
            radius,
            feature: [None, Some(RED.to_vec()), Some(BLUE.to_vec())][feature].clone(),
            ..cup(position)
        },
    );
    proptest::collection::vec(detection, 0..6)
}

proptest! {
    /// However crowded it is: no entry has two detections of one view, every detection is in one entry, and the indexes
    /// are those that a map made from the same state has.
    #[test]
    fn no_entry_has_two_detections_of_a_view(views in proptest::collection::vec(any_view(), 1..12)) {
        let mut map = map();
        let mut taken = 0;
        for (minute, detections) in views.into_iter().enumerate() {
            taken += detections.len();
            let seen = covering(view(minute as i64, detections), -0.5, 0.5);
            let mut entries = ids(&map.observe(&seen).outcomes);
            entries.sort_unstable();
            prop_assert!(entries.windows(2).all(|pair| pair[0] < pair[1]));
        }
        for entry in map.state().entries.values() {
            let views: BTreeSet<_> = entry.sightings.values().map(|sighting| &sighting.view).collect();
            prop_assert_eq!(views.len(), entry.views());
            for id in views.into_iter().flatten() {
                prop_assert!(map.state().views[id].contains(&entry.id));
            }
        }
        prop_assert_eq!(map.state().entries.values().map(Entry::views).sum::<usize>(), taken);
        let again = SemanticMap::new(map.state().clone(), *map.parameters());
        prop_assert_eq!(&again.grid, &map.grid);
    }
}

#[test]
fn another_spelling_of_the_class_names_the_same_thing() {
    let mut map = map();
    let mut seen = |minute, name| {
        let detection = Detection { class: class(name), ..cup([0.0; 3]) };
        ids(&map.observe(&view(minute, vec![detection])).outcomes)
    };
    for (minute, name) in [(0, "coffee mug"), (1, "Coffee Mug"), (2, "coffee_mug")] {
        assert_eq!(seen(minute, name), [Some(0)], "{name}");
    }
    assert_eq!(seen(3, "coffee cup"), [Some(1)]);
}
