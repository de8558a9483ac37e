//! How many detections a minute are put on the map.

use std::fmt::Write;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::time::{Duration, Instant};

use coin_schemas::tools::Observation;
use coin_tests::{Program, is_slow_run};
use rstest::rstest;
use rusqlite::Connection;

/// Things in a row, half a metre from the next row; a view shows one row.
const IN_A_ROW: usize = 20;
/// Rows of things.
const ROWS: usize = 100;
/// How many detections are in the file.
const DETECTIONS: usize = 200_000;
/// What is promised of detections without features. With them the machine sets the pace, by its processor and by its
/// disk, and what is promised is how long it takes in comparison.
const DETECTIONS_A_MINUTE: f64 = 1_000_000.0;
/// How much longer it may take, at most, to put detections with features on the map than to copy them into a table.
const MOST_COPIES: f64 = 2.0;
/// How many lines are copied in one transaction.
const COPIED_TOGETHER: usize = 16_000;

/// A number between −1 and 1 that looks like chance.
fn scattered(number: usize) -> f64 {
    let mixed = (number as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (mixed ^ (mixed >> 29)) as u32 as f64 / f64::from(u32::MAX) * 2.0 - 1.0
}

/// Views of the rows in turn: every thing is seen every hundredth view, off by up to 5 cm on each axis.
fn detections(features: &[String]) -> String {
    let mut text = String::new();
    for view in 0..DETECTIONS / IN_A_ROW {
        let row = view % ROWS;
        let (hour, minute, second) = (view / 3600, view / 60 % 60, view % 60);
        let along = 0.5 * row as f64;
        for place in 0..IN_A_ROW {
            let number = 3 * (view * IN_A_ROW + place);
            let at = |metres: f64, axis: usize| metres + 0.05 * scattered(number + axis);
            let (x, y, z) = (at(0.3 * place as f64, 0), at(along, 1), at(0.0, 2));
            let feature = features.get(row * IN_A_ROW + place).map_or("", String::as_str);
            writeln!(
                text,
                r#"{{"class":"cup","position":[{x:.4},{y:.4},{z:.4}],"radius":0.045,"seen_at":"2025-03-01T{hour:02}:{minute:02}:{second:02}","view":"{view}"{feature}}}"#
            )
            .unwrap();
        }
        let (least, greatest) = (along - 0.4, along + 0.4);
        writeln!(text, r#"{{"view":"{view}","least":[-0.5,{least},-1],"greatest":[6.5,{greatest},1]}}"#)
            .unwrap();
    }
    text
}

/// A feature for each thing, as a line holds it.
fn features() -> Vec<String> {
    let feature = |thing: usize| {
        let numbers = (0..512).map(|place| format!("{:.5}", scattered(thing * 512 + place)));
        format!(r#","embedding":[{}]"#, numbers.collect::<Vec<_>>().join(","))
    };
    (0..ROWS * IN_A_ROW).map(feature).collect()
}

/// How long it takes to read the detections of a file and to write them, with their features, into a table: what
/// anybody has to do who keeps them, and nothing else.
fn time_of_a_copy(detections: &Path, database: &Path) -> Duration {
    let started = Instant::now();
    let mut lines = BufReader::new(File::open(detections).unwrap()).lines().map(Result::unwrap).peekable();
    let mut connection = Connection::open(database).unwrap();
    connection
        .execute_batch(
            "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;
             CREATE TABLE detections (
                 class TEXT, x REAL, y REAL, z REAL, radius REAL, seen_at TEXT, view TEXT, feature BLOB
             );",
        )
        .unwrap();
    while lines.peek().is_some() {
        let transaction = connection.transaction().unwrap();
        let mut insertion = transaction
            .prepare_cached("INSERT INTO detections VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)")
            .unwrap();
        for line in lines.by_ref().take(COPIED_TOGETHER) {
            // What is no detection tells what a view had in sight.
            let Ok(Observation { class, position: [x, y, z], radius, embedding, seen_at, view, .. }) =
                serde_json::from_str(&line)
            else {
                continue;
            };
            let feature: Option<Vec<u8>> =
                embedding.map(|numbers| numbers.iter().flat_map(|number| number.to_le_bytes()).collect());
            insertion.execute((class, x, y, z, radius, seen_at, view, feature)).unwrap();
        }
        drop(insertion);
        transaction.commit().unwrap();
    }
    connection.close().unwrap();
    started.elapsed()
}

#[rstest]
#[case::without_features("without features", Vec::new())]
#[case::with_features("with features", features())]
fn many_detections_a_minute_are_taken_in(#[case] name: &str, #[case] features: Vec<String>) {
    if !is_slow_run("observe") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("detections.jsonl");
    fs::write(&file, detections(&features)).unwrap();
    let finished = Program::new("coin-server")
        .args(["observe".as_ref(), "--file".as_ref(), file.as_os_str()])
        .args(["--db".as_ref(), folder.path().join("home.db").as_os_str()])
        .run()
        .expect_code(0);
    let told =
        format!("Detections {DETECTIONS} stored and 0 left out; things {} new and 0 moved.", ROWS * IN_A_ROW);
    finished.expect_stderr(&[&told]);
    let seconds = finished.duration.as_secs_f64();
    let rate = DETECTIONS as f64 / seconds * 60.0;
    let copies = seconds / time_of_a_copy(&file, &folder.path().join("copy.db")).as_secs_f64();
    println!(
        "observe: {DETECTIONS} detections {name} in {seconds:.1} s, {:.2} million a minute, {copies:.2} times as \
         long as to copy them",
        rate / 1e6
    );
    if features.is_empty() {
        assert!(rate >= DETECTIONS_A_MINUTE, "{rate:.0} detections a minute");
    } else {
        assert!(copies <= MOST_COPIES, "{copies:.2} times as long as to copy them");
    }
}
