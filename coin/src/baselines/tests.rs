//! The two heuristics.

use rstest::rstest;

use super::{frequency, last_user};
use crate::captions::Action;
use crate::support::{set, user};
use crate::usage::UsageEvent;

fn events(seen: &[(i64, Option<usize>)]) -> Vec<UsageEvent> {
    seen.iter()
        .map(|&(at_seconds, actor)| UsageEvent { at_seconds, actor: actor.map(user), action: Action::Use })
        .collect()
}

#[rstest]
#[case::the_latest(&[(1, Some(0)), (3, Some(1)), (2, Some(2))], &[1])]
#[case::of_one_moment_the_later_in_the_list(&[(1, Some(2)), (1, Some(0))], &[0])]
#[case::nobody_is_passed_over(&[(1, Some(2)), (5, None)], &[2])]
#[case::nobody_at_all(&[(5, None)], &[])]
#[case::nothing(&[], &[])]
fn who_used_it_last(#[case] seen: &[(i64, Option<usize>)], #[case] owners: &[usize]) {
    assert_eq!(last_user(&events(seen)), set(owners));
}

#[rstest]
#[case::the_most(&[(1, Some(0)), (2, Some(0)), (3, Some(1))], &[0])]
#[case::of_equals_the_latest(&[(4, Some(1)), (2, Some(0)), (3, Some(0)), (1, Some(1))], &[1])]
#[case::then_the_first_by_name(&[(4, Some(1)), (4, Some(0))], &[0])]
#[case::events_without_an_actor_count_for_nobody(&[(1, Some(2)), (2, None), (3, None)], &[2])]
#[case::nothing(&[], &[])]
fn who_used_it_most(#[case] seen: &[(i64, Option<usize>)], #[case] owners: &[usize]) {
    assert_eq!(frequency(&events(seen)), set(owners));
}
