use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::*;

/// A small valid episode that a test can spoil.
struct Fixture {
    folder: TempDir,
    home: Value,
}

impl Fixture {
    fn new() -> Self {
        let fixture = Self {
            folder: tempfile::tempdir().unwrap(),
            home: json!({
                "name": "three things",
                "users": {"Bob": {"role": "father"}, "Mary": {}},
                "objects": [
                    {"id": "1", "class": "marker", "position": [1.0, 2.0, 0.5]},
                    {"id": "2", "class": "cup", "position": [1.5, 2.0, 0.5], "room": "kitchen"},
                    {"id": "marker-3", "class": "marker", "position": [0.0, 0.0, 0.0]},
                ],
                "captions": "captions.jsonl",
                "embeddings": "embeddings.npy",
                "truth": "truth.json",
                "now": "2025-01-19T23:00:00",
                "train_until": "2025-01-16T00:00:00",
            }),
        };
        fixture.save();
        fixture.file(
            "captions.jsonl",
            caption("1", "2025-01-19 19:00 Bob takes the Marker")
                + &caption("2", "2025-01-18 08:00 Mary uses the Cup"),
        );
        fixture.file("embeddings.npy", npy("<f4", false, &[3, 512], &[0.5; 3 * 512]));
        fixture.file("truth.json", r#"{"owners": {"1": ["Bob"], "2": ["Bob", "Mary"], "marker-3": []}, "usage_type": {"1": "single_user"}}"#);
        fixture
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    fn save(&self) {
        self.file(EPISODE_FILE, self.home.to_string());
    }

    fn set(&mut self, pointer: &str, value: Value) {
        *self.home.pointer_mut(pointer).unwrap() = value;
        self.save();
    }

    fn load(&self) -> Result<LoadedEpisode, EpisodeError> {
        load(self.folder.path())
    }

    /// Loads everything, the truth too, and returns the complaint.
    fn complaint(&self) -> String {
        let outcome = self.load().and_then(|loaded| load_truth(self.folder.path(), &loaded.episode));
        outcome.expect_err("the episode was accepted").to_string()
    }
}

fn caption(object: &str, text: &str) -> String {
    format!("{}\n", json!({"object_id": object, "caption": text}))
}

/// A NumPy file of version 1.0, made by hand.
fn npy(kind: &str, fortran: bool, shape: &[usize], numbers: &[f32]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let shape: String = shape.iter().map(|length| format!("{length}, ")).collect();
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': ({shape}), }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

#[test]
fn a_sound_episode_is_loaded() {
    let fixture = Fixture::new();
    let loaded = fixture.load().unwrap();
    assert_eq!(loaded.episode.objects.len(), 3);
    assert_eq!(loaded.captions.len(), 2);
    assert_eq!(loaded.captions[1].object_id.as_str(), "2");
    assert_eq!(loaded.observations[0].at.to_string(), "2025-01-19T19:00:00");
    assert_eq!(loaded.observations[0].actor, Some(loaded.roster.index_of("Bob").unwrap()));
    assert_eq!(loaded.features.unwrap(), vec![[0.5; FEATURE_DIMENSIONS]; 3]);
    let truth = load_truth(fixture.folder.path(), &loaded.episode).unwrap().unwrap();
    assert_eq!(truth.owners.len(), 3);
}

#[test]
fn embeddings_and_truth_may_be_left_out() {
    let mut fixture = Fixture::new();
    let home = fixture.home.as_object_mut().unwrap();
    home.remove("embeddings");
    home.remove("truth");
    fixture.save();
    let loaded = fixture.load().unwrap();
    assert_eq!(loaded.features, None);
    assert_eq!(load_truth(fixture.folder.path(), &loaded.episode).unwrap(), None);
}

#[test]
fn loading_does_not_look_at_the_truth() {
    let fixture = Fixture::new();
    fs::remove_file(fixture.path("truth.json")).unwrap();
    fixture.load().unwrap();
}

#[test]
fn captions_after_now_are_loaded() {
    let fixture = Fixture::new();
    fixture.file("captions.jsonl", caption("1", "2025-02-01 08:00 Bob takes the Marker"));
    assert_eq!(fixture.load().unwrap().captions.len(), 1);
}

#[test]
fn blank_lines_and_windows_line_ends_are_accepted() {
    let fixture = Fixture::new();
    let line = caption("1", "2025-01-19 19:00 Bob takes the Marker");
    fixture.file("captions.jsonl", format!("\r\n{}\r\n\n", line.trim_end()));
    let loaded = fixture.load().unwrap();
    assert_eq!(loaded.captions.len(), 1);
    assert_eq!(loaded.captions[0].caption, "2025-01-19 19:00 Bob takes the Marker");
}

#[cfg(unix)]
#[test]
fn a_link_within_the_folder_is_followed() {
    let fixture = Fixture::new();
    fs::rename(fixture.path("captions.jsonl"), fixture.path("week.jsonl")).unwrap();
    std::os::unix::fs::symlink("week.jsonl", fixture.path("captions.jsonl")).unwrap();
    assert_eq!(fixture.load().unwrap().captions.len(), 2);
}

#[test]
fn a_folder_that_is_none_is_refused() {
    let fixture = Fixture::new();
    let message = |path: &Path| {
        load(path).unwrap_err().to_string().replace(fixture.folder.path().to_str().unwrap(), "FOLDER")
    };
    insta::assert_snapshot!(message(&fixture.path("nowhere")), @"FOLDER/nowhere: this is no episode folder (there is no such file); an episode is a folder with an episode.json");
    insta::assert_snapshot!(message(&fixture.path(EPISODE_FILE)), @"FOLDER/episode.json: this is no episode folder (it is a file); an episode is a folder with an episode.json");
}

type Spoil = (&'static str, fn(&mut Fixture));

const SPOILED_HOMES: &[Spoil] = &[
    ("episode.json is missing", |fixture| fs::remove_file(fixture.path(EPISODE_FILE)).unwrap()),
    ("episode.json is a folder", |fixture| {
        fs::remove_file(fixture.path(EPISODE_FILE)).unwrap();
        fs::create_dir(fixture.path(EPISODE_FILE)).unwrap();
    }),
    ("episode.json is empty", |fixture| fixture.file(EPISODE_FILE, "")),
    ("episode.json is no JSON", |fixture| fixture.file(EPISODE_FILE, "{\n  \"name\": oops\n}")),
    ("episode.json is cut off", |fixture| fixture.file(EPISODE_FILE, &fixture.home.to_string()[..80])),
    ("episode.json is a list", |fixture| fixture.file(EPISODE_FILE, "[]")),
    ("episode.json holds two documents", |fixture| {
        fixture.file(EPISODE_FILE, format!("{}\n{{}}", fixture.home));
    }),
    ("episode.json is no UTF-8", |fixture| fixture.file(EPISODE_FILE, b"{\n\"name\": \"caf\xe9\"}")),
    ("a key is unknown", |fixture| {
        fixture.home["objekts"] = json!([]);
        fixture.save();
    }),
    ("a key of an object is unknown", |fixture| {
        fixture.home["objects"][1]["colour"] = json!("red");
        fixture.save();
    }),
    ("a key is missing", |fixture| {
        fixture.home.as_object_mut().unwrap().remove("now");
        fixture.save();
    }),
    ("a value has the wrong type", |fixture| fixture.set("/objects/0/id", json!(1))),
    ("the name is empty", |fixture| fixture.set("/name", json!(" "))),
    ("an object id is empty", |fixture| fixture.set("/objects/2/id", json!(""))),
    ("an object stands twice", |fixture| fixture.set("/objects/2/id", json!("1"))),
    ("a position is short", |fixture| fixture.set("/objects/0/position", json!([1.0, 2.0]))),
    ("a position is NaN", |fixture| {
        fixture.file(EPISODE_FILE, fixture.home.to_string().replace("[1.5,2.0,0.5]", "[NaN,2.0,0.5]"));
    }),
    ("a position is infinite", |fixture| {
        fixture.file(EPISODE_FILE, fixture.home.to_string().replace("[1.5,2.0,0.5]", "[1e999,2.0,0.5]"));
    }),
    ("a position is null", |fixture| fixture.set("/objects/0/position", json!([null, 2.0, 0.5]))),
    ("there are no users", |fixture| fixture.set("/users", json!({}))),
    ("there are 65 users", |fixture| {
        let users = (0..65).map(|number| (format!("user {number}"), json!({}))).collect();
        fixture.set("/users", Value::Object(users));
    }),
    ("a user stands twice", |fixture| {
        let home = fixture.home.to_string().replace("\"Mary\":{}", "\"Mary\":{},\"Bob\":{}");
        fixture.file(EPISODE_FILE, home);
    }),
    ("a user name holds a line break", |fixture| fixture.set("/users", json!({"Bob\nMary": {}}))),
    ("a key of a user is unknown", |fixture| fixture.set("/users/Mary", json!({"age": 40}))),
    ("now does not exist", |fixture| fixture.set("/now", json!("2025-02-30T00:00:00"))),
    ("now has a time zone", |fixture| fixture.set("/now", json!("2025-01-19T23:00:00Z"))),
    ("train_until is after now", |fixture| fixture.set("/train_until", json!("2025-01-20T00:00:00"))),
    ("a file name is absolute", |fixture| fixture.set("/captions", json!("/etc/passwd"))),
    ("a file name climbs out", |fixture| fixture.set("/embeddings", json!("a/../../secret.npy"))),
    ("a file name climbs out the Windows way", |fixture| fixture.set("/truth", json!("..\\truth.json"))),
    ("a file name is empty", |fixture| fixture.set("/captions", json!(""))),
];

const SPOILED_CAPTIONS: &[Spoil] = &[
    ("the file is missing", |fixture| fs::remove_file(fixture.path("captions.jsonl")).unwrap()),
    ("the file is a folder", |fixture| fixture.set("/captions", json!("."))),
    ("a line is no JSON", |fixture| {
        fixture.file("captions.jsonl", caption("1", "2025-01-19 19:00 Bob takes the Marker") + "oops\n");
    }),
    ("a line is cut off", |fixture| fixture.file("captions.jsonl", "{\"object_id\": \"1\", \"capt")),
    ("a line holds two values", |fixture| {
        let line = caption("1", "2025-01-19 19:00 Bob takes the Marker");
        fixture.file("captions.jsonl", format!("{} {line}", line.trim_end()));
    }),
    ("a key is missing", |fixture| fixture.file("captions.jsonl", "{\"object_id\": \"1\"}\n")),
    ("a key is unknown", |fixture| {
        fixture.file("captions.jsonl", "{\"object_id\": \"1\", \"caption\": \"x\", \"user\": \"Bob\"}\n");
    }),
    ("an id is a number", |fixture| {
        fixture.file("captions.jsonl", "{\"object_id\": 1, \"caption\": \"x\"}\n");
    }),
    ("the object is unknown", |fixture| {
        fixture.file("captions.jsonl", caption("marker-4", "2025-01-19 19:00 Bob takes the Marker"));
    }),
    ("a line has ten megabytes", |fixture| {
        fixture.file("captions.jsonl", caption("1", &"x".repeat(10_000_000)));
    }),
    ("a line is no UTF-8", |fixture| {
        let mut bytes = caption("1", "2025-01-19 19:00 Bob takes the Marker").into_bytes();
        bytes.extend(b"{\"object_id\": \"1\", \"caption\": \"\xff\"}\n");
        fixture.file("captions.jsonl", bytes);
    }),
];

const SPOILED_EMBEDDINGS: &[Spoil] = &[
    ("the file is missing", |fixture| fs::remove_file(fixture.path("embeddings.npy")).unwrap()),
    ("the file is empty", |fixture| fixture.file("embeddings.npy", "")),
    ("the file is no array", |fixture| fixture.file("embeddings.npy", "a shopping list")),
    ("the numbers have 64 bits", |fixture| {
        fixture.file("embeddings.npy", npy("<f8", false, &[3, 512], &[0.5; 6 * 512]));
    }),
    ("the numbers are big-endian", |fixture| {
        fixture.file("embeddings.npy", npy(">f4", false, &[3, 512], &[0.5; 3 * 512]));
    }),
    ("the array is in Fortran order", |fixture| {
        fixture.file("embeddings.npy", npy("<f4", true, &[3, 512], &[0.5; 3 * 512]));
    }),
    ("a row is missing", |fixture| {
        fixture.file("embeddings.npy", npy("<f4", false, &[2, 512], &[0.5; 2 * 512]));
    }),
    ("the rows are short", |fixture| {
        fixture.file("embeddings.npy", npy("<f4", false, &[3, 256], &[0.5; 3 * 256]));
    }),
    ("the array is flat", |fixture| fixture.file("embeddings.npy", npy("<f4", false, &[1536], &[0.5; 1536]))),
    ("the file is cut off", |fixture| {
        fixture.file("embeddings.npy", npy("<f4", false, &[3, 512], &[0.5; 700]));
    }),
    ("the file is too long", |fixture| {
        fixture.file("embeddings.npy", npy("<f4", false, &[3, 512], &[0.5; 2000]));
    }),
    ("a number is NaN", |fixture| {
        let mut numbers = [0.5; 3 * 512];
        numbers[2 * 512 + 7] = f32::NAN;
        fixture.file("embeddings.npy", npy("<f4", false, &[3, 512], &numbers));
    }),
];

const SPOILED_TRUTHS: &[Spoil] = &[
    ("the file is missing", |fixture| fs::remove_file(fixture.path("truth.json")).unwrap()),
    ("the file is no JSON", |fixture| fixture.file("truth.json", "owners: Bob")),
    ("a key is unknown", |fixture| fixture.file("truth.json", r#"{"owners": {}, "thieves": {}}"#)),
    ("an object is unknown", |fixture| fixture.file("truth.json", r#"{"owners": {"marker-4": ["Bob"]}}"#)),
    ("an object is missing", |fixture| {
        fixture.file("truth.json", r#"{"owners": {"1": ["Bob"], "2": ["Mary"]}}"#);
    }),
    ("an object stands twice", |fixture| {
        fixture.file("truth.json", "{\"owners\": {\n\"1\": [\"Bob\"],\n\"1\": [\"Mary\"]}}");
    }),
    ("an owner is unknown", |fixture| fixture.file("truth.json", r#"{"owners": {"1": ["bob"]}}"#)),
    ("an owner is no list", |fixture| fixture.file("truth.json", r#"{"owners": {"1": "Bob"}}"#)),
    ("a usage type is unknown", |fixture| {
        fixture.file(
            "truth.json",
            r#"{"owners": {"1": [], "2": [], "marker-3": []}, "usage_type": {"1": "borrowed"}}"#,
        );
    }),
    ("a usage type is of an unknown object", |fixture| {
        fixture.file(
            "truth.json",
            r#"{"owners": {"1": [], "2": [], "marker-3": []}, "usage_type": {"7": "single_user"}}"#,
        );
    }),
];

fn complaints(rows: &[Spoil]) -> String {
    let mut table = String::new();
    for (name, spoil) in rows {
        let mut fixture = Fixture::new();
        spoil(&mut fixture);
        writeln!(table, "{name}\n    {}", fixture.complaint()).unwrap();
    }
    table
}

#[test]
fn a_malformed_home_is_refused() {
    insta::assert_snapshot!(complaints(SPOILED_HOMES));
}

#[test]
fn malformed_captions_are_refused() {
    insta::assert_snapshot!(complaints(SPOILED_CAPTIONS));
}

#[test]
fn malformed_embeddings_are_refused() {
    insta::assert_snapshot!(complaints(SPOILED_EMBEDDINGS));
}

#[test]
fn a_malformed_truth_is_refused() {
    insta::assert_snapshot!(complaints(SPOILED_TRUTHS));
}

#[test]
fn a_caption_whose_time_does_not_exist_is_refused_by_line() {
    let fixture = Fixture::new();
    let sound = caption("1", "2025-01-19 19:00 Bob takes the Marker");
    for text in ["2025-02-30 19:00 Bob takes the Marker", "2025-01-19 25:00 Bob", "Bob takes the Marker", ""]
    {
        fixture.file("captions.jsonl", format!("{sound}{}", caption("1", text)));
        let complaint = fixture.complaint();
        assert!(complaint.starts_with("captions.jsonl:2: "), "{complaint}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_that_leaves_the_folder_is_refused() {
    let fixture = Fixture::new();
    let elsewhere = tempfile::tempdir().unwrap();
    fs::rename(fixture.path("captions.jsonl"), elsewhere.path().join("captions.jsonl")).unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join("captions.jsonl"), fixture.path("captions.jsonl"))
        .unwrap();
    insta::assert_snapshot!(fixture.complaint(), @"captions.jsonl: it is a link that leaves the episode's folder; put the file itself there");
}
