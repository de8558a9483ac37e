//! Households of one, of two and of many, and names that are hard to tell.

use rstest::rstest;

use super::*;

#[tokio::test]
async fn a_household_of_one_is_not_asked_about_everybody() {
    let dialogue = Dialogue::with(&["Tom"]);
    insta::assert_snapshot!(dialogue.typed(b"2\nTom\n").await.1, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %
         o somebody outside the household   ? I don't know
         Or your own words. Also: skip, stop, help.
    > 2
         The only number is 1.
    > Tom
         Noted: Tom.
    ");
}

#[tokio::test]
async fn two_may_be_both() {
    let dialogue = Dialogue::with(&["Tom", "Bob"]);
    assert_eq!(dialogue.typed(b"both\n").await.0, chose(&["Bob", "Tom"]));
    assert_eq!(ask(b"both\n").await.0, said("both"), "of three");
}

#[tokio::test]
async fn a_score_that_nobody_gave_is_not_shown() {
    let mut dialogue = Dialogue::with(&["Tom", "Bob"]);
    for candidate in &mut dialogue.candidates {
        candidate.score = Score::ZERO;
    }
    let seen = dialogue.typed(b"1\n").await.1;
    assert!(seen.contains("1 Tom   2 Bob\n"), "{seen}");
}

const TWELVE: [&str; 12] =
    ["Ann", "Bea", "Cid", "Dan", "Eve", "Fay", "Gus", "Hal", "Ida", "Joe", "Kim", "Lea"];

#[tokio::test]
async fn a_household_of_many_numbers_nine_and_shows_the_others_on_demand() {
    let dialogue = Dialogue::with(&TWELVE);
    let (response, seen) = dialogue.typed(b"10\no\n99\n11\n").await;
    assert_eq!(response, chose(&["Kim"]));
    insta::assert_snapshot!(seen, @"

    Q2   Whose is the pencil on the desk?
         1 Ann 62 %   2 Bea 15 %   3 Cid 8 %   4 Dan 6 %   5 Eve 4 %   6 Fay 3 %
         7 Gus 3 %   8 Hal 2 %   9 Ida 2 %
         e everybody   o somebody else   ? I don't know
         Or your own words. Also: skip, stop, help.
    > 10
         The numbers are 1 to 9; o shows who else there is, and every name will
         do.
    > o
         Who is it then?
         10 Joe 2 %   11 Kim 2 %   12 Lea 1 %
         o somebody outside the household
         undo goes back to the question.
    > 99
         The numbers are 1 to 12.
    > 11
         Noted: Kim.
    ");
}

#[rstest]
#[case("lea\n", chose(&["Lea"]))]
#[case("1 o\n12\n", chose(&["Ann", "Lea"]))]
#[case("o\n10 Kim\n", chose(&["Joe", "Kim"]))]
#[case("o\n2\n", chose(&["Bea"]))]
#[case("o\no\n", chose_with_somebody_outside(&[]))]
#[case("1 o\n10, o\n", chose_with_somebody_outside(&["Ann", "Joe"]))]
#[case("joe kim lea o\n", chose_with_somebody_outside(&["Joe", "Kim", "Lea"]))]
#[case("1 o\nundo\n11\n2\n", chose(&["Bea"]))]
#[case("1 o\nthe plumber\n", said("Ann and the plumber"))]
#[case("o\n?\n", said("I don't know."))]
#[case("o\nskip\n", Response::Declined)]
#[case("o\nstop\n", Response::Stop)]
#[case("o\n", Response::NobodyLeft)]
#[tokio::test]
async fn somebody_else_may_be_a_member_without_a_number(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(Dialogue::with(&TWELVE).typed(typed.as_bytes()).await.0, response);
}

/// Names that mean something else here, and names within names.
const ODD: [&str; 9] = ["Skip", "E", "Mary Ann", "mary ann", "Mary", "And", "7", "Me", "J. R."];

#[rstest]
#[case("skip\n", Response::Declined)]
#[case("\"skip\"\n", chose(&["Skip"]))]
#[case("1\n", chose(&["Skip"]))]
#[case("'E' and “and”\n", chose(&["And", "E"]))]
#[case("mary\n", chose(&["Mary"]))]
#[case("Mary Ann\n", chose(&["Mary Ann"]))]
#[case("mary ann's\n", chose(&["mary ann"]))]
#[case("MARY ANN\nmary ann\n", chose(&["mary ann"]))]
#[case("7\n", chose(&["7"]))]
#[case("2\n", chose(&["E"]))]
#[case("\"7\"\n", chose(&["7"]))]
#[case("j. r.\n", chose(&["J. R."]))]
#[case("me\nmary\n", said_by("me", "Mary"))]
#[case("\"Me\"\n", chose(&["Me"]))]
#[tokio::test]
async fn every_member_can_be_named(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(Dialogue::with(&ODD).typed(typed.as_bytes()).await.0, response);
}

#[tokio::test]
async fn names_that_mean_something_else_are_pointed_out() {
    let seen = Dialogue::with(&["Skip", "Tom", "E"]).typed(b"\"E\"\n").await.1;
    insta::assert_snapshot!(seen, @r#"

    Q2   Whose is the pencil on the desk?
         1 Skip 62 %   2 Tom 15 %   3 E 8 %
         e everybody   o somebody outside the household   ? I don't know
         “Skip” in quotation marks is the person.
         “E” in quotation marks is the person.
         Or your own words. Also: skip, stop, help.
    > "E"
         Noted: E.
    "#);
}

#[tokio::test]
async fn names_that_differ_in_capitals_only_are_told_apart() {
    let seen = Dialogue::with(&["Bob", "bob"]).typed(b"BOB\nbob\n").await.1;
    insta::assert_snapshot!(seen, @"

    Q2   Whose is the pencil on the desk?
         1 Bob 62 %   2 bob 15 %
         e both   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, stop, help.
    > BOB
         That may be Bob or bob; please give the number, or the name just so.
    > bob
         Noted: bob.
    ");
}
