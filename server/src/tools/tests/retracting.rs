//! Taking an answer back.

use serde_json::json;

use super::recording::{answer, history, listed};
use super::*;
use crate::store::StoreError;
use crate::test_home;

fn retract(object: &str) -> Value {
    json!({"object_id": object})
}

/// The words of every answer about a thing, and whether it was taken back.
fn retractions(store: &Store, object: &str) -> Vec<(String, bool)> {
    store
        .read::<_, StoreError>(|reader| {
            let household = reader.household()?.unwrap();
            let key = reader.object(object)?.unwrap().key;
            reader.answers(&household, key)
        })
        .unwrap()
        .into_iter()
        .map(|answer| (answer.answer, answer.retracted_at.is_some()))
        .collect()
}

#[test]
fn a_retracted_answer_is_as_if_it_had_not_been_given() {
    let store = test_home::store();
    let before = listed(&store, "1");
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    insta::assert_json_snapshot!(done(&store, "retract_answer", retract("1")), @r#"
    {
      "object": {
        "id": "1",
        "name": "Marker"
      },
      "owners": [],
      "confidence": 0.0,
      "settled": false
    }
    "#);
    assert_eq!(listed(&store, "1"), before);
}

#[test]
fn the_inference_counts_again_as_it_was_last_handed_in() {
    let store = test_home::store();
    let scores = |bob: f64| json!({"object_id": "1", "scores": {"Bob": bob, "Mary": 0.01, "Tom": 0.01}});
    done(&store, "record_scores", scores(0.5));
    done(&store, "record_answer", answer("1", "Mary's.", &json!({"Mary": true})));
    done(&store, "record_scores", scores(0.97));
    let result = done(&store, "retract_answer", retract("1"));
    assert_eq!((&result["owners"], &result["source"]), (&json!(["Bob"]), &json!("inferred")));
    let listed = listed(&store, "1");
    for field in ["owners", "confidence", "settled", "source"] {
        assert_eq!(listed[field], result[field], "{field}");
    }
    let unanswered = test_home::store();
    let inferred = done(&unanswered, "record_scores", scores(0.97));
    assert_eq!((&result["confidence"], &result["settled"]), (&inferred["confidence"], &inferred["settled"]));
}

#[test]
fn an_older_answer_does_not_count_again_and_the_history_keeps_all() {
    let store = test_home::store();
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    done(&store, "record_answer", answer("1", "Mary's.", &json!({"Mary": true})));
    done(&store, "record_answer", answer("1", "No idea.", &json!({})));
    assert_eq!(done(&store, "retract_answer", retract("1"))["owners"], json!([]));
    let all = [("Bob's.", false), ("Mary's.", true), ("No idea.", false)];
    assert_eq!(retractions(&store, "1"), all.map(|(words, back)| (words.to_owned(), back)));
}

#[test]
fn there_may_be_nothing_to_retract() {
    let store = test_home::store();
    done(&store, "record_scores", json!({"object_id": "1", "scores": {"Bob": 1, "Mary": 0, "Tom": 0}}));
    done(&store, "record_answer", answer("1", "No idea.", &json!({})));
    insta::assert_snapshot!(refused(&store, "retract_answer", retract("1")), @r#"
    object_id: there is no answer to take back: what is believed of object "1" was not said by a person. list_objects tells as source where a belief comes from.
    "#);
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    done(&store, "retract_answer", retract("1"));
    let after = listed(&store, "1");
    refused(&store, "retract_answer", retract("1"));
    assert_eq!(listed(&store, "1"), after);
    assert_eq!(retractions(&store, "1").iter().filter(|(_, back)| *back).count(), 1);
}

#[test]
fn the_same_answer_can_be_given_again_after_it_was_taken_back() {
    let store = test_home::store();
    let call = answer("1", "Bob's.", &json!({"Bob": true}));
    done(&store, "record_answer", call.clone());
    done(&store, "retract_answer", retract("1"));
    done(&store, "record_answer", call.clone());
    done(&store, "record_answer", call);
    assert_eq!(listed(&store, "1")["owners"], json!(["Bob"]));
    assert_eq!(history(&store, "1"), ["Bob's.", "Bob's."]);
}

#[test]
fn neighbours_and_look_alikes_do_not_show_it_any_more() {
    let store = test_home::store();
    let known = |tool: &str, list: &str| done(&store, tool, retract("2"))[list].take();
    let look = || (known("nearby_objects", "nearby_objects"), known("similar_objects", "similar_objects"));
    let before = look();
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    let answered = look();
    assert_ne!(answered.0, before.0);
    assert_ne!(answered.1, before.1);
    done(&store, "retract_answer", retract("1"));
    assert_eq!(look(), before);
}

#[test]
fn other_things_stay_as_they_are() {
    let store = test_home::store();
    for object in ["1", "2"] {
        done(&store, "record_answer", answer(object, "Bob's.", &json!({"Bob": true})));
    }
    done(&store, "retract_answer", retract("1"));
    assert_eq!(listed(&store, "2")["owners"], json!(["Bob"]));
    assert_eq!(listed(&store, "2")["source"], "answer");
}
