//! `observe_objects`.

use coin_schemas::episode::FEATURE_DIMENSIONS;
use rstest::rstest;
use serde_json::json;

use super::*;
use crate::test_home;

fn mug(x: f64, view: &str) -> Value {
    json!({
        "class": "mug", "position": [x, 3.0, 0.8], "radius": 0.05, "seen_at": "2025-01-20T08:00:00", "view": view,
    })
}

fn without(mut observation: Value, field: &str) -> Value {
    observation.as_object_mut().unwrap().remove(field);
    observation
}

fn with(mut observation: Value, field: &str, value: Value) -> Value {
    observation[field] = value;
    observation
}

#[test]
fn detections_become_things() {
    let store = test_home::store();
    let result = done(
        &store,
        "observe_objects",
        json!({"observations": [mug(3.0, "a"), mug(3.2, "a"), mug(3.02, "b")]}),
    );
    // The variance is 0.15 m · 0.05 m, and two Gaussians of one extent are Δ² / variance apart: 0.02² / 0.0075 = 0.0533.
    assert_eq!(
        result,
        json!({
            "results": [
                {"index": 0, "object_id": "thing-6", "new": true, "views": 2},
                {"index": 1, "object_id": "thing-7", "new": true, "views": 1},
                {"index": 2, "object_id": "thing-6", "new": false, "divergence": 0.0533, "views": 2},
            ],
            "rejected": [],
        })
    );
    let listed = recording::listed(&store, "thing-6");
    assert_eq!(listed["position"], json!([3.01, 3.0, 0.8]));
}

#[test]
fn a_detection_joins_what_was_recorded() {
    let store = test_home::store();
    let cup = with(mug(0.01, "a"), "position", json!([0.01, 0.4, 0.0]));
    let cup = with(cup, "class", json!("coffee cup"));
    let seen = done(&store, "observe_objects", json!({"observations": [cup]}))["results"][0].take();
    assert_eq!(
        (&seen["object_id"], &seen["new"], &seen["views"]),
        (&json!("cup-a"), &json!(false), &json!(2))
    );
    assert!(seen["divergence"].as_f64().unwrap() > 0.0, "{seen}");
}

#[rstest]
#[case::no_number("position", json!([1.0, null, 0.0]), "position[1]: null is given; a number is expected.")]
#[case::a_word("position", json!([1.0, "NaN", 0.0]), "position[1]: \"NaN\" is given; a number is expected.")]
#[case::two_coordinates("position", json!([1.0, 2.0]), "position: invalid length 2")]
#[case::no_extent("radius", json!(0.0), "radius: a radius is a positive number (metres), not 0")]
#[case::negative("radius", json!(-0.1), "radius: a radius is a positive number (metres), not -0.1")]
#[case::dimension("embedding", json!([1.0, 2.0]), "embedding: the features of this map have 512 numbers, not 2")]
#[case::nothing_to_see("embedding", json!(vec![0.0; FEATURE_DIMENSIONS]), "embedding: a feature holds finite numbers")]
#[case::beyond_32_bits("embedding", json!(vec![1e300; FEATURE_DIMENSIONS]), "embedding: a feature holds finite numbers")]
#[case::future("seen_at", json!("2999-01-01T00:00:00"), "seen_at: 2999-01-01T00:00:00 is in the future; here it is")]
#[case::no_time("seen_at", json!("yesterday"), "seen_at: \"yesterday\" is no local time that exists")]
#[case::no_class("class", json!("  "), "class: an object class is empty")]
#[case::no_view("view", json!(" "), "view: it is empty; leave it out")]
#[case::no_room("room", json!("a\u{7}"), "room: it holds a control character")]
#[case::a_long_view("view", json!("v".repeat(201)), "view: it has 201 bytes; at most 200 are allowed")]
#[case::unknown("colour", json!("red"), "colour: there is no such field.")]
fn a_bad_detection_is_refused_and_the_others_are_kept(
    #[case] field: &str,
    #[case] value: Value,
    #[case] reason: &str,
) {
    let store = test_home::store();
    let observations = [mug(3.0, "a"), with(mug(4.0, "a"), field, value), mug(5.0, "a")];
    let result = done(&store, "observe_objects", json!({"observations": observations}));
    let indexes = |list: &Value| -> Vec<u64> {
        list.as_array().unwrap().iter().map(|item| item["index"].as_u64().unwrap()).collect()
    };
    assert_eq!(indexes(&result["results"]), [0, 2]);
    assert_eq!(indexes(&result["rejected"]), [1]);
    let told = result["rejected"][0]["reason"].as_str().unwrap();
    assert!(told.starts_with(reason), "{told}");
}

#[rstest]
#[case(json!(3), "3 is given; an object is expected.")]
#[case(json!(null), "null is given; an object is expected.")]
#[case(
    without(mug(0.0, "a"), "class"),
    "class: it is missing and required. What the detector calls the thing."
)]
#[case(without(mug(0.0, "a"), "seen_at"), "seen_at: it is missing and required. Local time.")]
fn what_is_no_detection_is_refused_in_its_place(#[case] item: Value, #[case] reason: &str) {
    let result = done(&test_home::store(), "observe_objects", json!({"observations": [mug(3.0, "a"), item]}));
    assert_eq!(result["rejected"], json!([{"index": 1, "reason": reason}]));
    assert_eq!(result["results"].as_array().unwrap().len(), 1);
}

#[test]
fn the_same_call_again_changes_nothing() {
    let store = test_home::store();
    let call = json!({"observations": [mug(3.0, "a"), without(mug(4.0, "a"), "view")]});
    let first = done(&store, "observe_objects", call.clone());
    assert_eq!(first["rejected"], json!([]));
    let before = done(&store, "list_objects", json!({}));
    let again = done(&store, "observe_objects", call);
    assert_eq!(
        again,
        json!({"results": [], "rejected": [
            {"index": 0, "reason": "it was taken in before, as a sighting of \"thing-6\""},
            {"index": 1, "reason": "it was taken in before, as a sighting of \"thing-7\""},
        ]})
    );
    assert_eq!(done(&store, "list_objects", json!({})), before);
    let twice = json!({"observations": [mug(7.0, "c"), mug(7.0, "c")]});
    let twice = done(&store, "observe_objects", twice);
    assert_eq!(twice["rejected"][0]["index"], 1);
}

#[test]
fn texts_that_stand_for_numbers_are_taken() {
    let observation = with(with(mug(0.0, "a"), "radius", json!("0.05")), "position", json!(["9", 9, "0.5"]));
    let observation = with(with(observation, "room", json!("")), "embedding", json!(null));
    let store = test_home::store();
    let result = done(&store, "observe_objects", json!({"observations": [observation]}));
    assert_eq!(result["rejected"], json!([]));
    assert_eq!(recording::listed(&store, "thing-6")["position"], json!([9.0, 9.0, 0.5]));
}

#[rstest]
#[case(json!({"view": "a", "least": [0, 0, 2], "greatest": [1, 1, 1]}), "views[0]: least: [0.0, 0.0, 2.0] is beyond greatest")]
#[case(json!({"view": "z", "least": [0, 0, 0], "greatest": [1, 1, 1]}), "views[0]: seen_at: it is missing, and no observation is of the view \"z\"")]
#[case(json!({"view": "a", "seen_at": "3", "least": [0, 0, 0], "greatest": [1, 1, 1]}), "views[0]: seen_at: \"3\" is no local time")]
#[case(json!({"view": "", "least": [0, 0, 0], "greatest": [1, 1, 1]}), "views[0]: view: it is empty")]
#[case(json!({"view": "a"}), "views[0].least: it is missing and required.")]
fn a_bad_view_refuses_the_call(#[case] view: Value, #[case] message: &str) {
    let store = test_home::store();
    let told = refused(&store, "observe_objects", json!({"observations": [mug(3.0, "a")], "views": [view]}));
    assert!(told.starts_with(message), "{told}");
    assert_eq!(done(&store, "list_objects", json!({}))["total"], 5);
}

#[test]
fn too_many_are_refused() {
    let observations = vec![json!({}); 10_001];
    let told = refused(&test_home::store(), "observe_objects", json!({"observations": observations}));
    assert_eq!(told, "observations: 10001 are given; at most 10000 are allowed in a call");
}

/// A look of its own, so that a thing can be recognised elsewhere.
fn looking(observation: Value, at: &str) -> Value {
    let mut feature = vec![0.0; FEATURE_DIMENSIONS];
    feature[77] = 1.0;
    with(with(observation, "embedding", json!(feature)), "seen_at", json!(at))
}

#[test]
fn a_thing_that_was_moved_is_told() {
    let store = test_home::store();
    let seen = |x: f64, view: &str, at: &str| looking(mug(x, view), at);
    let empty = |view: &str, at: &str| json!({"view": view, "seen_at": at, "least": [2.0, 2.0, 0.0], "greatest": [4.0, 4.0, 2.0]});
    let all = json!({
        "observations": [
            seen(8.0, "f", "2025-01-20T08:05:00"),
            seen(8.0, "g", "2025-01-20T08:06:00"),
            seen(3.0, "a", "2025-01-20T08:00:00"),
            seen(3.0, "b", "2025-01-20T08:01:00"),
        ],
        "views": [
            empty("c", "2025-01-20T08:02:00"),
            empty("d", "2025-01-20T08:03:00"),
            empty("e", "2025-01-20T08:04:00"),
        ],
    });
    let result = done(&store, "observe_objects", all);
    assert_eq!(
        result["moved"],
        json!([{
            "object_id": "thing-6", "from": [3.0, 3.0, 0.8], "to": [8.0, 3.0, 0.8], "at": "2025-01-20T08:05:00",
        }])
    );
    let things: Vec<&Value> =
        result["results"].as_array().unwrap().iter().map(|seen| &seen["object_id"]).collect();
    assert_eq!(things, [&json!("thing-6"); 4]);
    assert_eq!(recording::listed(&store, "thing-6")["position"], json!([8.0, 3.0, 0.8]));
}

#[test]
fn what_cannot_be_told_is_left_to_a_person() {
    let store = test_home::store();
    let seen = |x: f64, view: &str, at: &str| looking(mug(x, view), at);
    // Two equal mugs stand side by side, and four weeks later one like them is seen elsewhere.
    let both = |view: &str, at: &str| [seen(3.0, view, at), seen(3.3, view, at)];
    let before = [both("a", "2025-01-01T08:00:00"), both("b", "2025-01-01T08:01:00")].concat();
    done(&store, "observe_objects", json!({"observations": before}));
    let after = [seen(8.0, "c", "2025-01-29T08:00:00"), seen(8.0, "d", "2025-01-29T08:01:00")];
    let result = done(&store, "observe_objects", json!({"observations": after}));
    assert_eq!(
        result["perhaps_moved"],
        json!([{"object_id": "thing-8", "candidates": ["thing-6", "thing-7"]}])
    );
    assert_eq!(result.get("moved"), None);
}
