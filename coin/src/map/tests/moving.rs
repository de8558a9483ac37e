//! Things that are moved, and when it can be told.

use rstest::rstest;

use super::*;
use crate::map::{Change, Moved, PerhapsMoved};

/// Shows the cups at these places for some minutes, to a robot that sees everything.
fn show(map: &mut SemanticMap, minutes: std::ops::Range<i64>, places: &[f64]) {
    show_part(map, minutes, places, [-10.0, 10.0]);
}

fn show_part(map: &mut SemanticMap, minutes: std::ops::Range<i64>, places: &[f64], [from, to]: [f64; 2]) {
    for minute in minutes {
        map.observe(&covering(view(minute, places.iter().copied().map(red_cup).collect()), from, to));
    }
}

#[test]
fn a_thing_that_is_moved_keeps_its_id() {
    let mut map = map();
    show(&mut map, 0..3, &[0.0]);
    show(&mut map, 10..13, &[4.0]);
    assert_eq!(all_ids(&map), [0]);
    let moved =
        Moved { entry: EntryId(0), newcomer: EntryId(1), from: [0.0; 3], to: [4.0, 0.0, 0.0], at: clock(10) };
    assert_eq!(map.news().history, [Change::Moved(moved)]);
    assert_eq!((entry(&map, 0).place.position, entry(&map, 0).views()), ([4.0, 0.0, 0.0], 6));
    show(&mut map, 13..14, &[4.0, 0.0]);
    assert_eq!(all_ids(&map), [0, 2], "what stands at the old place now is something else");
}

#[test]
fn it_is_also_found_when_its_old_place_is_looked_at_afterwards() {
    let mut map = map();
    show_part(&mut map, 0..3, &[0.0], [-1.0, 1.0]);
    show_part(&mut map, 10..13, &[4.0], [3.0, 5.0]);
    assert_eq!(all_ids(&map), [0, 1], "the first may still be where it was");
    show_part(&mut map, 13..16, &[], [-1.0, 1.0]);
    assert_eq!(all_ids(&map), [0]);
}

#[rstest]
#[case::soon(60 * 24, vec![0, 1])]
#[case::after_three_weeks(60 * 24 * 21, vec![0])]
fn what_was_not_seen_for_long_may_have_moved(#[case] later: i64, #[case] expected: Vec<u64>) {
    let mut map = map();
    show_part(&mut map, 0..3, &[0.0], [-1.0, 1.0]);
    show_part(&mut map, later..later + 2, &[4.0], [3.0, 5.0]);
    assert_eq!(all_ids(&map), expected);
}

#[test]
fn without_a_look_or_with_another_one_nothing_moves() {
    let blue = |x: f64| looking(cup([x, 0.0, 0.0]), BLUE);
    let unknown = |x: f64| cup([x, 0.0, 0.0]);
    for (before, after) in [(red_cup(0.0), blue(4.0)), (unknown(0.0), unknown(4.0))] {
        let mut map = map();
        for minute in 0..8 {
            let seen = if minute < 4 { before.clone() } else { after.clone() };
            map.observe(&covering(view(minute, vec![seen]), -10.0, 10.0));
        }
        assert_eq!(all_ids(&map), [0, 1]);
    }
}

#[test]
fn one_view_is_no_move() {
    let mut map = map();
    show(&mut map, 0..3, &[0.0]);
    show(&mut map, 3..4, &[4.0]);
    show(&mut map, 4..8, &[]);
    assert_eq!(all_ids(&map), [0, 1]);
}

/// Mary's cup stands where it stood; so the one that was moved is Bob's. Before it has been seen there, either may be.
#[test]
fn of_two_equal_cups_the_one_that_moved_is_told_by_the_other() {
    let mut map = map();
    show(&mut map, 0..3, &[0.0, 8.0]);
    show_part(&mut map, 10..14, &[4.0], [-1.0, 5.0]);
    assert_eq!(all_ids(&map), [0, 1, 2]);
    let candidates = vec![EntryId(0), EntryId(1)];
    assert_eq!(map.perhaps_moved(), [PerhapsMoved { newcomer: EntryId(2), candidates }]);
    show_part(&mut map, 14..15, &[8.0], [6.0, 9.0]);
    assert_eq!(all_ids(&map), [0, 1]);
    assert_eq!(entry(&map, 0).place.position[0], 4.0);
    assert_eq!(map.perhaps_moved(), []);
}

#[test]
fn of_two_equal_cups_that_both_moved_nothing_is_guessed() {
    let mut map = map();
    show(&mut map, 0..3, &[0.0, 8.0]);
    show(&mut map, 10..20, &[3.0, 5.0]);
    assert_eq!(all_ids(&map), [0, 1, 2, 3]);
    let candidates = vec![EntryId(0), EntryId(1)];
    let either = |id: u64| PerhapsMoved { newcomer: EntryId(id), candidates: candidates.clone() };
    assert_eq!(map.perhaps_moved(), [either(2), either(3)]);
}

/// The limit: two equal cups that change places leave no trace. A feature that tells them apart does.
#[test]
fn a_swap_of_equal_cups_cannot_be_told_and_one_of_different_cups_can() {
    let mut map = map();
    show(&mut map, 0..3, &[0.0, 2.0]);
    show(&mut map, 3..9, &[2.0, 0.0]);
    assert_eq!(all_ids(&map), [0, 1]);
    assert_eq!(map.news().history, []);

    let mut map = super::map();
    let blue_cup = |x: f64| looking(cup([x, 0.0, 0.0]), BLUE);
    for minute in 0..9 {
        let [red, blue] = if minute < 3 { [0.0, 2.0] } else { [2.0, 0.0] };
        map.observe(&covering(view(minute, vec![red_cup(red), blue_cup(blue)]), -3.0, 3.0));
    }
    assert_eq!(all_ids(&map), [0, 1]);
    assert_eq!((entry(&map, 0).place.position[0], entry(&map, 1).place.position[0]), (2.0, 0.0));
}

/// One of two cups side by side is taken away: the other stays the other, however it shakes.
#[test]
fn the_twin_of_what_was_taken_away_stays_itself() {
    let mut map = map();
    show(&mut map, 0..5, &[0.0, 0.15]);
    show(&mut map, 10..14, &[0.15]);
    show(&mut map, 14..17, &[0.05, 4.0]);
    assert_eq!(all_ids(&map), [0, 1]);
    assert_eq!((entry(&map, 0).place.position[0], entry(&map, 1).views()), (4.0, 12));
}

/// Two views of one thing were too far apart; once it is known better, its parts are put together.
#[test]
fn fragments_of_a_thing_are_joined() {
    let mut map = map();
    show(&mut map, 0..1, &[-0.2]);
    show(&mut map, 1..2, &[0.11]);
    assert_eq!(all_ids(&map), [0, 1]);
    show(&mut map, 2..10, &[0.05]);
    assert_eq!(all_ids(&map), [0]);
    assert_eq!(map.news().history, [Change::Merged { entry: EntryId(0), other: EntryId(1) }]);
    assert_eq!(entry(&map, 0).views(), 10);
}
