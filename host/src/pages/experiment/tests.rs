//! The page of an experiment whose names are hostile.

use coin_schemas::experiment::{ExperimentResults, StatisticalTests};

use super::*;

fn nothing(name: &str) -> ExperimentResults {
    ExperimentResults {
        episodes: vec![name.to_owned()],
        trials: 1,
        seed: 0,
        model: name.to_owned(),
        calibration: None,
        methods: Default::default(),
        tests: StatisticalTests {
            level: 0.05,
            overall: Default::default(),
            by_usage_type: Default::default(),
        },
        oracle: Vec::new(),
        target_accuracy: 0.95,
        coverage: Vec::new(),
        kinds: Vec::new(),
        created_with: "a test".to_owned(),
    }
}

#[test]
fn names_let_no_markup_through() {
    let results = nothing("<script>alert(1)</script>\"'&");
    let page = index(&results, &[], &figures(&results));
    assert!(!page.contains("<script"), "{page}");
    assert!(page.contains("&lt;script&gt;alert(1)"));
}

#[test]
fn a_page_asks_the_network_for_nothing() {
    let results = nothing("home");
    let page = index(&results, &[], &figures(&results));
    assert!(page.contains("default-src 'none'"));
    let addresses: Vec<&str> =
        page.match_indices("http").map(|(at, _)| &page[at..(at + 30).min(page.len())]).collect();
    assert!(
        addresses
            .iter()
            .all(|address| address.starts_with("http-equiv")
                || address.starts_with("http://www.w3.org/2000/svg")),
        "{addresses:?}"
    );
}

#[test]
fn an_experiment_without_a_method_still_has_a_page() {
    for figure in figures(&nothing("home")) {
        assert!(roxmltree::Document::parse(&figure.svg).is_ok(), "{}", figure.file_name);
    }
}
