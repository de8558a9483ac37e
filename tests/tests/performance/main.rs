//! Figures that the project promises. They take long and need optimised programs and a quiet machine, so they run
//! only with `COIN_SLOW_TESTS=1 cargo test --release -p coin-tests --test performance -- --nocapture
//! --test-threads=1`, and print what they measured.

mod calls;
mod history;
mod large_home;
mod observing;
mod pipe;
mod writing;

use std::time::{Duration, Instant};

use coin_tests::provider::{Script, ScriptedProvider};
use coin_tests::{Program, is_slow_run, small_house};

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

fn microseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e6
}

/// The value below which `share` of the durations lie.
fn quantile(durations: &mut [Duration], share: f64) -> Duration {
    assert!(!durations.is_empty());
    durations.sort_unstable();
    durations[((durations.len() - 1) as f64 * share).round() as usize]
}

fn median(durations: &mut [Duration]) -> Duration {
    quantile(durations, 0.5)
}

#[test]
fn a_small_house_takes_less_than_a_second() {
    if !is_slow_run("small-house") {
        return;
    }
    let mut durations: Vec<Duration> = (0..5)
        .map(|_| {
            let program = Program::new("host").arg("--episode").arg(small_house());
            let started = Instant::now();
            program.run().expect_code(0);
            started.elapsed()
        })
        .collect();
    let typical = median(&mut durations);
    println!("small-house: {:.0} ms from start to end (median of 5)", milliseconds(typical));
    assert!(typical < Duration::from_secs(1), "it took {typical:?}");
}

/// Ten trials of nine methods on 34 things.
#[test]
fn a_whole_experiment_takes_less_than_a_minute() {
    if !is_slow_run("a whole experiment") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let program = Program::new("host").args(["experiment", "--coverage-homes", "0", "--quiet", "--episode"]);
    let took = program
        .arg(small_house())
        .arg("--out")
        .arg(folder.path().join("results"))
        .run()
        .expect_code(0)
        .duration;
    println!("ten trials of nine methods: {:.1} s", took.as_secs_f64());
    assert!(took < Duration::from_secs(60), "it took {took:?}");
}

/// With four conversations at once, and thresholds from other homes.
#[test]
fn a_model_that_answers_after_300_ms_is_through_in_8_seconds() {
    if !is_slow_run("a model that answers after 300 ms") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let calibration = ScriptedProvider::start(Script::default()).calibration(folder.path(), &[]);
    let slow = ScriptedProvider::start(Script { delay: Duration::from_millis(300), ..Script::default() });
    let finished = slow
        .host()
        .args(["--model", "openai:scripted", "--concurrency", "4", "--json", "--quiet", "--calibration"])
        .arg(calibration)
        .arg("--episode")
        .arg(small_house())
        .run()
        .expect_code(0);
    let report = finished.json();
    let accuracy = report["metrics"]["overall"]["subset_accuracy"].as_f64().unwrap();
    println!(
        "{} questions, {accuracy:.3}, {} calls, {:.2} s",
        report["metrics"]["questions"],
        report["cost"]["model_calls"],
        finished.duration.as_secs_f64()
    );
    assert!((accuracy - 1.0).abs() < f64::EPSILON, "{accuracy}");
    assert!(finished.duration < Duration::from_secs(8), "{:?}", finished.duration);
}
