//! Episodes that are refused: exit status 2, one message that names file, line or key, what was given and what is
//! expected, and nothing half-loaded.

use std::fs;
use std::path::Path;

use coin_tests::{EpisodeBuilder, Program, feature};
use rstest::rstest;
use serde_json::{Value, json};

/// Both programs refuse the episode with one message that holds `parts`, and neither leaves a home behind.
#[track_caller]
fn assert_refused(episode: &Path, parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("home.db");
    let programs = [
        super::host(episode, &["--db"]).arg(&db),
        Program::new("coin-server").arg("import").arg("--episode").arg(episode).arg("--db").arg(&db),
    ];
    for program in programs {
        let refused = program.run().expect_code(2);
        assert_eq!(refused.stdout, "");
        refused.expect_stderr(parts);
        assert_eq!(refused.stderr.trim_end().lines().count(), 1, "one message: {}", refused.stderr);
        assert!(refused.stderr.len() < 2_000, "a message and not the file: {}", refused.stderr);
    }
    assert!(!db.exists(), "a refused episode leaves no home");
}

fn refuse(episode: &EpisodeBuilder, parts: &[&str]) {
    assert_refused(episode.write().path(), parts);
}

fn three_things() -> EpisodeBuilder {
    EpisodeBuilder::three_things()
}

#[rstest]
#[case::unknown_key("/usres", json!({}), &["episode.json", "usres", "users"])]
#[case::missing_now("/now", Value::Null, &["episode.json", "now"])]
#[case::now_of_no_day("/now", json!("2025-02-30T23:00:00"), &["episode.json", "now", "2025-02-30"])]
#[case::now_with_a_zone("/now", json!("2025-01-19T23:00:00Z"), &["episode.json", "now", "time zone"])]
#[case::now_as_a_number("/now", json!(20_250_119), &["episode.json", "now", "20250119"])]
#[case::no_users("/users", json!({}), &["episode.json", "users"])]
#[case::users_as_a_list("/users", json!(["Bob"]), &["episode.json", "users"])]
#[case::unknown_key_of_a_user("/users/Bob/age", json!(40), &["episode.json", "users.Bob.age"])]
#[case::empty_name("/name", json!(""), &["episode.json", "name"])]
#[case::object_twice("/objects/1/id", json!("1"), &["episode.json", "objects[1].id", "\"1\"", "twice"])]
#[case::id_as_a_number("/objects/0/id", json!(1), &["episode.json", "objects[0].id", "string"])]
#[case::empty_class("/objects/0/class", json!(" "), &["episode.json", "objects[0].class", "empty"])]
#[case::missing_class("/objects/0/class", Value::Null, &["episode.json", "objects[0]", "class"])]
#[case::short_position("/objects/2/position", json!([1, 2]), &["episode.json", "objects[2].position", "3"])]
#[case::position_in_words("/objects/2/position", json!("kitchen"), &["episode.json", "objects[2].position"])]
#[case::unknown_key_of_a_thing("/objects/0/colour", json!("red"), &["episode.json", "objects[0].colour"])]
#[case::absolute_path("/captions", json!("/etc/passwd"), &["episode.json", "captions", "/etc/passwd", "folder"])]
#[case::climbing_path("/captions", json!("../captions.jsonl"), &["episode.json", "captions", "folder"])]
#[case::missing_captions("/captions", json!("gone.jsonl"), &["gone.jsonl"])]
#[case::missing_features("/embeddings", json!("gone.npy"), &["gone.npy"])]
fn a_malformed_description_is_refused(#[case] pointer: &str, #[case] value: Value, #[case] parts: &[&str]) {
    let mut episode = three_things();
    episode.truth = None;
    refuse(&episode.with(pointer, value), parts);
}

#[rstest]
#[case::empty("", &["episode.json"])]
#[case::no_json("name: small", &["episode.json", "1"])]
#[case::cut_off("{\"name\": \"small\", \"users\": {", &["episode.json"])]
#[case::a_list("[]", &["episode.json", "list"])]
#[case::not_a_number("{\"name\":\"a\",\"users\":{\"Bob\":{}},\"objects\":[{\"id\":\"1\",\"class\":\"cup\",\"position\":[NaN,0,0]}],\"captions\":\"captions.jsonl\",\"now\":\"2025-01-19T23:00:00\"}", &["episode.json", "objects[0].position", "NaN"])]
#[case::infinite("{\"name\":\"a\",\"users\":{\"Bob\":{}},\"objects\":[{\"id\":\"1\",\"class\":\"cup\",\"position\":[1e999,0,0]}],\"captions\":\"captions.jsonl\",\"now\":\"2025-01-19T23:00:00\"}", &["episode.json", "objects[0].position"])]
#[case::user_twice("{\"name\":\"a\",\"users\":{\"Bob\":{},\"Bob\":{}},\"objects\":[],\"captions\":\"captions.jsonl\",\"now\":\"2025-01-19T23:00:00\"}", &["episode.json", "Bob", "twice"])]
fn a_description_that_is_none_is_refused(#[case] text: &str, #[case] parts: &[&str]) {
    refuse(&three_things().file("episode.json", text), parts);
}

#[rstest]
#[case::no_json("Bob takes the Marker", &["captions.jsonl:2"])]
#[case::unknown_key("{\"object_id\": \"1\", \"caption\": \"2025-01-16 08:00 Bob takes the Marker\", \"confidence\": 1}", &["captions.jsonl:2", "confidence"])]
#[case::missing_key("{\"object_id\": \"1\"}", &["captions.jsonl:2", "caption"])]
#[case::nobodys_object("{\"object_id\": \"17\", \"caption\": \"2025-01-16 08:00 Bob takes the Marker\"}", &["captions.jsonl:2", "\"17\""])]
#[case::no_time("{\"object_id\": \"1\", \"caption\": \"Bob takes the Marker\"}", &["captions.jsonl:2", "YYYY-MM-DD"])]
#[case::time_of_no_day("{\"object_id\": \"1\", \"caption\": \"2025-02-29 08:00 Bob takes the Marker\"}", &["captions.jsonl:2", "2025-02-29"])]
#[case::time_of_no_hour("{\"object_id\": \"1\", \"caption\": \"2025-01-16 24:30 Bob takes the Marker\"}", &["captions.jsonl:2", "24:30"])]
#[case::no_text("{\"object_id\": \"1\", \"caption\": \"2025-01-16 08:00\"}", &["captions.jsonl:2"])]
#[case::a_list("[\"1\", \"2025-01-16 08:00 Bob takes the Marker\"]", &["captions.jsonl:2"])]
fn a_malformed_caption_is_refused_by_its_line(#[case] line: &str, #[case] parts: &[&str]) {
    let mut episode = three_things();
    episode.captions.insert(1, line.to_owned());
    refuse(&episode, parts);
}

#[test]
fn a_line_of_ten_megabytes_is_refused() {
    let mut episode = three_things();
    let caption = format!("2025-01-16 08:00 Bob {}", "x".repeat(10_000_000));
    episode.captions.insert(2, json!({"object_id": "1", "caption": caption}).to_string());
    refuse(&episode, &["captions.jsonl:3", "bytes"]);
}

#[test]
fn a_line_that_is_no_text_is_refused() {
    let mut bytes =
        b"{\"object_id\": \"1\", \"caption\": \"2025-01-16 08:00 Bob takes the Marker\"}\n".to_vec();
    bytes.extend(b"{\"object_id\": \"1\", \"caption\": \"2025-01-16 08:00 B\xff\xfeb\"}\n");
    refuse(&three_things().file("captions.jsonl", bytes), &["captions.jsonl:2", "UTF-8"]);
}

#[rstest]
#[case::no_json("owners: Bob", &["truth.json"])]
#[case::unknown_key(r#"{"owners": {}, "owner": {}}"#, &["truth.json", "owner"])]
#[case::no_user(r#"{"owners": {"1": ["Bobby"], "2": ["Mary"], "3": ["Tom"]}}"#, &["truth.json", "Bobby"])]
#[case::no_thing(r#"{"owners": {"1": ["Bob"], "2": ["Mary"], "3": ["Tom"], "4": ["Tom"]}}"#, &["truth.json", "4"])]
#[case::no_list(r#"{"owners": {"1": "Bob"}}"#, &["truth.json", "owners.1"])]
#[case::no_type(r#"{"owners": {"1": ["Bob"], "2": ["Mary"], "3": ["Tom"]}, "usage_type": {"1": "rarely"}}"#, &["truth.json", "rarely", "single_user"])]
fn a_malformed_truth_is_refused(#[case] text: &str, #[case] parts: &[&str]) {
    assert_truth_refused(&three_things().file("truth.json", text), parts);
}

#[test]
fn a_truth_that_is_not_there_is_refused() {
    let mut episode = three_things();
    episode.truth = None;
    assert_truth_refused(&episode.with("/truth", json!("gone.json")), &["gone.json"]);
}

/// The server never looks at the truth, so that only the host can refuse it.
fn assert_truth_refused(episode: &EpisodeBuilder, parts: &[&str]) {
    let episode = episode.write();
    let db = episode.join("home.db");
    let refused = super::host(episode.path(), &["--db"]).arg(&db).run().expect_code(2);
    assert_eq!(refused.stdout, "");
    refused.expect_stderr(parts);
    assert_eq!(refused.stderr.trim_end().lines().count(), 1, "one message: {}", refused.stderr);
    assert!(!db.exists(), "a refused episode leaves no home");
}

#[test]
fn features_of_another_number_of_things_are_refused() {
    let two = vec![feature(&[(0, 1.0)]); 2];
    refuse(&three_things().features(two), &["embeddings.npy", "[2, 512]", "[3, 512]"]);
}

#[test]
fn features_of_another_width_are_refused() {
    refuse(&three_things().features(vec![vec![1.0; 768]; 3]), &["embeddings.npy", "768", "512"]);
}

#[test]
fn features_that_are_not_finite_are_refused() {
    for odd in [f32::NAN, f32::INFINITY] {
        let rows = [feature(&[(0, 1.0)]), feature(&[(7, odd)]), feature(&[(0, 1.0)])];
        refuse(&three_things().features(rows), &["embeddings.npy", "1"]);
    }
}

#[test]
fn features_of_another_kind_are_refused() {
    let rows = vec![feature(&[(0, 1.0)]); 3];
    let good = three_things().features(rows).write();
    let bytes = fs::read(good.join("embeddings.npy")).unwrap();
    let replaced = |from: &[u8], to: &[u8]| {
        let place = bytes.windows(from.len()).position(|window| window == from).unwrap();
        let mut changed = bytes.clone();
        changed[place..place + from.len()].copy_from_slice(to);
        changed
    };
    let broken: [(Vec<u8>, &str); 5] = [
        (replaced(b"'<f4'", b"'<i4'"), "float32"),
        (replaced(b"'fortran_order': False", b"'fortran_order': True "), "C order"),
        (bytes[..bytes.len() - 4].to_vec(), "embeddings.npy"),
        ([bytes.clone(), vec![0; 4]].concat(), "embeddings.npy"),
        (b"PK\x03\x04 this is an archive".to_vec(), "NumPy"),
    ];
    for (content, part) in broken {
        let mut episode = three_things().file("embeddings.npy", content);
        episode = episode.with("/embeddings", json!("embeddings.npy"));
        refuse(&episode, &["embeddings.npy", part]);
    }
}

#[test]
fn a_folder_that_is_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(&folder.path().join("nowhere"), &["nowhere"]);
    assert_refused(folder.path(), &["episode.json"]);
    let file = folder.path().join("episode.zip");
    fs::write(&file, "").unwrap();
    assert_refused(&file, &["episode.zip", "folder"]);
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_is_refused() {
    let secret = tempfile::tempdir().unwrap();
    let target = secret.path().join("captions.jsonl");
    fs::write(&target, "{\"object_id\": \"1\", \"caption\": \"2025-01-16 08:00 Bob takes the Marker\"}\n")
        .unwrap();
    let episode = three_things().with("/captions", json!("linked.jsonl")).write();
    std::os::unix::fs::symlink(&target, episode.join("linked.jsonl")).unwrap();
    assert_refused(episode.path(), &["linked.jsonl", "folder"]);
}
