mod households;

use std::io::{self, Cursor};

use coin_schemas::household::{ClassLabel, ObjectId, Position, Score};
use coin_schemas::model::TaskObject;
use rstest::rstest;

use super::*;
use crate::output::Colour;
use crate::person::{Candidate, PreviousAnswer, Understood};

const PLAIN: Style = Style { width: 80, colour: Colour::Never };

fn name(name: &str) -> UserName {
    UserName::new(name).unwrap()
}

fn said(answer: &str) -> Response {
    Response::Said { answer: answer.to_owned(), answered_by: None }
}

fn said_by(answer: &str, speaker: &str) -> Response {
    Response::Said { answer: answer.to_owned(), answered_by: Some(name(speaker)) }
}

fn chose(names: &[&str]) -> Response {
    let owners = names.iter().copied().map(name).collect();
    Response::Chose { owners, owner_outside_household: false, answered_by: None }
}

fn chose_with_somebody_outside(names: &[&str]) -> Response {
    let owners = names.iter().copied().map(name).collect();
    Response::Chose { owners, owner_outside_household: true, answered_by: None }
}

fn pencil() -> TaskObject {
    TaskObject {
        id: ObjectId::new("3").unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([1.0, 2.0, 0.7]).unwrap(),
        room: Some("office".to_owned()),
    }
}

/// A household of which every member is held to be a likelier owner than the next.
fn household(names: &[&str]) -> Vec<Candidate> {
    let scores = (0..names.len()).map(|place| Score::new(0.62 / (1.0 + place as f64 * 3.0)).unwrap());
    names.iter().zip(scores).map(|(member, score)| Candidate { name: name(member), score }).collect()
}

fn marker_is_bobs() -> PreviousAnswer {
    let object = TaskObject { class: ClassLabel::new("marker").unwrap(), ..pencil() };
    let understood = Understood::Named { owners: [name("Bob")].into(), owner_outside_household: false };
    PreviousAnswer { object, understood }
}

/// A question to a household, and how it looks.
struct Dialogue<'a> {
    question: &'a str,
    candidates: Vec<Candidate>,
    before: Option<PreviousAnswer>,
    remaining: Option<usize>,
    style: Style,
}

impl Dialogue<'_> {
    fn with(names: &[&str]) -> Self {
        Self {
            question: "Whose is the pencil on the desk?",
            candidates: household(names),
            before: None,
            remaining: None,
            style: PLAIN,
        }
    }

    /// What the person who types `input` answers, and what the terminal then shows: what is typed stands behind
    /// its prompt.
    async fn typed(&self, input: &[u8]) -> (Response, String) {
        let object = pencil();
        let question = PutQuestion {
            step: 2,
            object: &object,
            also: &[],
            question: self.question,
            candidates: &self.candidates,
            times_asked: 0,
            before: self.before.as_ref(),
            remaining: self.remaining,
        };
        let mut person = TerminalPerson::new(Cursor::new(input.to_vec()), Vec::new(), self.style).unwrap();
        let response = person.ask(&question).await.unwrap();
        let mut typed = input.split(|&byte| byte == b'\n').map(String::from_utf8_lossy);
        let mut seen = String::new();
        for part in String::from_utf8(person.writer).unwrap().split_inclusive("\n  > ") {
            seen.push_str(part);
            if part.ends_with("\n  > ") {
                seen.push_str(&typed.next().filter(|line| line.len() < 100).unwrap_or("(too long)".into()));
                seen.push('\n');
            }
        }
        (response, seen)
    }
}

async fn ask(input: &[u8]) -> (Response, String) {
    Dialogue::with(&["Tom", "Mary", "Bob"]).typed(input).await
}

#[rstest]
#[case("It's Tom's\n", said("It's Tom's"))]
#[case("  It's Tom's  \r\n", said("It's Tom's"))]
#[case("no line end", said("no line end"))]
#[case("I think it's Tom's\n", said("I think it's Tom's"))]
#[case("all 3 of us\n", said("all 3 of us"))]
#[case("not Bob\n", said("not Bob"))]
#[case("Bob?\n", said("Bob?"))]
#[case("Bob or Mary\n", said("Bob or Mary"))]
#[case("Tommy\n", said("Tommy"))]
#[case("1st\n", said("1st"))]
#[case("e.g. Bob's aunt\n", said("e.g. Bob's aunt"))]
#[case("yes\n", said("yes"))]
#[case("Tom and my cousin\nBob\n", said_by("Tom and my cousin", "Bob"))]
#[case("mine\n2\n", said_by("mine", "Mary"))]
#[case("I\n2\n", said_by("I", "Mary"))]
#[case("That is my pencil\nbob\n", said_by("That is my pencil", "Bob"))]
#[case("It belongs to me and Tom\nwho\n1 2\nMary\n", said_by("It belongs to me and Tom", "Mary"))]
#[case("mine\n\n", said("mine"))]
#[case("mine\n?\n", said("mine"))]
#[case("mine", said("mine"))]
#[case("mine\nundo\n2\n", chose(&["Mary"]))]
#[case("mine\nstop\n", Response::Stop)]
#[tokio::test]
async fn words_stay_words(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(ask(typed.as_bytes()).await.0, response);
}

#[rstest]
#[case("2\n", chose(&["Mary"]))]
#[case("1 and 3\n", chose(&["Bob", "Tom"]))]
#[case("3, 1, 3.\n", chose(&["Bob", "Tom"]))]
#[case("1 2 3\n", chose(&["Bob", "Mary", "Tom"]))]
#[case("0\n4\n99999999999999999999\n1 4\n1\n", chose(&["Tom"]))]
#[case("bob\n", chose(&["Bob"]))]
#[case("Bob's.\n", chose(&["Bob"]))]
#[case("TOM’S and mary's\n", chose(&["Mary", "Tom"]))]
#[case("Bob and Mary\n", chose(&["Bob", "Mary"]))]
#[case("1 & bob\n", chose(&["Bob", "Tom"]))]
#[case("\"Bob\", “Mary”\n", chose(&["Bob", "Mary"]))]
#[case("e\n", chose(&["Bob", "Mary", "Tom"]))]
#[case("Everyone!\n", chose(&["Bob", "Mary", "Tom"]))]
#[case("o\n", chose_with_somebody_outside(&[]))]
#[case("Somebody else.\n", chose_with_somebody_outside(&[]))]
#[case("1, o\n", chose_with_somebody_outside(&["Tom"]))]
#[case("\nTom\n", chose(&["Tom"]))]
#[tokio::test]
async fn choices_mean_what_they_say(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(ask(typed.as_bytes()).await.0, response);
}

#[rstest]
#[case("?\n", said("I don't know."))]
#[case("I don’t know\n", said("I don't know."))]
#[case("dunno\n", said("I don't know."))]
#[case("skip\n", Response::Declined)]
#[case("SKIP.\n", Response::Declined)]
#[case("\"skip\"\n", Response::Declined)]
#[case("\n\n", Response::Declined)]
#[case("stop\n", Response::Stop)]
#[case("quit\n", Response::Stop)]
#[case("undo\nhelp\nx\n...\nskip\n", Response::Declined)]
#[case("", Response::NobodyLeft)]
#[case("\n", Response::NobodyLeft)]
#[case("help\n", Response::NobodyLeft)]
#[tokio::test]
async fn commands_are_obeyed(#[case] typed: &str, #[case] response: Response) {
    assert_eq!(ask(typed.as_bytes()).await.0, response);
}

#[tokio::test]
async fn the_last_answer_can_be_taken_back_where_there_is_one() {
    let mut dialogue = Dialogue::with(&["Tom", "Bob"]);
    assert_eq!(dialogue.typed(b"undo\n1\n").await.0, chose(&["Tom"]));
    dialogue.before = Some(marker_is_bobs());
    assert_eq!(dialogue.typed(b"Undo\n1\n").await.0, Response::Undo);
}

#[tokio::test]
async fn shows_the_question_and_the_likeliest_owners_first() {
    insta::assert_snapshot!(ask(b"1 3\n").await.1, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Mary 15 %   3 Bob 8 %
         e everybody   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, stop, help.
    > 1 3
         Noted: Bob and Tom.
    ");
}

#[tokio::test]
async fn shows_what_undo_takes_back_and_how_much_is_left() {
    let mut dialogue = Dialogue::with(&["Tom", "Bob"]);
    dialogue.before = Some(marker_is_bobs());
    dialogue.remaining = Some(5);
    insta::assert_snapshot!(dialogue.typed(b"?\n").await.1, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Bob 15 %
         e both   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, undo, stop, help.
         undo takes back: the marker in the office belongs to Bob.
         After this one, at most 5 more things to ask about.
    > ?
         Noted: you do not know.
    ");
    dialogue.before.as_mut().unwrap().understood = Understood::Nobody;
    dialogue.remaining = Some(0);
    insta::assert_snapshot!(dialogue.typed(b"e\n").await.1, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Bob 15 %
         e both   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, undo, stop, help.
         undo takes back: nobody could say whose the marker in the office is.
         This is the last question.
    > e
         Noted: Bob and Tom.
    ");
}

#[tokio::test]
async fn says_what_was_wrong_and_asks_again() {
    let long = [&vec![b'x'; lines::MAX_LINE_BYTES + 1][..], b"\n\xff\n7\nx\nundo\n\nmine\n5\n\n"].concat();
    let (response, seen) = ask(&long).await;
    assert_eq!(response, said("mine"));
    insta::assert_snapshot!(seen, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Mary 15 %   3 Bob 8 %
         e everybody   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, stop, help.
    > (too long)
         That has more than 10000 bytes; please say it in a sentence.
    > �
         That is not UTF-8 text; please type it again.
    > 7
         The numbers are 1 to 3.
    > x
         That means nothing here. Please give a number, a name or a sentence; help
         says more.
    > undo
         There is no answer yet that could be taken back.
    > 
         Whose is it? Press Enter again to pass it over.
    > mine
         And who are you?
         1 Tom   2 Mary   3 Bob
         Enter leaves it open. undo goes back.
    > 5
         Please give one number or name.
    >
    ");
}

#[tokio::test]
async fn helps() {
    insta::assert_snapshot!(ask(b"help\no\n").await.1, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Mary 15 %   3 Bob 8 %
         e everybody   o somebody outside the household   ? I don't know
         Or your own words. Also: skip, stop, help.
    > help
         1 3   Numbers pick people, one or several. So do names: Tom and Mary.
         e     It belongs to everybody who lives here.
         o     It belongs to somebody who has no number here.
         ?     You do not know; whose it is stays open.
         …     Anything else is read as your own words, such as: It's mine, but
               Tom may use it.
         skip  Passes this question over.
         undo  Takes the answer before back and asks that question again.
         stop  Ends the questions; you can go on another time. So does Ctrl-D.
    > o
         Noted: somebody outside the household.
    ");
}

#[tokio::test]
async fn fits_a_narrow_terminal() {
    let mut dialogue =
        Dialogue::with(&["Tom", "Mary", "Bartholomew Featherstonehaugh-Cholmondeley", "Ann", "Li"]);
    dialogue.before = Some(marker_is_bobs());
    dialogue.remaining = Some(12);
    dialogue.style.width = 40;
    let seen = dialogue.typed(b"help\nmine\nann\n").await.1;
    insta::assert_snapshot!(seen, @"

    Q2   Whose is the pencil on the desk?
         1 Tom 62 %   2 Mary 15 %
         3 Bartholomew Feathersto… 8 %
         4 Ann 6 %   5 Li 4 %
         e everybody
         o somebody outside the household
         ? I don't know
         Or your own words. Also: skip,
         undo, stop, help.
         undo takes back: the marker in
         the office belongs to Bob.
         After this one, at most 12 more
         things to ask about.
    > help
         1 3   Numbers pick people, one or
               several. So do names: Tom
               and Mary.
         e     It belongs to everybody who
               lives here.
         o     It belongs to somebody who
               has no number here.
         ?     You do not know; whose it
               is stays open.
         …     Anything else is read as
               your own words, such as:
               It's mine, but Tom may use
               it.
         skip  Passes this question over.
         undo  Takes the answer before
               back and asks that question
               again.
         stop  Ends the questions; you can
               go on another time. So does
               Ctrl-D.
    > mine
         And who are you?
         1 Tom   2 Mary
         3 Bartholomew Feathersto…   4 Ann
         5 Li
         Enter leaves it open. undo goes
         back.
    > ann
    ");
    assert!(seen.lines().all(|line| console::measure_text_width(line) <= 40), "{seen}");
}

#[tokio::test]
async fn colour_only_repeats_what_the_words_say() {
    let mut dialogue = Dialogue::with(&["Tom", "Mary", "Bob"]);
    dialogue.before = Some(marker_is_bobs());
    let plain = dialogue.typed(b"help\n9\n1\n").await.1;
    dialogue.style.colour = Colour::Always;
    let colourful = dialogue.typed(b"help\n9\n1\n").await.1;
    assert!(!plain.contains('\u{1b}') && colourful.contains('\u{1b}'));
    assert_eq!(console::strip_ansi_codes(&colourful), plain);
}

#[tokio::test]
async fn a_question_cannot_command_the_terminal() {
    let mut dialogue = Dialogue::with(&["Tom\u{202e}"]);
    dialogue.question = "Whose\n\u{1b}[2J is \u{7}it?";
    let (_, seen) = dialogue.typed(b"1\n").await;
    assert!(seen.contains("Whose ␛[2J is ␇it?"), "{seen}");
    assert!(!seen.contains('\u{202e}'), "{seen}");
}

#[tokio::test]
async fn answers_one_question_after_the_other_and_remembers_who_speaks() {
    let object = pencil();
    let candidates = household(&["Tom", "Mary"]);
    let question = PutQuestion {
        step: 1,
        object: &object,
        also: &[],
        question: "Whose?",
        candidates: &candidates,
        times_asked: 0,
        before: None,
        remaining: None,
    };
    let input = Cursor::new("1\nmine\n2\nmy pen\n\nmine\n?\n");
    let mut person = TerminalPerson::new(input, Vec::new(), PLAIN).unwrap();
    assert_eq!(person.ask(&question).await.unwrap(), chose(&["Tom"]));
    assert_eq!(person.ask(&question).await.unwrap(), said_by("mine", "Mary"));
    assert_eq!(person.ask(&question).await.unwrap(), said_by("my pen", "Mary"));
    assert_eq!(person.ask(&question).await.unwrap(), said("mine"));
    assert_eq!(person.ask(&question).await.unwrap(), Response::NobodyLeft);
    assert_eq!(person.kind().as_str(), "terminal");
    let seen = String::from_utf8(person.writer).unwrap();
    assert!(seen.contains("Enter: Mary again."), "{seen}");
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
    let object = pencil();
    let question = PutQuestion {
        step: 1,
        object: &object,
        also: &[],
        question: "Whose?",
        candidates: &[],
        times_asked: 0,
        before: None,
        remaining: None,
    };
    let mut deaf = TerminalPerson::new(BufReader::new(Broken), io::sink(), PLAIN).unwrap();
    insta::assert_snapshot!(
        deaf.ask(&question).await.unwrap_err(),
        @"the answer could not be read from standard input: unplugged"
    );
    let mut dumb = TerminalPerson::new(Cursor::new("Tom\n"), Broken, PLAIN).unwrap();
    insta::assert_snapshot!(
        dumb.ask(&question).await.unwrap_err(),
        @"the question could not be shown at the terminal: unplugged"
    );
}
