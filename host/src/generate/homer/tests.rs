//! The HOMER generator on a small folder of our own in the same layout, and on the data set itself where it is at hand.

use std::fs;
use std::path::{Path, PathBuf};

use coin::captions::CaptionReader;
use coin::roster::Roster;
use coin_schemas::household::UsageType;
use rstest::rstest;
use tempfile::TempDir;

use super::*;
use crate::generate::{GeneratedEpisode, Protocol, RoutineSettings, generate_homer};

/// Where the data set is, if anywhere.
const DATA: &str = "COIN_HOMER_DATA";

/// A home of two personas: one cooks at seven and at six in the evening, the other reads all day.
fn small_data() -> TempDir {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let hours = |busy: &[usize]| -> Vec<f64> {
        (0..18).map(|slot| if busy.contains(&slot) { 0.9 } else { 0.0 }).collect()
    };
    let histograms = serde_json::json!({
        "cooking": [hours(&[1, 12]), hours(&[])],
        "reading": [hours(&[3, 5, 7, 9])],
        "washing": [hours(&[0, 15])],
    });
    write("personaBasedSchedules/cluster_histograms.json", &histograms.to_string());
    let personas = serde_json::json!({
        "one": {"cooking": 0, "washing": 0, "reading": null},
        "two": {"cooking": 1, "washing": 0, "reading": 0},
    });
    write("personaBasedSchedules/optimized_persona.json", &personas.to_string());
    let pots: String = (1..=40)
        .map(|number| format!("[FIND] <pot_{number}> ({number}) [1]\n[GRAB] <pot_{number}> ({number}) [2]\n[PUTBACK] <pot_{number}> ({number}) <table> (900) [3]\n"))
        .collect();
    write("executableScriptsByActivity/cooking/00.txt", &pots);
    write(
        "executableScriptsByActivity/reading/00.txt",
        "Reading\nSomebody reads.\n\n[WALK] <home_office> (2) [1]\n[GRAB] <food_book> (50) [2]\n[READ] <food_book> (50) [3]\n[STANDUP] [4]\n[SWITCHON] <radio> (51) [5]\n",
    );
    write(
        "executableScriptsByActivity/washing/00.txt",
        "[GRAB] <brush> (52) [1]\n\n[PUTBACK] <brush> (52) <sink> (53) [2]\n",
    );
    let scene = serde_json::json!({
        "nodes": [
            {"id": 1, "class_name": "bathroom", "category": "Rooms"},
            {"id": 2, "class_name": "home_office", "category": "Rooms"},
            {"id": 52, "class_name": "brush", "category": "Props"},
            {"id": 900, "class_name": "table", "category": "Furniture"},
        ],
        "edges": [{"from_id": 52, "to_id": 1, "relation_type": "INSIDE"}],
    });
    write("CustomScene2_graph.json", &scene.to_string());
    folder
}

fn home(data: &HomerData, protocol: Protocol, seed: u64) -> GeneratedEpisode {
    generate_homer(&RoutineSettings { seed, protocol }, data).unwrap()
}

/// Every plain caption is read as its user's, of its thing, whatever the class is called.
fn assert_is_read(episode: &GeneratedEpisode) {
    let roster = Roster::new(&episode.episode.users).unwrap();
    let reader = CaptionReader::new(&roster);
    for line in &episode.captions {
        let read = reader.read(&line.caption).unwrap();
        let named = line.caption.split_whitespace().nth(2).unwrap();
        assert_eq!(roster.name(read.actor.unwrap()).as_str(), named, "{}", line.caption);
        assert_ne!(read.action, coin::captions::Action::Other, "{}", line.caption);
    }
}

#[test]
fn what_people_handle_is_a_thing_and_what_is_built_in_is_not() {
    let folder = small_data();
    let data = HomerData::read(folder.path()).unwrap();
    assert_eq!(data.personas.len(), 2);
    assert!(data.classes.contains_key("pot 7") && data.classes.contains_key("book"));
    assert!(data.classes.contains_key("radio"), "it is switched on");
    assert!(!data.classes.contains_key("table") && !data.classes.contains_key("home office"));
    assert_eq!(data.classes["brush"].room.as_deref(), Some("bathroom"));
}

#[test]
fn equal_settings_give_equal_homes_and_other_seeds_others() {
    let folder = small_data();
    let data = HomerData::read(folder.path()).unwrap();
    assert_eq!(home(&data, Protocol::Week, 3), home(&data, Protocol::Week, 3));
    assert_ne!(home(&data, Protocol::Week, 3), home(&data, Protocol::Week, 4));
}

#[test]
fn the_papers_owner_sets_and_captions_that_are_read() {
    let folder = small_data();
    let data = HomerData::read(folder.path()).unwrap();
    let episode = home(&data, Protocol::Paper, 1);
    assert_has_the_papers_structure(&episode);
    assert_is_read(&episode);
    let brush = episode.episode.objects.iter().find(|object| object.class.as_str() == "brush");
    assert!(brush.is_none_or(|brush| brush.room.as_deref() == Some("bathroom")));
    assert!(episode.episode.description.unwrap().contains("CC BY-NC-SA 4.0"));
}

/// Section 8 of the method note: 34 things, 55 ownerships.
fn assert_has_the_papers_structure(episode: &GeneratedEpisode) {
    assert_eq!(episode.episode.objects.len(), 34);
    let types = episode.truth.usage_type.as_ref().unwrap();
    let count = |usage_type, owners: usize| {
        let of_type = types.iter().filter(|(_, found)| **found == usage_type);
        of_type.filter(|(object, _)| episode.truth.owners[*object].len() == owners).count()
    };
    assert_eq!(count(UsageType::SingleUser, 1), 10);
    assert_eq!([1, 2, 3].map(|owners| count(UsageType::TemporarySharing, owners)), [11, 1, 3]);
    assert_eq!([1, 2, 3].map(|owners| count(UsageType::MultiUserSharing, owners)), [1, 2, 6]);
}

#[test]
fn an_office_is_refused() {
    let folder = small_data();
    let data = HomerData::read(folder.path()).unwrap();
    let settings = RoutineSettings { seed: 1, protocol: Protocol::Office };
    assert!(matches!(generate_homer(&settings, &data), Err(HomerError::NoSuchPlace)));
}

#[rstest]
#[case::no_scene("CustomScene2_graph.json", None, "cannot read")]
#[case::a_broken_scene("CustomScene2_graph.json", Some("{"), "not in HOMER's form")]
#[case::a_short_histogram(
    "personaBasedSchedules/cluster_histograms.json",
    Some(r#"{"cooking": [[0.5]]}"#),
    "18 numbers"
)]
#[case::an_unknown_cluster(
    "personaBasedSchedules/optimized_persona.json",
    Some(r#"{"one": {"cooking": 7}}"#),
    "cluster 7"
)]
#[case::no_persona("personaBasedSchedules/optimized_persona.json", Some("{}"), "no persona")]
#[case::a_broken_script(
    "executableScriptsByActivity/cooking/00.txt",
    Some("[GRAB] <pot> (1)\nGRAB pot"),
    "line 2"
)]
fn malformed_data_is_refused(#[case] file: &str, #[case] text: Option<&str>, #[case] expected: &str) {
    let folder = small_data();
    let path = folder.path().join(file);
    match text {
        Some(text) => fs::write(&path, text).unwrap(),
        None => fs::remove_file(&path).unwrap(),
    }
    let refused = HomerData::read(folder.path()).unwrap_err().to_string();
    assert!(refused.contains(expected), "{refused}");
}

fn homer() -> Option<PathBuf> {
    let folder = std::env::var_os(DATA).map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: {DATA} does not name the HOMER data set");
    }
    folder
}

#[test]
fn homer_itself_gives_homes_of_every_kind() {
    let Some(folder) = homer() else { return };
    let data = HomerData::read(Path::new(&folder)).unwrap();
    for protocol in Protocol::ALL.into_iter().filter(|protocol| *protocol != Protocol::Office) {
        let episode = home(&data, protocol, 1);
        assert!(episode.episode.objects.len() >= 25, "{protocol:?}: {}", episode.episode.objects.len());
        if protocol == Protocol::Paper {
            assert_has_the_papers_structure(&episode);
            assert_is_read(&episode);
        }
    }
}
