//! Nobody who looks waits for somebody who writes. One reads and one writes here, so that nobody waits for a
//! processor instead.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use coin_schemas::household::{Background, UserName};
use coin_server::store::{Access, Store, StoreError};
use coin_tests::{Home, HttpServer, is_slow_run, small_house};
use rusqlite::{Connection, TransactionBehavior};
use serde_json::json;

use super::clients::Client;
use super::distribution;

/// How long a write takes, in the tests.
const HOLD: Duration = Duration::from_millis(500);

/// How many writes follow one another.
const WRITES: usize = 6;

/// How long a reader may take beside a writer.
fn limit(name: &str) -> Duration {
    if is_slow_run(name) { Duration::from_millis(50) } else { HOLD / 2 }
}

/// Reads again and again while `write` does its work; fails where a read took too long.
#[track_caller]
fn assert_reads_go_on(name: &str, write: impl FnOnce() + Send, mut read: impl FnMut()) {
    let writes = AtomicBool::new(true);
    let mut times = Vec::new();
    thread::scope(|scope| {
        let writer = scope.spawn(|| {
            write();
            writes.store(false, Ordering::Release);
        });
        while writes.load(Ordering::Acquire) && !writer.is_finished() {
            let begun = Instant::now();
            read();
            times.push(begun.elapsed());
            thread::sleep(Duration::from_millis(1));
        }
        writer.join().unwrap();
    });
    println!("{name}: {}", distribution(&mut times));
    assert!(times.len() > 50, "there were only {} reads", times.len());
    let longest = times.last().unwrap();
    assert!(*longest < limit(name), "a read took {longest:?}");
}

#[test]
fn a_read_does_not_wait_for_a_write_of_its_own_process() {
    let home = Home::import(&small_house());
    let store = Store::open(&home.db(), Access::ReadWrite).unwrap();
    let write = || {
        for number in 0..WRITES {
            let name = UserName::new(format!("Guest {number}")).unwrap();
            let written = store.write(|writer| {
                writer.put_user(&name, &Background::default())?;
                thread::sleep(HOLD);
                Ok::<_, StoreError>(())
            });
            written.unwrap();
        }
    };
    assert_reads_go_on("reading beside a write in one process", write, || {
        let things = store.read(|reader| reader.objects()).unwrap();
        assert_eq!(things.len(), 34);
    });
}

#[test]
fn a_call_does_not_wait_for_another_that_cannot_write_yet() {
    let home = Home::import(&small_house());
    let server = HttpServer::start(home.db());
    let mut looking = Client::modern(server.address());
    let mut recording = Client::modern(server.address());
    let write = || {
        for number in 0..WRITES {
            // Another process writes for a while, so that the server's own write has to wait for it.
            let mut other = Connection::open(home.db()).unwrap();
            let lock = other.transaction_with_behavior(TransactionBehavior::Immediate).unwrap();
            let caption = format!("2025-01-19 19:00 Bob takes the Marker once more, {number}");
            let captions = json!({"captions": [{"object_id": "1", "caption": caption}]});
            thread::scope(|scope| {
                let recorded = scope.spawn(|| recording.call("record_usage", &captions));
                thread::sleep(HOLD);
                assert!(!recorded.is_finished(), "the write did not wait");
                lock.rollback().unwrap();
                assert_eq!(recorded.join().unwrap()["recorded"], 1);
            });
        }
    };
    assert_reads_go_on("reading over HTTP beside a write that waits", write, || {
        looking.call("get_usage_summary", &json!({"object_id": "1"}));
    });
}
