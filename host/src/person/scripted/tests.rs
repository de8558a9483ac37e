use coin_schemas::household::{Background, ClassLabel, Position};
use coin_schemas::model::TaskObject;
use rstest::rstest;
use tempfile::NamedTempFile;

use super::*;

fn objects() -> BTreeSet<ObjectId> {
    ["12", "3", "5", "7"].map(|id| ObjectId::new(id).unwrap()).into()
}

fn users() -> Users {
    ["Bob", "Mary"].map(|name| (UserName::new(name).unwrap(), Background::default())).into()
}

fn load(script: &[u8]) -> Result<ScriptedPerson, ScriptError> {
    let file = NamedTempFile::new().unwrap();
    std::fs::write(file.path(), script).unwrap();
    ScriptedPerson::from_file(file.path(), &objects(), &users())
}

async fn ask(person: &mut ScriptedPerson, id: &str) -> Response {
    let object = TaskObject {
        id: ObjectId::new(id).unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([0.0; 3]).unwrap(),
        room: None,
    };
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
    person.ask(&question).await.unwrap()
}

fn said(answer: &str, answered_by: Option<&str>) -> Response {
    Response::Said {
        answer: answer.to_owned(),
        answered_by: answered_by.map(|name| UserName::new(name).unwrap()),
    }
}

#[tokio::test]
async fn says_the_lines_of_a_thing_in_order_and_declines_what_has_none() {
    let mut person = load(
        br#"{"object_id": "3", "answer": "I don't know"}
{"object_id": "5", "declined": true}

{"object_id": "3", "answer": "Mine", "answered_by": "Mary"}
"#,
    )
    .unwrap();
    assert_eq!(person.kind().as_str(), "scripted");
    assert_eq!(ask(&mut person, "3").await, said("I don't know", None));
    assert_eq!(ask(&mut person, "7").await, Response::Declined, "no line is about thing 7");
    assert_eq!(ask(&mut person, "5").await, Response::Declined, "its line says so");
    assert_eq!(ask(&mut person, "5").await, Response::Declined, "no line is left for thing 5");
    assert_eq!(ask(&mut person, "3").await, said("Mine", Some("Mary")));
    assert_eq!(ask(&mut person, "3").await, Response::NobodyLeft, "every line is used");
    assert_eq!(ask(&mut person, "7").await, Response::NobodyLeft);
}

#[rstest]
#[case::empty(b"")]
#[case::white_lines(b"\n  \n\r\n")]
#[tokio::test]
async fn a_file_without_lines_is_nobody(#[case] script: &[u8]) {
    assert_eq!(ask(&mut load(script).unwrap(), "3").await, Response::NobodyLeft);
}

#[tokio::test]
async fn the_last_line_needs_no_end() {
    let mut person = load(br#"{"object_id": "3", "answer": "Bob's"}"#).unwrap();
    assert_eq!(ask(&mut person, "3").await, said("Bob's", None));
}

#[rstest]
#[case::no_json("It's Tom's", "expected value at line 1 column 1; a line is {")]
#[case::a_list("[1]", "invalid type: integer `1`, expected a string at line 1 column 2; a line is {")]
#[case::unknown_key(r#"{"object_id":"3","answer":"Bob","by":"Bob"}"#, "unknown field `by`")]
#[case::key_twice(r#"{"object_id":"3","answer":"Bob","answer":"Mary"}"#, "duplicate field `answer`")]
#[case::no_id(r#"{"answer":"Bob"}"#, "missing field `object_id`")]
#[case::a_number_as_id(r#"{"object_id":3,"answer":"Bob"}"#, "invalid type: integer `3`")]
#[case::unknown_thing(
    r#"{"object_id":"4","answer":"Bob"}"#,
    r#"object_id "4" is not in the episode; it has 3, 5, 7, 12"#
)]
#[case::unknown_person(
    r#"{"object_id":"3","answer":"Mine","answered_by":"mary"}"#,
    r#"answered_by "mary" is not a member of the household; its members are Bob, Mary"#
)]
#[case::empty_answer(r#"{"object_id":"3","answer":" "}"#, r#""answer" is empty"#)]
#[case::neither(r#"{"object_id":"3"}"#, "and this one has neither")]
#[case::both(r#"{"object_id":"3","answer":"Bob","declined":true}"#, "and this one has both")]
#[case::not_declined(r#"{"object_id":"3","declined":false}"#, r#"and this one has "declined": false"#)]
#[case::declined_by(
    r#"{"object_id":"3","declined":true,"answered_by":"Bob"}"#,
    r#""answered_by" belongs to an "answer""#
)]
fn a_bad_line_is_named(#[case] line: &str, #[case] expected: &str) {
    let script = format!("{{\"object_id\":\"3\",\"answer\":\"Bob\"}}\n\n{line}\n");
    let file = NamedTempFile::new().unwrap();
    std::fs::write(file.path(), script).unwrap();
    let error = ScriptedPerson::from_file(file.path(), &objects(), &users()).unwrap_err().to_string();
    let place = format!("{}:3: ", file.path().display());
    assert!(error.starts_with(&place), "{error}");
    assert!(error.contains(expected), "{error}");
}

#[test]
fn a_line_of_ten_megabytes_is_refused_unread() {
    let mut script = br#"{"object_id":"3","answer":""#.to_vec();
    script.resize(10_000_000, b'x');
    let error = load(&script).unwrap_err();
    assert!(matches!(error, ScriptError::Line { line: 1, problem: LineProblem::TooLong, .. }), "{error}");
}

#[test]
fn the_longest_line_is_read() {
    let head = br#"{"object_id":"3","answer":""#;
    let mut script = head.to_vec();
    script.resize(MAX_LINE_BYTES - 2, b'x');
    script.extend(b"\"}\n");
    assert!(load(&script).is_ok());
}

#[test]
fn invalid_utf8_is_refused_with_its_place() {
    let error = load(b"\n{\"object_id\":\"3\",\"answer\":\"\xff\"}").unwrap_err().to_string();
    assert!(error.ends_with(":2: the line is not UTF-8 text (byte 28 is the first that is not)"), "{error}");
}

#[test]
fn a_missing_file_and_a_folder_are_named() {
    let error = ScriptedPerson::from_file("/no/such/answers.jsonl", &objects(), &users()).unwrap_err();
    insta::assert_snapshot!(
        error,
        @"the answers in /no/such/answers.jsonl cannot be read: No such file or directory (os error 2)"
    );
    let folder = tempfile::tempdir().unwrap();
    let error = ScriptedPerson::from_file(folder.path(), &objects(), &users()).unwrap_err().to_string();
    assert!(error.contains("cannot be read: Is a directory"), "{error}");
}

#[test]
fn a_long_list_of_ids_is_cut_short() {
    let ids: Vec<String> = (1..=34).map(|id| id.to_string()).collect();
    assert_eq!(listed(&ids), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10 … (34 in all)");
    assert_eq!(listed(&ids[..10]), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10");
}
