//! The fixture `small-house` has the structure of the paper's data: the paper's two heuristics, written down here
//! anew, get the paper's rows of Tables 2 and 4 to 6 on it, to the third decimal.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use coin_tests::small_house;
use rstest::rstest;
use serde_json::Value;

type People = BTreeSet<String>;

/// What the fixture says, read without any code of the product.
struct SmallHouse {
    truth: BTreeMap<String, People>,
    usage_type: BTreeMap<String, String>,
    /// Time and actor of every sighting of a thing, in the order of the file.
    uses: BTreeMap<String, Vec<(String, String)>>,
}

fn json(name: &str) -> Value {
    serde_json::from_slice(&fs::read(small_house().join(name)).unwrap()).unwrap()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap().to_owned()
}

impl SmallHouse {
    fn read() -> Self {
        let description = json("episode.json");
        let truth = json("truth.json");
        let people: Vec<&String> = description["users"].as_object().unwrap().keys().collect();
        let mut uses: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
        for line in fs::read_to_string(small_house().join("captions.jsonl")).unwrap().lines() {
            let line: Value = serde_json::from_str(line).unwrap();
            let caption = text(&line["caption"]);
            // `2025-01-13 06:13 Mary looks for the Sponge`: every caption of this fixture begins with its actor.
            let (time, words) = caption.split_at(16);
            let actor = words.split_whitespace().next().unwrap().to_owned();
            assert!(people.contains(&&actor), "{caption:?} has no actor of the household");
            uses.entry(text(&line["object_id"])).or_default().push((time.to_owned(), actor));
        }
        let owners = truth["owners"].as_object().unwrap().iter();
        let types = truth["usage_type"].as_object().unwrap().iter();
        Self {
            truth: owners
                .map(|(id, owners)| (id.clone(), owners.as_array().unwrap().iter().map(text).collect()))
                .collect(),
            usage_type: types.map(|(id, usage_type)| (id.clone(), text(usage_type))).collect(),
            uses,
        }
    }

    /// Last-User: whoever was seen last. Lines of one minute stand in their order.
    fn last_user(&self, id: &str) -> String {
        let mut uses: Vec<&(String, String)> = self.uses[id].iter().collect();
        uses.sort_by(|one, other| one.0.cmp(&other.0));
        uses.last().unwrap().1.clone()
    }

    /// Frequency: whoever was seen most often; of equals, who was seen last.
    fn most_frequent_user(&self, id: &str) -> String {
        let mut seen: BTreeMap<&str, (usize, &str)> = BTreeMap::new();
        for (time, actor) in &self.uses[id] {
            let (count, last) = seen.entry(actor).or_insert((0, time));
            *count += 1;
            *last = time.as_str().max(last);
        }
        seen.into_iter().max_by_key(|(_, rank)| *rank).unwrap().0.to_owned()
    }
}

/// Subset Accuracy, Mean Jaccard, and micro-averaged precision, recall and F1, to the third decimal.
fn figures(judged: &[(&People, People)]) -> [String; 5] {
    let things = judged.len() as f64;
    let mut exact = 0.0;
    let mut jaccard = 0.0;
    let (mut right, mut given, mut wanted) = (0.0, 0.0, 0.0);
    for (truth, estimate) in judged {
        exact += f64::from(u8::from(*truth == estimate));
        let both = truth.intersection(estimate).count() as f64;
        jaccard += both / truth.union(estimate).count() as f64;
        right += both;
        given += estimate.len() as f64;
        wanted += truth.len() as f64;
    }
    let (precision, recall) = (right / given, right / wanted);
    let f1 = 2.0 * precision * recall / (precision + recall);
    [exact / things, jaccard / things, precision, recall, f1].map(three_decimals)
}

/// As the paper rounds: a half goes up, and 18/32 is .563.
fn three_decimals(figure: f64) -> String {
    format!("{:.3}", (figure * 1e3).round() / 1e3)
}

#[derive(Debug, Clone, Copy)]
enum Heuristic {
    LastUser,
    Frequency,
}

#[rstest]
#[case::overall(Heuristic::LastUser, None, ["0.588", "0.721", "0.941", "0.582", "0.719"])]
#[case::overall(Heuristic::Frequency, None, ["0.647", "0.779", "1.000", "0.618", "0.764"])]
#[case::single(Heuristic::LastUser, Some("single_user"), ["1.000"; 5])]
#[case::single(Heuristic::Frequency, Some("single_user"), ["1.000"; 5])]
#[case::temporary(Heuristic::LastUser, Some("temporary_sharing"), ["0.600", "0.700", "0.867", "0.591", "0.703"])]
#[case::temporary(Heuristic::Frequency, Some("temporary_sharing"), ["0.733", "0.833", "1.000", "0.682", "0.811"])]
#[case::multi(Heuristic::LastUser, Some("multi_user_sharing"), ["0.111", "0.444", "1.000", "0.391", "0.563"])]
#[case::multi(Heuristic::Frequency, Some("multi_user_sharing"), ["0.111", "0.444", "1.000", "0.391", "0.563"])]
fn the_heuristics_get_the_papers_rows(
    #[case] heuristic: Heuristic,
    #[case] usage_type: Option<&str>,
    #[case] row: [&str; 5],
) {
    let house = SmallHouse::read();
    let judged: Vec<(&People, People)> = house
        .truth
        .iter()
        .filter(|(id, _)| usage_type.is_none_or(|wanted| house.usage_type[*id] == wanted))
        .map(|(id, truth)| {
            let user = match heuristic {
                Heuristic::LastUser => house.last_user(id),
                Heuristic::Frequency => house.most_frequent_user(id),
            };
            (truth, People::from([user]))
        })
        .collect();
    assert_eq!(figures(&judged), row);
}

#[test]
fn the_fixture_has_the_size_of_the_papers_data() {
    let house = SmallHouse::read();
    assert_eq!(house.truth.len(), 34);
    assert_eq!(house.truth.values().map(People::len).sum::<usize>(), 55);
    assert_eq!(house.uses.values().map(Vec::len).sum::<usize>(), 3_425);
    let of_type = |wanted: &str| house.usage_type.values().filter(|one| *one == wanted).count();
    assert_eq!(["single_user", "temporary_sharing", "multi_user_sharing"].map(of_type), [10, 15, 9]);
    let times: Vec<&String> = house.uses.values().flatten().map(|(time, _)| time).collect();
    let days: BTreeSet<&str> = times.iter().map(|time| &time[..10]).collect();
    assert_eq!(days.len(), 7);
    assert!(times.iter().all(|time| ("06:00"..="23:00").contains(&&time[11..])));
}

#[test]
fn the_products_own_metrics_agree() {
    // With nothing asked, the report's figures are those of its own owner sets, worked out here once more.
    let report = coin_tests::Program::new("host")
        .args(["--episode".as_ref(), small_house().as_os_str()])
        .args(["--gate", "never", "--json", "--quiet"])
        .run()
        .expect_code(0)
        .json();
    let house = SmallHouse::read();
    let judged: Vec<(&People, People)> = report["objects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|object| {
            let owners = object["owners"].as_array().unwrap().iter().map(text).collect();
            (&house.truth[object["id"].as_str().unwrap()], owners)
        })
        .collect();
    let overall = &report["metrics"]["overall"];
    let reported = ["subset_accuracy", "mean_jaccard", "micro_precision", "micro_recall", "micro_f1"]
        .map(|figure| three_decimals(overall[figure].as_f64().unwrap()));
    assert_eq!(figures(&judged), reported);
}
