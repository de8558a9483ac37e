//! The paper's figures, recomputed from the written files by other code than the crate's own.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{Protocol, home, write};

type Names = BTreeSet<String>;

/// What one user did with one thing: how many events, and the time of the last.
type Activity = (usize, String);

/// What is counted for one set of things: how many are right, the sum of Jaccard indices, and the three counts
/// of the micro averages.
#[derive(Default)]
struct Tally {
    things: f64,
    right: f64,
    jaccard: f64,
    both: f64,
    predicted: f64,
    true_owners: f64,
}

impl Tally {
    fn add(&mut self, predicted: &str, owners: &Names) {
        let hit = f64::from(u8::from(owners.contains(predicted)));
        self.things += 1.0;
        self.right += if owners.len() == 1 { hit } else { 0.0 };
        self.jaccard += hit / (owners.len() as f64 + 1.0 - hit);
        self.both += hit;
        self.predicted += 1.0;
        self.true_owners += owners.len() as f64;
    }

    /// Subset Accuracy, Mean Jaccard, precision, recall and F1 to the third decimal, halves rounded up as the
    /// paper does.
    fn row(&self) -> String {
        let figures = [
            self.right / self.things,
            self.jaccard / self.things,
            self.both / self.predicted,
            self.both / self.true_owners,
            2.0 * self.both / (self.predicted + self.true_owners),
        ];
        figures.map(|figure| format!("{:.3}", (figure * 1000.0 + 0.5).floor() / 1000.0)).join(" ")
    }
}

/// The rows of a heuristic, overall and by usage type.
fn rows(predictions: &BTreeMap<String, String>, truth: &Value) -> BTreeMap<String, String> {
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for (id, owners) in truth["owners"].as_object().unwrap() {
        let owners: Names =
            owners.as_array().unwrap().iter().map(|name| name.as_str().unwrap().to_owned()).collect();
        for of in ["overall", truth["usage_type"][id].as_str().unwrap()] {
            tallies.entry(of.to_owned()).or_default().add(&predictions[id], &owners);
        }
    }
    tallies.into_iter().map(|(of, tally)| (of, tally.row())).collect()
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap()
}

/// Checks everything that the paper says of its data, in the files of a folder.
pub(super) fn assert_paper_structure(folder: &Path) {
    let episode: Value = serde_json::from_str(&read(&folder.join("episode.json"))).unwrap();
    let truth: Value = serde_json::from_str(&read(&folder.join("truth.json"))).unwrap();
    let lines: Vec<Value> = read(&folder.join("captions.jsonl"))
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();

    assert_eq!(episode["objects"].as_array().unwrap().len(), 34);
    assert_eq!(
        episode["users"],
        serde_json::json!({
            "Bob": {"role": "father", "occupation": "office worker"},
            "Mary": {"role": "mother", "occupation": "homemaker"},
            "Tom": {"role": "son", "occupation": "elementary school student"},
        })
    );
    assert_eq!(episode["now"], "2025-01-19T23:00:00");
    assert_eq!(episode["train_until"], "2025-01-16T00:00:00");
    assert_eq!(lines.len(), 3425);

    let mut structure: BTreeMap<(String, usize), usize> = BTreeMap::new();
    for (id, owners) in truth["owners"].as_object().unwrap() {
        let usage_type = truth["usage_type"][id].as_str().unwrap().to_owned();
        *structure.entry((usage_type, owners.as_array().unwrap().len())).or_default() += 1;
    }
    let expected = [
        (("single_user", 1), 10),
        (("temporary_sharing", 1), 11),
        (("temporary_sharing", 2), 1),
        (("temporary_sharing", 3), 3),
        (("multi_user_sharing", 1), 1),
        (("multi_user_sharing", 2), 2),
        (("multi_user_sharing", 3), 6),
    ];
    assert_eq!(
        structure,
        expected.map(|((usage_type, owners), count)| ((usage_type.to_owned(), owners), count)).into()
    );

    let mut unique = BTreeSet::new();
    let mut events: BTreeMap<String, BTreeMap<String, Activity>> = BTreeMap::new();
    for line in &lines {
        let (id, caption) = (line["object_id"].as_str().unwrap(), line["caption"].as_str().unwrap());
        assert!(unique.insert((id, caption)), "twice: {caption}");
        let (time, user) = (&caption[..16], caption[17..].split(' ').next().unwrap());
        assert!(("2025-01-13".."2025-01-20").contains(&&time[..10]), "{caption}");
        assert!(("06:00".."23:00").contains(&&time[11..]), "{caption}");
        let of_user = events.entry(id.to_owned()).or_default().entry(user.to_owned()).or_default();
        of_user.0 += 1;
        of_user.1 = time.to_owned().max(std::mem::take(&mut of_user.1));
    }
    let best = |key: &dyn Fn(&Activity) -> Activity| -> BTreeMap<String, String> {
        events
            .iter()
            .map(|(id, users)| {
                // In the order of names, and a later one must be strictly better.
                let mut best: Option<(&String, Activity)> = None;
                for (user, of_user) in users {
                    if best.as_ref().is_none_or(|(_, score)| key(of_user) > *score) {
                        best = Some((user, key(of_user)));
                    }
                }
                (id.clone(), best.unwrap().0.clone())
            })
            .collect()
    };
    let frequency = best(&|of_user| of_user.clone());
    let last_user = best(&|of_user| (0, of_user.1.clone()));
    for users in events.values() {
        let last = users.values().map(|(_, time)| time).max().unwrap();
        assert_eq!(users.values().filter(|(_, time)| time == last).count(), 1, "a tie in the last minute");
    }

    let table = |rows: [(&str, &str); 4]| -> BTreeMap<String, String> {
        rows.map(|(of, row)| (of.to_owned(), row.to_owned())).into()
    };
    assert_eq!(
        rows(&last_user, &truth),
        table([
            ("overall", "0.588 0.721 0.941 0.582 0.719"),
            ("single_user", "1.000 1.000 1.000 1.000 1.000"),
            ("temporary_sharing", "0.600 0.700 0.867 0.591 0.703"),
            ("multi_user_sharing", "0.111 0.444 1.000 0.391 0.563"),
        ])
    );
    assert_eq!(
        rows(&frequency, &truth),
        table([
            ("overall", "0.647 0.779 1.000 0.618 0.764"),
            ("single_user", "1.000 1.000 1.000 1.000 1.000"),
            ("temporary_sharing", "0.733 0.833 1.000 0.682 0.811"),
            ("multi_user_sharing", "0.111 0.444 1.000 0.391 0.563"),
        ])
    );
}

#[test]
fn the_heuristics_reproduce_the_papers_rows() {
    for seed in [1, 2, 77] {
        let folder = tempfile::tempdir().unwrap();
        write(&home(Protocol::Paper, seed), folder.path()).unwrap();
        assert_paper_structure(folder.path());
    }
}
