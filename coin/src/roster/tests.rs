//! Laws of the household's members.

use coin_schemas::household::Background;
use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::{any_scores, any_set, name, roster, roster_of, scores, user};

proptest! {
    #[test]
    fn names_places_and_sets_go_there_and_back(members in 1..=MAX_USERS, owners in any_set(9)) {
        let roster = roster_of(members);
        prop_assert_eq!(roster.len(), members);
        for index in roster.indices() {
            prop_assert_eq!(roster.index_of(roster.name(index).as_str()), Ok(index));
        }
        prop_assert_eq!(Roster::new(&roster.users()), Ok(roster.clone()));
        let owners = owners.intersection(roster.everyone());
        prop_assert_eq!(roster.owner_set(&roster.owners(owners)), Ok(owners));
        prop_assert_eq!(roster.everyone().len(), members);
    }

    #[test]
    fn scores_go_there_and_back(vector in any_scores(1..=9)) {
        let roster = roster_of(vector.len());
        prop_assert_eq!(roster.score_vector(&roster.scores(&vector)), Ok(vector));
    }

    #[test]
    fn an_indicator_scores_owners_one_and_others_zero(owners in any_set(5)) {
        let roster = roster_of(5);
        let expected: Vec<f64> =
            (0..5).map(|place| if owners.contains(user(place)) { 1.0 } else { 0.0 }).collect();
        prop_assert_eq!(roster.score_vector(&roster.indicator(owners)), Ok(scores(&expected)));
    }
}

#[test]
fn members_stand_in_the_order_of_their_names() {
    let roster = roster(&["Tom", "bob", "Mary", "Bob"]);
    let names: Vec<&str> = roster.names().map(UserName::as_str).collect();
    assert_eq!(names, ["Bob", "Mary", "Tom", "bob"]);
}

#[test]
fn a_background_stays_with_its_person() {
    let father = Background { role: Some("father".to_owned()), occupation: None };
    let users = Users::from([(name("Tom"), father.clone()), (name("Ann"), Background::default())]);
    let roster = Roster::new(&users).unwrap();
    assert_eq!(roster.background(roster.index_of("Tom").unwrap()), &father);
    assert_eq!(roster.background(roster.index_of("Ann").unwrap()), &Background::default());
}

#[rstest]
#[case(0, Err("a household has at least one member, and none is given"))]
#[case(1, Ok(()))]
#[case(64, Ok(()))]
#[case(65, Err("a household has at most 64 members, and 65 are given"))]
fn a_household_has_one_to_sixty_four_members(#[case] members: usize, #[case] expected: Result<(), &str>) {
    let users: Users =
        (0..members).map(|place| (name(&format!("U{place:02}")), Background::default())).collect();
    let taken = Roster::new(&users).map(drop).map_err(|error| error.to_string());
    assert_eq!(taken, expected.map_err(str::to_owned));
}

#[rstest]
#[case(63, true)]
#[case(64, false)]
#[case(256, false)]
#[case(usize::MAX, false)]
fn places_end_where_sets_end(#[case] place: usize, #[case] exists: bool) {
    assert_eq!(UserIndex::new(place).map(UserIndex::place), exists.then_some(place));
}

mod errors_tell_the_reader {
    use super::*;

    const UNKNOWN: &str = "\"bob\" is not a member of the household; its members are Bob, Mary";

    #[test]
    fn who_is_no_member_and_who_is() {
        let roster = roster(&["Bob", "Mary"]);
        assert_eq!(roster.index_of("bob").unwrap_err().to_string(), UNKNOWN);
        assert_eq!(roster.owner_set(&[name("Mary"), name("bob")]).unwrap_err().to_string(), UNKNOWN);
    }

    #[test]
    fn whose_score_is_missing_or_one_too_many() {
        let roster = roster(&["Bob", "Mary"]);
        let half = Score::new(0.5).unwrap();
        let mut given = Scores::from([(name("Mary"), half)]);
        assert_eq!(roster.score_vector(&given).unwrap_err().to_string(), "there is no score for Bob");
        given.extend([(name("Bob"), half), (name("bob"), half)]);
        assert_eq!(roster.score_vector(&given).unwrap_err().to_string(), UNKNOWN);
    }
}

#[rstest]
#[case::too_few(&[0.5])]
#[case::too_many(&[0.5, 0.5, 0.5])]
#[should_panic(expected = "one score for each member")]
fn a_vector_of_another_household_is_a_fault_of_the_caller(#[case] vector: &[f64]) {
    roster(&["Bob", "Mary"]).scores(&scores(vector));
}
