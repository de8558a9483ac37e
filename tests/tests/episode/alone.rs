//! The server by itself, for hosts that have no loop of their own, comes to what a run of `host` comes to.

use std::collections::BTreeMap;

use coin_tests::{Home, small_house};
use serde_json::{Value, json};

/// Who owns what, by the file that no run reads.
fn truth() -> BTreeMap<String, Value> {
    let text = std::fs::read_to_string(small_house().join("truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&text).unwrap();
    serde_json::from_value(truth["owners"].clone()).unwrap()
}

#[test]
fn next_question_asks_what_a_run_asks_and_comes_to_the_same() {
    let report = super::report(&small_house(), &[]);
    let expected: Vec<(&Value, &Value)> = super::questions(&report)
        .iter()
        .map(|question| (&question["object_id"], &question["question"]))
        .collect();
    let truth = truth();
    let home = Home::import(&small_house());
    let mut server = home.server();
    let mut asked = Vec::new();
    loop {
        assert!(asked.len() <= truth.len(), "it asks for ever: {asked:?}");
        let next = server.ok("next_question", json!({}));
        if next["done"] == true {
            break;
        }
        let id = next["object"]["id"].clone();
        let owners: Vec<&str> = truth[id.as_str().unwrap()]
            .as_array()
            .unwrap()
            .iter()
            .map(|name| name.as_str().unwrap())
            .collect();
        let answered = server.ok("ask_owner", json!({"object_id": id, "owner": owners.join(" and ")}));
        assert_eq!(answered["owners"], json!(owners));
        asked.push((id, next["question"].clone()));
    }
    let asked: Vec<(&Value, &Value)> = asked.iter().map(|(id, question)| (id, question)).collect();
    assert_eq!(asked, expected);
    for (id, owners) in &truth {
        let told = server.ok("whose_is", json!({"object_id": id}));
        assert_eq!((&told["owners"], &told["settled"]), (owners, &json!(true)), "{id}");
    }
}

#[test]
fn whose_is_is_as_sure_as_a_run_that_asks_nobody() {
    let report = super::report(&small_house(), &["--gate", "never"]);
    let home = Home::import(&small_house());
    let mut server = home.server();
    for object in report["objects"].as_array().unwrap() {
        let told = server.ok("whose_is", json!({"object_id": object["id"]}));
        assert_eq!(told["owners"], object["owners"]);
        for field in ["confidence", "uncertainty"] {
            let (alone, run) = (told[field].as_f64().unwrap(), object[field].as_f64().unwrap());
            assert!((alone - run).abs() < 1e-9, "{field} of {}: {alone} and {run}", object["id"]);
        }
        assert_eq!(told["prediction_set"], object["prediction_set"]);
    }
}
