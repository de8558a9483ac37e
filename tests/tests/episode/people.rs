//! Who answers: a file, somebody at the terminal, nobody.

use std::path::PathBuf;

use coin_tests::{EpisodeBuilder, EpisodeFolder, assert_conforms, published_schema};
use rstest::rstest;
use serde_json::{Value, json};

/// Three things, and a file of answers about them.
fn with_answers(lines: &[Value]) -> (EpisodeFolder, PathBuf) {
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let episode = EpisodeBuilder::three_things().file("answers.jsonl", text).write();
    let file = episode.join("answers.jsonl");
    (episode, file)
}

fn scripted(lines: &[Value], more: &[&str]) -> Value {
    let (episode, file) = with_answers(lines);
    let mut arguments = vec!["--gate", "always", "--answers", file.to_str().unwrap()];
    arguments.extend(more);
    super::report(episode.path(), &arguments)
}

#[test]
fn answers_from_a_file_are_read_and_believed() {
    let report = scripted(
        &[
            json!({"object_id": "1", "answer": "It's mine.", "answered_by": "Mary"}),
            json!({"object_id": "2", "answer": "Bob and Tom share it."}),
            json!({"object_id": "3", "answer": "That belongs to all of us."}),
        ],
        &[],
    );
    assert_eq!(report["parameters"]["answers"], "scripted");
    assert_eq!(super::questions(&report).len(), 3);
    for (id, owners) in
        [("1", json!(["Mary"])), ("2", json!(["Bob", "Tom"])), ("3", json!(["Bob", "Mary", "Tom"]))]
    {
        let object = super::object(&report, id);
        assert_eq!(object["owners"], owners, "{id}");
        assert_eq!(object["source"], "answer", "{id}");
    }
    // The truth says otherwise of two of them, and the file's word counts.
    assert_eq!(report["metrics"]["overall"]["subset_accuracy"], json!(1.0 / 3.0));
}

#[test]
fn an_answer_that_names_nobody_is_followed_by_another_question() {
    let report = scripted(
        &[
            json!({"object_id": "1", "answer": "I don't know."}),
            json!({"object_id": "1", "answer": "It is Bob's."}),
            json!({"object_id": "2", "answer": "Mary's"}),
            json!({"object_id": "3", "answer": "everybody's"}),
        ],
        // By default there is one question for each thing; here one thing takes two.
        &["--max-questions", "10"],
    );
    let about_the_marker: Vec<&Value> = super::questions(&report)
        .iter()
        .filter(|question| question["object_id"] == "1")
        .map(|question| &question["status"])
        .collect();
    assert_eq!(about_the_marker, ["unresolved", "answered"]);
    assert_eq!(super::object(&report, "1")["owners"], json!(["Bob"]));
}

#[test]
fn a_declined_question_leaves_the_inference() {
    let report = scripted(
        &[
            json!({"object_id": "1", "declined": true}),
            json!({"object_id": "2", "answer": "Mary's"}),
            json!({"object_id": "3", "answer": "everybody's"}),
        ],
        &["--max-questions", "10"],
    );
    assert_eq!(super::object(&report, "1")["source"], "inferred");
    assert_eq!(super::object(&report, "1")["owners"], json!(["Bob"]));
    assert_eq!(super::object(&report, "2")["source"], "answer");
    assert_eq!(report["stopped"], "nothing_left_to_ask");
}

#[test]
fn an_owner_outside_the_household_is_believed() {
    let report = scripted(&[json!({"object_id": "1", "answer": "It belongs to our neighbour."})], &[]);
    let object = super::object(&report, "1");
    assert_eq!(object["source"], "answer");
    assert_eq!(object["owners"], json!([]));
}

#[rstest]
#[case::no_json("It's mine\n", &["answers.jsonl:1"])]
#[case::unknown_key("{\"object_id\": \"1\", \"reply\": \"mine\"}\n", &["answers.jsonl:1", "reply"])]
#[case::unknown_thing("{\"object_id\": \"9\", \"answer\": \"Bob's\"}\n", &["answers.jsonl:1", "\"9\""])]
#[case::unknown_person("\n{\"object_id\": \"1\", \"answer\": \"mine\", \"answered_by\": \"Zoe\"}\n", &["answers.jsonl:2", "Zoe"])]
#[case::empty("{\"object_id\": \"1\", \"answer\": \"\"}\n", &["answers.jsonl:1", "answer"])]
#[case::both("{\"object_id\": \"1\", \"answer\": \"mine\", \"declined\": true}\n", &["answers.jsonl:1", "declined"])]
fn a_malformed_file_of_answers_is_refused(#[case] text: &str, #[case] parts: &[&str]) {
    let episode = EpisodeBuilder::three_things().file("answers.jsonl", text).write();
    let file = episode.join("answers.jsonl");
    let refused = super::host(episode.path(), &["--answers", file.to_str().unwrap()]).run().expect_code(2);
    refused.expect_stderr(parts);
    assert_eq!(refused.stdout, "");
}

#[test]
fn a_file_of_answers_that_is_not_there_is_refused() {
    let episode = EpisodeBuilder::three_things().write();
    super::host(episode.path(), &["--answers", "nowhere.jsonl"])
        .run()
        .expect_code(2)
        .expect_stderr(&["nowhere.jsonl"]);
}

#[test]
fn somebody_at_the_terminal_answers_in_words() {
    let episode = EpisodeBuilder::three_things().write();
    let finished = super::host(episode.path(), &["--gate", "always", "--answers", "terminal", "--json"])
        .input("Tom owns it\nThat is Tom's\nTom\n")
        .run()
        .expect_code(0);
    let report = finished.json();
    assert_eq!(report["parameters"]["answers"], "terminal");
    for object in report["objects"].as_array().unwrap() {
        assert_eq!(object["owners"], json!(["Tom"]), "{object:#}");
        assert_eq!(object["source"], "answer");
    }
    // The question is put where a person sees it and a program does not stumble over it.
    for question in super::questions(&report) {
        let question = question["question"].as_str().unwrap();
        assert!(finished.stderr.contains(question), "{question:?} was put: {}", finished.stderr);
    }
}

#[test]
fn mine_has_a_meaning_once_it_is_known_who_speaks() {
    let episode = EpisodeBuilder::three_things().write();
    let report = super::host(
        episode.path(),
        &["--gate", "always", "--max-questions", "1", "--answers", "terminal", "--json"],
    )
    .input("It's mine\nMary\n")
    .run()
    .expect_code(0)
    .json();
    assert_eq!(super::questions(&report)[0]["ownership"]["Mary"], true);
    assert_eq!(super::questions(&report)[0]["ownership"]["Bob"], false);
}

#[test]
fn questions_can_be_passed_over_and_end_with_the_input() {
    let episode = EpisodeBuilder::three_things().write();
    let report = super::host(episode.path(), &["--gate", "always", "--answers", "terminal", "--json"])
        .input("skip\nTom\n")
        .run()
        .expect_code(0)
        .json();
    let objects = report["objects"].as_array().unwrap();
    assert_eq!(objects.iter().filter(|object| object["source"] == "answer").count(), 1);
    assert_eq!(report["stopped"], "nothing_left_to_ask");
}

#[test]
fn a_number_chooses_a_person() {
    let episode = EpisodeBuilder::three_things().write();
    let report = super::host(
        episode.path(),
        &["--gate", "always", "--max-questions", "1", "--answers", "terminal", "--json"],
    )
    .input("1\n")
    .run()
    .expect_code(0)
    .json();
    let ownership = super::questions(&report)[0]["ownership"].as_object().unwrap();
    assert_eq!(ownership.values().filter(|owns| **owns == json!(true)).count(), 1, "{ownership:?}");
}

/// Three things whose owners nobody ever wrote down.
fn without_truth() -> EpisodeBuilder {
    let mut episode = EpisodeBuilder::three_things();
    episode.truth = None;
    episode
}

#[test]
fn without_truth_nothing_is_judged() {
    let episode =
        without_truth().file("answers.jsonl", "{\"object_id\": \"3\", \"answer\": \"ours\"}\n").write();
    let file = episode.join("answers.jsonl");
    let arguments = ["--gate", "always", "--answers", file.to_str().unwrap()];
    let report = super::report(episode.path(), &arguments);
    assert_conforms(&published_schema("report.schema.json"), &report, "the report");
    assert!(report.get("curve").is_none());
    let figures = report["metrics"].as_object().unwrap();
    assert_eq!(figures.keys().collect::<Vec<_>>(), ["questions"]);
    assert!(report["objects"].as_array().unwrap().iter().all(|object| object.get("truth").is_none()));
    let text = super::host(episode.path(), &arguments).run().expect_code(0).stdout;
    assert!(!text.contains("accuracy"), "{text}");
}

#[test]
fn without_truth_nobody_can_be_simulated() {
    super::host(without_truth().write().path(), &[])
        .run()
        .expect_code(2)
        .expect_stderr(&["truth", "--answers terminal"]);
}
