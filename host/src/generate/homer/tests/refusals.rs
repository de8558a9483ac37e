//! Damaged data: which file, what stands there, what should.

use std::fs;
use std::path::Path;

use rstest::rstest;

use super::made_up;
use crate::generate::homer::{HomerData, HomerError};
use crate::generate::{Protocol, RoutineSettings, generate_homer};

const HISTOGRAMS: &str = "personaBasedSchedules/cluster_histograms.json";
const PERSONAS: &str = "personaBasedSchedules/optimized_persona.json";
const SCENE: &str = "CustomScene2_graph.json";
const COOKING: &str = "executableScriptsByActivity/cooking/00.txt";

/// What is said of the made-up data with one file replaced, as the program says it: the error and all its sources.
fn refusal(file: &str, bytes: &[u8]) -> String {
    let folder = made_up::folder();
    fs::write(folder.path().join(file), bytes).unwrap();
    let error = HomerData::read(folder.path()).unwrap_err();
    format!("{:#}", anyhow::Error::from(error))
}

#[rstest]
#[case::no_json(SCENE, "{", &["is not in HOMER's form", "line 1"])]
#[case::no_node(SCENE, r#"{"nodes": [], "edges": []}"#, &["holds no node;"])]
#[case::no_room(
    SCENE,
    r#"{"nodes": [{"id": 1, "class_name": "brush", "category": "Props"}], "edges": []}"#,
    &["no node of the category Rooms"]
)]
#[case::a_short_histogram(
    HISTOGRAMS,
    r#"{"cooking": [[0.5, 0.5]]}"#,
    &["cluster 0 of \"cooking\"", "2 numbers are given", "18"]
)]
#[case::no_share(
    HISTOGRAMS,
    r#"{"cooking": [[], [0,0,1.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]]}"#,
    &["cluster 0 of \"cooking\"", "0 numbers are given"]
)]
#[case::more_than_one(
    HISTOGRAMS,
    r#"{"cooking": [[0,0,1.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]]}"#,
    &["cluster 0 of \"cooking\"", "1.5 is given for the hour from 08:00", "0 to 1"]
)]
#[case::no_persona(PERSONAS, "{}", &["holds no persona"])]
#[case::an_unknown_cluster(
    PERSONAS,
    r#"{"one": {"cooking": 7}}"#,
    &["\"cooking\" of \"one\"", "cluster 7 is given", "holds 2"]
)]
#[case::an_unknown_activity(PERSONAS, r#"{"one": {"juggling": 0}}"#, &["\"juggling\" of \"one\"", "holds 0"])]
#[case::a_negative_cluster(PERSONAS, r#"{"one": {"cooking": -1}}"#, &["is not in HOMER's form", "line 1"])]
#[case::an_idle_persona(PERSONAS, r#"{"one": {"reading": 1}}"#, &["\"one\"", "every hour", "is empty"])]
#[case::no_way_home(
    PERSONAS,
    r#"{"one": {"cooking": 0, "leave_home": 0}}"#,
    &["\"one\"", "after leave_home there is no come_home"]
)]
#[case::no_step(COOKING, "cooking\n00.txt\n", &["holds no step"])]
#[case::nothing(COOKING, "", &["holds no step"])]
#[case::a_line_that_is_no_step(COOKING, "[GRAB] <pot> (1)\nGRAB pot", &["line 2", "\"GRAB pot\" is no step"])]
#[case::a_third_line_before_the_steps(
    COOKING,
    "cooking\n00.txt\nmore\n[GRAB] <pot> (1)\n",
    &["line 3", "\"more\" is no step"]
)]
#[case::a_step_in_the_place_of_a_title(
    COOKING,
    "GRAB] <pot> (1)\n[GRAB] <pot> (1)\n",
    &["line 1", "is no step such as"]
)]
#[case::an_unknown_verb(COOKING, "\n[HURL] <pot> (1) [1]", &["line 2", "[HURL] is no verb", "CLOSE, DRINK"])]
#[case::a_small_verb(COOKING, "[grab] <pot> (1) [1]", &["line 1", "[grab] is no verb"])]
#[case::no_thing(COOKING, "[GRAB] [1]", &["line 1", "[GRAB] takes one thing", "0 are given"])]
#[case::a_thing_too_many(COOKING, "[STANDUP] <chair> (1) [1]", &["[STANDUP] takes no thing", "1 are given"])]
#[case::nowhere_to_put_it(
    COOKING,
    "[PUTIN] <pot> (1) [1]",
    &["[PUTIN] takes a thing and where it goes", "1 are given"]
)]
#[case::no_id(COOKING, "[GRAB] <pot> [1]", &["line 1", "is no step such as"])]
#[case::an_open_bracket(COOKING, "[GRAB] <pot (1) [1]", &["line 1", "is no step such as"])]
#[case::no_name(COOKING, "[GRAB] <> (1) [1]", &["line 1", "is no step such as"])]
#[case::something_behind_it(COOKING, "[GRAB] <pot> (1) [1] slowly", &["line 1", "is no step such as"])]
fn damaged_files_are_refused_with_the_place(
    #[case] file: &str,
    #[case] text: &str,
    #[case] expected: &[&str],
) {
    let refused = refusal(file, text.as_bytes());
    assert!(refused.contains(file), "{refused}");
    for part in expected {
        assert!(refused.contains(part), "{part:?} is not in: {refused}");
    }
}

#[test]
fn a_file_that_is_no_text_is_no_matter_of_the_folder() {
    let refused = refusal(COOKING, b"cooking\n00.txt\n[GRAB] <p\xff> (1)\n");
    assert!(
        refused.contains(COOKING) && refused.contains("line 3") && refused.contains("UTF-8"),
        "{refused}"
    );
    assert!(!refused.contains("--data"), "{refused}");
}

#[test]
fn what_the_system_says_of_a_missing_file_is_said_once() {
    for file in [SCENE, HISTOGRAMS, PERSONAS] {
        let folder = made_up::folder();
        fs::remove_file(folder.path().join(file)).unwrap();
        let error = anyhow::Error::from(HomerData::read(folder.path()).unwrap_err());
        let refused = format!("{error:#}");
        assert!(refused.contains(file) && refused.contains("--data names the folder"), "{refused}");
        assert_eq!(refused.matches("os error").count(), 1, "{refused}");
    }
}

#[test]
fn an_activity_that_nobody_wrote_a_script_for_is_refused() {
    let folder = made_up::folder();
    fs::remove_dir_all(folder.path().join("executableScriptsByActivity/reading")).unwrap();
    let refused = HomerData::read(folder.path()).unwrap_err().to_string();
    assert!(refused.contains("\"reading\" of \"three\"") && refused.contains("no script"), "{refused}");

    fs::remove_dir_all(folder.path().join("executableScriptsByActivity")).unwrap();
    fs::create_dir(folder.path().join("executableScriptsByActivity")).unwrap();
    let refused = HomerData::read(folder.path()).unwrap_err().to_string();
    assert!(refused.contains("holds no activity script"), "{refused}");
}

fn generate(folder: &Path, protocol: Protocol) -> Result<usize, HomerError> {
    let data = HomerData::read(folder)?;
    let settings = RoutineSettings { seed: 1, protocol };
    generate_homer(&settings, &data).map(|home| home.episode.objects.len())
}

#[test]
fn too_few_things_are_no_home() {
    let folder = made_up::folder();
    for script in ["cooking/00.txt", "cooking/01.txt"] {
        let path = folder.path().join("executableScriptsByActivity").join(script);
        fs::write(path, "[FIND] <pot> (1) [1]\n[GRAB] <pot> (1) [2]\n").unwrap();
    }
    let error = generate(folder.path(), Protocol::Paper).unwrap_err();
    let HomerError::TooFewClasses { needed, found, .. } = error else { unreachable!("{error}") };
    assert!(needed == 34 && found < 10, "{needed}, {found}");
    let message = error.to_string();
    assert!(message.contains("needs 34 classes") && message.contains(&format!("has {found}")), "{message}");
}

#[test]
fn a_persona_that_stays_out_is_refused() {
    let folder = made_up::folder();
    // The clusters of going out and of coming home change places, so that coming home is earlier than going out.
    let path = folder.path().join(HISTOGRAMS);
    let text = fs::read_to_string(&path).unwrap();
    let swapped =
        text.replace("leave_home", "x").replace("come_home", "leave_home").replace("\"x\"", "\"come_home\"");
    fs::write(&path, swapped).unwrap();
    fs::write(folder.path().join(PERSONAS), r#"{"three": {"leave_home": 0, "come_home": 0}}"#).unwrap();
    let error = generate(folder.path(), Protocol::TwoDays).unwrap_err();
    assert!(matches!(error, HomerError::NeverHome { .. }), "{error}");
    assert!(error.to_string().contains("\"three\""), "{error}");
}

#[test]
fn an_office_is_refused() {
    let folder = made_up::folder();
    let error = generate(folder.path(), Protocol::Office).unwrap_err();
    assert!(matches!(error, HomerError::NoSuchPlace), "{error}");
}
