//! `--html`: one page about one episode, that opens from disk and lets nothing in.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use coin_tests::{EpisodeBuilder, small_house};
use serde_json::{Value, json};

/// Runs an episode and gives its page and its report.
fn page(episode: &Path, more: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("home.html");
    let finished =
        super::host(episode, &["--json", "--html", file.to_str().unwrap()]).args(more).run().expect_code(0);
    (fs::read_to_string(&file).unwrap(), finished.json())
}

/// The values of an attribute, wherever it stands.
fn attributes<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let key = format!(" {name}=\"");
    page.split(key.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn every_thing_is_on_the_plan_and_its_evidence_on_the_page() {
    let (page, report) = page(&small_house(), &[]);
    let things = report["objects"].as_array().unwrap();
    assert_eq!(page.matches("class=\"thing\" href=\"#thing-").count(), things.len());
    let ids: BTreeSet<&str> = attributes(&page, "id").into_iter().collect();
    for link in attributes(&page, "href") {
        assert!(ids.contains(link.strip_prefix('#').unwrap()), "{link} leads nowhere");
    }
    for question in super::questions(&report) {
        for words in [&question["question"], &question["answer"]] {
            let shown = words.as_str().unwrap().replace('&', "&amp;").replace('"', "&quot;");
            assert!(page.contains(&shown), "{shown} is not on the page");
        }
    }
    // Every thing was seen in use, and says by whom.
    assert_eq!(page.matches("<caption>Who used it</caption>").count(), things.len());
}

/// The slider goes through the states that the plan had, and each thing has exactly one at every step.
#[test]
fn the_plan_can_be_seen_as_it_was_after_every_question() {
    let (page, report) = page(&small_house(), &["--gate", "always", "--max-questions", "4"]);
    let asked = super::questions(&report).len();
    assert!(asked > 0 && page.contains(&format!("type=\"range\" min=\"0\" max=\"{asked}\"")), "{asked}");
    for mark in page.split("<a class=\"thing\"").skip(1) {
        let mark = mark.split("</a>").next().unwrap();
        let mut next = 0;
        for state in mark.split("<g").skip(1) {
            let bound = |name: &str| attributes(state, name)[0].parse::<usize>().unwrap();
            assert_eq!(bound("data-from"), next, "{mark}");
            next = bound("data-to") + 1;
        }
        assert_eq!(next, asked + 1, "{mark}");
    }
    let rings: Vec<&str> = page.split("<circle class=\"asked").skip(1).collect();
    assert_eq!(rings.len(), asked);
}

#[test]
fn a_page_asks_the_network_for_nothing() {
    let (page, _) = page(&small_house(), &[]);
    assert!(page.contains("default-src 'none'"));
    assert!(attributes(&page, "src").is_empty());
    let addresses: BTreeSet<&str> = page
        .match_indices("://")
        .map(|(at, _)| page[..at].rsplit(['"', '\'', ' ']).next().unwrap())
        .collect();
    assert_eq!(addresses, BTreeSet::from(["http"]), "the name of the SVG format alone");
    assert_eq!(page.matches("http://").count(), page.matches("http://www.w3.org/2000/svg").count());
}

#[test]
fn names_captions_and_answers_stay_text() {
    let hostile = "<script>alert('1')</script>";
    let mut episode = EpisodeBuilder::three_things();
    episode.description["name"] = json!(hostile);
    episode.description["description"] = json!(format!("\"{hostile}"));
    episode.description["objects"][0]["class"] = json!(hostile);
    episode.description["objects"][0]["room"] = json!(format!("\"/>{hostile}"));
    episode.description["users"][hostile] = json!({"role": hostile});
    episode = episode.caption("2", &format!("2025-01-18 20:00 Mary reads \"{hostile}\" to the Mug"));
    let folder = episode.write();
    let (page, _) = page(folder.path(), &["--gate", "always"]);
    assert_eq!(page.matches("<script").count(), 1, "the page's own");
    assert!(page.contains("&lt;script&gt;alert('1')&lt;/script&gt;&quot; to the Mug"));
}

#[test]
fn without_truth_the_page_shows_how_sure_the_answers_are() {
    let mut episode = EpisodeBuilder::three_things();
    episode.truth = None;
    let folder = episode.write();
    let (page, report) = page(folder.path(), &["--gate", "never", "--answers", "terminal"]);
    assert!(report.get("curve").is_none());
    assert!(page.contains("mean confidence") && !page.contains("Subset Accuracy"));
    assert!(page.contains("Nothing was asked."));
    assert!(!page.contains("type=\"range\""), "there is nothing to go back to");
}

#[test]
fn a_home_without_things_has_a_page() {
    let mut episode = EpisodeBuilder::new();
    episode.truth = Some(json!({"owners": {}}));
    let folder = episode.write();
    let (page, _) = page(folder.path(), &[]);
    assert!(page.contains("<svg class=\"plan\""));
}

#[test]
fn the_same_run_makes_the_same_page() {
    let pages = [(); 2].map(|()| page(&small_house(), &[]).0);
    let without_time = |page: &str| {
        let lines = page.split("<dt>").filter(|fact| !fact.starts_with("effort"));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(without_time(&pages[0]), without_time(&pages[1]));
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_work() {
    super::host(&small_house(), &["--html", "/nowhere/at/all/home.html"])
        .run()
        .expect_code(2)
        .expect_stderr(&["cannot write /nowhere/at/all/home.html"]);
}
