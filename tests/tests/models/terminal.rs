//! Somebody at the terminal who makes a mistake, stops, and goes on another day.

use coin_tests::{Era, Program, ServerProcess, small_house};
use serde_json::{Value, json};
use tempfile::TempDir;

/// `host` in small-house with the database of this folder, which hears these lines.
fn sitting(folder: &TempDir, lines: &str, arguments: &[&str]) -> (Value, String) {
    let finished = Program::new("host")
        .arg("--episode")
        .arg(small_house())
        .args(["--gate", "always", "--answers", "terminal", "--json", "--db"])
        .arg(folder.path().join("home.db"))
        .args(arguments)
        .input(lines)
        .run()
        .expect_code(0);
    (finished.json(), finished.stderr)
}

fn answers(report: &Value) -> Vec<(&str, &str, Vec<&str>)> {
    let questions = report["questions"].as_array().unwrap().iter();
    questions
        .map(|question| {
            let owners = question["ownership"].as_object().unwrap().iter();
            (
                question["object_id"].as_str().unwrap(),
                question["answer"].as_str().unwrap(),
                owners.filter(|(_, owner)| **owner == true).map(|(name, _)| name.as_str()).collect(),
            )
        })
        .collect()
}

#[test]
fn an_answer_is_taken_back_and_the_rest_comes_another_day() {
    let folder = TempDir::new().unwrap();
    let (first, told) = sitting(&folder, "Bob\nundo\nMary and Tom\nskip\nstop\n", &[]);
    assert_eq!(first["stopped"], "interrupted");
    let given = answers(&first);
    assert_eq!(given.len(), 2);
    assert_eq!((given[0].1, &given[0].2), ("Mary and Tom", &vec!["Mary", "Tom"]));
    assert_eq!((given[1].1, given[1].2.len()), ("", 0), "passed over");
    assert!(told.contains("The answer to Q1 is taken back.") && told.contains("--resume"), "{told}");

    let (second, told) =
        sitting(&folder, "I don't know\nall of us\nTom\nTom\nTom\nTom\nTom\n", &["--resume"]);
    let all = answers(&second);
    assert_eq!(all[..2], given[..]);
    assert!(all.len() > 3, "{all:?}");
    assert_eq!(all[2].2, Vec::<&str>::new());
    assert_eq!(all[3].2, ["Bob", "Mary", "Tom"]);
    let passed_over = all[1].0;
    assert_eq!(all.iter().filter(|(thing, ..)| *thing == passed_over).count(), 1, "nobody is nagged");
    assert!(told.contains("Q1") && told.contains("Mary and Tom"), "{told}");
}

/// What was taken back is not believed any more, nor is what was inferred from it.
#[test]
fn an_answer_that_was_taken_back_leaves_nothing_behind() {
    let folder = TempDir::new().unwrap();
    let (report, told) = sitting(&folder, "Mary and Tom\nundo\nskip\nstop\n", &[]);
    assert!(told.contains("This also changes") || told.contains("taken back"), "{told}");
    let db = folder.path().join("home.db");
    let mut server = ServerProcess::start(["--db".as_ref(), db.as_os_str()], Era::Legacy);
    let listed = server.ok("list_objects", json!({"limit": 500}));
    for object in listed["objects"].as_array().unwrap() {
        assert_eq!(object["source"], "inferred", "{object}");
        let reported = report["objects"].as_array().unwrap();
        let reported = reported.iter().find(|reported| reported["id"] == object["id"]).unwrap();
        // Owner sets that are next to impossible are not stored, and the others are made to sum to 1 once more.
        let difference = object["confidence"].as_f64().unwrap() - reported["confidence"].as_f64().unwrap();
        assert!(difference.abs() < 1e-5, "{object} is reported with {}", reported["confidence"]);
    }
}

/// The run may end between the journal and the database; then the server is told when the run goes on.
#[test]
fn an_answer_that_was_taken_back_right_before_a_crash_is_taken_back() {
    let folder = TempDir::new().unwrap();
    let (report, _) = sitting(&folder, "Bob\nundo\nstop\n", &[]);
    assert_eq!(report["questions"], json!([]));
    let db = folder.path().join("home.db");
    let listed = |id: &str| -> Value {
        let mut server = ServerProcess::start(["--db".as_ref(), db.as_os_str()], Era::Legacy);
        let listed = server.ok("list_objects", json!({"limit": 500}));
        listed["objects"].as_array().unwrap().iter().find(|object| object["id"] == id).unwrap().clone()
    };
    let (another, _) = sitting(&TempDir::new().unwrap(), "Bob\nstop\n", &[]);
    let first_asked = another["questions"][0]["object_id"].as_str().unwrap();
    let mut server = ServerProcess::start(["--db".as_ref(), db.as_os_str()], Era::Legacy);
    let answer =
        json!({"object_id": first_asked, "question": "?", "answer": "Bob", "ownership": {"Bob": true}});
    server.ok("record_answer", answer);
    drop(server);
    assert_eq!(listed(first_asked)["source"], "answer");
    let (resumed, _) = sitting(&folder, "stop\n", &["--resume"]);
    assert_eq!(resumed["questions"], json!([]));
    assert_eq!(listed(first_asked)["source"], "inferred");
}
