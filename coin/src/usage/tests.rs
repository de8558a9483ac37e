use proptest::prelude::*;
use rstest::rstest;

use super::*;

const DAY: i64 = 86_400;

fn user(place: usize) -> UserIndex {
    UserIndex::new(place).unwrap()
}

fn event(at_seconds: i64, actor: Option<usize>, action: Action) -> UsageEvent {
    UsageEvent { at_seconds, actor: actor.map(user), action }
}

/// Minutes and actors; every action is a use.
fn uses(events: &[(i64, Option<usize>)]) -> Vec<UsageEvent> {
    events.iter().map(|&(minute, actor)| event(minute * 60, actor, Action::Use)).collect()
}

#[rstest]
#[case::one_run(&[(0, Some(0)), (5, Some(0)), (20, Some(0))], &[1, 0])]
#[case::a_gap_of_twenty_minutes_is_none(&[(0, Some(0)), (20, Some(0))], &[1, 0])]
#[case::a_longer_gap_cuts(&[(0, Some(0)), (21, Some(0))], &[2, 0])]
#[case::gaps_do_not_add_up(&[(0, Some(0)), (15, Some(0)), (30, Some(0)), (45, Some(0))], &[1, 0])]
#[case::another_user_cuts(&[(0, Some(0)), (1, Some(1)), (2, Some(0))], &[2, 1])]
#[case::nobody_does_not_cut(&[(0, Some(0)), (1, None), (2, Some(0))], &[1, 0])]
#[case::nobody_bridges_no_gap(&[(0, Some(0)), (15, None), (30, Some(0))], &[2, 0])]
#[case::nothing(&[], &[0, 0])]
#[case::only_nobody(&[(0, None)], &[0, 0])]
fn sessions_are_cut(#[case] events: &[(i64, Option<usize>)], #[case] sessions: &[u64]) {
    let events = uses(events);
    assert_eq!(session_counts(&events, 2), sessions);
    let summary = summarise(&events, 5);
    for statistics in &summary.users {
        assert_eq!(statistics.sessions, sessions[statistics.user.place()]);
    }
}

#[test]
fn a_summary_has_the_most_active_first_and_the_latest_examples() {
    let events = [
        event(0, Some(2), Action::Take),
        event(60, Some(2), Action::Use),
        event(90, None, Action::Take),
        event(120, Some(2), Action::Place),
        event(DAY, Some(1), Action::Use),
        event(DAY + 60, Some(0), Action::Clean),
    ];
    let summary = summarise(&events, 2);
    let statistics =
        |place: usize, total_events, actions: &[(Action, u64)], last_at_seconds, examples: &[usize]| {
            let mut counts = [0; 8];
            for &(action, count) in actions {
                counts[usize::from(action.code())] = count;
            }
            UserStatistics {
                user: user(place),
                total_events,
                sessions: 1,
                actions: counts,
                last_at_seconds,
                examples: examples.to_vec(),
            }
        };
    assert_eq!(
        summary,
        UsageStatistics {
            users: vec![
                statistics(2, 3, &[(Action::Take, 1), (Action::Use, 1), (Action::Place, 1)], 120, &[1, 3]),
                statistics(0, 1, &[(Action::Clean, 1)], DAY + 60, &[5]),
                statistics(1, 1, &[(Action::Use, 1)], DAY, &[4]),
            ],
            unattributed_events: 1,
        }
    );
}

#[rstest]
#[case(0, 0, 0.0)]
#[case(0, DAY, 1.0)]
#[case(0, 4319, 0.0)]
#[case(0, 4320, 0.1)]
#[case(0, 8 * DAY / 10, 0.8)]
#[case(0, 365 * DAY, 365.0)]
#[case(DAY, 0, -1.0)]
#[case(4319, 0, 0.0)]
#[case(i64::MIN, i64::MAX, 213_503_982_334_601.3)]
fn recency_has_one_decimal(#[case] last: i64, #[case] as_of: i64, #[case] days: f64) {
    assert_eq!(days_since(last, as_of), days);
}

#[test]
fn extreme_times_do_not_overflow() {
    let events = [event(i64::MIN, Some(0), Action::Use), event(i64::MAX, Some(0), Action::Use)];
    assert_eq!(session_counts(&events, 1), [2]);
    assert_eq!(summarise(&events, usize::MAX).users[0].examples, [0, 1]);
}

/// Events in time order of up to four users, dense enough for sessions to form.
fn histories() -> impl Strategy<Value = Vec<UsageEvent>> {
    let step = prop_oneof![Just(0_i64), 1..600_i64, 1190..1210_i64, 1200..90_000_i64];
    let one = (step, prop::option::weighted(0.9, 0..4_usize), 0..8_u8);
    prop::collection::vec(one, 0..60).prop_map(|steps| {
        let mut now = 0;
        steps
            .into_iter()
            .map(|(step, actor, code)| {
                now += step;
                event(now, actor, Action::from_code(code).unwrap())
            })
            .collect()
    })
}

/// The definition of a session, without a running state: an attributed event begins one unless the attributed
/// event before it is of the same user and at most Δt away.
fn sessions_by_definition(events: &[UsageEvent], of: UserIndex) -> u64 {
    let attributed: Vec<&UsageEvent> = events.iter().filter(|event| event.actor.is_some()).collect();
    let begins = |index: usize| {
        index == 0
            || attributed[index - 1].actor != attributed[index].actor
            || attributed[index].at_seconds - attributed[index - 1].at_seconds > SESSION_GAP_SECONDS
    };
    (0..attributed.len()).filter(|&index| attributed[index].actor == Some(of) && begins(index)).count() as u64
}

proptest! {
    #[test]
    fn sessions_follow_their_definition(events in histories()) {
        let counts = session_counts(&events, 4);
        for (place, &count) in counts.iter().enumerate() {
            prop_assert_eq!(count, sessions_by_definition(&events, user(place)));
        }
    }

    #[test]
    fn every_event_is_counted_exactly_once(events in histories(), max_examples in 0..8_usize) {
        let summary = summarise(&events, max_examples);
        let attributed: u64 = summary.users.iter().map(|statistics| statistics.total_events).sum();
        prop_assert_eq!(attributed + summary.unattributed_events, events.len() as u64);
        for statistics in &summary.users {
            let own: Vec<usize> = (0..events.len()).filter(|&index| events[index].actor == Some(statistics.user)).collect();
            prop_assert_eq!(statistics.total_events, own.len() as u64);
            prop_assert_eq!(statistics.actions.iter().sum::<u64>(), statistics.total_events);
            prop_assert!(1 <= statistics.sessions && statistics.sessions <= statistics.total_events);
            prop_assert_eq!(statistics.last_at_seconds, events[own[own.len() - 1]].at_seconds);
            prop_assert_eq!(&statistics.examples[..], &own[own.len().saturating_sub(max_examples)..]);
        }
    }

    #[test]
    fn users_stand_in_order_and_agree_with_the_counts(events in histories()) {
        let summary = summarise(&events, 1);
        let counts = session_counts(&events, 4);
        for statistics in &summary.users {
            prop_assert_eq!(statistics.sessions, counts[statistics.user.place()]);
        }
        for pair in summary.users.windows(2) {
            prop_assert!(
                pair[0].total_events > pair[1].total_events
                    || pair[0].total_events == pair[1].total_events && pair[0].user < pair[1].user
            );
        }
    }

    #[test]
    fn moving_all_times_changes_nothing_else(events in histories(), shift in -1_000_000_000..1_000_000_000_i64) {
        let moved: Vec<UsageEvent> =
            events.iter().map(|event| UsageEvent { at_seconds: event.at_seconds + shift, ..*event }).collect();
        let mut expected = summarise(&events, 3);
        for statistics in &mut expected.users {
            statistics.last_at_seconds += shift;
        }
        prop_assert_eq!(summarise(&moved, 3), expected);
        prop_assert_eq!(session_counts(&moved, 4), session_counts(&events, 4));
    }

    #[test]
    fn cutting_a_history_in_two_splits_at_most_one_session(events in histories(), cut in 0..60_usize) {
        let (early, late) = events.split_at(cut.min(events.len()));
        let whole: u64 = session_counts(&events, 4).iter().sum();
        let parts: u64 = session_counts(early, 4).iter().chain(&session_counts(late, 4)).sum();
        prop_assert!(whole <= parts && parts <= whole + 1);
    }

    #[test]
    fn repeating_an_event_adds_no_session(events in histories(), index in 0..60_usize) {
        prop_assume!(!events.is_empty());
        let index = index % events.len();
        let mut repeated = events.clone();
        repeated.insert(index, events[index]);
        prop_assert_eq!(session_counts(&repeated, 4), session_counts(&events, 4));
    }

    #[test]
    fn unattributed_events_change_no_users_sessions(events in histories()) {
        let attributed: Vec<UsageEvent> = events.iter().copied().filter(|event| event.actor.is_some()).collect();
        prop_assert_eq!(session_counts(&attributed, 4), session_counts(&events, 4));
    }

    #[test]
    fn recency_is_within_half_a_tenth(seconds in 0..10_000_000_000_i64, last in -1_000_000_000..1_000_000_000_i64) {
        let days = days_since(last, last + seconds);
        prop_assert!((days - seconds as f64 / 86_400.0).abs() <= 0.05 + 1e-9);
    }
}
