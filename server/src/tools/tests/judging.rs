//! `whose_is` and `next_question`: what COIN concludes by itself.

use serde_json::json;

use super::recording::{answer, listed};
use super::*;
use crate::test_home;

fn whose(store: &Store, object: &str) -> Value {
    done(store, "whose_is", json!({"object_id": object}))
}

#[test]
fn a_thing_is_judged_by_what_was_seen() {
    insta::assert_json_snapshot!(whose(&test_home::store(), "1"));
}

#[test]
fn what_a_person_said_counts_most() {
    let store = test_home::store();
    done(&store, "record_answer", answer("1", "It is Tom's.", &json!({"Tom": true})));
    let told = whose(&store, "1");
    assert_eq!(told["owners"], json!(["Tom"]));
    assert_eq!(told["scores"], json!({"Bob": 0.0, "Mary": 0.0, "Tom": 1.0}));
    assert_eq!((&told["confidence"], &told["uncertainty"]), (&json!(1.0), &json!(0.0)));
    assert_eq!((&told["settled"], &told["source"]), (&json!(true), &json!("answer")));
    assert_eq!(told["evidence"]["answer"]["answer"], "It is Tom's.");
    insta::assert_snapshot!(told["explanation"].as_str().unwrap(), @r#"A person said on 2025-01-19 that the marker in the office belongs to Tom. The words were: "It is Tom's.""#);
}

#[test]
fn an_owner_outside_the_household_is_told() {
    let store = test_home::store();
    let mut guest = answer("1", "A guest's.", &json!({}));
    guest["owner_outside_household"] = json!(true);
    done(&store, "record_answer", guest);
    let told = whose(&store, "1");
    assert_eq!((&told["owners"], &told["owner_outside_household"]), (&json!([]), &json!(true)));
    assert_eq!(told["settled"], true);
}

#[test]
fn an_answer_bears_on_the_things_beside_it() {
    let store = test_home::store();
    let before = whose(&store, "2");
    done(&store, "record_answer", answer("cup-a", "Mary's", &json!({"Mary": true})));
    let after = whose(&store, "2");
    assert_eq!(after["evidence"]["neighbours"][0]["id"], "cup-a");
    assert_eq!(after["evidence"]["neighbours"][0]["owners"], json!(["Mary"]));
    assert!(after["scores"]["Mary"].as_f64() > before["scores"]["Mary"].as_f64(), "{before} {after}");
    assert!(after["explanation"].as_str().unwrap().contains("the coffee cup"), "{after}");
}

#[test]
fn scores_of_another_model_count_before_the_evidence() {
    let store = test_home::store();
    let scores = json!({"Bob": 0.0, "Mary": 0.0, "Tom": 0.99});
    done(&store, "record_scores", json!({"object_id": "1", "scores": scores, "model": "a model"}));
    let told = whose(&store, "1");
    assert_eq!(told["owners"], json!(["Tom"]));
    assert_eq!(told["source"], "inferred");
    assert!(told["explanation"].as_str().unwrap().contains("says the model \"a model\""), "{told}");
}

#[test]
fn the_evidence_models_own_recorded_scores_do_not_grow_old() {
    let store = test_home::store();
    let now = whose(&store, "1");
    let scores = json!({"Bob": 0.0, "Mary": 0.0, "Tom": 0.99});
    done(&store, "record_scores", json!({"object_id": "1", "scores": scores, "model": "embedded"}));
    assert_eq!(whose(&store, "1"), now);
}

#[test]
fn the_past_is_judged_by_what_was_known_then() {
    let store = test_home::store();
    done(&store, "record_answer", answer("1", "Tom's", &json!({"Tom": true})));
    let scores = json!({"Bob": 0.0, "Mary": 0.99, "Tom": 0.0});
    done(&store, "record_scores", json!({"object_id": "1", "scores": scores, "model": "a model"}));
    let then = done(&store, "whose_is", json!({"object_id": "1", "as_of": "2025-01-17T12:00:00"}));
    assert_eq!(then["source"], "inferred");
    assert_eq!(then["owners"], json!(["Bob"]));
    let users = then["evidence"]["usage"].as_array().unwrap();
    assert_eq!(users.len(), 1, "{then}");
}

#[test]
fn the_past_does_not_know_what_was_said_later_of_other_things() {
    let store = test_home::store();
    let before = done(&store, "whose_is", json!({"object_id": "2", "as_of": "2025-01-18T00:00:00"}));
    done(&store, "record_answer", answer("cup-a", "Mary's", &json!({"Mary": true})));
    done(&store, "add_user", json!({"name": "Ann"}));
    let after = done(&store, "whose_is", json!({"object_id": "2", "as_of": "2025-01-18T00:00:00"}));
    assert_eq!(after["evidence"]["neighbours"], json!([]));
    assert_eq!(after["confidence"], before["confidence"]);
    assert_eq!(after["scores"]["Ann"], 0.0, "who joined later was no candidate");
    let now = done(&store, "whose_is", json!({"object_id": "2"}));
    assert_eq!(now["evidence"]["neighbours"][0]["owners"], json!(["Mary"]));
}

#[test]
fn an_unknown_thing_is_answered_with_a_near_miss() {
    let message = refused(&test_home::store(), "whose_is", json!({"object_id": "marker"}));
    insta::assert_snapshot!(message, @r#"object_id: there is no object "marker". Of that class are "1", "2". list_objects gives all ids."#);
}

#[test]
fn a_home_without_people_is_refused() {
    let store = Store::open_in_memory().unwrap();
    let message = refused(&store, "next_question", json!({}));
    assert_eq!(message, "nobody lives in this home yet; add its members with add_user, or import an episode");
}

#[test]
fn the_first_question_is_about_what_is_least_sure() {
    insta::assert_json_snapshot!(done(&test_home::store(), "next_question", json!({})));
}

/// Every question of a home, answered by Bob until nothing is worth asking.
#[test]
fn questions_come_to_an_end() {
    let store = test_home::store();
    let mut asked = Vec::new();
    loop {
        let next = done(&store, "next_question", json!({}));
        if next["done"] == true {
            assert_eq!(next["unsettled"], 0);
            break;
        }
        let id = next["object"]["id"].as_str().unwrap().to_owned();
        let said = json!({"object_id": id, "question": next["question"], "answer": "Bob's", "ownership": {"Bob": true}});
        done(&store, "record_answer", said);
        asked.push(id);
        assert!(asked.len() <= 5, "{asked:?}");
    }
    let settled = whose(&store, asked.first().unwrap());
    assert_eq!(settled["source"], "answer");
}

#[test]
fn a_thing_that_nobody_knows_is_asked_about_twice_and_after_the_others() {
    let store = test_home::store();
    let first = done(&store, "next_question", json!({}));
    let id = first["object"]["id"].as_str().unwrap().to_owned();
    let unknown = |words: &str| answer(&id, words, &json!({}));
    done(&store, "record_answer", unknown("No idea."));
    let second = done(&store, "next_question", json!({}));
    assert_ne!(second["object"]["id"], id, "{second}");
    done(&store, "record_answer", unknown("Still no idea."));
    loop {
        let next = done(&store, "next_question", json!({}));
        if next["done"] == true {
            assert_eq!(next["unsettled"], 1, "{next}");
            break;
        }
        let other = next["object"]["id"].as_str().unwrap();
        assert_ne!(other, id);
        done(&store, "record_answer", answer(other, "Bob's", &json!({"Bob": true})));
    }
}

/// Mary says that the key is Tom's; then Bob uses it every day.
#[test]
fn an_answer_that_use_no_longer_fits_is_opened_again() {
    let store = test_home::store();
    done(&store, "record_answer", answer("key", "Tom's", &json!({"Tom": true})));
    let used = |days: std::ops::Range<u32>| {
        let captions = days.map(
            |day| json!({"object_id": "key", "caption": format!("2025-02-{day:02} 08:00 Bob takes the Key")}),
        );
        json!({"captions": captions.collect::<Vec<_>>()})
    };
    done(&store, "record_usage", used(1..4));
    assert_eq!(whose(&store, "key")["source"], "answer", "three days may be a loan");
    done(&store, "record_usage", used(4..12));
    let after = whose(&store, "key");
    assert_eq!(
        (&after["owners"], &after["settled"], &after["source"]),
        (&json!(["Bob"]), &json!(false), &json!("inferred"))
    );
    insta::assert_snapshot!(after["explanation"].as_str().unwrap());
    assert_eq!(listed(&store, "key")["settled"], false);
    let mut proposed = Vec::new();
    while let Some(id) = done(&store, "next_question", json!({}))["object"]["id"].as_str().map(str::to_owned)
    {
        let owner = if id == "key" { "Bob" } else { "Mary" };
        done(&store, "record_answer", answer(&id, "as said", &json!({owner: true})));
        proposed.push(id);
    }
    assert!(proposed.contains(&"key".to_owned()), "{proposed:?}");
    let settled = whose(&store, "key");
    assert_eq!((&settled["owners"], &settled["settled"]), (&json!(["Bob"]), &json!(true)));
    let before = done(&store, "whose_is", json!({"object_id": "key", "as_of": "2025-02-03T00:00:00"}));
    assert_eq!(before["owners"], json!(["Tom"]), "{before}");
}
