//! `add_user`: people who join.

use rstest::rstest;
use serde_json::json;

use super::recording::{answer, history};
use super::*;
use crate::test_home;

fn whose(store: &Store, object: &str) -> Value {
    done(store, "whose_is", json!({"object_id": object}))
}

#[test]
fn a_newcomer_becomes_a_member() {
    let store = test_home::store();
    let result = done(&store, "add_user", json!({"name": " Ann ", "role": "flatmate"}));
    assert_eq!(result["users"][0], json!({"name": "Ann", "role": "flatmate"}));
    assert_eq!(result["users"].as_array().unwrap().len(), 4);
    assert_eq!(result["users"], done(&store, "list_users", json!({}))["users"]);
    assert_eq!(
        done(&store, "add_user", json!({"name": "Ann"})),
        result,
        "the same call again changes nothing"
    );
    let moved = done(&store, "add_user", json!({"name": "Ann", "occupation": "cook"}));
    assert_eq!(moved["users"][0], json!({"name": "Ann", "role": "flatmate", "occupation": "cook"}));
}

#[test]
fn what_is_believed_of_older_things_stays() {
    let store = test_home::store();
    done(&store, "record_answer", answer("2", "Mary's", &json!({"Mary": true})));
    let before = ["1", "2", "cup-a"].map(|object| whose(&store, object));
    let result = done(&store, "add_user", json!({"name": "Ann"}));
    assert_eq!(result["reopened"], json!([]));
    for (object, before) in ["1", "2", "cup-a"].into_iter().zip(before) {
        let after = whose(&store, object);
        assert_eq!(after["owners"], before["owners"]);
        assert_eq!(after["settled"], before["settled"]);
        let (now, then) = (after["confidence"].as_f64().unwrap(), before["confidence"].as_f64().unwrap());
        // What is open is judged among more people, and more people can form more groups.
        assert!((now - then).abs() < 1e-2, "{object}: {now} and {then}");
        assert_eq!(after["scores"]["Ann"], 0.0);
    }
}

#[test]
fn a_thing_that_nobody_has_used_may_be_the_newcomers() {
    let store = test_home::store();
    done(&store, "add_user", json!({"name": "Ann"}));
    assert!(whose(&store, "key")["scores"]["Ann"].as_f64().unwrap() > 0.1);
}

#[test]
fn what_was_seen_of_the_newcomer_before_counts() {
    let store = test_home::store();
    let captions: Vec<Value> = (10..17)
        .map(|day| json!({"object_id": "2", "caption": format!("2025-01-{day} 08:00 Ann takes the Marker")}))
        .collect();
    let recorded = done(&store, "record_usage", json!({"captions": captions}));
    assert_eq!(recorded["unattributed"], 7);
    let result = done(&store, "add_user", json!({"name": "Ann"}));
    assert_eq!(result["attributed_events"], 7);
    let summary = done(&store, "get_usage_summary", json!({"object_id": "2"}));
    assert_eq!(summary["user_summary"][0]["user_id"], "Ann");
    assert_eq!(summary["unattributed_events"], 0);
    assert_eq!(whose(&store, "2")["owners"], json!(["Ann"]));
}

#[test]
fn what_was_everybodys_is_open_again() {
    let store = test_home::store();
    let everybody = json!({"Bob": true, "Mary": true, "Tom": true});
    done(&store, "record_answer", answer("sofa", "Ours.", &everybody));
    done(&store, "record_answer", answer("2", "Bob's and Mary's", &json!({"Bob": true, "Mary": true})));
    let result = done(&store, "add_user", json!({"name": "Ann"}));
    assert_eq!(result["reopened"], json!([{"id": "sofa", "name": "Sofa"}]));
    assert_eq!(whose(&store, "sofa")["source"], "inferred");
    assert_eq!(whose(&store, "2")["source"], "answer");
    assert_eq!(history(&store, "sofa"), ["Ours."], "the history keeps the answer");
    let again = json!({"Ann": true, "Bob": true, "Mary": true, "Tom": true});
    done(&store, "record_answer", answer("sofa", "Ours.", &again));
    assert_eq!(whose(&store, "sofa")["owners"], json!(["Ann", "Bob", "Mary", "Tom"]));
}

#[test]
fn a_models_word_that_a_thing_is_everybodys_is_open_again() {
    let store = test_home::store();
    let sets = json!([{"owners": ["Bob", "Mary", "Tom"], "probability": 1.0}]);
    let scores = json!({"Bob": 1.0, "Mary": 1.0, "Tom": 1.0});
    done(&store, "record_scores", json!({"object_id": "sofa", "scores": scores, "owner_sets": sets}));
    let settled = |store: &Store| super::recording::listed(store, "sofa")["settled"].clone();
    assert_eq!(settled(&store), true);
    done(&store, "add_user", json!({"name": "Ann"}));
    assert_eq!(settled(&store), false);
    assert_eq!(whose(&store, "sofa")["settled"], false);
}

#[test]
fn what_a_person_said_is_not_opened_by_what_a_model_said_before() {
    let store = test_home::store();
    let sets = json!([{"owners": ["Bob", "Mary", "Tom"], "probability": 1.0}]);
    let scores = json!({"Bob": 1.0, "Mary": 1.0, "Tom": 1.0});
    done(&store, "record_scores", json!({"object_id": "sofa", "scores": scores, "owner_sets": sets}));
    done(&store, "record_answer", answer("sofa", "Bob's", &json!({"Bob": true})));
    assert_eq!(done(&store, "add_user", json!({"name": "Ann"}))["reopened"], json!([]));
    assert_eq!(whose(&store, "sofa")["settled"], true);
}

#[test]
fn an_empty_home_takes_its_first_members() {
    let store = Store::open_in_memory().unwrap();
    done(&store, "add_user", json!({"name": "Bob"}));
    let result = done(&store, "add_user", json!({"name": "Mary", "role": "mother"}));
    assert_eq!(result["users"].as_array().unwrap().len(), 2);
    let founders = store
        .read(|reader| {
            Ok::<_, crate::store::StoreError>(reader.household()?.unwrap().newcomers_after(i64::MIN))
        })
        .unwrap();
    assert!(founders.is_empty(), "who was there before anything was seen is no newcomer");
}

#[rstest]
#[case(json!({"name": ""}), "name: ")]
#[case(json!({"name": "Ann\u{7}"}), "name: ")]
#[case(json!({"name": "Ann", "role": "a\nb"}), "role: it holds a control character")]
#[case(json!({"name": "Ann", "occupation": "x".repeat(300)}), "occupation: it has 300 bytes")]
#[case(json!({}), "name: it is missing")]
fn wrong_people_are_refused(#[case] arguments: Value, #[case] problem: &str) {
    let store = test_home::store();
    let message = refused(&store, "add_user", arguments);
    assert!(message.contains(problem), "{message}");
    assert_eq!(done(&store, "list_users", json!({}))["users"].as_array().unwrap().len(), 3);
}

#[test]
fn a_household_has_a_largest_size() {
    let store = test_home::store();
    for number in 0..61 {
        done(&store, "add_user", json!({"name": format!("user {number}")}));
    }
    let message = refused(&store, "add_user", json!({"name": "one too many"}));
    assert!(message.contains("at most 64 members"), "{message}");
    assert_eq!(done(&store, "list_users", json!({}))["users"].as_array().unwrap().len(), 64);
}
