//! How fast what was seen is parsed and committed.

use std::fs;
use std::time::Instant;

use coin_tests::{Home, Program, is_slow_run, small_house};
use serde_json::{Value, json};

use super::pipe::{Pipe, call};

/// How often the week of the fixture is repeated, each time in another year.
const WEEKS: usize = 100;
/// Captions in one call.
const A_CALL: usize = 50_000;
/// What is promised.
const CAPTIONS_A_SECOND: f64 = 100_000.0;

/// The captions of the fixture, in as many years as there are weeks.
fn captions() -> Vec<Value> {
    let text = fs::read_to_string(small_house().join("captions.jsonl")).unwrap();
    let week: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let mut captions = Vec::with_capacity(WEEKS * week.len());
    for year in 1_900..1_900 + WEEKS {
        captions.extend(week.iter().map(|line| {
            let caption = line["caption"].as_str().unwrap();
            json!({"object_id": line["object_id"], "caption": format!("{year}{}", &caption[4..])})
        }));
    }
    captions
}

#[test]
fn an_import_takes_a_hundred_thousand_captions_a_second() {
    if !is_slow_run("import") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["episode.json", "truth.json", "embeddings.npy"] {
        fs::copy(small_house().join(name), folder.path().join(name)).unwrap();
    }
    let captions = captions();
    let lines: String = captions.iter().map(|caption| format!("{caption}\n")).collect();
    fs::write(folder.path().join("captions.jsonl"), lines).unwrap();
    let finished = Program::new("coin-server")
        .arg("import")
        .arg("--episode")
        .arg(folder.path())
        .arg("--db")
        .arg(folder.path().join("home.db"))
        .run()
        .expect_code(0);
    finished.expect_stderr(&[&captions.len().to_string()]);
    let rate = captions.len() as f64 / finished.duration.as_secs_f64();
    println!(
        "import: {} captions in {:.2} s, {rate:.0} a second, the start of the program included",
        captions.len(),
        finished.duration.as_secs_f64()
    );
    assert!(rate >= CAPTIONS_A_SECOND, "{rate:.0} captions a second");
}

#[test]
fn record_usage_takes_a_hundred_thousand_captions_a_second() {
    if !is_slow_run("record_usage") {
        return;
    }
    let home = Home::import(&small_house());
    let (mut pipe, _) = Pipe::open(&home.db());
    let captions = captions();
    let calls: Vec<String> =
        captions.chunks(A_CALL).map(|chunk| call("record_usage", json!({"captions": chunk}))).collect();
    let started = Instant::now();
    let recorded: u64 = calls.iter().map(|call| pipe.result(call)["recorded"].as_u64().unwrap()).sum();
    let duration = started.elapsed();
    assert_eq!(recorded, captions.len() as u64);
    let rate = captions.len() as f64 / duration.as_secs_f64();
    println!(
        "record_usage: {} captions in {:.2} s, {rate:.0} a second, {A_CALL} a call over the pipe",
        captions.len(),
        duration.as_secs_f64()
    );
    assert!(rate >= CAPTIONS_A_SECOND, "{rate:.0} captions a second");
}
