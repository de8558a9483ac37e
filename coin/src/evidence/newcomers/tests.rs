use coin_schemas::tools::{Neighbour, UsageSummary};
use serde_json::json;

use super::*;
use crate::captions::test_support::roster;
use crate::evidence::posterior;

const FOUNDERS: [(&str, &str); 3] = [("Bob", "father"), ("Mary", "mother"), ("Tom", "")];

fn founders() -> Roster {
    roster(&FOUNDERS)
}

/// The founders and Ann, who stands first.
fn with_ann() -> (Roster, OwnerSet) {
    let all: Vec<_> = [("Ann", "")].into_iter().chain(FOUNDERS).collect();
    let roster = roster(&all);
    let ann = roster.index_of("Ann").unwrap();
    (roster, OwnerSet::single(ann))
}

fn context(sessions: &[(&str, u64)], neighbour_of: Option<&str>) -> GivenContext {
    let users: Vec<_> = sessions
        .iter()
        .map(|(name, sessions)| {
            json!({"user_id": name, "total_events": sessions, "sessions": sessions, "actions": {},
                   "last_used_days_ago": 1.0, "example_events": []})
        })
        .collect();
    let usage: UsageSummary = serde_json::from_value(json!({
        "object": {"id": "1", "name": "Marker"}, "as_of": "2025-01-19T00:00:00", "window_days": 365,
        "user_summary": users, "unattributed_events": 0,
    }))
    .unwrap();
    let neighbours: Vec<Neighbour> = neighbour_of
        .map(|owner| {
            serde_json::from_value(json!({
                "id": "2", "name": "Cup", "distance": 0.1, "weight": 0.98,
                "known_ownership": {"owners": [owner], "scores": {owner: 1.0}, "source": "answer"},
            }))
            .unwrap()
        })
        .into_iter()
        .collect();
    GivenContext { usage: Some(usage), nearby_objects: neighbours, similar_objects: Vec::new() }
}

fn marker() -> ClassLabel {
    ClassLabel::new("marker").unwrap()
}

fn judged(roster: &Roster, newcomers: OwnerSet, context: &GivenContext) -> OwnerSetDistribution {
    let arrivals = Arrivals { absent: OwnerSet::EMPTY, newcomers };
    judge(roster, arrivals, &marker(), context, &EvidenceParameters::default()).unwrap()
}

#[test]
fn without_newcomers_it_is_the_posterior() {
    let roster = founders();
    let context = context(&[("Bob", 4), ("Mary", 1)], Some("Bob"));
    let weighed = WeighedContext::new(&roster, &marker(), &context).unwrap();
    let expectation = expect("marker", &roster);
    let expected = posterior(
        &weighed.sessions,
        Opinion::from(expectation.as_ref()),
        &weighed.relatives,
        &EvidenceParameters::default(),
    );
    assert_eq!(judged(&roster, OwnerSet::EMPTY, &context), expected);
}

#[test]
fn a_newcomer_who_never_used_a_thing_puts_no_belief_in_doubt() {
    let (roster, ann) = with_ann();
    for sessions in [&[("Bob", 5), ("Mary", 1)][..], &[("Bob", 9)], &[("Mary", 4), ("Tom", 1)]] {
        let context = context(sessions, Some("Bob"));
        let before = judged(&founders(), OwnerSet::EMPTY, &context);
        let after = judged(&roster, ann, &context);
        let (owners, confidence) = before.best();
        assert_eq!(roster.owners(after.best().0), founders().owners(owners));
        assert!((after.best().1 - confidence).abs() < 1e-12, "{} and {confidence}", after.best().1);
        assert_eq!(after.marginals(4)[0].value(), 0.0);
    }
}

#[test]
fn a_newcomer_who_used_a_thing_is_a_candidate() {
    let (roster, ann) = with_ann();
    let after = judged(&roster, ann, &context(&[("Ann", 9), ("Bob", 1)], None));
    assert_eq!(after.best().0, ann);
}

#[test]
fn whether_everybodys_thing_is_the_newcomers_too_is_open() {
    let (roster, ann) = with_ann();
    let shared = context(&[("Bob", 9), ("Mary", 8), ("Tom", 9)], None);
    let before = judged(&founders(), OwnerSet::EMPTY, &shared);
    assert_eq!(before.best().0, founders().everyone());
    let after = judged(&roster, ann, &shared);
    assert!(after.probability(roster.everyone()) > 0.0);
    assert!(after.best().1 < before.best().1, "{} and {}", after.best().1, before.best().1);
}

#[test]
fn who_is_not_there_yet_shares_nothing() {
    let (roster, ann) = with_ann();
    let shared = context(&[("Bob", 9), ("Mary", 8), ("Tom", 9)], None);
    let arrivals = Arrivals { absent: ann, newcomers: OwnerSet::EMPTY };
    let then = judge(&roster, arrivals, &marker(), &shared, &EvidenceParameters::default()).unwrap();
    let before = judged(&founders(), OwnerSet::EMPTY, &shared);
    assert_eq!(roster.owners(then.best().0), founders().owners(before.best().0));
    assert!((then.best().1 - before.best().1).abs() < 1e-12);
}

#[test]
fn where_all_are_newcomers_those_who_are_there_are_judged() {
    let (roster, ann) = with_ann();
    let founders: OwnerSet = roster.indices().filter(|&user| !ann.contains(user)).collect();
    let nobodys = context(&[], None);
    let arrivals = Arrivals { absent: ann, newcomers: founders };
    let then = judge(&roster, arrivals, &marker(), &nobodys, &EvidenceParameters::default()).unwrap();
    assert_eq!(then.marginals(4)[0].value(), 0.0, "who is not there yet owns nothing");
}

#[test]
fn what_a_newcomer_owns_says_nothing_of_what_others_have_used() {
    let (roster, ann) = with_ann();
    let sessions = [("Bob", 6), ("Mary", 1)];
    let beside_anns = judged(&roster, ann, &context(&sessions, Some("Ann")));
    assert_eq!(beside_anns, judged(&roster, ann, &context(&sessions, None)));
}

#[test]
fn strangers_are_refused() {
    let error = judge(
        &founders(),
        Arrivals { absent: OwnerSet::EMPTY, newcomers: OwnerSet::EMPTY },
        &marker(),
        &context(&[("Zoe", 1)], None),
        &EvidenceParameters::default(),
    )
    .unwrap_err();
    assert!(error.to_string().contains("Zoe"), "{error}");
}
