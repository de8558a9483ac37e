//! Several who use one home at once, and calls that somebody gives up.

use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use coin::captions::{Action, Observation};
use coin_schemas::episode::EpisodeObject;
use serde_json::json;

use super::*;

/// A home in a file with one thing, and the folder that holds it.
fn home() -> (tempfile::TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("home.db"), Access::ReadWrite).unwrap();
    add_bob(&store);
    let thing: EpisodeObject =
        serde_json::from_value(json!({"id": "1", "class": "cup", "position": [0.0, 0.0, 0.0]})).unwrap();
    store.write(|writer| writer.add_object(&thing)).unwrap();
    (folder, store)
}

#[expect(clippy::redundant_closure_for_method_calls, reason = "the method's path is not general enough")]
fn events(store: &Store) -> u64 {
    store.read(|reader| reader.event_count()).unwrap()
}

/// Records so many events in one change.
fn record(store: &Store, count: i64) -> Result<UsageCounts, StoreError> {
    let start: jiff::civil::DateTime = "2025-01-01T00:00:00".parse().unwrap();
    store.write(|writer| {
        let household = writer.household()?.unwrap();
        let object = writer.object("1")?.unwrap().key;
        let records: Vec<UsageRecord<'_>> = (0..count)
            .map(|second| {
                let at = start.saturating_add(jiff::Span::new().seconds(second));
                UsageRecord {
                    object,
                    observation: Observation { at, actor: None, action: Action::Use },
                    caption: "seen",
                }
            })
            .collect();
        writer.record_usage(&household, &records)
    })
}

#[test]
fn who_reads_waits_for_nobody_who_writes() {
    let (_folder, store) = home();
    let (begun, beginning) = channel();
    let writer = store.clone();
    let writing = thread::spawn(move || {
        writer.write(|writer| {
            writer.put_user(&UserName::new("Mary").unwrap(), &Background::default())?;
            begun.send(()).unwrap();
            thread::sleep(Duration::from_millis(400));
            Ok::<_, StoreError>(())
        })
    });
    beginning.recv().unwrap();
    let started = Instant::now();
    let seen = people(&store).unwrap().roster().len();
    assert!(started.elapsed() < Duration::from_millis(300), "a read took {:?}", started.elapsed());
    assert_eq!(seen, 1, "what is not committed is not seen");
    writing.join().unwrap().unwrap();
    assert_eq!(people(&store).unwrap().roster().len(), 2);
}

#[test]
fn more_readers_than_connections_are_all_served() {
    let (_folder, store) = home();
    thread::scope(|scope| {
        for _ in 0..40 {
            scope.spawn(|| {
                store
                    .read(|reader| {
                        thread::sleep(Duration::from_millis(5));
                        assert!(reader.household()?.is_some());
                        Ok::<_, StoreError>(())
                    })
                    .unwrap();
            });
        }
    });
}

#[test]
fn who_reads_sees_one_state_however_many_write_meanwhile() {
    let (_folder, store) = home();
    store
        .read(|reader| {
            let before = reader.event_count()?;
            assert_eq!(record(&store, 10)?.recorded, 10);
            assert_eq!(reader.event_count()?, before);
            Ok::<_, StoreError>(())
        })
        .unwrap();
    assert_eq!(events(&store), 10);
}

#[test]
fn a_long_change_tells_how_far_it_has_come() {
    let (_folder, store) = home();
    let (tell, told) = channel();
    let call = Call::with_listener(move |progress| tell.send(progress).unwrap());
    assert_eq!(record(&store.during(&call), 1200).unwrap().recorded, 1200);
    let told: Vec<u64> = told.try_iter().map(|Progress { done, total, .. }| done * 10_000 + total).collect();
    assert_eq!(told, [1200, 5_001_200, 10_001_200]);
}

#[test]
fn a_long_change_that_is_given_up_between_two_statements_keeps_nothing() {
    let (_folder, store) = home();
    let (tell, told) = channel();
    let call = Call::with_listener(move |progress| tell.send(progress).unwrap());
    let stop = call.clone();
    let giving_up = thread::spawn(move || {
        told.recv().unwrap();
        stop.interrupt();
    });
    let outcome = record(&store.during(&call), 500_000);
    giving_up.join().unwrap();
    assert!(matches!(outcome, Err(StoreError::Interrupted)), "{outcome:?}");
    assert_eq!(events(&store), 0);
}

#[test]
fn an_interrupted_call_keeps_nothing() {
    let (_folder, store) = home();
    let call = Call::default();
    let stop = call.clone();
    let refused = store.during(&call).write(|writer| {
        writer.put_user(&UserName::new("Mary").unwrap(), &Background::default())?;
        stop.interrupt();
        Ok::<_, StoreError>(())
    });
    assert!(matches!(refused, Err(StoreError::Interrupted)), "{refused:?}");
    assert_eq!(people(&store).unwrap().roster().len(), 1);
    let later = store.during(&call).read(|_| Ok::<_, StoreError>(()));
    assert!(matches!(later, Err(StoreError::Interrupted)), "an interrupted call does not go on: {later:?}");
    add_bob(&store);
}

#[test]
fn a_statement_that_runs_is_broken_off() {
    let (_folder, store) = home();
    let call = Call::default();
    let stop = call.clone();
    let (begun, beginning) = channel();
    let stopping = thread::spawn(move || {
        beginning.recv().unwrap();
        thread::sleep(Duration::from_millis(50));
        stop.interrupt();
    });
    let started = Instant::now();
    let outcome: Result<i64, StoreError> = store.during(&call).read(|reader| {
        begun.send(()).unwrap();
        // It counts to a number that takes minutes.
        let endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100000000000)
                       SELECT max(i) FROM n";
        Ok(reader.connection.query_row(endless, [], |row| row.get(0))?)
    });
    assert!(matches!(outcome, Err(StoreError::Interrupted)), "{outcome:?}");
    assert!(started.elapsed() < Duration::from_secs(20));
    stopping.join().unwrap();
    assert!(people(&store).is_some());
}
