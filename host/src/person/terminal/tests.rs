use std::io::{self, Cursor};

use coin_schemas::household::{ClassLabel, ObjectId, Position};
use coin_schemas::model::TaskObject;
use rstest::rstest;

use super::*;

fn names(names: &[&str]) -> Vec<UserName> {
    names.iter().map(|name| UserName::new(*name).unwrap()).collect()
}

fn said(answer: &str) -> Response {
    Response::Said { answer: answer.to_owned(), answered_by: None }
}

fn said_by(answer: &str, name: &str) -> Response {
    Response::Said { answer: answer.to_owned(), answered_by: Some(UserName::new(name).unwrap()) }
}

/// What the person who types `input` says, and what they saw.
async fn ask_with(question: &str, input: &[u8]) -> (Response, String) {
    let object = TaskObject {
        id: ObjectId::new("3").unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([1.0, 2.0, 0.7]).unwrap(),
        room: None,
    };
    let candidates = names(&["Tom", "Mary", "Bob"]);
    let question =
        PutQuestion { step: 2, object: &object, question, candidates: &candidates, times_asked: 0 };
    let mut person = TerminalPerson::new(Cursor::new(input.to_vec()), Vec::new()).unwrap();
    let response = person.ask(&question).await.unwrap();
    (response, String::from_utf8(person.writer).unwrap())
}

async fn ask(input: &[u8]) -> (Response, String) {
    ask_with("Whose is the pencil on the desk?", input).await
}

#[rstest]
#[case("It's Tom's\n", said("It's Tom's"))]
#[case("  It's Tom's  \r\n", said("It's Tom's"))]
#[case("no line end", said("no line end"))]
#[case("I don't know\n", said("I don't know"))]
#[case("I think it's Tom's\n", said("I think it's Tom's"))]
#[case("2\n", said("Mary"))]
#[case("1 and 3\n", said("Tom and Bob"))]
#[case("3, 1, 3.\n", said("Bob and Tom"))]
#[case("1 2 3\n", said("Tom and Mary and Bob"))]
#[case("all 3 of us\n", said("all 3 of us"))]
#[case("0\n4\n99999999999999999999\n1\n", said("Tom"))]
#[case("skip\n", Response::Declined)]
#[case("SKIP\n", Response::Declined)]
#[case("\n\n", Response::Declined)]
#[case("\nTom\n", said("Tom"))]
#[case("", Response::NobodyLeft)]
#[case("\n", Response::NobodyLeft)]
#[case("mine\n2\n", said_by("mine", "Mary"))]
#[case("That is my pencil\nbob\n", said_by("That is my pencil", "Bob"))]
#[case("It belongs to me and Tom\nwho\n1 2\nMary\n", said_by("It belongs to me and Tom", "Mary"))]
#[case("mine\n\n", said("mine"))]
#[case("mine", said("mine"))]
#[tokio::test]
async fn takes_what_is_typed(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(ask(typed.as_bytes()).await.0, response);
}

#[tokio::test]
async fn shows_the_question_and_the_likeliest_owners_first() {
    insta::assert_snapshot!(ask(b"1\n").await.1, @r#"

      Q2   Whose is the pencil on the desk?
           1 Tom   2 Mary   3 Bob
           A number, or your own words; "skip" passes it over.
      >
    "#);
}

#[tokio::test]
async fn says_what_was_wrong_and_asks_again() {
    let long = [&vec![b'x'; lines::MAX_LINE_BYTES + 1][..], b"\n\xff\n7\n\nmine\n5\n\n"].concat();
    let (response, seen) = ask(&long).await;
    assert_eq!(response, said("mine"));
    insta::assert_snapshot!(seen, @r#"

      Q2   Whose is the pencil on the desk?
           1 Tom   2 Mary   3 Bob
           A number, or your own words; "skip" passes it over.
      >        That has more than 10000 bytes; please say it in a sentence.
      >        That is not UTF-8 text; please type it again.
      >        The choices are 1 to 3.
      >        Whose is it? Press Enter again to pass it over.
      >        And who are you?  1 Tom   2 Mary   3 Bob  (Enter leaves it open)
      >        Please give one number or name.
      >
    "#);
}

#[tokio::test]
async fn a_question_cannot_command_the_terminal() {
    let (_, seen) = ask_with("Whose\n\u{1b}[2J is \u{7}it?", b"1\n").await;
    assert!(seen.contains("Whose ␛[2J is ␇it?"), "{seen}");
}

#[tokio::test]
async fn answers_one_question_after_the_other() {
    let object = TaskObject {
        id: ObjectId::new("3").unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([0.0; 3]).unwrap(),
        room: None,
    };
    let candidates = names(&["Tom", "Mary"]);
    let question =
        PutQuestion { step: 1, object: &object, question: "Whose?", candidates: &candidates, times_asked: 0 };
    let mut person = TerminalPerson::new(Cursor::new("1\n2\n"), io::sink()).unwrap();
    assert_eq!(person.ask(&question).await.unwrap(), said("Tom"));
    assert_eq!(person.ask(&question).await.unwrap(), said("Mary"));
    assert_eq!(person.ask(&question).await.unwrap(), Response::NobodyLeft);
    assert_eq!(person.kind().as_str(), "terminal");
}

#[tokio::test]
async fn a_household_of_many_offers_nine_and_takes_any_name() {
    let many: Vec<UserName> = (1..=12).map(|number| UserName::new(format!("P{number}")).unwrap()).collect();
    assert_eq!(choose("9", &many[..MOST_CHOICES]), Choice::Of(vec![many[8].clone()]));
    assert_eq!(choose("10", &many[..MOST_CHOICES]), Choice::OutOfRange);
    assert_eq!(choose("P10", &many[..MOST_CHOICES]), Choice::OwnWords);
}

struct Broken;

impl io::Read for Broken {
    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        Err(io::Error::other("unplugged"))
    }
}

impl Write for Broken {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::Error::other("unplugged"))
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[tokio::test]
async fn a_broken_way_to_the_person_is_an_error() {
    let object = TaskObject {
        id: ObjectId::new("3").unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([0.0; 3]).unwrap(),
        room: None,
    };
    let question =
        PutQuestion { step: 1, object: &object, question: "Whose?", candidates: &[], times_asked: 0 };
    let mut deaf = TerminalPerson::new(BufReader::new(Broken), io::sink()).unwrap();
    insta::assert_snapshot!(
        deaf.ask(&question).await.unwrap_err(),
        @"the answer could not be read from standard input: unplugged"
    );
    let mut dumb = TerminalPerson::new(Cursor::new("Tom\n"), Broken).unwrap();
    insta::assert_snapshot!(
        dumb.ask(&question).await.unwrap_err(),
        @"the question could not be shown at the terminal: unplugged"
    );
}
