//! A small data set of our own in HOMER's layout.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use tempfile::TempDir;

use crate::generate::homer::HomerData;

/// What the made-up personas cook with; more classes than any home has things.
const POTS: usize = 40;

/// The made-up data, read once.
pub(in crate::generate) fn data() -> &'static HomerData {
    static DATA: LazyLock<HomerData> = LazyLock::new(|| HomerData::read(folder().path()).unwrap());
    &DATA
}

/// Shares of the hours from six; the others are empty.
fn hours(busy: &[(usize, f64)]) -> Vec<f64> {
    let share = |hour| busy.iter().find(|(of, _)| *of == hour).map_or(0.0, |(_, share)| *share);
    (6..24).map(share).collect()
}

/// A scene, three personas and their activities, written to a new folder. The first two cook and wash, the third is out
/// in the middle of the day, and two of them read.
pub(super) fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let histograms = serde_json::json!({
        "cooking": [
            hours(&[(7, 0.8), (8, 0.4), (12, 0.5), (18, 0.9), (19, 0.3)]),
            hours(&[(6, 0.6), (11, 0.5), (17, 0.7), (21, 0.4)]),
        ],
        "reading": [hours(&[(9, 0.5), (10, 0.4), (13, 0.6), (14, 0.6), (20, 0.7), (21, 0.5)]), hours(&[])],
        "washing": [hours(&[(6, 0.3), (9, 0.3), (15, 0.8), (22, 0.2)])],
        "leave_home": [hours(&[(8, 0.7), (9, 0.3)])],
        "come_home": [hours(&[(13, 0.2), (15, 0.4), (16, 0.4)])],
    });
    write(&folder, "personaBasedSchedules/cluster_histograms.json", &histograms.to_string());
    let personas = serde_json::json!({
        "one": {"cooking": 0, "washing": 0, "reading": null, "leave_home": null, "come_home": null},
        "two": {"cooking": 1, "washing": 0, "reading": 0},
        "three": {"cooking": 1, "washing": 0, "reading": 0, "leave_home": 0, "come_home": 0},
    });
    write(&folder, "personaBasedSchedules/optimized_persona.json", &personas.to_string());

    // The spoon is taken again and again, so that its session is long and told in many captions.
    let stir = "[GRAB] <spoon> (60) [1]\n[PUTBACK] <spoon> (60) <table> (900) [2]\n";
    let taken: String = (1..=POTS)
        .map(|pot| {
            let stir = if pot % 4 == 0 { stir } else { "" };
            format!("[FIND] <pot_{pot}> ({pot})\n[GRAB] <pot_{pot}> ({pot})\n{stir}")
        })
        .collect();
    let put: String =
        (1..=POTS).map(|pot| format!("[PUTBACK] <pot_{pot}> ({pot}) <table> (900) [3]\n")).collect();
    // Whoever eats sits for up to an hour, so that what is put back afterwards may be another session.
    let meal = "[SIT] <chair> (901) [1]\n[STANDUP] [2]\n";
    script(&folder, "cooking/00", &format!("cooking\n00.txt\n{taken}{meal}{put}"));
    script(&folder, "cooking/01", &format!("{taken}[WALK] <table> (900) [1]\n{meal}\n{put}"));
    script(
        &folder,
        "reading/00",
        "Reading\nSomebody reads.\n\n[WALK] <home_office> (2) [1]\n[GRAB] <food_book> (50) [2]\n[READ] <food_book> (50) \
         [3]\n[LOOKAT] <food_book> (50) [4]\n[SWITCHON] <radio> (51) [5]\n[SWITCHOFF] <radio> (51) [6]\n",
    );
    script(
        &folder,
        "reading/01",
        "[GRAB] <mug> (54) [1]\n[DRINK] <mug> (54) [2]\n[PUTOBJBACK] <mug> (54) [3]\n[TURNTO] <mug> (54) [4]\n",
    );
    script(
        &folder,
        "washing/00",
        "[GRAB] <brush> (52) [1]\n\n[OPEN] <washing_machine> (55) [2]\n[PUTIN] <brush> (52) <washing_machine> (55) \
         [3]\n[CLOSE] <washing_machine> (55) [4]\n[SWITCHON] <washing_machine> (55) [5]\n",
    );
    for (number, thing) in [("00", "clothes_coat> (56)"), ("01", "keys> (57)")] {
        script(
            &folder,
            &format!("leave_home/{number}"),
            &format!("[GRAB] <{thing} [1]\n[WALK] <outside> (999) [2]\n"),
        );
        script(&folder, &format!("come_home/{number}"), &format!("[PUTBACK] <{thing} <table> (900) [1]\n"));
    }

    let scene = serde_json::json!({
        "nodes": [
            {"id": 1, "class_name": "bathroom", "category": "Rooms"},
            {"id": 2, "class_name": "home_office", "category": "Rooms"},
            {"id": 52, "class_name": "brush", "category": "Props"},
            {"id": 900, "class_name": "table", "category": "Furniture"},
        ],
        "edges": [{"from_id": 52, "to_id": 1, "relation_type": "INSIDE"}],
    });
    write(&folder, "CustomScene2_graph.json", &scene.to_string());
    folder
}

/// Writes one script of an activity.
fn script(folder: &TempDir, name: &str, text: &str) {
    write(folder, &format!("executableScriptsByActivity/{name}.txt"), text);
}

fn write(folder: &TempDir, name: &str, text: &str) {
    let path = folder.path().join(Path::new(name));
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}
