//! Tools that look.

use serde_json::json;

use super::*;
use crate::test_home;

#[test]
fn a_usage_summary_counts_up_to_the_present_of_the_recording() {
    let store = test_home::store();
    insta::assert_json_snapshot!(done(&store, "get_usage_summary", json!({"object_id": "1", "max_examples": 2})), @r#"
{
  "object": {
    "id": "1",
    "name": "Marker"
  },
  "as_of": "2025-01-19T23:00:00",
  "window_days": 365,
  "user_summary": [
    {
      "user_id": "Bob",
      "total_events": 3,
      "sessions": 2,
      "actions": {
        "take": 1,
        "use": 2
      },
      "last_used_days_ago": 0.2,
      "example_events": [
        "2025-01-17 08:05 Bob is using the Marker",
        "2025-01-19 19:00 Bob is using the Marker"
      ]
    },
    {
      "user_id": "Mary",
      "total_events": 1,
      "sessions": 1,
      "actions": {
        "take": 1
      },
      "last_used_days_ago": 1.6,
      "example_events": [
        "2025-01-18 09:00 Mary takes the Marker"
      ]
    }
  ],
  "unattributed_events": 1
}
"#);
}

#[test]
fn as_of_and_the_window_bound_the_history_on_both_sides() {
    let store = test_home::store();
    let summary = |as_of: &str, days: u32| {
        let arguments = json!({"object_id": "1", "as_of": as_of, "window_days": days});
        let users = done(&store, "get_usage_summary", arguments)["user_summary"].take();
        users
            .as_array()
            .unwrap()
            .iter()
            .map(|user| format!("{} {}", user["user_id"].as_str().unwrap(), user["total_events"]))
            .collect::<Vec<_>>()
    };
    assert_eq!(summary("2025-01-20T08:00:00", 365), ["Bob 3", "Mary 1", "Tom 1"]);
    assert_eq!(summary("2025-01-20T07:59:59", 365), ["Bob 3", "Mary 1"]);
    assert_eq!(summary("2025-01-18T09:00:00", 1), ["Mary 1"]);
    assert_eq!(summary("2025-01-18T08:05:00", 1), ["Bob 1"]);
    assert_eq!(summary("2024-01-01T00:00:00", 365), [] as [&str; 0]);
    assert_eq!(summary("-009999-01-02T00:00:00", 36_500), [] as [&str; 0]);
}

#[test]
fn neighbours_come_by_weight_and_without_the_thing_itself() {
    let store = test_home::store();
    insta::assert_json_snapshot!(done(&store, "nearby_objects", json!({"object_id": "1", "sigma": 0.5})), @r#"
{
  "object": {
    "id": "1",
    "name": "Marker",
    "position": [
      0.0,
      0.0,
      0.0
    ]
  },
  "nearby_objects": [
    {
      "id": "2",
      "name": "Marker",
      "distance": 0.3,
      "weight": 0.8353
    },
    {
      "id": "cup-a",
      "name": "Coffee Cup",
      "distance": 0.4,
      "weight": 0.7261
    }
  ]
}
"#);
    let all = done(&store, "nearby_objects", json!({"object_id": "1", "k": 100, "min_weight": 0}));
    assert_eq!(all["nearby_objects"].as_array().unwrap().len(), 4);
    let flat = done(&store, "nearby_objects", json!({"object_id": "1", "gamma": 0}));
    assert_eq!(flat["nearby_objects"][0]["id"], "key", "without height the key lies at the same place");
}

#[test]
fn look_alikes_come_by_similarity_and_without_the_thing_itself() {
    let store = test_home::store();
    insta::assert_json_snapshot!(done(&store, "similar_objects", json!({"object_id": "1"})), @r#"
{
  "object": {
    "id": "1",
    "name": "Marker"
  },
  "similar_objects": [
    {
      "id": "2",
      "name": "Marker",
      "similarity": 0.6
    },
    {
      "id": "cup-a",
      "name": "Coffee Cup",
      "similarity": 0.0
    },
    {
      "id": "sofa",
      "name": "Sofa",
      "similarity": -1.0
    }
  ]
}
"#);
    assert_eq!(
        done(&store, "similar_objects", json!({"object_id": "1", "k": 1}))["similar_objects"],
        json!([{"id": "2", "name": "Marker", "similarity": 0.6}])
    );
}

#[test]
fn a_thing_without_features_gets_a_note() {
    let store = test_home::store();
    insta::assert_json_snapshot!(done(&store, "similar_objects", json!({"object_id": "key"})), @r#"
{
  "object": {
    "id": "key",
    "name": "Key"
  },
  "similar_objects": [],
  "note": "This object has no visual features, so nothing can be compared with it."
}
"#);
}

#[test]
fn only_reliable_owners_are_passed_on() {
    let store = test_home::store();
    let known = |tool: &str| {
        let result = done(&store, tool, json!({"object_id": "1"}));
        let list = result["nearby_objects"].as_array().or(result["similar_objects"].as_array()).unwrap();
        list.iter().find(|other| other["id"] == "2").unwrap()["known_ownership"].clone()
    };
    assert_eq!(known("nearby_objects"), Value::Null);
    done(&store, "record_scores", json!({"object_id": "2", "scores": {"Bob": 0.8, "Mary": 0.1, "Tom": 0}}));
    assert_eq!(known("nearby_objects"), Value::Null, "an unsure inference is no knowledge");
    done(&store, "record_scores", json!({"object_id": "2", "scores": {"Bob": 0.97, "Mary": 0.01, "Tom": 0}}));
    let inferred =
        json!({"owners": ["Bob"], "scores": {"Bob": 0.97, "Mary": 0.01, "Tom": 0.0}, "source": "inferred"});
    assert_eq!(known("nearby_objects"), inferred);
    let answer = json!({"object_id": "2", "question": "?", "answer": "!", "ownership": {"Mary": true}});
    done(&store, "record_answer", answer);
    let answered =
        json!({"owners": ["Mary"], "scores": {"Bob": 0.0, "Mary": 1.0, "Tom": 0.0}, "source": "answer"});
    assert_eq!(known("nearby_objects"), answered);
    assert_eq!(known("similar_objects"), answered);
}

#[test]
fn users_are_listed_with_their_background() {
    let store = test_home::store();
    insta::assert_json_snapshot!(done(&store, "list_users", json!({})), @r#"
{
  "users": [
    {
      "name": "Bob",
      "role": "father",
      "occupation": "office worker"
    },
    {
      "name": "Mary",
      "role": "mother"
    },
    {
      "name": "Tom"
    }
  ]
}
"#);
}

#[test]
fn an_empty_home_has_no_users_and_no_objects() {
    let store = Store::open_in_memory().unwrap();
    assert_eq!(done(&store, "list_users", json!({})), json!({"users": []}));
    assert_eq!(done(&store, "list_objects", json!({})), json!({"objects": [], "total": 0}));
    insta::assert_snapshot!(refused(&store, "get_usage_summary", json!({"object_id": "1"})), @r#"object_id: there is no object "1". list_objects gives all ids."#);
}

#[test]
fn objects_are_listed_page_by_page() {
    let store = test_home::store();
    let mut cursor = Value::Null;
    let mut ids = Vec::new();
    loop {
        let page = done(&store, "list_objects", json!({"limit": 2, "cursor": cursor}));
        assert_eq!(page["total"], 5);
        ids.extend(page["objects"].as_array().unwrap().iter().map(|object| object["id"].clone()));
        cursor = page["next_cursor"].clone();
        if cursor.is_null() {
            break;
        }
    }
    assert_eq!(ids, ["1", "2", "cup-a", "key", "sofa"]);
}

#[test]
fn objects_are_filtered_by_class_owner_and_settledness() {
    let store = test_home::store();
    let answer = json!({"object_id": "2", "question": "?", "answer": "!", "ownership": {"Mary": true}});
    done(&store, "record_answer", answer);
    done(
        &store,
        "record_scores",
        json!({"object_id": "sofa", "scores": {"Bob": 0.6, "Mary": 0.5, "Tom": 0.1}}),
    );
    let ids = |arguments: Value| {
        let result = done(&store, "list_objects", arguments);
        let ids: Vec<String> = result["objects"]
            .as_array()
            .unwrap()
            .iter()
            .map(|object| object["id"].as_str().unwrap().to_owned())
            .collect();
        assert_eq!(result["total"], ids.len());
        ids
    };
    assert_eq!(ids(json!({"class": "COFFEE cup"})), ["cup-a"]);
    assert_eq!(ids(json!({"class": "teapot"})), [] as [&str; 0]);
    assert_eq!(ids(json!({"owner": "Mary"})), ["2"]);
    assert_eq!(ids(json!({"owner": "Bob"})), ["sofa"]);
    assert_eq!(ids(json!({"settled": true})), ["2"]);
    assert_eq!(ids(json!({"settled": false})), ["1", "cup-a", "key", "sofa"]);
    assert_eq!(ids(json!({"class": "marker", "settled": false})), ["1"]);
    insta::assert_json_snapshot!(done(&store, "list_objects", json!({"class": "marker"})), @r#"
{
  "objects": [
    {
      "id": "1",
      "name": "Marker",
      "position": [
        0.0,
        0.0,
        0.0
      ],
      "room": "office",
      "owners": [],
      "confidence": 0.0,
      "settled": false
    },
    {
      "id": "2",
      "name": "Marker",
      "position": [
        0.3,
        0.0,
        0.0
      ],
      "owners": [
        "Mary"
      ],
      "confidence": 1.0,
      "settled": true,
      "source": "answer"
    }
  ],
  "total": 2
}
"#);
}
