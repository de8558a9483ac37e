//! `observe_objects`, over the pipe, and the commands that do the same from files.

use std::fs;

use coin_tests::{Era, Home, Program, ServerProcess, feature};
use rstest::rstest;
use serde_json::{Value, json};

/// The look that moved things are recognised by.
fn look() -> Vec<f32> {
    feature(&[(2, 1.0)])
}

fn detection(class: &str, position: [f64; 3], seen_at: &str, view: &str) -> Value {
    json!({
        "class": class, "position": position, "radius": 0.05, "seen_at": seen_at, "view": view, "embedding": look(),
    })
}

fn observe(server: &mut ServerProcess, observations: &[Value]) -> Value {
    server.ok("observe_objects", json!({"observations": observations}))
}

fn field<'a>(items: &'a Value, name: &str) -> Vec<&'a Value> {
    items.as_array().unwrap().iter().map(|item| &item[name]).collect()
}

#[rstest]
#[case(Era::Legacy)]
#[case(Era::Modern)]
fn a_detection_joins_a_thing_or_becomes_one(#[case] era: Era) {
    let home = super::furnished_home();
    let mut server = home.server_of(era);
    let kettle = |x: f64, view: &str| detection("kettle", [x, 5.0, 1.0], "2025-01-20T08:00:00", view);
    let result = observe(&mut server, &[kettle(5.0, "a"), kettle(5.3, "a"), kettle(5.03, "b")]);
    // Two Gaussians of the variance 0.15 m · 0.05 m, 3 cm apart: 0.03² / 0.0075 = 0.12 nats.
    assert_eq!(
        result,
        json!({
            "results": [
                {"index": 0, "object_id": "thing-5", "new": true, "views": 2},
                {"index": 1, "object_id": "thing-6", "new": true, "views": 1},
                {"index": 2, "object_id": "thing-5", "new": false, "divergence": 0.12, "views": 2},
            ],
            "rejected": [],
        })
    );
    let found = server.ok("find_object", json!({"query": "where is the kettle next to the kettle?"}));
    assert_ne!(found["decision"], "none", "{found}");
    let near = server.ok("nearby_objects", json!({"object_id": "thing-5"}));
    // 28.5 cm apart: exp(-0.285² / (2 · 0.5²)) = 0.85006.
    assert_eq!(
        near["nearby_objects"],
        json!([{"id": "thing-6", "name": "Kettle", "distance": 0.285, "weight": 0.8501}])
    );
    let alike = server.ok("similar_objects", json!({"object_id": "thing-5"}));
    assert_eq!(alike["similar_objects"][0], json!({"id": "thing-6", "name": "Kettle", "similarity": 1.0}));
}

#[test]
fn bad_detections_are_refused_one_by_one() {
    let home = super::furnished_home();
    let mut server = home.server();
    let good = |x: f64| detection("kettle", [x, 5.0, 1.0], "2025-01-20T08:00:00", "a");
    let with = |field: &str, value: Value| {
        let mut bad = good(50.0);
        bad[field] = value;
        bad
    };
    let all = [
        good(1.0),
        with("position", json!([0.0, null, 0.0])),
        with("embedding", json!(vec![0.0; 512])),
        with("embedding", json!(vec![1.0; 511])),
        with("radius", json!(-0.05)),
        with("seen_at", json!("2999-01-01T00:00:00")),
        good(1.0),
        json!("kettle"),
        good(9.0),
    ];
    let result = observe(&mut server, &all);
    assert_eq!(field(&result["results"], "index"), [&json!(0), &json!(8)]);
    assert_eq!(
        field(&result["rejected"], "index"),
        (1..8).map(|index| json!(index)).collect::<Vec<_>>().iter().collect::<Vec<_>>()
    );
    let reasons =
        ["position[1]", "embedding", "embedding", "radius", "seen_at", "it was taken in", "\"kettle\" is"];
    for (reason, beginning) in field(&result["rejected"], "reason").into_iter().zip(reasons) {
        assert!(reason.as_str().unwrap().starts_with(beginning), "{reason}");
    }
    assert_eq!(server.ok("list_objects", json!({"class": "kettle"}))["total"], 2);
}

/// Two days of a kettle: here, not here, and there.
fn a_kettle_that_moves() -> (Vec<Value>, Vec<Value>) {
    let at = |minute: usize| format!("2025-01-20T08:{minute:02}:00");
    let seen =
        |x: f64, minute: usize| detection("kettle", [x, 5.0, 1.0], &at(minute), &format!("view {minute}"));
    let empty = |minute: usize| {
        json!({
            "view": format!("view {minute}"), "seen_at": at(minute),
            "least": [4.0, 4.0, 0.0], "greatest": [6.0, 6.0, 2.0],
        })
    };
    (vec![seen(5.0, 0), seen(5.0, 1), seen(9.0, 5), seen(9.0, 6)], vec![empty(2), empty(3), empty(4)])
}

#[test]
fn a_thing_that_is_carried_away_keeps_its_id_and_its_owner() {
    let home = super::furnished_home();
    let mut server = home.server();
    let (seen, empty) = a_kettle_that_moves();
    let first = observe(&mut server, &seen[..2]);
    let kettle = first["results"][0]["object_id"].as_str().unwrap().to_owned();
    server.ok("record_answer", super::answer(&kettle, "Mary"));
    server.ok("observe_objects", json!({"observations": [], "views": empty}));
    let newcomer = observe(&mut server, &seen[2..3])["results"][0]["object_id"].as_str().unwrap().to_owned();
    assert_ne!(newcomer, kettle);
    let last = observe(&mut server, &seen[3..]);
    assert_eq!(last["results"][0]["object_id"], kettle.as_str());
    assert_eq!(
        last["moved"],
        json!([{"object_id": kettle, "from": [5.0, 5.0, 1.0], "to": [9.0, 5.0, 1.0], "at": "2025-01-20T08:05:00"}])
    );
    // Whoever noted the passing id still finds the thing.
    let whose = home.server().ok("whose_is", json!({"object_id": newcomer}));
    assert_eq!((&whose["object"]["id"], &whose["owners"]), (&json!(kettle), &json!(["Mary"])));
    let uri = format!("coin://objects/{kettle}/history");
    let told = server.request("resources/read", json!({"uri": uri})).unwrap();
    let history: Value = serde_json::from_str(told["contents"][0]["text"].as_str().unwrap()).unwrap();
    assert_eq!(
        history["changes"],
        json!([{"kind": "moved", "other": newcomer, "at": "2025-01-20T08:05:00"}])
    );
    assert_eq!(
        history["former_places"],
        json!([{"position": [5.0, 5.0, 1.0], "until": "2025-01-20T08:05:00"}])
    );
    assert_eq!(history["sightings"].as_array().unwrap().len(), 4);
}

#[test]
fn a_home_in_which_nobody_lives_yet_can_be_mapped() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("new.db");
    let mut server = ServerProcess::start(["--db".as_ref(), db.as_os_str()], Era::Legacy);
    let (seen, _) = a_kettle_that_moves();
    assert_eq!(observe(&mut server, &seen[..1])["results"][0]["object_id"], "thing-1");
    server.ok("add_user", json!({"name": "Ann"}));
    assert_eq!(server.ok("list_objects", json!({}))["total"], 1);
}

#[test]
fn a_file_of_detections_becomes_the_same_things() {
    let home = super::furnished_home();
    let file = home.join("detections.jsonl");
    let (seen, empty) = a_kettle_that_moves();
    let mut lines: Vec<String> = seen.iter().chain(&empty).map(Value::to_string).collect();
    lines.insert(
        2,
        r#"{"class": "cup", "position": [NaN, 0, 0], "radius": 1, "seen_at": "2025-01-20T08:00:00"}"#
            .to_owned(),
    );
    lines.insert(3, String::new());
    fs::write(&file, lines.join("\n")).unwrap();
    let command = |arguments: &[&str]| {
        Program::new("coin-server")
            .arg("observe")
            .arg("--db")
            .arg(home.db())
            .args(arguments)
            .run()
            .expect_code(0)
    };
    let first = command(&["--file", file.to_str().unwrap(), "--json"]);
    let told: Vec<Value> = first.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(
        told,
        [
            json!({"index": 0, "object_id": "thing-5", "new": true, "views": 4}),
            json!({"index": 1, "object_id": "thing-5", "new": false, "divergence": 0.0, "views": 4}),
            json!({"index": 2, "reason": "it is no JSON, which has neither NaN nor infinity: expected value at line 1 column 31"}),
            json!({"index": 4, "object_id": "thing-5", "new": false, "views": 4}),
            json!({"index": 5, "object_id": "thing-5", "new": false, "divergence": 0.0, "views": 4}),
        ]
    );
    assert!(first.stderr.starts_with("line 3: it is no JSON"), "{}", first.stderr);
    assert!(
        first.stderr.ends_with("Detections 4 stored and 1 left out; things 1 new and 1 moved.\n"),
        "{}",
        first.stderr
    );
    let again = command(&["--file", file.to_str().unwrap()]);
    assert!(again.stderr.ends_with("Detections 0 stored and 5 left out; things 0 new and 0 moved.\n"));
}

#[rstest]
#[case(&["--file", "/nowhere/detections.jsonl"], "cannot read /nowhere/detections.jsonl")]
#[case(&["--file", "/"], "it is a folder")]
#[case(&[], "--file")]
fn a_file_that_cannot_be_read_is_told(#[case] arguments: &[&str], #[case] message: &str) {
    let home = super::furnished_home();
    let finished =
        Program::new("coin-server").arg("observe").arg("--db").arg(home.db()).args(arguments).run();
    assert!(finished.expect_code(2).stderr.contains(message));
}

fn split(home: &Home, arguments: &[&str]) -> coin_tests::Finished {
    Program::new("coin-server").arg("split").args(arguments).arg("--db").arg(home.db()).run()
}

#[test]
fn a_wrong_join_is_listed_and_undone() {
    let home = super::furnished_home();
    let mut server = home.server();
    let seen = |x: f64, minute: usize| {
        detection("kettle", [x, 5.0, 1.0], &format!("2025-01-20T08:0{minute}:00"), &format!("view {minute}"))
    };
    observe(&mut server, &[seen(5.0, 0), seen(5.1, 1), seen(5.0, 2)]);
    let listed = split(&home, &["thing-5"]).expect_code(0).stdout;
    assert_eq!(
        listed,
        " sighting  seen at                               position, m  class             view\n        \
         5  2025-01-20T08:00:00           5.000, 5.000, 1.000  kettle            view 0\n        \
         6  2025-01-20T08:01:00           5.100, 5.000, 1.000  kettle            view 1\n        \
         7  2025-01-20T08:02:00           5.000, 5.000, 1.000  kettle            view 2\n"
    );
    let apart = split(&home, &["thing-5", "--sightings", "6"]).expect_code(0);
    assert_eq!(apart.stdout, "thing-6\n");
    assert_eq!(apart.stderr, "1 of 3 sightings of thing-5 are now the thing thing-6.\n");
    let kettles = server.ok("list_objects", json!({"class": "kettle"}));
    assert_eq!(field(&kettles["objects"], "position"), [&json!([5.0, 5.0, 1.0]), &json!([5.1, 5.0, 1.0])]);
    // A server that was running all the while goes on from there.
    let both = observe(&mut server, &[seen(5.1, 3), seen(5.0, 3)]);
    assert_eq!(field(&both["results"], "object_id"), [&json!("thing-6"), &json!("thing-5")]);
}

#[rstest]
#[case(&["thing-9"], "there is no object \"thing-9\"")]
#[case(&["marker", "--since", "2000-01-01T00:00:00"], "none of the 0 sightings")]
#[case(&["marker", "--sightings", "3-1"], "ends before it begins")]
#[case(&["marker", "--sightings", "x"], "is no number")]
#[case(&["marker", "--sightings", "1", "--since", "2000-01-01T00:00:00"], "cannot be used with")]
fn what_cannot_be_split_is_told(#[case] arguments: &[&str], #[case] message: &str) {
    let told = split(&super::furnished_home(), arguments).expect_code(2).stderr;
    assert!(told.contains(message), "{told}");
}
