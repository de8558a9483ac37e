//! What models write around an answer is passed over, and what they answer is taken as it is or refused.

use std::time::{Duration, Instant};

use coin_schemas::model::{OwnershipReply, ReadingReply};
use proptest::prelude::*;
use rstest::rstest;
use serde_json::{Map, Value, json};

use super::*;

fn bobs_score(text: &str) -> Result<f64, String> {
    let reply = read_json::<OwnershipReply>(text).map_err(|error| error.to_string())?;
    let score = reply.ownership_distribution.get("Bob").copied();
    score.map(coin_schemas::household::Score::value).ok_or_else(|| "no Bob".to_owned())
}

#[rstest]
#[case::clean(r#"{"ownership_distribution": {"Bob": 0.9}}"#)]
#[case::white_space_and_mark("\u{feff}\n  {\"ownership_distribution\": {\"Bob\": 0.9}}\n\n")]
#[case::fence("```\n{\"ownership_distribution\": {\"Bob\": 0.9}}\n```")]
#[case::fence_with_tag("```json\n{\"ownership_distribution\": {\"Bob\": 0.9}}\n```")]
#[case::fence_without_end("```JSON5\r\n{\"ownership_distribution\": {\"Bob\": 0.9}}")]
#[case::prose("Surely Bob's:\n{\"ownership_distribution\": {\"Bob\": 0.9}}\nI hope this helps :-}")]
#[case::last_of_several(
    r#"First {"ownership_distribution": {"Bob": 0.1}}, but no: {"ownership_distribution": {"Bob": 0.9}}"#
)]
#[case::thoughts_then_fence(
    "<think>{\"ownership_distribution\": {\"Bob\": 0.5}}?</think>\n```json\n{\"ownership_distribution\": {\"Bob\": 0.9}}\n```"
)]
#[case::braces_in_prose(r#"With {NAME} as 5" { and { so on: {"ownership_distribution": {"Bob": 0.9}} }{"#)]
#[case::remark_after_it(r#"{"ownership_distribution": {"Bob": 0.9}} {"confidence": "high"} {}"#)]
#[case::trailing_commas(
    "{\"ownership_distribution\": {\"Bob\": 0.9,\n},\n \"owner_sets\": [{\"owners\": [\"Bob\",], \"probability\": 1,}, ] , }"
)]
#[case::braces_in_strings(r#"{"note": "a \" quote, and }{", "ownership_distribution": {"Bob": 0.9}}"#)]
fn what_stands_around_an_object_is_passed_over(#[case] text: &str) {
    assert_eq!(bobs_score(text), Ok(0.9));
}

#[test]
fn commas_in_strings_stay() {
    let text = r#"{"a": ",}", "b": [",]", "\",}"],}"#;
    assert_eq!(read_json::<Value>(text).unwrap(), json!({"a": ",}", "b": [",]", "\",}"]}));
}

#[test]
fn what_is_wrong_is_told_and_not_mended() {
    let told: Vec<String> = [
        "Surely Bob.",
        "",
        r#"["Bob"]"#,
        "```json\n[{\"ownership_distribution\": {\"Bob\": 0.9}}]\n```",
        r#"{"ownership_distribution": {"Bob": NaN}}"#,
        r#"{"ownership_distribution": {"Bob": 90%}}"#,
        r#"{"ownership_distribution": {'Bob': 0.9}}"#,
        r#"{"ownership_distribution": {"Bob": 0.9, , "Tom": 0}}"#,
        r#"{"ownership_distribution": {"Bob": 0.9}"#,
        r#"{"ownership_distribution": {"Bob": "0.9"}}"#,
        r#"{"ownership_distribution": {"Bob": 1.5}}"#,
        r#"{"ownership_distribution": {"Bob": 0.9, "Tom": 0, "Bob": 0.2}}"#,
        r#"{"scores": {"Bob": 0.9}}"#,
        r#"{"result": {"ownership_distribution": {"Bob": 0.9}}}"#,
        r#"{"ownership_distribution": {"Bob": 1e999}}"#,
        "{\"ownership_distribution\": {\"B\u{1b}\": 2}}",
    ]
    .into_iter()
    .map(|text| bobs_score(text).unwrap_err())
    .map(|error| error.replace("the reply is not the JSON that was asked for: ", ""))
    .collect();
    insta::assert_snapshot!(told.join("\n"), @r#"
    it holds no JSON object; answer with one, {"KEY": …}
    it holds no JSON object; answer with one, {"KEY": …}
    it is a list; answer with one JSON object, {"KEY": …}
    it is a list; answer with one JSON object, {"KEY": …}
    ownership_distribution.Bob: expected value; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    ownership_distribution: expected `,` or `}`; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    ownership_distribution: key must be a string; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    ownership_distribution: key must be a string; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    the object that begins with {"ownership_distribution": {"Bob": 0.9} has no end; close every string, bracket and brace
    ownership_distribution.Bob: invalid type: string "0.9", expected a number
    ownership_distribution.Bob: a score lies between 0 and 1, and 1.5 does not
    ownership_distribution: the key "Bob" stands twice; give every key once
    the object: missing field `ownership_distribution`
    the object: missing field `ownership_distribution`
    ownership_distribution.Bob: number out of range; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    ownership_distribution: control character (\u0000-\u001F) found while parsing a string; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % and never NaN, and a comma stands between two entries
    "#);
}

/// A draft that could be read does not stand in for a last word that cannot.
#[rstest]
#[case::no_number(r#"{"ownership_distribution": {"Bob": 90%}}"#)]
#[case::no_score(r#"{"ownership_distribution": {"Bob": 9}}"#)]
#[case::cut_short(r#"{"ownership_distribution": {"Bob": 0.8, "#)]
#[case::contradiction(r#"{"ownership_distribution": {"Bob": 0.8, "Bob": 0.1}}"#)]
fn a_draft_is_no_answer(#[case] last: &str) {
    let text = format!("Perhaps {{\"ownership_distribution\": {{\"Bob\": 0.5}}}}. In the end: {last}");
    assert!(bobs_score(&text).is_err());
}

#[test]
fn a_key_may_stand_in_two_objects() {
    let text = r#"{"a": {"x": 1}, "b": [{"x": 2}, {"x": 3}]}"#;
    assert_eq!(read_json::<Value>(text).unwrap()["b"][1]["x"], 3);
}

#[test]
fn an_error_repeats_no_more_than_an_excerpt() {
    let text = format!(r#"{{"ownership_distribution": {{"{0}": "{0}"}}}}"#, "ä\u{202e}".repeat(10_000));
    let error = bobs_score(&text).unwrap_err();
    assert!(error.len() < 1000 && !error.contains('\u{202e}'), "{error}");
}

#[test]
fn long_replies_are_refused_unread() {
    let text = format!("{}{{}}", " ".repeat(MOST_BYTES));
    let told = "the reply has 1048578 bytes, and at most 1048576 are read; answer briefly";
    assert_eq!(read_json::<Value>(&text).unwrap_err().to_string(), told);
    assert_eq!(read_sentence(&text).unwrap_err().to_string(), told);
}

/// Each of these made a reader that starts anew at every brace take the square of the length.
#[rstest]
#[case("{")]
#[case("{\"")]
#[case("{\"a\":")]
#[case("{\"a\":[")]
#[case("{} ")]
#[case("{\"a\":1,} ")]
#[case("{\"{\":\"")]
#[case(",")]
#[case("{ \t")]
#[case("[{\"a\":1},")]
fn the_longest_texts_are_read_in_time(#[case] piece: &str) {
    let text = piece.repeat(MOST_BYTES / piece.len());
    let start = Instant::now();
    let _ = read_json::<ReadingReply>(&text);
    let _ = read_json::<ReadingReply>(&format!("{{\"a\":[{}]}}", &text[..text.len() - 20]));
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}

fn json_values() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_filter("JSON has none", |number| number.is_finite()).prop_map(Value::from),
        ".*".prop_map(Value::from),
        "[{}\\[\\],:\"\\\\`]*".prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 32, 4, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..4).prop_map(Value::from),
            json_objects(inner).prop_map(Value::from),
        ]
    })
}

fn json_objects(values: impl Strategy<Value = Value>) -> impl Strategy<Value = Map<String, Value>> {
    prop::collection::btree_map(".*", values, 0..4).prop_map(|entries| entries.into_iter().collect())
}

/// Prose with quotes, backslashes and fences, without braces.
fn prose() -> impl Strategy<Value = String> {
    "([a-z \"'\\\\,.\n]|```|```json\n|ä|\u{feff})*"
}

proptest! {
    #[test]
    fn an_object_in_prose_reads_back_identical(
        object in json_objects(json_values()),
        before in prose(),
        after in prose(),
        pretty in any::<bool>(),
    ) {
        let written =
            if pretty { serde_json::to_string_pretty(&object) } else { serde_json::to_string(&object) }.unwrap();
        let read: Map<String, Value> = read_json(&format!("{before}{written}{after}")).unwrap();
        prop_assert_eq!(&read, &object);
        // What was read and written again reads the same.
        prop_assert_eq!(read_json::<Map<String, Value>>(&serde_json::to_string(&read).unwrap()).unwrap(), read);
    }

    #[test]
    fn no_text_is_too_strange(text in "(.|[{}\\[\\],:\"\\\\`?*_>#-]|\n|\"a\":|NaN|Question:)*") {
        let _ = read_json::<Value>(&text);
        let _ = read_json::<OwnershipReply>(&text);
        if let Ok(question) = read_sentence(&text) {
            prop_assert!(question.chars().count() <= MOST_CHARACTERS);
            prop_assert!(!question.chars().any(char::is_control));
            prop_assert_eq!(read_sentence(&question).unwrap(), question);
        }
    }

    #[test]
    fn a_plain_question_stays_as_it_is(text in "[A-Z][a-z]{1,9}( [a-z']{1,9}){0,20}\\?") {
        prop_assert_eq!(read_sentence(&text).unwrap(), text);
    }
}

#[rstest]
#[case::clean("Is the red mug Bob's?")]
#[case::white_space("\u{feff} Is the  red\tmug Bob's?\n")]
#[case::fence("```\nIs the red mug Bob's?\n```")]
#[case::fence_with_tag("```text\nIs the red mug Bob's?\n```")]
#[case::fence_in_line("```Is the red mug Bob's?```")]
#[case::quotes("\"Is the red mug Bob's?\"")]
#[case::single_quotes("'Is the red mug Bob's?'")]
#[case::curly_quotes("“Is the red mug Bob's?”")]
#[case::label("Question: Is the red mug Bob's?")]
#[case::marked_label("**QUESTION:** \"Is the red mug Bob's?\"")]
#[case::emphasis("*Is* the **red** __mug__ _Bob's_?")]
#[case::all_at_once("```\n**Question:** \"Is the `red mug` *Bob's*?\"\n```")]
#[case::heading("# Is the red mug Bob's?")]
fn what_stands_around_a_question_is_taken_off(#[case] text: &str) {
    assert_eq!(read_sentence(text).unwrap(), "Is the red mug Bob's?");
}

#[rstest]
#[case("Is it \"Bob\" or \"Mary\"?")]
#[case("Whose is mug_2_b, or 5 * 3 * 2?")]
#[case("Is it <Bob's>, R&D's, or somebody else's?")]
#[case("¿De quién es la taza?")]
#[case("これは誰のカップですか？")]
fn what_belongs_to_a_question_stays(#[case] text: &str) {
    assert_eq!(read_sentence(text).unwrap(), text);
}

#[test]
fn what_is_no_question_is_told() {
    let told: Vec<String> = [
        "",
        "```\n```",
        "Here is a question:\n\nWhose is the mug?",
        "Whose is the mug?\nBob's?",
        "{\"question\": \"Whose is the mug?\"}",
        "```json\n[\n\"Whose?\"\n]\n```",
        "Whose is the \u{7}mug?",
        "Whose is the \u{202e}gum?",
        "Tell me whose the mug is.",
        &format!("Whose is the {} mug?", "very ".repeat(100)),
        &format!("Whose is the {} mug?", "very ".repeat(1000)),
    ]
    .into_iter()
    .map(|text| read_sentence(text).unwrap_err().to_string())
    .map(|error| error.replace("the reply is not the one question that was asked for: ", ""))
    .collect();
    insta::assert_snapshot!(told.join("\n"), @r#"
    it is empty; answer with the question
    it is empty; answer with the question
    it has 2 lines; answer with the question alone, in one line, without a word before or after it
    it has 2 lines; answer with the question alone, in one line, without a word before or after it
    it is JSON; answer with the question in plain words
    it is JSON; answer with the question in plain words
    it holds the control character U+0007; use plain text
    it holds the control character U+202E; use plain text
    it ends with "me whose the mug is."; end with a question mark
    it has 517 characters, and at most 300 are allowed; ask one short question
    it has 5018 characters, and at most 300 are allowed; ask one short question
    "#);
}

/// The embedded model's own questions can be read, whatever the thing.
#[test]
fn the_embedded_models_questions_are_read_as_they_are() {
    use coin::dialogue::{QuestionContext, word_question};
    let users = serde_json::from_value(json!({"Bob": {}, "Mary": {}, "Tom": {}})).unwrap();
    let roster = coin::roster::Roster::new(&users).unwrap();
    for class in ["mug", "reading glasses", "mug_2"] {
        for scores in [[0.9, 0.1, 0.1], [0.5, 0.5, 0.1], [0.9, 0.9, 0.9], [0.0, 0.0, 0.0]] {
            for times_asked in 0..3 {
                let scores = scores.map(|score| coin_schemas::household::Score::new(score).unwrap());
                let question = word_question(&QuestionContext {
                    roster: &roster,
                    class,
                    room: Some("living_room"),
                    position: [0.0; 3],
                    scores: &scores,
                    times_asked,
                });
                assert_eq!(read_sentence(&question).unwrap(), question);
            }
        }
    }
}
