//! Laws of the judgement of a whole home. `coin/tests/method/known_answers.rs` compares it with another computation.

use proptest::prelude::*;
use rstest::rstest;

use super::super::posterior;
use super::*;
use crate::common_sense::Expectation;
use crate::support::{any_order, any_set, moved, set, user};

const EXACT: f64 = 1e-9;

fn defaults() -> EvidenceParameters {
    EvidenceParameters::default()
}

fn everyone(members: usize) -> OwnerSet {
    (0..members).map(user).collect()
}

/// A thing of a class of its own that these people used, one letter a session: a is the first of the household.
fn thing(members: usize, sessions: &str) -> SeenThing {
    let sessions = sessions.bytes().map(|letter| user(usize::from(letter - b'a'))).collect();
    SeenThing {
        class: String::new(),
        sessions,
        near: Vec::new(),
        alike: Vec::new(),
        candidates: everyone(members),
        latecomers: OwnerSet::EMPTY,
    }
}

fn home(members: usize, sessions: &[&str]) -> Vec<SeenThing> {
    let things = sessions.iter().enumerate();
    things
        .map(|(place, sessions)| SeenThing { class: place.to_string(), ..thing(members, sessions) })
        .collect()
}

/// The things judged without any opinion, with these answers.
fn judged(
    things: Vec<SeenThing>,
    answers: &[(usize, OwnerSet)],
    parameters: EvidenceParameters,
) -> Vec<OwnerSetDistribution> {
    let mut told = vec![Told { answer: None, opinion: Opinion::None }; things.len()];
    for &(place, owners) in answers {
        told[place].answer = Some(owners);
    }
    HomeEvidence::new(things, parameters).judge(&told).distributions().to_vec()
}

fn any_thing(members: usize) -> impl Strategy<Value = Vec<usize>> {
    proptest::collection::vec(0..members, 0..12)
}

fn any_home() -> impl Strategy<Value = (usize, Vec<Vec<usize>>)> {
    (1..=4_usize)
        .prop_flat_map(|members| (Just(members), proptest::collection::vec(any_thing(members), 1..5)))
}

fn seen(members: usize, users: &[Vec<usize>]) -> Vec<SeenThing> {
    let things = users.iter().enumerate();
    things
        .map(|(place, users)| SeenThing {
            class: place.to_string(),
            sessions: users.iter().map(|&place| user(place)).collect(),
            ..thing(members, "")
        })
        .collect()
}

mod accounts {
    use super::*;

    /// Every account is a law of who uses a thing in which session: over all sequences of users it sums to 1.
    #[rstest]
    fn sum_to_one_over_all_sequences_of_users(
        #[values(2, 3)] members: usize,
        #[values(1, 2, 3, 4)] length: u32,
    ) {
        let candidates = Candidates::of(everyone(members));
        let sequences = (0..members.pow(length))
            .map(|number| (0..length).map(|place| number / members.pow(place) % members).collect::<Vec<_>>());
        let logs: Vec<_> =
            sequences.map(|users| likelihood::logarithms(&users, &candidates, &defaults())).collect();
        for kind in 0..logs[0].len() {
            for set in 0..candidates.sets().len() {
                let sum: f64 = logs.iter().map(|accounts| exp(accounts[kind][set])).sum();
                assert!((sum - 1.0).abs() < EXACT, "account {kind}, set {set}: {sum}");
            }
        }
    }

    #[test]
    fn of_lending_are_the_bare_formula() {
        let users = [0, 1, 0, 2, 0, 0, 1];
        let candidates = Candidates::of(everyone(3));
        let accounts = likelihood::logarithms(&users, &candidates, &defaults());
        let lent = &accounts[habits::MISTAKEN.len()];
        let habits::Lending { borrowed, own_use } = habits::LENDING[0];
        let evenness = habits::EVENNESS[0].owners;
        let parameters = EvidenceParameters { borrowed, own_use, evenness, ..defaults() };
        for (&set, lent) in candidates.sets().iter().zip(lent) {
            assert!((lent - log_likelihood(&[4, 2, 1], set, &parameters)).abs() < EXACT);
        }
    }
}

proptest! {
    #[test]
    fn names_do_not_matter((members, users) in any_home(), order in any_order(4)) {
        let order: Vec<usize> = order.into_iter().filter(|&place| place < members).collect();
        let renamed: Vec<Vec<usize>> =
            users.iter().map(|users| users.iter().map(|&place| order[place]).collect()).collect();
        let before = judged(seen(members, &users), &[], defaults());
        let after = judged(seen(members, &renamed), &[], defaults());
        for (before, after) in before.iter().zip(&after) {
            for &(set, probability) in before.entries() {
                let there = after.probability(moved(set, &order));
                prop_assert!((probability - there).abs() < EXACT, "{probability} and {there}");
            }
        }
    }

    /// The order of the things does not matter, and what nobody used and nobody said leaves the others as they were.
    #[test]
    fn an_unused_thing_changes_nothing((members, mut users) in any_home()) {
        let before = judged(seen(members, &users), &[], defaults());
        users.push(Vec::new());
        users.rotate_right(1);
        let after = judged(seen(members, &users), &[], defaults());
        for (before, after) in before.iter().zip(&after[1..]) {
            for (&(_, before), &(_, after)) in before.entries().iter().zip(after.entries()) {
                prop_assert!((before - after).abs() < EXACT, "{before} and {after}");
            }
        }
    }

    /// Whatever a model says, the best set keeps what was promised of it.
    #[test]
    fn leaves_the_best_set_what_is_promised(
        (members, users) in any_home(),
        certain in any_set(4),
    ) {
        let certain = certain.intersection(everyone(members));
        let told = vec![Told { answer: None, opinion: Opinion::None }; users.len()];
        let home = HomeEvidence::new(seen(members, &users), defaults());
        let judgement = home.judge(&told);
        let promised = home.least_confidence(&judgement, 0);
        let without = home.reconsidered(&judgement, 0, Opinion::None);
        let with = home.reconsidered(&judgement, 0, Opinion::Certain(certain));
        let best = without.best().0;
        prop_assert!(with.probability(best) >= promised - EXACT, "{} and {promised}", with.probability(best));
    }
}

proptest! {
    /// What is worked out again after an answer is what would have been worked out at once.
    #[test]
    fn judging_again_is_judging((members, users) in any_home(), owners in any_set(4), again in any_set(4)) {
        let mut things = seen(members, &users);
        for (place, thing) in things.iter_mut().enumerate().skip(1) {
            thing.near = vec![(place - 1, 0.9)];
            thing.alike = (0..place).map(|other| (other, 0.1 * ((place * other) % 3) as f64)).collect();
        }
        let home = HomeEvidence::new(things, defaults());
        let mut told = vec![Told { answer: None, opinion: Opinion::None }; users.len()];
        let mut judgement = home.judge(&told);
        for (place, owners) in [owners, again].into_iter().enumerate().take(users.len()) {
            told[place].answer = Some(owners.intersection(everyone(members)));
            judgement = home.judge_again(&told, &judgement);
            let at_once = home.judge(&told);
            for (again, at_once) in judgement.distributions().iter().zip(at_once.distributions()) {
                for (&(_, again), &(_, at_once)) in again.entries().iter().zip(at_once.entries()) {
                    prop_assert!((again - at_once).abs() < 1e-7, "{again} and {at_once}");
                }
            }
        }
    }
}

#[rstest]
#[case::one_person("aaaaaa", &[0])]
#[case::one_who_lends("aabaaacaa", &[0])]
#[case::two_in_turns("abbaabab", &[0, 1])]
#[case::everybody_in_turns("abccabbca", &[0, 1, 2])]
#[case::handed_down("aaaaaaaabbbbbbbb", &[1])]
#[case::one_mistaken_sighting("aaaaaaaaaaaaaaabaaaaaaaa", &[0])]
fn the_best_set_is_the_plain_reading(#[case] sessions: &str, #[case] owners: &[usize]) {
    let judged = judged(home(3, &[sessions]), &[], defaults());
    assert_eq!(judged[0].best().0, set(owners));
}

#[test]
fn turns_tell_sharing_from_borrowing() {
    let confidence =
        |parameters| judged(home(3, &["abababab"]), &[], parameters)[0].probability(set(&[0, 1]));
    let by_chance = confidence(EvidenceParameters { turns: 0.0, ..defaults() });
    assert!(confidence(defaults()) > by_chance, "{} and {by_chance}", confidence(defaults()));
}

#[test]
fn without_a_change_of_hands_two_owners_after_one_another_are_sharers() {
    let parameters = EvidenceParameters { change_of_hands: 0.0, ..defaults() };
    assert_eq!(judged(home(3, &["aaaaaaaabbbbbbbb"]), &[], parameters)[0].best().0, set(&[0, 1]));
}

/// The same thing in two homes: people who lend nothing, and people who lend a lot.
#[test]
fn a_home_shows_how_much_it_lends() {
    let open = "aaabab";
    let keepers = home(3, &[open, "aaaaaaaa", "bbbbbbbb", "cccccccc", "aaaaaaa", "bbbbbb", "ccccc"]);
    let lenders = home(3, &[open, "aabacaaa", "bbabbbcb", "ccaccbcc", "abaaaca", "bbbacb", "cbcca"]);
    let single = |things, parameters| judged(things, &[], parameters)[0].probability(set(&[0]));
    assert!(single(lenders.clone(), defaults()) > single(keepers.clone(), defaults()) + 0.1);
    let ordinary = EvidenceParameters { habits: HabitSource::Ordinary, ..defaults() };
    assert!((single(lenders, ordinary) - single(keepers, ordinary)).abs() < EXACT);
}

/// The same thing in two homes: in one anybody borrows anything, in the other everything has one borrower.
#[test]
fn a_home_shows_whether_the_same_person_borrows_again() {
    let open = "aaabbaabbaaabb";
    let anybody = home(4, &[open, "bbabbcbbdbb", "ccaccbccdcc", "ddaddbddcdd", "aacaadaabaa"]);
    let friends = home(4, &[open, "bbcbbcbbcbb", "ccdccdccdcc", "ddaddaddadd", "aacaacaacaa"]);
    let single = |things| judged(things, &[], defaults())[0].probability(set(&[0]));
    let (anybody, friends) = (single(anybody), single(friends));
    assert!(friends > anybody + 0.1, "{friends} and {anybody}");
}

/// What nobody used yet, beside things that are whose one would expect, and beside others.
#[test]
fn a_home_shows_whether_its_things_are_whose_one_would_expect() {
    let expected = |suited: usize| Expectation {
        single: 0.88,
        everyone: 0.04,
        suitability: (0..3).map(|place| if place == suited { 3.0 } else { 1.0 }).collect(),
    };
    let used = ["aaaaaa", "bbbbbb", "cccccc", "aaaaa", "bbbbb", "ccccc", "aaaa", "bbbb", "cccc", ""];
    let of_first = |suited: fn(usize) -> usize| {
        let opinions: Vec<Expectation> =
            (0..9).map(|place| expected(suited(place))).chain([expected(0)]).collect();
        let told = |opinion| Told { answer: None, opinion: Opinion::OfClass(opinion) };
        let evidence = HomeEvidence::new(home(3, &used), defaults());
        let judgement = evidence.judge(&opinions.iter().map(told).collect::<Vec<_>>());
        judgement.distributions()[9].probability(set(&[0]))
    };
    let (as_expected, otherwise) = (of_first(|place| place % 3), of_first(|place| (place + 1) % 3));
    assert!(as_expected > otherwise + 0.05, "{as_expected} and {otherwise}");
}

#[test]
fn an_answer_makes_the_next_belief_better() {
    let open = ["aabaaab", "bbcbbcb", "ccaccac", "aacaaca"];
    let before = judged(home(3, &open), &[], defaults())[3].probability(set(&[0]));
    let borrowed = [(0, set(&[0])), (1, set(&[1])), (2, set(&[2]))];
    let after = judged(home(3, &open), &borrowed, defaults())[3].probability(set(&[0]));
    assert!(after > before + 0.02, "{before} and {after}");
    let shared = [(0, set(&[0, 1])), (1, set(&[1, 2])), (2, set(&[0, 2]))];
    let otherwise = judged(home(3, &open), &shared, defaults())[3].probability(set(&[0]));
    assert!(otherwise < before - 0.02, "{before} and {otherwise}");
}

#[test]
fn what_somebody_outside_owns_says_nothing_of_habits() {
    let things = home(3, &["aabaaab", "bbcbbcb"]);
    let strangers = judged(things.clone(), &[(1, OwnerSet::EMPTY)], defaults());
    let unused = judged(home(3, &["aabaaab", ""]), &[], defaults());
    assert_eq!(strangers[0], unused[0]);
}

mod looks {
    use super::*;

    /// Six things, of which the first three are one person's and the next two another's, and the last was never used. Two
    /// of one owner have the one cosine, others the other.
    fn looking(same: f64, other: f64) -> Vec<SeenThing> {
        let mut things = home(2, &["aaaaaaaa", "aaaaaaa", "aaaaaa", "bbbbbbbb", "bbbbbbb", "bbbbbb", ""]);
        let owner = |place: usize| place / 3;
        for (place, thing) in things.iter_mut().enumerate() {
            let spread =
                |left: usize, right: usize| 0.02 * ((left * 7 + right * 11 + left * right) % 5) as f64;
            thing.alike = (0..place)
                .map(|earlier| {
                    let alike = owner(earlier) == if place == 6 { 1 } else { owner(place) };
                    (earlier, spread(earlier, place) + if alike { same } else { other })
                })
                .collect();
        }
        things
    }

    #[test]
    fn count_for_as_much_as_they_tell_in_this_home() {
        let of_second = |things, parameters| judged(things, &[], parameters)[6].probability(set(&[1]));
        let telling = of_second(looking(0.3, 0.1), defaults());
        let silent = of_second(looking(0.1, 0.1), defaults());
        assert!(telling > 0.9, "{telling}");
        assert!(silent < 0.4, "{silent}");
        let off = EvidenceParameters { resemblance: 0.0, ..defaults() };
        let never_seen = of_second(
            looking(0.3, 0.1).into_iter().map(|thing| SeenThing { alike: Vec::new(), ..thing }).collect(),
            defaults(),
        );
        assert_eq!(of_second(looking(0.3, 0.1), off), never_seen);
    }

    #[test]
    fn of_one_class_tell_nothing() {
        let mut things = looking(0.3, 0.1);
        things.iter_mut().for_each(|thing| thing.class = "Mug".to_owned());
        let alike = judged(things.clone(), &[], defaults());
        things.iter_mut().for_each(|thing| thing.alike.clear());
        assert_eq!(alike, judged(things, &[], defaults()));
    }
}

mod places {
    use super::*;

    /// Two people's things: those of one lie together, or all lie among each other, and the last was never used.
    fn lying(together: bool) -> Vec<SeenThing> {
        let used = ["aaaaaa", "bbbbbb"].into_iter().cycle().take(24).chain([""]);
        let mut things = home(2, &used.collect::<Vec<_>>());
        let shelf = |place: usize| match (place, together) {
            (24, _) => 0,
            (_, true) => place % 2,
            (_, false) => place / 2 % 2,
        };
        let places = 0..things.len();
        for (place, thing) in things.iter_mut().enumerate() {
            let beside = places.clone().filter(|&other| other != place && shelf(other) == shelf(place));
            thing.near = beside.map(|other| (other, 0.3 + 0.1 * ((place + other) % 5) as f64)).collect();
        }
        things
    }

    #[test]
    fn count_for_as_much_as_they_tell_in_this_home() {
        let of_first = |things, parameters| judged(things, &[], parameters)[24].probability(set(&[0]));
        let off = EvidenceParameters { nearness: 0.0, ..defaults() };
        let alone = of_first(lying(true), off);
        let telling = of_first(lying(true), defaults());
        assert!(telling > alone + 0.3, "{telling} and {alone}");
        let silent = of_first(lying(false), defaults());
        assert!((silent - of_first(lying(false), off)).abs() < 0.05, "{silent}");
    }

    #[test]
    fn are_told_by_those_whose_owners_are_named() {
        let mut things = lying(true);
        things[0].sessions.clear();
        let other = judged(things.clone(), &[], defaults())[24].probability(set(&[1]));
        let named = judged(things, &[(0, set(&[1])), (2, set(&[1])), (4, set(&[1]))], defaults());
        assert!(named[24].probability(set(&[1])) > other, "{other}");
    }
}

#[test]
fn a_very_large_household_is_judged_thing_by_thing() {
    let things = home(13, &["aabaaab", "bbbb"]);
    let judged = judged(things, &[], defaults());
    let mut counts = vec![0; 13];
    (counts[0], counts[1]) = (5, 2);
    let alone = posterior(&counts, Opinion::None, &[], &defaults());
    for (&(_, one), &(_, other)) in judged[0].entries().iter().zip(alone.entries()) {
        assert!((one - other).abs() < EXACT);
    }
}

#[test]
fn a_year_of_use_stays_finite() {
    let lent = |session: usize| char::from(b'b' + u8::try_from(session / 5 % 7).unwrap());
    let long: String = (0..1000).map(|session| if session % 5 == 0 { lent(session) } else { 'a' }).collect();
    let judged = judged(home(8, &[&long, ""]), &[], defaults());
    assert!(
        judged.iter().all(|thing| thing.entries().iter().all(|(_, probability)| probability.is_finite()))
    );
    assert_eq!(judged[0].best().0, set(&[0]));
}
