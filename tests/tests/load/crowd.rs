//! A minute with 64 clients of one server, and eight further servers beside it.

use std::collections::BTreeSet;
use std::thread;
use std::time::{Duration, Instant};

use coin_tests::{Era, Home, HttpServer, is_slow_run, small_house};
use rusqlite::Connection;
use serde_json::json;

use super::clients::Client;
use super::distribution;

const HTTP_CLIENTS: usize = 64;
const PIPE_CLIENTS: usize = 8;
const CLIENTS: usize = HTTP_CLIENTS + PIPE_CLIENTS;

/// How often every client calls a tool. A model that thinks in between calls far more rarely.
const PACE: Duration = Duration::from_millis(100);

/// What one client saw.
#[derive(Default)]
struct Ledger {
    captions: Vec<String>,
    questions: Vec<String>,
    reads: Vec<Duration>,
    writes: Vec<Duration>,
}

impl Ledger {
    /// Reads and records in turn until the time is up, and notes what was acknowledged.
    fn of(client: &mut Client, number: usize, duration: Duration) -> Self {
        let mut ledger = Self::default();
        let started =
            Instant::now() + PACE * u32::try_from(number).unwrap() / u32::try_from(CLIENTS).unwrap();
        for turn in 0.. {
            let at = started + PACE * turn;
            if at > started + duration {
                break;
            }
            thread::sleep(at.saturating_duration_since(Instant::now()));
            let turn = turn as usize;
            let object = (1 + (number + turn) % 30).to_string();
            let begun = Instant::now();
            match (number + turn) % 5 {
                0 => {
                    client.call("get_usage_summary", &json!({"object_id": object}));
                }
                1 => {
                    client.call("list_objects", &json!({}));
                }
                2 => {
                    client.call("nearby_objects", &json!({"object_id": object}));
                }
                3 => {
                    let caption = format!("2025-01-19 19:00 Bob takes the Marker, says {number} at {turn}");
                    let captions = json!({"captions": [{"object_id": object, "caption": caption}]});
                    assert_eq!(client.call("record_usage", &captions)["recorded"], 1);
                    ledger.captions.push(caption);
                }
                _ => {
                    let question = format!("Whose is it, asks {number} at {turn}?");
                    let answer = json!({
                        "object_id": object,
                        "question": question,
                        "answer": "It is Mary's.",
                        "ownership": {"Mary": true},
                    });
                    assert_eq!(client.call("record_answer", &answer)["status"], "answered");
                    ledger.questions.push(question);
                }
            }
            let times = if (number + turn) % 5 < 3 { &mut ledger.reads } else { &mut ledger.writes };
            times.push(begun.elapsed());
        }
        ledger
    }
}

#[test]
fn a_crowd_of_clients_is_served_and_loses_nothing() {
    let is_measured = is_slow_run("crowd");
    let duration = Duration::from_secs(if is_measured { 60 } else { 3 });
    let home = Home::import(&small_house());
    let server = HttpServer::start(home.db());
    let address = server.address();
    let ledgers: Vec<Ledger> = thread::scope(|scope| {
        let clients: Vec<_> = (0..CLIENTS)
            .map(|number| {
                let home = &home;
                scope.spawn(move || {
                    let mut client = match number {
                        HTTP_CLIENTS.. => Client::pipe(home, [Era::Legacy, Era::Modern][number % 2]),
                        _ if number % 4 == 0 => Client::session(address),
                        _ => Client::modern(address),
                    };
                    Ledger::of(&mut client, number, duration)
                })
            })
            .collect();
        clients.into_iter().map(|client| client.join().unwrap()).collect()
    });

    let (over_http, over_pipes) = ledgers.split_at(HTTP_CLIENTS);
    for (transport, ledgers) in [("HTTP", over_http), ("pipes", over_pipes)] {
        let times = |of: fn(&Ledger) -> &Vec<Duration>| -> Vec<Duration> {
            ledgers.iter().flat_map(|ledger| of(ledger).clone()).collect()
        };
        println!("reading over {transport}: {}", distribution(&mut times(|ledger| &ledger.reads)));
        println!("recording over {transport}: {}", distribution(&mut times(|ledger| &ledger.writes)));
    }
    assert_eq!(server.stderr().lines().count(), 1, "{}", server.stderr());

    let kept = |query: &str| -> BTreeSet<String> {
        let database = Connection::open(home.db()).unwrap();
        let mut statement = database.prepare(query).unwrap();
        statement.query_map([], |row| row.get(0)).unwrap().map(Result::unwrap).collect()
    };
    let captions = kept("SELECT caption FROM usage_events");
    let questions = kept("SELECT question FROM answers");
    let acknowledged = |of: fn(&Ledger) -> &Vec<String>| ledgers.iter().flat_map(of);
    let lost: Vec<&String> = acknowledged(|ledger| &ledger.captions)
        .filter(|caption| !captions.contains(*caption))
        .chain(acknowledged(|ledger| &ledger.questions).filter(|question| !questions.contains(*question)))
        .collect();
    assert!(lost.is_empty(), "acknowledged and lost: {lost:?}");
    let calls = (duration.as_secs_f64() / PACE.as_secs_f64()) as usize;
    assert!(questions.len() >= CLIENTS * calls / 10, "only {} answers were recorded", questions.len());
    assert_eq!(kept("PRAGMA integrity_check"), BTreeSet::from(["ok".to_owned()]));
}
