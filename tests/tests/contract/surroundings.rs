//! `nearby_objects`, `similar_objects` and the `known_ownership` that goes along with both.

use coin_tests::{Home, ServerProcess, feature};
use rstest::rstest;
use serde_json::{Value, json};

fn nearby(arguments: Value) -> Value {
    super::furnished_home().server().ok("nearby_objects", arguments)
}

#[test]
fn nearby_objects_has_exactly_the_fields_of_the_contract() {
    // Both mugs are 0.5 m away: exp(-0.5) = 0.60653. The table is 1.6 m away: exp(-5.12) = 0.00598, too little.
    assert_eq!(
        nearby(json!({"object_id": "marker"})),
        json!({
            "object": {"id": "marker", "name": "Marker", "position": [0.0, 0.0, 0.8]},
            "nearby_objects": [
                {"id": "mug-blue", "name": "Mug", "distance": 0.5, "weight": 0.6065},
                {"id": "mug-red", "name": "Mug", "distance": 0.5, "weight": 0.6065},
            ],
        })
    );
}

#[rstest]
// The lightest one comes in when nothing is too light.
#[case(json!({"min_weight": 0.0}), &[("mug-blue", 0.5, 0.6065), ("mug-red", 0.5, 0.6065), ("table", 1.6, 0.006)])]
// exp(-0.5) is just under 0.61.
#[case(json!({"min_weight": 0.61}), &[])]
// The blue mug hangs above the marker: without height they are in one place.
#[case(json!({"gamma": 0.0}), &[("mug-blue", 0.0, 1.0), ("mug-red", 0.5, 0.6065)])]
// Twice the height is 1 m: exp(-2).
#[case(json!({"gamma": 2.0}), &[("mug-red", 0.5, 0.6065), ("mug-blue", 1.0, 0.1353)])]
// exp(-0.125) and exp(-1.28).
#[case(json!({"sigma": 1.0}), &[("mug-blue", 0.5, 0.8825), ("mug-red", 0.5, 0.8825), ("table", 1.6, 0.278)])]
#[case(json!({"sigma": 1.0, "k": 1}), &[("mug-blue", 0.5, 0.8825)])]
#[case(json!({"sigma": 1.0, "k": 100}), &[("mug-blue", 0.5, 0.8825), ("mug-red", 0.5, 0.8825), ("table", 1.6, 0.278)])]
fn neighbours_are_weighed_as_asked(#[case] extra: Value, #[case] expected: &[(&str, f64, f64)]) {
    let mut arguments = json!({"object_id": "marker"});
    arguments.as_object_mut().unwrap().extend(extra.as_object().unwrap().clone());
    let found: Vec<Value> = nearby(arguments)["nearby_objects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|neighbour| json!([neighbour["id"], neighbour["distance"], neighbour["weight"]]))
        .collect();
    let expected: Vec<Value> =
        expected.iter().map(|(id, distance, weight)| json!([id, distance, weight])).collect();
    assert_eq!(found, expected);
}

#[test]
fn distances_and_weights_have_four_decimals() {
    // √(1.3² + 0.4²) = 1.360147…; exp(-1.85/0.5) = 0.0247235…
    let seen = nearby(json!({"object_id": "mug-red"}));
    let table = seen["nearby_objects"].as_array().unwrap().iter().find(|one| one["id"] == "table").unwrap();
    assert_eq!(table["distance"], 1.3601);
    assert_eq!(table["weight"], 0.0247);
}

#[test]
fn by_default_there_are_five_neighbours() {
    let mut episode = super::furnished();
    for number in 0..6 {
        episode =
            episode.object(&format!("pen-{number}"), "pen", [0.0, 0.0, 0.81 + 0.01 * f64::from(number)]);
    }
    let seen = Home::of(&episode).server().ok("nearby_objects", json!({"object_id": "marker"}));
    let ids: Vec<&Value> =
        seen["nearby_objects"].as_array().unwrap().iter().map(|neighbour| &neighbour["id"]).collect();
    assert_eq!(ids, ["pen-0", "pen-1", "pen-2", "pen-3", "pen-4"]);
}

/// The marker looks like (1, 0); the blue mug (2, 4), the red mug (3, 3), the table (-5, 0).
fn seen_home() -> Home {
    Home::of(&super::furnished().features([
        feature(&[(0, 1.0)]),
        feature(&[(0, 2.0), (1, 4.0)]),
        feature(&[(0, 3.0), (1, 3.0)]),
        feature(&[(0, -5.0)]),
    ]))
}

#[test]
fn similar_objects_has_exactly_the_fields_of_the_contract() {
    // Cosines do not see lengths: 3/√18 = 0.70711, 2/√20 = 0.44721.
    assert_eq!(
        seen_home().server().ok("similar_objects", json!({"object_id": "marker"})),
        json!({
            "object": {"id": "marker", "name": "Marker"},
            "similar_objects": [
                {"id": "mug-red", "name": "Mug", "similarity": 0.7071},
                {"id": "mug-blue", "name": "Mug", "similarity": 0.4472},
                {"id": "table", "name": "Coffee Table", "similarity": -1.0},
            ],
        })
    );
}

#[test]
fn k_is_the_most_look_alikes() {
    let mut server = seen_home().server();
    let seen = server.ok("similar_objects", json!({"object_id": "marker", "k": 1}));
    assert_eq!(seen["similar_objects"], json!([{"id": "mug-red", "name": "Mug", "similarity": 0.7071}]));
}

#[test]
fn by_default_there_are_five_look_alikes() {
    let mut episode = super::furnished();
    let mut features = vec![feature(&[(0, 1.0)]); 4];
    for number in 0..3 {
        episode = episode.object(&format!("pen-{number}"), "pen", [9.0, 0.0, 0.0]);
        features.push(feature(&[(0, 1.0)]));
    }
    let seen =
        Home::of(&episode.features(features)).server().ok("similar_objects", json!({"object_id": "table"}));
    let ids: Vec<&Value> =
        seen["similar_objects"].as_array().unwrap().iter().map(|look_alike| &look_alike["id"]).collect();
    assert_eq!(ids, ["marker", "mug-blue", "mug-red", "pen-0", "pen-1"], "ties stand by id");
}

#[test]
fn a_thing_without_features_has_no_look_alikes_and_a_note() {
    let seen = super::furnished_home().server().ok("similar_objects", json!({"object_id": "marker"}));
    assert_eq!(seen["object"], json!({"id": "marker", "name": "Marker"}));
    assert_eq!(seen["similar_objects"], json!([]));
    assert!(!seen["note"].as_str().unwrap().is_empty());
}

/// `known_ownership` of the red mug, as its neighbours and its look-alikes see it.
fn known_of_red_mug(server: &mut ServerProcess) -> [Value; 2] {
    let of = |list: &Value| {
        let one = list.as_array().unwrap().iter().find(|one| one["id"] == "mug-red").unwrap();
        one.get("known_ownership").cloned().unwrap_or(Value::Null)
    };
    let near = server.ok("nearby_objects", json!({"object_id": "marker"}));
    let alike = server.ok("similar_objects", json!({"object_id": "marker"}));
    [of(&near["nearby_objects"]), of(&alike["similar_objects"])]
}

#[test]
fn an_answer_is_known_ownership() {
    let mut server = seen_home().server();
    assert_eq!(known_of_red_mug(&mut server), [Value::Null, Value::Null]);
    server.ok("record_answer", super::answer("mug-red", "Bob"));
    let known = json!({
        "owners": ["Bob"],
        "scores": {"Bob": 1.0, "Mary": 0.0, "Tom": 0.0},
        "source": "answer",
    });
    assert_eq!(known_of_red_mug(&mut server), [known.clone(), known]);
}

#[rstest]
#[case(0.9, true)]
#[case(0.89, false)]
fn an_inference_is_known_ownership_from_a_confidence_of_nine_tenths(
    #[case] confidence: f64,
    #[case] is_known: bool,
) {
    let mut server = seen_home().server();
    let scores = json!({"Bob": confidence, "Mary": 1.0 - confidence, "Tom": 0.0});
    server.ok(
        "record_scores",
        json!({
            "object_id": "mug-red",
            "scores": scores,
            "owner_sets": [
                {"owners": ["Bob"], "probability": confidence},
                {"owners": ["Mary"], "probability": 1.0 - confidence},
            ],
        }),
    );
    let known = if is_known {
        json!({"owners": ["Bob"], "scores": scores, "source": "inferred"})
    } else {
        Value::Null
    };
    assert_eq!(known_of_red_mug(&mut server), [known.clone(), known]);
}

#[test]
fn an_owner_outside_the_household_is_known_too() {
    let mut server = seen_home().server();
    let mut arguments = super::answer("mug-red", "Bob");
    arguments["ownership"] = json!({});
    arguments["owner_outside_household"] = json!(true);
    server.ok("record_answer", arguments);
    let known = json!({
        "owners": [],
        "scores": {"Bob": 0.0, "Mary": 0.0, "Tom": 0.0},
        "source": "answer",
    });
    assert_eq!(known_of_red_mug(&mut server), [known.clone(), known]);
}
