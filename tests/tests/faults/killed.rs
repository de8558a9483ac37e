//! SIGKILL: no chance to tidy up.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use coin_tests::{EpisodeFolder, Home, binary};
use rusqlite::Connection;
use serde_json::json;

const CAPTIONS: usize = 60_000;
const KILLS: u32 = 20;

fn large_episode() -> EpisodeFolder {
    let mut episode = super::furnished();
    episode.captions = (0..CAPTIONS).map(|number| super::caption(number).to_string()).collect();
    episode.write()
}

/// Starts an import and kills it after `delay`. Returns whether it was still running.
fn kill_import(episode: &Path, db: &Path, delay: Duration) -> bool {
    let mut child = Command::new(binary("coin-server"))
        .arg("import")
        .arg("--episode")
        .arg(episode)
        .arg("--db")
        .arg(db)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    thread::sleep(delay);
    let still_running = child.try_wait().unwrap().is_none();
    child.kill().unwrap();
    child.wait().unwrap();
    still_running
}

#[test]
fn an_import_that_is_killed_leaves_all_or_nothing() {
    let episode = large_episode();
    let folder = tempfile::tempdir().unwrap();
    // How long it takes here and now, so that the kills fall into it.
    let started = Instant::now();
    super::import(episode.path(), &folder.path().join("whole.db")).run().expect_code(0);
    let whole = started.elapsed();

    let mut killed = 0;
    for attempt in 0..KILLS {
        let db = folder.path().join(format!("{attempt}.db"));
        let delay = whole * (attempt + 1) / (KILLS + 1);
        killed += u32::from(kill_import(episode.path(), &db, delay));
        if !db.exists() {
            continue;
        }
        // The file opens, whatever state it was left in, and holds all or nothing.
        let mut server = super::serve(&db);
        let (status, stderr) = match server.call("list_objects", json!({})) {
            answer if answer.is_error => server.finish(),
            answer => {
                let total = answer.value()["total"].as_u64().unwrap();
                assert!(total == 0 || total == 3, "{total} of 3 things were left");
                server.finish()
            }
        };
        assert_eq!(status.code(), Some(0), "{stderr}");
        super::assert_sound(&db);
        let (objects, events) = (super::count(&db, "objects"), super::count(&db, "usage_events"));
        assert!(
            (objects, events) == (0, 0) || (objects, events) == (3, CAPTIONS),
            "{objects} things and {events} events were left"
        );
        // The same import done again completes it.
        super::import(episode.path(), &db).run().expect_code(0);
        assert_eq!(super::count(&db, "usage_events"), CAPTIONS);
    }
    assert!(killed >= KILLS / 2, "only {killed} of {KILLS} imports were killed in time");
}

/// Which captions, by the moment in them, and which answers were acknowledged.
#[derive(Default)]
struct Acknowledged {
    captions: BTreeSet<String>,
    answers: BTreeSet<String>,
}

/// Loads the server with writes until it is killed from outside, and keeps what it acknowledged.
fn write_until_killed(home: &Home, round: u32, delay: Duration, acknowledged: &mut Acknowledged) {
    let mut server = home.server();
    let started = Instant::now();
    let mut number = 0;
    let mut sent = Vec::new();
    // Sixteen calls are always under way, every fourth an answer, so that the kill meets several transactions.
    while started.elapsed() < delay {
        let usage = super::caption(usize::try_from(round).unwrap() * 4_000 + number);
        let line = usage["caption"].as_str().unwrap().to_owned();
        let (arguments, tool) = if number % 4 == 0 {
            let answer = format!("It is Bob's ({round}, {number}).");
            (
                json!({"object_id": "2", "question": "Whose?", "answer": answer, "ownership": {"Bob": true}}),
                "record_answer",
            )
        } else {
            (json!({"captions": [usage]}), "record_usage")
        };
        let text = arguments.get("answer").and_then(|answer| answer.as_str()).map_or(line, str::to_owned);
        let id = server.send("tools/call", json!({"name": tool, "arguments": arguments}));
        sent.push((id, tool, text));
        number += 1;
        if sent.len() >= 16 {
            let (id, tool, text) = sent.remove(0);
            let result = server.wait(id).unwrap();
            assert!(!result["isError"].as_bool().unwrap_or(false), "{result:#}");
            acknowledge(acknowledged, tool, text);
        }
    }
    server.kill();
    // What was on its way out when the kill came was acknowledged too.
    for (id, tool, text) in sent {
        if let Some(Ok(result)) = server.try_wait(id) {
            assert!(!result["isError"].as_bool().unwrap_or(false), "{result:#}");
            acknowledge(acknowledged, tool, text);
        }
    }
}

fn acknowledge(acknowledged: &mut Acknowledged, tool: &str, text: String) {
    match tool {
        "record_usage" => acknowledged.captions.insert(text),
        _ => acknowledged.answers.insert(text),
    };
}

fn texts(db: &Path, select: &str) -> BTreeSet<String> {
    let database = Connection::open(db).unwrap();
    let mut statement = database.prepare(select).unwrap();
    statement.query_map([], |row| row.get(0)).unwrap().collect::<Result<_, _>>().unwrap()
}

#[test]
fn what_was_acknowledged_survives_every_kill() {
    let home = Home::of(&super::furnished());
    let mut acknowledged = Acknowledged::default();
    for round in 0..KILLS {
        let delay = Duration::from_millis(40 + u64::from(round) * 7);
        write_until_killed(&home, round, delay, &mut acknowledged);
        super::assert_sound(&home.db());
        let captions = texts(&home.db(), "SELECT caption FROM usage_events");
        let answers = texts(&home.db(), "SELECT answer FROM answers");
        let lost: Vec<&String> = acknowledged.captions.difference(&captions).collect();
        assert!(lost.is_empty(), "captions were acknowledged and are gone: {lost:?}");
        let lost: Vec<&String> = acknowledged.answers.difference(&answers).collect();
        assert!(lost.is_empty(), "answers were acknowledged and are gone: {lost:?}");
    }
    assert!(acknowledged.captions.len() > 100, "only {} captions were written", acknowledged.captions.len());
    assert!(acknowledged.answers.len() > 30, "only {} answers were written", acknowledged.answers.len());
    let listed = home.server().ok("list_objects", json!({"settled": true}));
    assert_eq!(listed["objects"][0]["owners"], json!(["Bob"]));
}
