use coin::dialogue::{Reading, read_answer};
use coin::owners::OwnerSet;
use coin::roster::Roster;
use coin_schemas::household::{Background, ClassLabel, ObjectId, Position};
use proptest::prelude::*;
use rstest::rstest;

use super::*;

fn names(names: &str) -> Owners {
    names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
}

fn chose(owners: &str, owner_outside_household: bool) -> Response {
    Response::Chose { owners: names(owners), owner_outside_household, answered_by: None }
}

#[rstest]
#[case("Bob", false, "Bob")]
#[case("Mary Bob", false, "Bob and Mary")]
#[case("Bob Mary Tom", false, "everybody")]
#[case("", true, "somebody outside the household")]
#[case("Tom", true, "Tom and somebody outside the household")]
#[case("Bob Mary Tom", true, "everybody and somebody outside the household")]
fn a_choice_is_put_in_words(#[case] owners: &str, #[case] outside: bool, #[case] words: &str) {
    assert_eq!(chose(owners, outside).in_words(&names("Bob Mary Tom")).unwrap(), words);
}

#[rstest]
#[case("Bob", "Bob", "Bob")]
#[case("Bob Mary", "Bob Mary", "Bob and Mary")]
#[case("Bob Mary Tom", "Ann Bob Mary Tom", "Bob, Mary and Tom")]
fn everybody_is_said_where_it_is_shorter(#[case] owners: &str, #[case] household: &str, #[case] words: &str) {
    assert_eq!(chose(owners, false).in_words(&names(household)).unwrap(), words);
}

#[test]
fn words_are_kept_as_they_are_and_no_answer_has_none() {
    let said = Response::Said { answer: " It's mine. ".to_owned(), answered_by: None };
    assert_eq!(said.in_words(&names("Bob")).unwrap(), " It's mine. ");
    for silent in [Response::Declined, Response::Undo, Response::Stop, Response::NobodyLeft] {
        assert_eq!(silent.in_words(&names("Bob")), None);
    }
}

proptest! {
    /// Whoever reads the record later, even without a model, finds nobody in it who was not picked. Of somebody
    /// outside the built-in reader may make nothing.
    #[test]
    fn the_words_of_a_choice_say_what_was_picked(picked in 0_u8..8, outside: bool) {
        let members = ["Bob", "Mary", "Tom"];
        let places = (0..members.len()).filter(|place| picked >> place & 1 == 1);
        let owners: Vec<&str> = places.map(|place| members[place]).collect();
        let words = chose(&owners.join(" "), outside).in_words(&names("Bob Mary Tom")).unwrap();
        let users = names("Bob Mary Tom").into_iter().map(|name| (name, Background::default())).collect();
        let roster = Roster::new(&users).unwrap();
        let owners: OwnerSet = owners.iter().map(|name| roster.index_of(name).unwrap()).collect();
        let reading = read_answer(&roster, "Whose marker is this?", &words, None);
        let exact = reading == Reading { owners, outside_household: outside };
        prop_assert!(exact || (outside && reading.is_unresolved()), "{words:?} is read as {reading:?}");
    }
}

#[rstest]
#[case(Understood::Named { owners: names("Bob"), owner_outside_household: false }, "the marker in the office belongs to Bob")]
#[case(Understood::Named { owners: names("Bob Mary Tom"), owner_outside_household: false }, "the marker in the office belongs to everybody")]
#[case(Understood::Named { owners: names("Bob"), owner_outside_household: true }, "the marker in the office belongs to Bob and somebody outside the household")]
#[case(Understood::Nobody, "nobody could say whose the marker in the office is")]
#[case(Understood::PassedOver, "the marker in the office was passed over")]
fn the_answer_before_is_put_in_words(#[case] understood: Understood, #[case] words: &str) {
    let object = TaskObject {
        id: ObjectId::new("3").unwrap(),
        class: ClassLabel::new("marker").unwrap(),
        position: Position::new([0.0; 3]).unwrap(),
        room: Some("office".to_owned()),
    };
    assert_eq!(PreviousAnswer { object, understood }.in_words(&names("Bob Mary Tom")), words);
}
