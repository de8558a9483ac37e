use super::*;
use crate::captions::test_support::roster;
use crate::common_sense::expect;
use crate::evidence::home::{HomeEvidence, Told};
use crate::evidence::{EvidenceParameters, Opinion};
use crate::owners::OwnerSetDistribution;
use crate::roster::Roster;

const FOUNDERS: [(&str, &str); 3] = [("Bob", "father"), ("Mary", "mother"), ("Tom", "")];

/// Taking somebody out of the sums may change them by their last bits.
const EXACT: f64 = 1e-12;

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

/// What was seen of a marker that these people used so often in turns.
fn marker(roster: &Roster, sessions: &[(&str, usize)]) -> SeenThing {
    let most = sessions.iter().map(|&(_, count)| count).max().unwrap_or(0);
    let order = (0..most).flat_map(|round| sessions.iter().filter(move |&&(_, count)| round < count));
    SeenThing {
        class: "Marker".to_owned(),
        sessions: order.map(|(name, _)| roster.index_of(name).unwrap()).collect(),
        near: vec![(1, 0.98)],
        alike: Vec::new(),
        candidates: roster.everyone(),
        latecomers: OwnerSet::EMPTY,
    }
}

/// The marker judged beside a cup of which is known whose it is.
fn judged_beside(
    roster: &Roster,
    arrivals: Arrivals,
    sessions: &[(&str, usize)],
    cup: Option<&str>,
) -> OwnerSetDistribution {
    let marker = marker(roster, sessions);
    let unused =
        SeenThing { class: "Cup".to_owned(), sessions: Vec::new(), near: Vec::new(), ..marker.clone() };
    let home = HomeEvidence::new(
        vec![marker.after(arrivals), unused.after(arrivals)],
        EvidenceParameters::default(),
    );
    let expectation = expect("marker", roster);
    let answer = cup.map(|owner| OwnerSet::single(roster.index_of(owner).unwrap()));
    let told = [
        Told { answer: None, opinion: expectation.as_ref().into() },
        Told { answer, opinion: Opinion::None },
    ];
    home.judge(&told).distributions()[0].clone()
}

fn judged(roster: &Roster, newcomers: OwnerSet, sessions: &[(&str, usize)]) -> OwnerSetDistribution {
    judged_beside(roster, Arrivals { newcomers, ..Arrivals::default() }, sessions, None)
}

#[test]
fn a_newcomer_who_never_used_a_thing_puts_no_belief_in_doubt() {
    let (roster, ann) = with_ann();
    for sessions in [&[("Bob", 5), ("Mary", 1)][..], &[("Bob", 9)], &[("Mary", 4), ("Tom", 1)]] {
        let before = judged(&founders(), OwnerSet::EMPTY, sessions);
        let after = judged(&roster, ann, sessions);
        let (owners, confidence) = before.best();
        assert_eq!(roster.owners(after.best().0), founders().owners(owners));
        assert!((after.best().1 - confidence).abs() < EXACT, "{} and {confidence}", after.best().1);
        assert_eq!(after.marginals(4)[0].value(), 0.0);
    }
}

#[test]
fn a_newcomer_who_used_a_thing_is_a_candidate() {
    let (roster, ann) = with_ann();
    let after = judged(&roster, ann, &[("Ann", 9), ("Bob", 1)]);
    assert_eq!(after.best().0, ann);
}

#[test]
fn whether_everybodys_thing_is_the_newcomers_too_is_open() {
    let (roster, ann) = with_ann();
    let shared = [("Bob", 9), ("Mary", 8), ("Tom", 9)];
    let before = judged(&founders(), OwnerSet::EMPTY, &shared);
    let (everybody, confidence) = before.best();
    assert_eq!(everybody, founders().everyone());
    let after = judged(&roster, ann, &shared);
    assert!((after.probability(roster.everyone()) - confidence / 2.0).abs() < EXACT);
    assert!((after.best().1 - confidence / 2.0).abs() < EXACT);
}

#[test]
fn who_is_not_there_yet_shares_nothing() {
    let (roster, ann) = with_ann();
    let shared = [("Bob", 9), ("Mary", 8), ("Tom", 9)];
    let arrivals = Arrivals { absent: ann, newcomers: OwnerSet::EMPTY };
    let then = judged_beside(&roster, arrivals, &shared, None);
    let before = judged(&founders(), OwnerSet::EMPTY, &shared);
    assert_eq!(roster.owners(then.best().0), founders().owners(before.best().0));
    assert!((then.best().1 - before.best().1).abs() < EXACT);
}

#[test]
fn where_all_are_newcomers_those_who_are_there_are_judged() {
    let (roster, ann) = with_ann();
    let founders: OwnerSet = roster.indices().filter(|&user| !ann.contains(user)).collect();
    let arrivals = Arrivals { absent: ann, newcomers: founders };
    let then = judged_beside(&roster, arrivals, &[], None);
    assert_eq!(then.marginals(4)[0].value(), 0.0, "who is not there yet owns nothing");
    assert!(then.marginals(4)[1].value() > 0.0);
}

#[test]
fn what_a_newcomer_owns_says_nothing_of_what_others_have_used() {
    let (roster, ann) = with_ann();
    let sessions = [("Bob", 6), ("Mary", 1)];
    let arrivals = Arrivals { newcomers: ann, ..Arrivals::default() };
    let beside_anns = judged_beside(&roster, arrivals, &sessions, Some("Ann"));
    assert_eq!(beside_anns, judged_beside(&roster, arrivals, &sessions, None));
}
