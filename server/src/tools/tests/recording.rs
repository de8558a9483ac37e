//! Tools that record.

use serde_json::json;

use super::*;
use crate::test_home;

pub(super) fn answer(object: &str, words: &str, ownership: &Value) -> Value {
    json!({"object_id": object, "question": "Whose is it?", "answer": words, "ownership": ownership})
}

pub(super) fn listed(store: &Store, object: &str) -> Value {
    let objects = done(store, "list_objects", json!({}))["objects"].take();
    objects.as_array().unwrap().iter().find(|listed| listed["id"] == object).unwrap().clone()
}

pub(super) fn history(store: &Store, object: &str) -> Vec<String> {
    store
        .read::<_, crate::store::StoreError>(|reader| {
            let household = reader.household()?.unwrap();
            let key = reader.object(object)?.unwrap().key;
            reader.answers(&household, key)
        })
        .unwrap()
        .into_iter()
        .map(|answer| answer.answer)
        .collect()
}

#[test]
fn an_answer_becomes_the_belief() {
    let store = test_home::store();
    let result =
        done(&store, "record_answer", answer("1", "Mine and Tom's.", &json!({"Tom": true, "Bob": true})));
    insta::assert_json_snapshot!(result, @r#"
{
  "object": {
    "id": "1",
    "name": "Marker"
  },
  "owners": [
    "Bob",
    "Tom"
  ],
  "scores": {
    "Bob": 1.0,
    "Mary": 0.0,
    "Tom": 1.0
  },
  "status": "answered"
}
"#);
    let listed = listed(&store, "1");
    assert_eq!(listed["owners"], json!(["Bob", "Tom"]));
    assert_eq!(listed["confidence"], 1.0);
    assert_eq!(listed["settled"], true);
    assert_eq!(listed["source"], "answer");
}

#[test]
fn the_same_answer_twice_is_one_answer() {
    let store = test_home::store();
    let call = answer("1", "Bob's.", &json!({"Bob": true}));
    let first = done(&store, "record_answer", call.clone());
    assert_eq!(done(&store, "record_answer", call), first);
    // Leaving a member out says the same as false.
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true, "Mary": false})));
    assert_eq!(history(&store, "1"), ["Bob's."]);
}

#[test]
fn a_new_answer_replaces_the_belief_and_the_history_keeps_both() {
    let store = test_home::store();
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    done(&store, "record_answer", answer("1", "No, Mary's!", &json!({"Mary": true})));
    assert_eq!(listed(&store, "1")["owners"], json!(["Mary"]));
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    assert_eq!(listed(&store, "1")["owners"], json!(["Bob"]), "they changed their mind back");
    assert_eq!(history(&store, "1"), ["Bob's.", "No, Mary's!", "Bob's."]);
}

#[test]
fn an_answer_at_another_time_is_another_answer() {
    let store = test_home::store();
    for (as_of, answers) in
        [("2025-01-19T10:00:00", 1), ("2025-01-19T10:00:00", 1), ("2025-01-19T11:00:00", 2)]
    {
        let mut call = answer("1", "Bob's.", &json!({"Bob": true}));
        call["as_of"] = json!(as_of);
        done(&store, "record_answer", call);
        assert_eq!(history(&store, "1").len(), answers);
    }
}

#[test]
fn an_unresolved_answer_is_kept_and_settles_nothing() {
    let store = test_home::store();
    let result = done(&store, "record_answer", answer("1", "No idea.", &json!({})));
    assert_eq!(result["status"], "unresolved");
    assert_eq!(result["owners"], json!([]));
    assert_eq!(listed(&store, "1")["settled"], false);
    assert_eq!(listed(&store, "1").get("source"), None);
    done(&store, "record_answer", answer("1", "Bob's.", &json!({"Bob": true})));
    done(&store, "record_answer", answer("1", "No idea.", &json!({"Bob": false})));
    assert_eq!(listed(&store, "1")["owners"], json!(["Bob"]), "not knowing takes nothing back");
    assert_eq!(history(&store, "1"), ["No idea.", "Bob's.", "No idea."]);
}

#[test]
fn an_owner_outside_the_household_settles_the_thing_without_owners() {
    let store = test_home::store();
    let mut call = answer("1", "A friend's.", &json!({}));
    call["owner_outside_household"] = json!(true);
    let result = done(&store, "record_answer", call);
    assert_eq!(result["status"], "answered");
    assert_eq!(result["owners"], json!([]));
    let listed = listed(&store, "1");
    assert_eq!((&listed["settled"], &listed["owners"]), (&json!(true), &json!([])));
}

#[test]
fn scores_become_the_belief_until_there_is_an_answer() {
    let store = test_home::store();
    let scores = json!({"object_id": "1", "scores": {"Bob": 0.97, "Mary": 0.01, "Tom": 0.01}});
    let inferred = done(&store, "record_scores", scores.clone());
    assert_eq!(inferred["owners"], json!(["Bob"]));
    assert_eq!(listed(&store, "1")["source"], "inferred");
    assert_eq!(listed(&store, "1")["confidence"], inferred["confidence"]);
    done(&store, "record_answer", answer("1", "Mary's.", &json!({"Mary": true})));
    let after = done(&store, "record_scores", scores);
    assert_eq!(after["owners"], json!(["Mary"]), "the answer stays");
    assert_eq!((&after["confidence"], &after["settled"]), (&json!(1.0), &json!(true)));
    assert_eq!(after["prediction_set"], inferred["prediction_set"], "it describes the scores");
    assert_eq!(listed(&store, "1")["owners"], json!(["Mary"]));
    let kept = store
        .read::<_, crate::store::StoreError>(|reader| {
            let key = reader.object("1")?.unwrap().key;
            reader.inference(key)
        })
        .unwrap()
        .unwrap();
    assert_eq!(
        kept.owners.iter().map(coin_schemas::household::UserName::as_str).collect::<Vec<_>>(),
        ["Bob"]
    );
}

#[test]
fn owner_sets_outweigh_what_the_scores_imply() {
    let store = test_home::store();
    let result = done(
        &store,
        "record_scores",
        json!({
            "object_id": "1",
            "scores": {"Bob": 0.9, "Mary": 0.3, "Tom": 0.1},
            "owner_sets": [{"owners": ["Bob", "Mary"], "probability": 0.75}, {"owners": ["Bob"], "probability": 0.25}],
        }),
    );
    assert_eq!(result["owners"], json!(["Bob", "Mary"]));
    assert_eq!(result["confidence"], 0.75);
}

#[test]
fn usage_is_recorded_once_and_what_cannot_be_is_listed() {
    let store = test_home::store();
    let captions = json!({"captions": [
        {"object_id": "2", "caption": "2025-01-19 19:00 Bob takes the Marker"},
        {"object_id": "2", "caption": "2025-01-19 19:00 Bob takes the Marker"},
        {"object_id": "2", "caption": "2025-01-19 19:30 Someone takes the Marker"},
        {"object_id": "7", "caption": "2025-01-19 19:00 Bob takes the Marker"},
        {"object_id": "2", "caption": "yesterday Bob took the Marker"},
        {"object_id": "2", "caption": "2025-02-30 19:00 Bob takes the Marker"},
    ]});
    insta::assert_json_snapshot!(done(&store, "record_usage", captions.clone()), @r#"
{
  "recorded": 2,
  "unattributed": 1,
  "duplicates": 1,
  "rejected": [
    {
      "index": 3,
      "reason": "object_id: there is no object \"7\". list_objects gives all ids."
    },
    {
      "index": 4,
      "reason": "caption: the caption begins with \"yesterday Bob took the M\"; it must begin with a local time, `YYYY-MM-DD HH:MM` or `YYYY-MM-DDTHH:MM:SS`, without a zone, and a space"
    },
    {
      "index": 5,
      "reason": "caption: the time 2025-02-30 19:00 of the caption does not exist; give a day of the calendar and a time from 00:00 to 23:59"
    }
  ]
}
"#);
    let again = done(&store, "record_usage", captions);
    assert_eq!((&again["recorded"], &again["duplicates"]), (&json!(0), &json!(3)));
}

#[test]
fn the_order_of_arrival_does_not_matter() {
    let lines = [
        "2025-01-19 19:00 Bob takes the Marker",
        "2025-01-19 19:00 Mary takes the Marker",
        "2025-01-18 10:00 Bob is using the Marker",
        "2025-01-19 19:10 Bob returns the Marker",
    ];
    let summary = |lines: &mut dyn Iterator<Item = &str>| {
        let store = test_home::store();
        for line in lines {
            done(&store, "record_usage", json!({"captions": [{"object_id": "2", "caption": line}]}));
        }
        done(&store, "get_usage_summary", json!({"object_id": "2"}))
    };
    assert_eq!(summary(&mut lines.into_iter()), summary(&mut lines.into_iter().rev()));
}

#[test]
fn recorded_events_move_the_present_of_a_recording_forward() {
    let store = test_home::store();
    let as_of = |store: &Store| done(store, "get_usage_summary", json!({"object_id": "1"}))["as_of"].clone();
    let record = |caption: &str| {
        done(&store, "record_usage", json!({"captions": [{"object_id": "2", "caption": caption}]}))
    };
    assert_eq!(as_of(&store), "2025-01-19T23:00:00");
    record("2025-01-18 08:00 Bob takes the Marker");
    assert_eq!(as_of(&store), "2025-01-19T23:00:00", "the past moves nothing");
    record("2025-01-20 09:00 Bob takes the Marker");
    assert_eq!(as_of(&store), "2025-01-20T09:00:00");
    let users = done(&store, "get_usage_summary", json!({"object_id": "1"}))["user_summary"].take();
    assert_eq!(users[2]["user_id"], "Tom", "what the recording held for later has come to pass");
}

#[test]
fn too_many_captions_are_refused_together() {
    let store = test_home::store();
    let line = json!({"object_id": "2", "caption": "2025-01-19 19:00 Bob takes the Marker"});
    let captions = vec![line; coin_schemas::tools::MAX_CAPTIONS + 1];
    insta::assert_snapshot!(refused(&store, "record_usage", json!({"captions": captions})), @"captions: 100001 are given; at most 100000 are allowed in a call");
}
