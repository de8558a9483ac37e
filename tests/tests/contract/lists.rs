//! `list_objects` and `list_users`.

use coin_tests::{EpisodeBuilder, Home};
use rstest::rstest;
use serde_json::{Value, json};

fn ids(listed: &Value) -> Vec<String> {
    let objects = listed["objects"].as_array().unwrap();
    objects.iter().map(|object| object["id"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn users_stand_by_name_with_what_is_known_of_them() {
    let episode = EpisodeBuilder::new()
        .with("/users", json!({"Zoe": {}, "Anna": {"role": "flatmate"}, "Max": {"occupation": "cook"}}));
    assert_eq!(
        Home::of(&episode).server().ok("list_users", json!({})),
        json!({"users": [
            {"name": "Anna", "role": "flatmate"},
            {"name": "Max", "occupation": "cook"},
            {"name": "Zoe"},
        ]})
    );
}

#[test]
fn objects_stand_by_id_and_nothing_is_believed_at_first() {
    let episode = super::furnished().with("/objects/0/room", json!("office"));
    let listed = Home::of(&episode).server().ok("list_objects", json!({}));
    assert_eq!(listed["total"], 4);
    assert!(listed.get("next_cursor").is_none());
    assert_eq!(ids(&listed), ["marker", "mug-blue", "mug-red", "table"]);
    assert_eq!(
        listed["objects"][0],
        json!({
            "id": "marker",
            "name": "Marker",
            "position": [0.0, 0.0, 0.8],
            "room": "office",
            "owners": [],
            "confidence": 0.0,
            "settled": false,
        })
    );
}

/// The marker was answered (Bob), the blue mug is settled (Mary), the red one is not (Bob), the table is unknown.
fn believed() -> Home {
    let home = super::furnished_home();
    let mut server = home.server();
    server.ok("record_answer", super::answer("marker", "Bob"));
    for (object_id, scores) in [
        ("mug-blue", json!({"Bob": 0.01, "Mary": 0.99, "Tom": 0.01})),
        ("mug-red", json!({"Bob": 0.7, "Mary": 0.2, "Tom": 0.1})),
    ] {
        server.ok("record_scores", json!({"object_id": object_id, "scores": scores}));
    }
    home
}

#[rstest]
#[case(json!({}), &["marker", "mug-blue", "mug-red", "table"])]
#[case(json!({"class": "mug"}), &["mug-blue", "mug-red"])]
#[case(json!({"class": "coffee table"}), &["table"])]
#[case(json!({"owner": "Bob"}), &["marker", "mug-red"])]
#[case(json!({"owner": "Tom"}), &[])]
#[case(json!({"settled": true}), &["marker", "mug-blue"])]
#[case(json!({"settled": false}), &["mug-red", "table"])]
#[case(json!({"owner": "Bob", "settled": false}), &["mug-red"])]
#[case(json!({"class": "mug", "owner": "Mary", "settled": true}), &["mug-blue"])]
fn filters_narrow_the_list(#[case] filters: Value, #[case] expected: &[&str]) {
    let listed = believed().server().ok("list_objects", filters);
    assert_eq!(ids(&listed), expected);
    assert_eq!(listed["total"], expected.len());
}

#[test]
fn sources_and_confidences_are_told() {
    let listed = believed().server().ok("list_objects", json!({}));
    let sources: Vec<Value> = listed["objects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|object| json!([object.get("source"), object["settled"], object["owners"]]))
        .collect();
    assert_eq!(
        json!(sources),
        json!([
            ["answer", true, ["Bob"]],
            ["inferred", true, ["Mary"]],
            ["inferred", false, ["Bob"]],
            [null, false, []],
        ])
    );
    assert_eq!(listed["objects"][0]["confidence"], 1.0);
    let doubtful = listed["objects"][2]["confidence"].as_f64().unwrap();
    assert!(doubtful > 0.0 && doubtful < 0.95, "{doubtful}");
}

#[rstest]
#[case(1)]
#[case(7)]
#[case(50)]
#[case(500)]
fn pages_make_up_the_whole_list_once(#[case] limit: usize) {
    let mut episode = EpisodeBuilder::new();
    for number in 0..120 {
        episode = episode.object(&format!("cup-{number:03}"), "cup", [f64::from(number), 0.0, 0.0]);
    }
    let mut server = Home::of(&episode).server();
    let mut seen = Vec::new();
    let mut arguments = json!({"limit": limit});
    loop {
        let page = server.ok("list_objects", arguments.clone());
        assert_eq!(page["total"], 120);
        let page_ids = ids(&page);
        assert!(page_ids.len() <= limit && !page_ids.is_empty());
        seen.extend(page_ids);
        match page.get("next_cursor") {
            Some(cursor) => arguments["cursor"] = cursor.clone(),
            None => break,
        }
    }
    let expected: Vec<String> = (0..120).map(|number| format!("cup-{number:03}")).collect();
    assert_eq!(seen, expected);
}

#[test]
fn by_default_a_page_has_fifty_things() {
    let mut episode = EpisodeBuilder::new();
    for number in 0..51 {
        episode = episode.object(&format!("cup-{number:03}"), "cup", [0.0, 0.0, 0.0]);
    }
    let page = Home::of(&episode).server().ok("list_objects", json!({}));
    assert_eq!(ids(&page).len(), 50);
    assert!(page.get("next_cursor").is_some());
}

#[test]
fn a_page_boundary_stays_where_it_was_when_beliefs_change() {
    let home = believed();
    let mut server = home.server();
    let first = server.ok("list_objects", json!({"settled": false, "limit": 1}));
    assert_eq!(ids(&first), ["mug-red"]);
    server.ok("record_answer", super::answer("mug-red", "Bob"));
    let second =
        server.ok("list_objects", json!({"settled": false, "limit": 1, "cursor": first["next_cursor"]}));
    assert_eq!(ids(&second), ["table"], "nothing is skipped because something before it went away");
}
