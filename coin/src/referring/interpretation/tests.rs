use rstest::rstest;

use super::*;
use crate::captions::test_support::roster;
use crate::support::{set, user};

const EVERYONE: OwnerReference = OwnerReference::Anybody;

fn members(places: &[usize]) -> OwnerReference {
    OwnerReference::Members(set(places))
}

/// Bob, the father, is 0; Lina and Nora, daughters, 1 and 2; Mary, the mother, 3. Bob speaks.
fn read(said: &str) -> Interpretation {
    let family = roster(&[("Bob", "father"), ("Lina", "daughter"), ("Mary", "mother"), ("Nora", "daughter")]);
    interpret(&family, said, Some(user(0)))
}

#[rstest]
#[case::the_speaker("my cup", "cup", members(&[0]))]
#[case::politely("Could you please bring me my cup?", "cup", members(&[0]))]
#[case::behind("a cup of mine", "cup", members(&[0]))]
#[case::a_name("Mary's cup", "cup", members(&[2]))]
#[case::without_apostrophe("Marys cup", "cup", members(&[2]))]
#[case::of_a_name("the cup of Mary", "cup", members(&[2]))]
#[case::in_a_clause("the cup that belongs to Mary", "cup", members(&[2]))]
#[case::as_subject("the cup that Mary owns", "cup", members(&[2]))]
#[case::a_role("the mother's cup", "cup", members(&[2]))]
#[case::a_pet_name("mommy's cup", "cup", members(&[2]))]
#[case::a_relative("my wife's cup", "cup", members(&[2]))]
#[case::a_relative_with_a_name("my daughter Nora's cup", "cup", members(&[3]))]
#[case::one_of_two("my daughter's cup", "cup", OwnerReference::OneOf(set(&[1, 3])))]
#[case::two("Bob and Mary's cup", "cup", members(&[0, 2]))]
#[case::two_with_endings("Bob's and Mary's cup", "cup", members(&[0, 2]))]
#[case::several("Lina, Nora and Mary's cup", "cup", members(&[1, 2, 3]))]
#[case::several_at_once("the girls' cup", "cup", members(&[1, 3]))]
#[case::ours("our cup", "cup", OwnerReference::Ours(Some(user(0))))]
#[case::everybody("everybody's cup", "cup", members(&[0, 1, 2, 3]))]
#[case::whoever_gets_it("bring Mary her cup", "cup", members(&[2]))]
#[case::for_somebody("bring Mary my cup", "cup", members(&[0]))]
#[case::somewhere("bring my cup to Mary's desk", "cup", members(&[0]))]
#[case::nobody("the cup", "cup", EVERYONE)]
#[case::a_guest("the guest's cup", "cup", OwnerReference::Outside)]
#[case::a_stranger("Steve's cup", "cup", OwnerReference::Unknown)]
#[case::nobody_named("her cup", "cup", OwnerReference::Unknown)]
#[case::not_hers("not Mary's cup, my cup", "cup cup", members(&[0]))]
#[case::a_part_of_the_name("Mary's deck of cards", "card deck", members(&[2]))]
#[case::properties("Mary's big red book", "big red book", members(&[2]))]
fn things_and_owners_are_told_apart(#[case] said: &str, #[case] class: &str, #[case] owner: OwnerReference) {
    let read = read(said);
    assert_eq!((read.thing.class.join(" ").as_str(), read.thing.owner), (class, owner), "{read:?}");
    assert_eq!(read.hints, []);
}

#[rstest]
#[case::a_thing("the cup next to the sink", Relation::Near, "sink", EVERYONE)]
#[case::an_owned_thing("the cup by my wife's bed", Relation::Near, "bed", members(&[2]))]
#[case::on("the cup on top of the table", Relation::Above, "table", EVERYONE)]
#[case::over("the cup over the table", Relation::Above, "table", EVERYONE)]
#[case::under("the cup out from under the table", Relation::Below, "table", EVERYONE)]
#[case::a_room("the cup from the living room", Relation::In, "living room", EVERYONE)]
#[case::a_clause("the cup that is in the kitchen", Relation::In, "kitchen", EVERYONE)]
fn places_are_hints(
    #[case] said: &str,
    #[case] relation: Relation,
    #[case] class: &str,
    #[case] owner: OwnerReference,
) {
    let read = read(said);
    assert_eq!((read.thing.class.join(" ").as_str(), read.thing.owner), ("cup", EVERYONE));
    let [hint] = read.hints.as_slice() else { panic!("{read:?}") };
    assert_eq!(
        (hint.relation, hint.anchor.class.join(" ").as_str(), hint.anchor.owner),
        (relation, class, owner)
    );
}

#[test]
fn where_a_thing_is_to_go_is_no_hint() {
    for said in ["put my cup on the table", "bring my cup to the kitchen"] {
        assert_eq!(read(said).hints, [], "{said}");
    }
}

#[test]
fn the_owner_is_asked_for() {
    for said in ["whose cup is this?", "who owns the cup", "Who does the cup belong to?"] {
        let read = read(said);
        assert_eq!((read.purpose, read.thing.class.join(" ").as_str()), (Purpose::Owner, "cup"), "{said}");
    }
    assert_eq!(read("where is the cup").purpose, Purpose::Thing);
}

#[test]
fn an_unknown_speaker_says_my() {
    let pair = roster(&[("Bob", "father"), ("Mary", "mother")]);
    let owner = |said: &str| interpret(&pair, said, None).thing.owner;
    assert_eq!(owner("my cup"), OwnerReference::Speaker);
    assert_eq!(owner("my wife's cup"), OwnerReference::Unknown);
    assert_eq!(owner("our cup"), OwnerReference::Ours(None));
    assert_eq!(owner("Mary's cup"), members(&[1]));
}

#[test]
fn who_lives_alone_owns_what_is_ours() {
    let alone = roster(&[("Bob", "")]);
    assert_eq!(interpret(&alone, "our cup", Some(user(0))).thing.owner, members(&[0]));
}

#[test]
fn behind_a_comma_the_thing_is_told_more_of() {
    let read = read("the book in the kitchen, the red one that is mine");
    assert_eq!((read.thing.class.join(" ").as_str(), read.thing.owner), ("red book", members(&[0])));
    assert_eq!(read.hints.len(), 1);
}
