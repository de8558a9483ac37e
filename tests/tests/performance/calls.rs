//! The time of single calls.

use std::collections::BTreeMap;
use std::fs;
use std::time::{Duration, Instant};

use coin_tests::{Home, binary, is_slow_run, small_house};
use serde_json::{Value, json};

use super::pipe::{Pipe, call};
use super::{median, microseconds, milliseconds, quantile};

const STARTS: usize = 20;
const CALLS: usize = 2_000;
const WARM_UP: usize = 300;

#[test]
fn a_server_answers_within_fifteen_milliseconds_of_its_start() {
    if !is_slow_run("start") {
        return;
    }
    let home = Home::import(&small_house());
    let request = call("get_usage_summary", json!({"object_id": "1"}));
    // The first start reads the program from the disk.
    drop(Pipe::open(&home.db()));
    let mut to_hello = Vec::new();
    let mut to_tool = Vec::new();
    for _ in 0..STARTS {
        let started = Instant::now();
        let (mut pipe, hello) = Pipe::open(&home.db());
        pipe.result(&request);
        to_tool.push(started.elapsed());
        to_hello.push(hello);
    }
    let (hello, tool) = (median(&mut to_hello), median(&mut to_tool));
    println!(
        "start: {:.1} ms to the answer to initialize, {:.1} ms to the answer of a first tool (medians of {STARTS})",
        milliseconds(hello),
        milliseconds(tool)
    );
    let limit = Duration::from_millis(15);
    assert!(hello < limit, "the first answer took {hello:?}");
    assert!(tool < limit, "the first answer of a tool took {tool:?}");
}

/// How many captions every thing of the fixture has.
fn captions_by_thing() -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in fs::read_to_string(small_house().join("captions.jsonl")).unwrap().lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        *counts.entry(line["object_id"].as_str().unwrap().to_owned()).or_insert(0) += 1;
    }
    counts
}

/// The medians of two calls that take turns on one connection.
fn compare(pipe: &mut Pipe, one: &str, other: &str) -> [Duration; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..WARM_UP + CALLS {
        let durations = [pipe.time(one), pipe.time(other)];
        if round >= WARM_UP {
            times[0].push(durations[0]);
            times[1].push(durations[1]);
        }
    }
    let tails = times.each_mut().map(|times| quantile(times, 0.99));
    println!("  99th percentiles: {:.0} and {:.0} µs", microseconds(tails[0]), microseconds(tails[1]));
    times.each_mut().map(|times| median(times))
}

#[test]
fn a_usage_summary_takes_little_more_time_than_a_trivial_tool() {
    if !is_slow_run("get_usage_summary") {
        return;
    }
    let home = Home::import(&small_house());
    assert!(binary("coin-server").is_file());
    let (mut pipe, _) = Pipe::open(&home.db());
    let trivial = call("list_users", json!({}));
    let mut things: Vec<(usize, String)> =
        captions_by_thing().into_iter().map(|(id, count)| (count, id)).collect();
    things.sort();
    let typical = &things[things.len() / 2];
    let busiest = &things[things.len() - 1];
    // A trivial tool costs little but the pipe and SQLite's transaction; a summary has a hundred rows to read besides.
    // The busiest thing has more to count and more to say; it is watched with room for a noisy machine.
    for (what, (count, id), limit) in [("typical", typical, 2.5), ("busiest", busiest, 3.5)] {
        let summary = call("get_usage_summary", json!({"object_id": id}));
        let seen = pipe.result(&summary);
        let users = seen["user_summary"].as_array().unwrap();
        let events: u64 = users.iter().map(|user| user["total_events"].as_u64().unwrap()).sum();
        assert_eq!(events, *count as u64);
        let [trivial_time, summary_time] = compare(&mut pipe, &trivial, &summary);
        let ratio = summary_time.as_secs_f64() / trivial_time.as_secs_f64();
        println!(
            "get_usage_summary of the {what} thing ({count} events): {:.1} µs, list_users: {:.1} µs, ratio {ratio:.2} \
             (medians of {CALLS} calls in turn)",
            microseconds(summary_time),
            microseconds(trivial_time),
        );
        assert!(ratio <= limit, "{what}: {ratio:.2} times the trivial tool, and at most {limit} is meant");
    }
}
