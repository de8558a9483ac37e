//! `host generate routine` and `host calibrate`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use coin_tests::{
    EpisodeBuilder, Finished, Program, assert_conforms, fixture, published_schema, small_house,
};
use serde_json::Value;

fn generate(protocol: &str, seed: u32, out: &Path, more: &[&str]) -> Finished {
    Program::new("host")
        .args(["generate", "routine", "--protocol", protocol, "--seed", &seed.to_string(), "--out"])
        .arg(out)
        .args(more)
        .run()
}

/// Every file below a folder, by its path from there.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found = BTreeMap::new();
    for entry in entries {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let inner = files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes));
            found.extend(inner);
        } else {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

#[test]
fn small_house_is_what_its_command_makes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("small-house");
    generate("paper", 1, &out, &[]).expect_code(0);
    assert_eq!(files(&out), files(&small_house()));
}

#[test]
fn the_same_seed_makes_the_same_home_and_another_seed_another() {
    let folder = tempfile::tempdir().unwrap();
    let make = |name: &str, seed| {
        let out = folder.path().join(name);
        generate("week", seed, &out, &[]).expect_code(0);
        files(&out)
    };
    let one = make("one", 7);
    assert_eq!(one, make("again", 7));
    assert_ne!(one["captions.jsonl"], make("other", 8)["captions.jsonl"]);
    let schemas = [("episode.json", "episode.schema.json"), ("truth.json", "truth.schema.json")];
    for (file, schema) in schemas {
        let document: Value = serde_json::from_slice(&one[file]).unwrap();
        assert_conforms(&published_schema(schema), &document, file);
    }
    let line = published_schema("caption-line.schema.json");
    for text in String::from_utf8(one["captions.jsonl"].clone()).unwrap().lines().take(50) {
        assert_conforms(&line, &serde_json::from_str(text).unwrap(), "a caption line");
    }
}

#[test]
fn a_folder_with_something_else_in_it_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.tex"), "a life's work").unwrap();
    let refused = generate("week", 7, folder.path(), &[]).expect_code(2);
    refused.expect_stderr(&[folder.path().to_str().unwrap()]);
    assert_eq!(files(folder.path()).keys().collect::<Vec<_>>(), ["thesis.tex"]);
}

#[test]
fn homes_are_made_calibrated_on_and_the_thresholds_used() {
    let folder = tempfile::tempdir().unwrap();
    let homes = folder.path().join("homes");
    generate("week", 100, &homes, &["--count", "3"]).expect_code(0);
    let mut names: Vec<_> = fs::read_dir(&homes).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    assert_eq!(names.len(), 3);

    let calibration = folder.path().join("mine.json");
    Program::new("host")
        .args(["calibrate", "--alpha", "0.1", "--out"])
        .arg(&calibration)
        .arg("--episode")
        .args(&names)
        .run()
        .expect_code(0);
    let thresholds: Value = serde_json::from_slice(&fs::read(&calibration).unwrap()).unwrap();
    assert_conforms(&published_schema("calibration.schema.json"), &thresholds, "the calibration");
    assert_eq!(thresholds["model"], "embedded");
    assert_eq!(thresholds["alpha"], 0.1);
    assert_eq!(thresholds["households"], 3);
    let things: usize = names
        .iter()
        .map(|home| {
            let description: Value =
                serde_json::from_slice(&fs::read(home.join("episode.json")).unwrap()).unwrap();
            description["objects"].as_array().unwrap().len()
        })
        .sum();
    assert_eq!(thresholds["samples"], things);

    let report = super::report(&small_house(), &["--calibration", calibration.to_str().unwrap()]);
    assert_eq!(report["calibration"], thresholds);
}

#[test]
fn calibrating_twice_makes_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let texts = ["one.json", "two.json"].map(|name| {
        let out = folder.path().join(name);
        let calibrate = Program::new("host").args(["calibrate", "--quiet", "--out"]).arg(&out);
        calibrate.arg("--episode").arg(small_house()).run().expect_code(0);
        fs::read_to_string(out).unwrap()
    });
    assert_eq!(texts[0], texts[1]);
}

/// The paper calibrates on the first days of the home that it judges.
#[test]
fn training_days_alone_may_be_calibrated_on() {
    let folder = tempfile::tempdir().unwrap();
    let calibrated = |name: &str, more: &[&str]| -> Value {
        let out = folder.path().join(name);
        let calibrate =
            Program::new("host").args(["calibrate", "--quiet", "--out"]).arg(&out).arg("--episode");
        calibrate.arg(small_house()).args(more).run().expect_code(0);
        serde_json::from_slice(&fs::read(&out).unwrap()).unwrap()
    };
    let whole = calibrated("whole.json", &[]);
    let days = calibrated("days.json", &["--history", "training-days"]);
    assert_eq!((&whole["history"], &days["history"]), (&"whole".into(), &"training_days".into()));
    assert_ne!(whole["q_set"], days["q_set"], "three days tell less than seven");
    assert_eq!(days["episodes"], serde_json::json!(["paper-1"]));

    let mut episode = EpisodeBuilder::three_things();
    episode.description.as_object_mut().unwrap().remove("train_until");
    let without = episode.write();
    Program::new("host")
        .args(["calibrate", "--history", "training-days", "--out"])
        .arg(folder.path().join("none.json"))
        .arg("--episode")
        .arg(without.path())
        .run()
        .expect_code(2)
        .expect_stderr(&["train_until"]);
}

#[test]
fn too_few_samples_for_a_level_are_told() {
    let folder = tempfile::tempdir().unwrap();
    Program::new("host")
        .args(["calibrate", "--out"])
        .arg(folder.path().join("mine.json"))
        .arg("--episode")
        .arg(fixture("episodes/three-things"))
        .run()
        .expect_code(0)
        .expect_stderr(&["--risk 0.012", "at least 83", "--alpha 0.2", "at least 4"]);
}

#[test]
fn thresholds_are_for_a_model_that_is_told_as_much() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("blind.json");
    let calibrate =
        Program::new("host").args(["calibrate", "--quiet", "--without", "usage", "--out"]).arg(&file);
    calibrate.arg("--episode").arg(small_house()).run().expect_code(0);
    let file = file.to_str().unwrap();
    super::host(&small_house(), &["--calibration", file])
        .run()
        .expect_code(2)
        .expect_stderr(&["usage withheld", "--force-calibration"]);
    let forced = super::report(&small_house(), &["--calibration", file, "--force-calibration"]);
    assert_eq!(forced["calibration"]["withheld"], serde_json::json!(["usage"]));
    let blind = super::report(&small_house(), &["--calibration", file, "--without", "usage"]);
    assert_eq!(blind["parameters"]["withheld"], serde_json::json!(["usage"]));
    assert!(
        blind["curve"][0]["subset_accuracy"].as_f64().unwrap() < 0.5,
        "nothing is known of who used what"
    );
}

#[test]
fn nobody_calibrates_without_truth() {
    let mut episode = EpisodeBuilder::three_things();
    episode.truth = None;
    let folder = episode.write();
    let out = folder.join("mine.json");
    Program::new("host")
        .args(["calibrate", "--out"])
        .arg(&out)
        .arg("--episode")
        .arg(folder.path())
        .run()
        .expect_code(2)
        .expect_stderr(&["truth"]);
    assert!(!out.exists());
}
