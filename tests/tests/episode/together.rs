//! One question about several alike things, and one that confirms an answer.

use coin_tests::EpisodeBuilder;
use serde_json::{Value, json};

/// Four pencils in a study, which Tom has used twice each, and six things that everybody keeps to themselves. The last
/// pencil is this person's.
fn study(last: &str) -> EpisodeBuilder {
    let mut episode = EpisodeBuilder::new();
    let mut owners = serde_json::Map::new();
    let mut objects = Vec::new();
    for pencil in 0..4 {
        let id = format!("pencil-{pencil}");
        objects.push(json!({"id": id, "class": "pencil", "position": [2 * pencil, 0, 0.8], "room": "study"}));
        for day in [10, 11] {
            episode = episode.caption(&id, &format!("2025-01-{day} 1{pencil}:00 Tom is using the Pencil"));
        }
        owners.insert(id, json!([if pencil == 3 { last } else { "Tom" }]));
    }
    let kept = [
        ("toothbrush", "Bob"),
        ("apron", "Mary"),
        ("helmet", "Tom"),
        ("diary", "Mary"),
        ("camera", "Bob"),
        ("skateboard", "Tom"),
    ];
    for (place, (class, owner)) in kept.into_iter().enumerate() {
        objects.push(
            json!({"id": class, "class": class, "position": [100 + 9 * place, 0, 0.8], "room": "hall"}),
        );
        for day in 10..19 {
            episode = episode.caption(class, &format!("2025-01-{day} 09:00 {owner} is using the {class}"));
        }
        owners.insert(class.to_owned(), json!([owner]));
    }
    episode = episode.with("/objects", json!(objects));
    episode.truth = Some(json!({"owners": owners}));
    episode
}

fn asked(report: &Value) -> Vec<(&str, usize)> {
    let questions = super::questions(report).iter();
    questions
        .map(|question| {
            let others = question["also"].as_array().map_or(0, Vec::len);
            (question["question"].as_str().unwrap(), 1 + others)
        })
        .collect()
}

#[test]
fn pencils_that_are_all_toms_take_one_question() {
    let report = super::report(study("Tom").write().path(), &[]);
    assert_eq!(asked(&report), [("Is every pencil in the study Tom's?", 4)]);
    assert_eq!(report["metrics"]["overall"]["subset_accuracy"], 1.0);
    assert_eq!(report["metrics"]["questions"], 1);
    let answered = |object: &&Value| object["source"] == "answer";
    assert_eq!(report["objects"].as_array().unwrap().iter().filter(answered).count(), 4);
}

/// Tom's use speaks for Tom also where a pencil is Mary's, so that her answer is confirmed.
#[test]
fn one_that_is_marys_takes_a_question_for_each_and_a_confirmation() {
    let report = super::report(study("Mary").write().path(), &[]);
    let asked = asked(&report);
    assert_eq!(asked[0], ("Is every pencil in the study Tom's?", 4));
    assert_eq!(super::questions(&report)[0]["status"], "unresolved");
    assert_eq!(asked.len(), 6);
    let sure = "Just to be sure, as its use tells otherwise: is the pencil in the study really Mary's?";
    assert_eq!(asked[5], (sure, 1));
    assert_eq!(report["metrics"]["overall"]["subset_accuracy"], 1.0);
}

#[test]
fn prepared_answers_are_about_one_thing_each() {
    let folder = study("Tom").write();
    let answers = folder.join("answers.jsonl");
    let lines: Vec<String> = (0..4)
        .map(|pencil| json!({"object_id": format!("pencil-{pencil}"), "answer": "Tom's."}).to_string())
        .collect();
    std::fs::write(&answers, lines.join("\n")).unwrap();
    let report = super::report(folder.path(), &["--answers", answers.to_str().unwrap()]);
    assert!(asked(&report).iter().all(|(_, things)| *things == 1));
    assert_eq!(report["metrics"]["overall"]["subset_accuracy"], 1.0);
}

#[test]
fn a_run_that_goes_on_does_not_ask_them_again() {
    let folder = study("Tom").write();
    let db = folder.join("home.db");
    let with_db = ["--db", db.to_str().unwrap()];
    let first = super::without_seconds(super::report(folder.path(), &with_db));
    let again = super::report(folder.path(), &[&with_db[..], &["--resume"]].concat());
    assert_eq!(super::without_seconds(again)["questions"], first["questions"]);
    let anew = super::report(folder.path(), &with_db);
    assert_eq!(super::questions(&anew).len(), 0, "the database knows all four answers");
}

/// Whose a thing is was said twice, and the second time taken back: the first answer is in the database again.
#[test]
fn a_confirmation_that_is_taken_back_leaves_the_answer() {
    let folder = study("Mary").write();
    let db = folder.join("home.db");
    // Not all together: two are Tom's, two are Mary's. The first of hers turns out to be Tom's, which is taken back where the
    // second is to be confirmed, and that ends it.
    let typed = "They are not all the same people's\nTom\nTom\nMary\nMary\nTom\nundo\nstop\n";
    let finished =
        super::host(folder.path(), &["--answers", "terminal", "--db", db.to_str().unwrap(), "--json"])
            .input(typed)
            .run()
            .expect_code(0);
    assert!(finished.stderr.contains("is taken back"), "{}", finished.stderr);
    let anew = super::report(folder.path(), &["--db", db.to_str().unwrap(), "--gate", "never"]);
    let pencils = anew["objects"].as_array().unwrap().iter().filter(|object| object["class"] == "pencil");
    let answered: Vec<&Value> = pencils.filter(|object| object["source"] == "answer").collect();
    assert_eq!(answered.len(), 4, "{answered:#?}");
    assert_eq!(answered.iter().filter(|object| object["owners"] == json!(["Mary"])).count(), 2);
}
