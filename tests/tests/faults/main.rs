//! What happens when things go wrong around the server: it is killed, the disk fills up, the file is another
//! program's, somebody else holds it. What was acknowledged is there afterwards, and the file opens.

mod disks;
mod files;
mod killed;
mod together;

use std::path::Path;

use coin_tests::{EpisodeBuilder, Era, Program, ServerProcess};
use rusqlite::Connection;
use serde_json::{Value, json};

/// A home of three things in which nothing was seen.
fn furnished() -> EpisodeBuilder {
    EpisodeBuilder::new().object("1", "marker", [0.0, 0.0, 0.8]).object("2", "mug", [4.0, 0.0, 0.8]).object(
        "3",
        "kettle",
        [8.0, 0.0, 0.8],
    )
}

fn serve(db: &Path) -> ServerProcess {
    ServerProcess::start(["--db".as_ref(), db.as_os_str()], Era::Legacy)
}

fn import(episode: &Path, db: &Path) -> Program {
    Program::new("coin-server").arg("import").arg("--episode").arg(episode).arg("--db").arg(db)
}

/// A caption about thing 1 that differs from all others by its number.
fn caption(number: usize) -> Value {
    let (day, hour, minute, second) =
        (1 + number / 86_400, number / 3_600 % 24, number / 60 % 60, number % 60);
    json!({
        "object_id": "1",
        "caption": format!("2025-01-{day:02} {hour:02}:{minute:02}:{second:02} Bob is using the Marker"),
    })
}

/// How many rows a table has, looked up behind the server's back.
fn count(db: &Path, table: &str) -> usize {
    let database = Connection::open(db).unwrap();
    let count: i64 =
        database.query_row(&format!("SELECT count(*) FROM {table}"), [], |row| row.get(0)).unwrap();
    usize::try_from(count).unwrap()
}

/// Fails unless SQLite finds the file sound and every reference in it leads somewhere.
#[track_caller]
fn assert_sound(db: &Path) {
    let database = Connection::open(db).unwrap();
    let verdict: String = database.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
    assert_eq!(verdict, "ok");
    let mut statement = database.prepare("PRAGMA foreign_key_check").unwrap();
    assert!(!statement.exists([]).unwrap(), "a reference leads nowhere");
}
