//! What a run leaves behind: the report, the event log and the database.

use std::fs;

use coin_tests::{
    EpisodeBuilder, Era, ServerProcess, assert_conforms, fixture, published_schema, small_house,
};
use serde_json::{Value, json};

#[test]
fn the_report_alone_is_on_standard_output_and_satisfies_its_schema() {
    // Without --quiet: the story goes to standard error.
    let finished = super::host(&small_house(), &["--json"]).run().expect_code(0);
    let report = finished.json();
    assert_conforms(&published_schema("report.schema.json"), &report, "the report");
    assert!(!finished.stderr.is_empty());
}

#[test]
fn the_report_is_consistent_in_itself() {
    let report = super::report(&small_house(), &[]);
    let asked = super::questions(&report);
    let curve = report["curve"].as_array().unwrap();
    assert_eq!(curve.len(), asked.len() + 1);
    for (step, point) in curve.iter().enumerate() {
        assert_eq!(point["step"], step);
    }
    let overall = &report["metrics"]["overall"];
    let last = curve.last().unwrap();
    for figure in ["subset_accuracy", "mean_jaccard", "micro_f1"] {
        assert_eq!(last[figure], overall[figure], "{figure}");
    }
    assert_eq!(report["metrics"]["questions"], asked.len());
    let by_type = report["metrics"]["by_usage_type"].as_object().unwrap();
    let judged: u64 = by_type.values().map(|summary| summary["objects"].as_u64().unwrap()).sum();
    assert_eq!(judged, 34);

    for object in report["objects"].as_array().unwrap() {
        let right = object["owners"] == object["truth"];
        let scores = object["scores"].as_object().unwrap();
        assert_eq!(scores.len(), 3);
        if object["source"] == "answer" {
            assert!(right, "a simulated person tells the truth: {object:#}");
            for (user, score) in scores {
                let owns = object["owners"].as_array().unwrap().iter().any(|owner| owner == user);
                assert_eq!(score.as_f64().unwrap(), if owns { 1.0 } else { 0.0 }, "{object:#}");
            }
            assert_eq!(object["confidence"], 1.0);
        }
    }
    let right = report["objects"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|object| object["owners"] == object["truth"])
        .count();
    let accuracy = overall["subset_accuracy"].as_f64().unwrap();
    assert!((accuracy - right as f64 / 34.0).abs() < 1e-12, "{right} of 34 are right, not {accuracy}");
    for (place, question) in asked.iter().enumerate() {
        assert_eq!(question["step"], place + 1);
    }
}

#[test]
fn the_same_run_gives_the_same_report_byte_for_byte() {
    let texts: Vec<String> = (0..3)
        .map(|_| super::host(&small_house(), &["--json", "--quiet"]).run().expect_code(0).stdout)
        .collect();
    let first = super::lines_without_seconds(&texts[0]);
    assert_eq!(first, super::lines_without_seconds(&texts[1]));
    assert_eq!(first, super::lines_without_seconds(&texts[2]));
}

#[test]
fn the_report_file_holds_what_standard_output_shows() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.json");
    let finished = super::host(&fixture("episodes/three-things"), &["--json", "--quiet", "--report"])
        .arg(&file)
        .run()
        .expect_code(0);
    let written: Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
    assert_eq!(written, finished.json());
}

#[test]
fn every_event_satisfies_its_schema_and_the_log_agrees_with_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("events.jsonl");
    let report = super::host(&small_house(), &["--json", "--quiet", "--events"])
        .arg(&file)
        .run()
        .expect_code(0)
        .json();
    let schema = published_schema("log-event.schema.json");
    let events: Vec<Value> = fs::read_to_string(&file)
        .unwrap()
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .inspect(|event| assert_conforms(&schema, event, "an event"))
        .collect();
    let named = |name: &str| events.iter().filter(|event| event["event"] == name).count();
    assert_eq!(events.first().unwrap()["event"], "run_started");
    assert_eq!(events.last().unwrap()["event"], "run_finished");
    assert_eq!(events.last().unwrap()["stopped"], report["stopped"]);
    assert_eq!(named("run_started"), 1);
    assert_eq!(named("run_finished"), 1);
    assert_eq!(named("question_asked"), super::questions(&report).len());
    assert_eq!(named("tool_called"), report["cost"]["tool_calls"].as_u64().unwrap() as usize);
    assert!(named("object_inferred") >= 34);
    assert_eq!(named("inference_failed"), 0);
}

#[test]
fn the_event_log_is_the_same_for_the_same_run() {
    let folder = tempfile::tempdir().unwrap();
    let logs = ["one.jsonl", "two.jsonl"].map(|name| {
        let file = folder.path().join(name);
        super::host(&small_house(), &["--quiet", "--events"]).arg(&file).run().expect_code(0);
        fs::read_to_string(file).unwrap()
    });
    assert_eq!(logs[0], logs[1]);
}

#[test]
fn the_database_keeps_what_was_learnt() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("home.db");
    let db_text = db.to_str().unwrap();
    let episode = EpisodeBuilder::three_things().write();
    let arguments = ["--gate", "always", "--max-questions", "2", "--db", db_text];
    let first = super::report(episode.path(), &arguments);
    assert_eq!(super::questions(&first).len(), 2);

    let mut server = ServerProcess::start(["--db", db_text], Era::Legacy);
    let listed = server.ok("list_objects", json!({}));
    for object in listed["objects"].as_array().unwrap() {
        let id = object["id"].as_str().unwrap();
        let reported = super::object(&first, id);
        assert_eq!(object["owners"], reported["owners"], "{id}");
        assert_eq!(object["source"], reported["source"], "{id}");
    }
    let seen = server.ok("get_usage_summary", json!({"object_id": "1"}));
    assert_eq!(seen["user_summary"][0]["user_id"], "Bob");
    assert_eq!(seen["user_summary"][0]["total_events"], 9);
    drop(server);

    // What was answered is not asked again.
    let second = super::report(episode.path(), &arguments);
    let asked: Vec<&Value> =
        super::questions(&second).iter().map(|question| &question["object_id"]).collect();
    assert_eq!(asked.len(), 1, "one thing was left to ask about");
    assert!(super::questions(&first).iter().all(|question| &question["object_id"] != asked[0]));
    for question in super::questions(&first) {
        let id = question["object_id"].as_str().unwrap();
        assert_eq!(super::object(&second, id)["source"], "answer");
    }
}

#[test]
fn without_a_database_nothing_is_left() {
    let episode = EpisodeBuilder::three_things().write();
    let names = || {
        let mut names: Vec<_> =
            fs::read_dir(episode.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    super::report(episode.path(), &[]);
    assert_eq!(names(), before);
}

#[test]
fn the_truth_reaches_only_the_person_and_the_scorer() {
    let honest = EpisodeBuilder::three_things();
    let mut lying = honest.clone();
    lying.truth = Some(json!({"owners": {"1": ["Tom"], "2": ["Tom"], "3": ["Tom"]}}));
    let mut silent = honest.clone();
    silent.truth = None;
    let concluded = |episode: &EpisodeBuilder| {
        let folder = episode.write();
        let nobody = folder.join("nobody.jsonl");
        fs::write(&nobody, "").unwrap();
        let arguments = ["--gate", "never", "--answers", nobody.to_str().unwrap()];
        let mut objects = super::report(folder.path(), &arguments)["objects"].take();
        for object in objects.as_array_mut().unwrap() {
            object.as_object_mut().unwrap().remove("truth");
        }
        objects
    };
    let expected = concluded(&honest);
    assert_eq!(concluded(&lying), expected);
    assert_eq!(concluded(&silent), expected);
}
