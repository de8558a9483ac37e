//! A long history does not slow a look at a thing down.

use std::path::Path;
use std::time::{Duration, Instant};

use coin_tests::{EpisodeBuilder, Home, is_slow_run};
use rusqlite::Connection;
use serde_json::json;

use super::pipe::{Pipe, call};
use super::{median, microseconds};

/// The other things of the home.
const OTHERS: usize = 1_000;
/// Events of the thing that is looked at.
const EVENTS: usize = 100;
const CALLS: usize = 2_000;

/// A home whose other things have so many events together. The thing that is looked at lies between them.
fn home_with(events: usize) -> Home {
    let mut episode = EpisodeBuilder::new();
    for number in 0..OTHERS {
        if number == OTHERS / 2 {
            episode = episode.object("looked-at", "marker", [0.0, 0.0, 0.0]);
        }
        episode = episode.object(&format!("other-{number:04}"), "mug", [1.0, 0.0, 0.0]);
    }
    for number in 0..EVENTS {
        let (day, hour) = (1 + number / 20, number % 20);
        let user = ["Bob", "Mary", "Tom"][number % 3];
        episode = episode
            .caption("looked-at", &format!("2025-01-{day:02} {hour:02}:00 {user} is using the Marker"));
    }
    let home = Home::of(&episode);
    fill(&home.db(), events / OTHERS);
    home
}

/// Puts events into the database behind the server's back; a million calls would take longer than the test.
fn fill(db: &Path, events_each: usize) {
    let database = Connection::open(db).unwrap();
    database
        .execute_batch(&format!(
            "PRAGMA journal_mode = OFF;
             PRAGMA synchronous = OFF;
             PRAGMA cache_size = -200000;
             BEGIN;
             WITH RECURSIVE numbers (number) AS (
                 SELECT 0 UNION ALL SELECT number + 1 FROM numbers WHERE number + 1 < {events_each}
             )
             INSERT INTO usage_events (object_key, at, caption, actor, action)
             SELECT objects.object_key, sample.at + numbers.number,
                    'Event ' || numbers.number || ': Bob is using the Mug', sample.actor, sample.action
             FROM objects
             CROSS JOIN (SELECT at, actor, action FROM usage_events ORDER BY at LIMIT 1) AS sample
             CROSS JOIN numbers
             WHERE objects.id <> 'looked-at';
             COMMIT;
             PRAGMA journal_mode = WAL;"
        ))
        .unwrap();
}

#[test]
fn ten_million_events_do_not_slow_a_summary_down() {
    if !is_slow_run("ten million events") {
        return;
    }
    let many: usize = std::env::var("COIN_SLOW_EVENTS")
        .map_or(10_000_000, |text| text.parse().expect("COIN_SLOW_EVENTS is a number"));
    let few = 10_000;
    let started = Instant::now();
    let homes = [home_with(few), home_with(many)];
    let megabytes = homes.each_ref().map(|home| std::fs::metadata(home.db()).unwrap().len() / 1_000_000);
    println!(
        "history: filled in {:.0} s; {} and {} MB",
        started.elapsed().as_secs_f64(),
        megabytes[0],
        megabytes[1]
    );

    let summary = call("get_usage_summary", json!({"object_id": "looked-at"}));
    let mut pipes = homes.each_ref().map(|home| Pipe::open(&home.db()).0);
    assert_eq!(pipes[0].result(&summary), pipes[1].result(&summary));
    let mut times: [Vec<Duration>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..CALLS {
        for (pipe, times) in pipes.iter_mut().zip(&mut times) {
            times.push(pipe.time(&summary));
        }
    }
    let [short, long] = times.each_mut().map(|times| median(times));
    let ratio = long.as_secs_f64() / short.as_secs_f64();
    println!(
        "get_usage_summary of a thing with {EVENTS} events: {:.1} µs among {few} events, {:.1} µs among {many}, \
         ratio {ratio:.2} (medians of {CALLS} calls in turn)",
        microseconds(short),
        microseconds(long),
    );
    assert!(ratio <= 2.0, "{ratio:.2} times as slow");
}
