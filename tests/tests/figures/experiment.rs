//! The tables and figures of `host experiment`.

use std::fs;
use std::path::Path;

use coin_tests::{Program, is_slow_run, repository, small_house};
use serde_json::Value;

/// `host experiment` on `small-house`, with more arguments.
fn experiment(out: &Path, more: &[&str]) {
    let program = Program::new("host").args(["experiment", "--quiet", "--episode"]).arg(small_house());
    program.arg("--out").arg(out).args(more).run().expect_code(0);
}

fn results(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("results.json")).unwrap()).unwrap()
}

fn mean(results: &Value, method: &str, figure: &str) -> f64 {
    let of_method = &results["methods"][method];
    let value = if of_method["overall"].get(figure).is_some() { &of_method["overall"] } else { of_method };
    value[figure]["mean"].as_f64().unwrap_or_else(|| panic!("{method} has no {figure}"))
}

/// The tables in the documentation are those of its command, but for the times.
#[test]
fn the_documented_tables_are_what_the_command_makes() {
    if !is_slow_run("the documented tables") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    experiment(&out, &[]);
    let timeless = |path: &Path| -> Vec<String> {
        let text = fs::read_to_string(path).unwrap();
        let timed = text.split("\n## ").filter(|section| section.starts_with("Table 3"));
        assert_eq!(timed.count(), 1);
        let kept = text.split("\n## ").filter(|section| !section.starts_with("Table 3"));
        kept.map(str::to_owned).collect()
    };
    let documented = repository().join("docs/experiment");
    assert_eq!(timeless(&out.join("tables.md")), timeless(&documented.join("tables.md")));
    for figure in fs::read_dir(out.join("figures")).unwrap() {
        let name = figure.unwrap().file_name();
        let [made, kept] = [&out, &documented].map(|at| fs::read(at.join("figures").join(&name)).unwrap());
        assert!(made == kept, "{} is another; copy the figures anew", name.display());
    }
    reaches_what_it_is_to_reach(&results(&out));
}

/// COIN at least as right as the paper with at most five questions; a tenth of the calls and tokens of the paper's
/// scheme.
fn reaches_what_it_is_to_reach(found: &Value) {
    for method in found["methods"].as_object().unwrap().keys() {
        println!(
            "{method}: {:.3} with {:.1} questions, {:.0} model calls, {:.0} tokens",
            mean(found, method, "subset_accuracy"),
            mean(found, method, "questions"),
            mean(found, method, "model_calls"),
            mean(found, method, "tokens"),
        );
    }
    assert!(mean(found, "coin", "subset_accuracy") >= 0.988);
    assert!(mean(found, "coin", "questions") <= 5.0);
    for cost in ["model_calls", "tokens"] {
        let (ours, papers) = (mean(found, "coin", cost), mean(found, "coin_paper", cost));
        assert!(10.0 * ours <= papers, "{cost}: {ours} against {papers}");
    }
}

/// What every term is worth is documented as the command measures it; one kind of home stands for all.
#[test]
fn the_documented_worth_of_terms_is_what_the_command_measures() {
    if !is_slow_run("the documented worth of terms") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let arguments = ["--methods", "coin", "--trials", "1", "--coverage-homes", "0", "--terms", "paper"];
    experiment(&out, &arguments);
    let section = |file: &Path| -> String {
        let text = fs::read_to_string(file).unwrap();
        let sections = text.split("\n## ").map(str::trim);
        let mut found = sections.filter(|section| section.starts_with("What the terms are worth: paper"));
        found.next().unwrap_or_else(|| panic!("{} has no such table", file.display())).to_owned()
    };
    let documented = repository().join("docs/experiment");
    assert_eq!(section(&out.join("tables.md")), section(&documented.join("terms.md")));
    let [made, kept] = [&out, &documented].map(|at| fs::read(at.join("figures/curve-paper.svg")).unwrap());
    assert!(made == kept, "curve-paper.svg is another; copy the figures anew");
    let kind = &results(&out)["kinds"][0];
    let questions = |place: usize| kind["terms"][place]["questions"]["mean"].as_f64().unwrap();
    assert_eq!(kind["terms"].as_array().unwrap().len(), 8);
    println!("paper: {:.1} questions, {:.1} without looks", questions(0), questions(3));
    assert!(questions(0) <= 4.0 && questions(0) < questions(3));
}
