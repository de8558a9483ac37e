//! Real routines: three weeks of homes whose routines were recorded from people. They are a development set that
//! lies outside the project (`COIN_HOMER_EPISODES` names the folder), so nothing here runs without it.

use std::path::PathBuf;

use coin_tests::{Program, is_slow_run};

const WEEKS: [&str; 3] = ["week-1", "week-2", "week-3"];

/// The folder of the weeks, or a word that it is not there.
fn episodes() -> Option<PathBuf> {
    if !is_slow_run("real routines") {
        return None;
    }
    let folder = std::env::var_os("COIN_HOMER_EPISODES").map(PathBuf::from);
    if folder.is_none() {
        println!("real routines: skipped; COIN_HOMER_EPISODES names no folder with week-1 to week-3");
    }
    folder
}

#[test]
fn real_weeks_are_settled_with_few_questions() {
    let Some(folder) = episodes() else { return };
    let mut accuracies = Vec::new();
    for week in WEEKS {
        let finished = Program::new("host")
            .arg("--episode")
            .arg(folder.join(week))
            .args(["--json", "--quiet"])
            .run()
            .expect_code(0);
        let report = finished.json();
        let accuracy = report["metrics"]["overall"]["subset_accuracy"].as_f64().unwrap();
        let at_first = report["curve"][0]["subset_accuracy"].as_f64().unwrap();
        let asked = report["metrics"]["questions"].as_u64().unwrap();
        println!(
            "{week}: Subset Accuracy {accuracy:.3} ({at_first:.3} before the first question), {asked} questions, \
             {:.2} s",
            finished.duration.as_secs_f64()
        );
        assert!(asked <= 8, "{week} took {asked} questions");
        accuracies.push(accuracy);
    }
    let mean = accuracies.iter().sum::<f64>() / accuracies.len() as f64;
    println!("mean Subset Accuracy of real weeks: {mean:.4}");
    assert!(mean >= 0.975, "the mean Subset Accuracy is {mean:.4}");
}
