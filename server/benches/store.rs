//! How fast a home's memory takes events in and sums them up.
//!
//! `cargo bench -p coin-server` prints the figures. Events are spread over a year and over the objects; the file
//! lies in the temporary folder, so its disk is part of what is measured.

#![expect(clippy::unwrap_used, reason = "a benchmark stops at the first fault")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use coin::captions::CaptionReader;
use coin_schemas::episode::CaptionLine;
use coin_schemas::household::ObjectId;
use coin_server::episode::{self, LoadedEpisode};
use coin_server::store::{Access, Store};
use coin_server::{ServiceOptions, service};
use divan::Bencher;
use divan::counter::ItemsCount;
use serde_json::{Value, json};
use tempfile::TempDir;

type JsonObject = serde_json::Map<String, Value>;

fn object(value: Value) -> JsonObject {
    serde_json::from_value(value).unwrap()
}

fn main() {
    divan::main();
}

const USERS: [&str; 4] = ["Bob", "Mary", "Tom", "Ann"];
const TEXTS: [&str; 4] =
    ["takes the Marker", "is using the Marker", "puts the Marker back", "carries the Marker"];

/// A minute of 2024 as captions write it.
fn minute(number: usize) -> String {
    let start = jiff::civil::date(2024, 1, 1).at(0, 0, 0, 0);
    let minute = i64::try_from(number % (366 * 24 * 60)).unwrap();
    start.saturating_add(jiff::Span::new().minutes(minute)).strftime("%Y-%m-%d %H:%M").to_string()
}

fn caption(number: usize) -> String {
    let user = USERS[number % USERS.len()];
    let text = TEXTS[number / 7 % TEXTS.len()];
    format!("{} {user} {text} {}", minute(number * 17), number / (366 * 24 * 60))
}

/// An episode folder with so many events, spread evenly over the objects.
fn write_episode(folder: &Path, objects: usize, events: usize) {
    let objects_json: Vec<Value> = (0..objects)
        .map(|id| json!({"id": id.to_string(), "class": "marker", "position": [id as f64, 0.0, 0.0]}))
        .collect();
    let users: serde_json::Map<String, Value> =
        USERS.iter().map(|&name| (name.to_owned(), json!({}))).collect();
    let home = json!({"name": "bench", "users": users, "objects": objects_json, "captions": "captions.jsonl",
        "now": "2025-01-01T00:00:00"});
    fs::write(folder.join("episode.json"), home.to_string()).unwrap();
    let mut lines = String::new();
    for number in 0..events {
        let line = json!({"object_id": (number % objects).to_string(), "caption": caption(number)});
        writeln!(lines, "{line}").unwrap();
    }
    fs::write(folder.join("captions.jsonl"), lines).unwrap();
}

fn loaded(objects: usize, events: usize) -> LoadedEpisode {
    let folder = tempfile::tempdir().unwrap();
    write_episode(folder.path(), objects, events);
    episode::load(folder.path()).unwrap()
}

/// A file with a home that holds so many events of each object.
fn home(objects: usize, events: usize) -> (TempDir, Arc<Store>) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("home.db"), Access::ReadWrite).unwrap();
    store.import(&loaded(objects, events)).unwrap();
    (folder, Arc::new(store))
}

#[divan::bench(args = [10_000, 100_000], sample_count = 10)]
fn load_episode(bencher: Bencher<'_, '_>, events: usize) {
    let folder = tempfile::tempdir().unwrap();
    write_episode(folder.path(), 34, events);
    bencher.counter(ItemsCount::new(events)).bench(|| episode::load(folder.path()).unwrap());
}

/// From the folder to the committed file.
#[divan::bench(args = [3_425, 10_000, 100_000], sample_count = 10, sample_size = 1)]
fn import(bencher: Bencher<'_, '_>, events: usize) {
    let folder = tempfile::tempdir().unwrap();
    write_episode(folder.path(), 34, events);
    bencher
        .counter(ItemsCount::new(events))
        .with_inputs(|| {
            let file = tempfile::tempdir().unwrap();
            let store = Store::open(&file.path().join("home.db"), Access::ReadWrite).unwrap();
            (file, store)
        })
        .bench_values(|(file, store)| {
            store.import(&episode::load(folder.path()).unwrap()).unwrap();
            (file, store)
        });
}

/// From the arguments of the call to the committed file and the result.
#[divan::bench(args = [1, 100, 10_000, 100_000], sample_count = 10, sample_size = 1)]
fn record_usage(bencher: Bencher<'_, '_>, events: usize) {
    let captions: Vec<Value> = (0..events)
        .map(|number| json!({"object_id": (number % 34).to_string(), "caption": caption(number)}))
        .collect();
    bencher
        .counter(ItemsCount::new(events))
        .with_inputs(|| {
            let (folder, store) = home(34, 0);
            (folder, service(store, ServiceOptions::default()), object(json!({"captions": captions})))
        })
        .bench_values(|(folder, service, arguments)| {
            let result = service.call("record_usage", &arguments).unwrap();
            assert_eq!(result["recorded"], events);
            folder
        });
}

/// A home with a hundred events of each object, filled object by object.
fn large_home(events: usize) -> (TempDir, Arc<Store>, usize) {
    const EVENTS_AN_OBJECT: usize = 100;
    const OBJECTS_A_CHUNK: usize = 10_000;
    let objects = events / EVENTS_AN_OBJECT;
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("home.db"), Access::ReadWrite).unwrap();
    let mut chunk = loaded(objects, 0);
    let reader = CaptionReader::new(&chunk.roster);
    for first in (0..objects).step_by(OBJECTS_A_CHUNK) {
        let last = (first + OBJECTS_A_CHUNK).min(objects);
        chunk.captions = (first..last)
            .flat_map(|object| (0..EVENTS_AN_OBJECT).map(move |number| (object, number * 1_009 + object)))
            .map(|(object, number)| CaptionLine {
                object_id: ObjectId::new(object.to_string()).unwrap(),
                caption: caption(number),
            })
            .collect();
        chunk.observations = chunk.captions.iter().map(|line| reader.read(&line.caption).unwrap()).collect();
        store.import(&chunk).unwrap();
    }
    (folder, Arc::new(store), objects)
}

/// An object with a hundred events, in a home with so many events in all; the same object again and again.
#[divan::bench(args = [10_000, 1_000_000, 10_000_000], sample_count = 200, sample_size = 20)]
fn get_usage_summary(bencher: Bencher<'_, '_>, events: usize) {
    let (_folder, store, objects) = large_home(events);
    let service = service(store, ServiceOptions::default());
    let arguments = object(json!({"object_id": (objects / 2).to_string()}));
    bencher.bench(|| service.call("get_usage_summary", &arguments).unwrap());
}

/// The same for an object at random, so that its page may have to be fetched.
#[divan::bench(args = [10_000, 1_000_000, 10_000_000], sample_count = 200, sample_size = 20)]
fn get_usage_summary_at_random(bencher: Bencher<'_, '_>, events: usize) {
    let (_folder, store, objects) = large_home(events);
    let service = service(store, ServiceOptions::default());
    let mut next = 0_usize;
    bencher
        .with_inputs(|| {
            next = (next * 6_364_136_223 + 1_442_695_041) % objects;
            object(json!({"object_id": next.to_string()}))
        })
        .bench_local_values(|arguments| service.call("get_usage_summary", &arguments).unwrap());
}

/// The tool that does least, for comparison.
#[divan::bench]
fn list_users(bencher: Bencher<'_, '_>) {
    let (_folder, store) = home(34, 0);
    let service = service(store, ServiceOptions::default());
    bencher.bench(|| service.call("list_users", &JsonObject::new()));
}

#[divan::bench]
fn record_answer(bencher: Bencher<'_, '_>) {
    let (_folder, store) = home(34, 0);
    let service = service(store, ServiceOptions::default());
    let mut number = 0_u64;
    bencher.bench_local(|| {
        number += 1;
        let answer = json!({"object_id": "3", "question": "Whose is it?", "answer": format!("Bob's, as I said {number} times."), "ownership": {"Bob": true}});
        service.call("record_answer", &object(answer))
    });
}
