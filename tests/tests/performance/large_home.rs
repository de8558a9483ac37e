//! A home of many things and people, with a year of captions, from its folder to the last answer.

use std::time::{Duration, Instant};

use coin_tests::{EpisodeBuilder, Program, is_slow_run};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value, json};

const THINGS: usize = 2000;
const PEOPLE: [&str; 8] = ["Ann", "Bob", "Cem", "Dora", "Eva", "Finn", "Gina", "Hans"];
const CLASSES: [&str; 10] =
    ["mug", "book", "pen", "towel", "laptop", "shirt", "plate", "lamp", "bag", "phone charger"];

fn below(generator: &mut ChaCha8Rng, bound: usize) -> usize {
    generator.random_range(0..bound)
}

/// So many of the people, drawn.
fn some_people(count: usize, generator: &mut ChaCha8Rng) -> Vec<usize> {
    rand::seq::index::sample(generator, PEOPLE.len(), count).into_vec()
}

/// Six things of ten are one person's, two are everybody's, two some people's; a third of them is lent, one session in
/// five.
fn large_home() -> EpisodeBuilder {
    let mut generator = ChaCha8Rng::seed_from_u64(7);

    let mut owners_of = Map::new();
    let users: Map<String, Value> = PEOPLE.iter().map(|name| ((*name).to_owned(), json!({}))).collect();
    let mut episode =
        EpisodeBuilder::new().with("/users", json!(users)).with("/now", json!("2026-01-01T00:00:00"));
    for thing in 1..=THINGS {
        let id = thing.to_string();
        let class = CLASSES[below(&mut generator, CLASSES.len())];
        let place = [below(&mut generator, 600) as f64 / 10.0, below(&mut generator, 600) as f64 / 10.0, 0.8];
        episode = episode.object(&id, class, place);
        let owner_count = match below(&mut generator, 10) {
            0..=5 => 1,
            6..=7 => PEOPLE.len(),
            _ => 2 + below(&mut generator, 2),
        };
        let owners = some_people(owner_count, &mut generator);
        let is_lent = below(&mut generator, 3) == 0;
        for session in 0..20 + below(&mut generator, 80) {
            let user = match is_lent && below(&mut generator, 5) == 0 {
                true => below(&mut generator, PEOPLE.len()),
                false => owners[below(&mut generator, owners.len())],
            };
            let (month, day) = (1 + session * 12 / 100, 1 + below(&mut generator, 28));
            let (hour, minute) = (6 + below(&mut generator, 16), below(&mut generator, 30));
            for (later, verb) in ["picks up", "is using", "puts away"].into_iter().enumerate() {
                let at = format!("2025-{month:02}-{day:02} {hour:02}:{:02}", minute + later);
                episode = episode.caption(&id, &format!("{at} {} {verb} the {class}", PEOPLE[user]));
            }
        }
        let names: Vec<&str> = owners.iter().map(|&owner| PEOPLE[owner]).collect();
        owners_of.insert(id, json!(names));
    }
    let truth = json!({"owners": owners_of}).to_string();
    episode.with("/truth", json!("truth.json")).file("truth.json", truth)
}

#[test]
fn a_home_of_2000_things_and_8_people_with_a_year_of_captions_settles_in_10_seconds() {
    if !is_slow_run("a large home") {
        return;
    }
    let folder = large_home().write();
    let started = Instant::now();
    let finished =
        Program::new("host").args(["--json", "--quiet", "--episode"]).arg(folder.path()).run().expect_code(0);
    let duration = started.elapsed();
    let report = finished.json();
    let questions = report["questions"].as_array().unwrap().len();
    let accuracy = report["metrics"]["overall"]["subset_accuracy"].as_f64().unwrap();
    println!("{THINGS} things: {:.1} s, {questions} questions, {accuracy:.4} right", duration.as_secs_f64());
    assert!(accuracy >= 0.988, "{accuracy}");
    assert!(duration < Duration::from_secs(10), "it took {duration:?}");
}
