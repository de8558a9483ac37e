//! Measures how `nearby_objects` and `similar_objects` do in a home with very many things.
//!
//! It reads a plan from standard input and prints what it measured, both as JSON; `clients/run scale` makes the one and
//! reads the other. It leaves the features and positions in the plan's folder, so that others can be measured with the
//! same ones.

mod bandwidth;
mod home;

use std::io::{Read, stdin};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use coin_server::service::CoinService;
use coin_server::store::{Access, Store};
use coin_server::{ServiceOptions, service};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// What is to be measured.
#[derive(Debug, Deserialize)]
struct Plan {
    /// Where everything is put.
    folder: PathBuf,
    /// How many things the home has.
    things: usize,
    /// Of how many classes.
    classes: usize,
    /// How many things are asked about, each once with each tool.
    calls: usize,
}

/// What was seen.
#[derive(Debug, Serialize)]
struct Figures {
    /// Bytes a second that are summed up, with one thread and with one for each processor.
    bandwidth: [f64; 2],
    build_seconds: f64,
    database_bytes: u64,
    /// Until a store is open, and then until the first call of each tool has its answer.
    open_milliseconds: f64,
    first_similar_milliseconds: f64,
    first_nearby_milliseconds: f64,
    /// The things that are asked about.
    asked: Vec<usize>,
    similar_milliseconds: Vec<f64>,
    nearby_milliseconds: Vec<f64>,
    /// The ids that came of each call.
    similar: Vec<Vec<String>>,
    nearby: Vec<Vec<String>>,
}

fn main() {
    let mut text = String::new();
    stdin().read_to_string(&mut text).expect("standard input can be read");
    let plan: Plan = serde_json::from_str(&text).expect("standard input holds a plan");
    println!("{}", json!(measure(&plan)));
}

fn measure(plan: &Plan) -> Figures {
    let bandwidth = bandwidth::measure();
    let database = plan.folder.join("home.db");
    let started = Instant::now();
    home::build(plan, &database);
    let build_seconds = started.elapsed().as_secs_f64();
    let database_bytes = database.metadata().expect("the database is there").len();

    let started = Instant::now();
    let store = Store::open(&database, Access::ReadWrite).expect("the database opens");
    let open_milliseconds = milliseconds(started);
    let service = service(Arc::new(store), ServiceOptions::default());
    let asked: Vec<usize> = (0..plan.calls).map(|call| (call * 7_919 + 13) % plan.things).collect();
    let ask = |tool, part, thing| call(&service, tool, part, thing);
    let (first_similar_milliseconds, _) = ask("similar_objects", "similar_objects", asked[0]);
    let (first_nearby_milliseconds, _) = ask("nearby_objects", "nearby_objects", asked[0]);
    let round = |tool| asked.iter().map(|&thing| ask(tool, tool, thing)).unzip();
    // The first round warms up.
    let _: (Vec<f64>, Vec<_>) = round("similar_objects");
    let (similar_milliseconds, similar) = round("similar_objects");
    let (nearby_milliseconds, nearby) = round("nearby_objects");
    Figures {
        bandwidth,
        build_seconds,
        database_bytes,
        open_milliseconds,
        first_similar_milliseconds,
        first_nearby_milliseconds,
        asked,
        similar_milliseconds,
        nearby_milliseconds,
        similar,
        nearby,
    }
}

/// Calls a tool about a thing: how long it took, and the ids in a part of the result.
fn call(service: &CoinService, tool: &str, part: &str, thing: usize) -> (f64, Vec<String>) {
    let arguments = json!({"object_id": thing.to_string()}).as_object().cloned().unwrap_or_default();
    let started = Instant::now();
    let result = service.call(tool, &arguments).unwrap_or_else(|error| panic!("{tool}: {error}"));
    let took = milliseconds(started);
    let id = |found: &Value| found["id"].as_str().expect("what is found has an id").to_owned();
    (took, result[part].as_array().expect("a list").iter().map(id).collect())
}

fn milliseconds(started: Instant) -> f64 {
    started.elapsed().as_secs_f64() * 1e3
}
