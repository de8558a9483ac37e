//! How many detections a minute are put on the map.

use std::fmt::Write;
use std::fs;

use coin_tests::Program;
use rstest::rstest;

use super::is_wanted;

/// Things in a row, half a metre from the next row; a view shows one row.
const IN_A_ROW: usize = 20;
/// Rows of things.
const ROWS: usize = 100;
/// How many detections are in the file.
const DETECTIONS: usize = 200_000;
/// What is promised.
const DETECTIONS_A_MINUTE: f64 = 1_000_000.0;

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

#[rstest]
#[case::without_features("without features", Vec::new())]
#[case::with_features("with features", features())]
fn a_million_detections_a_minute_are_taken_in(#[case] name: &str, #[case] features: Vec<String>) {
    if !is_wanted("observe") {
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
    println!("observe: {DETECTIONS} detections {name} in {seconds:.1} s, {:.2} million a minute", rate / 1e6);
    assert!(rate >= DETECTIONS_A_MINUTE, "{rate:.0} detections a minute");
}
