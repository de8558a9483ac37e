//! Files that are no database of ours, or not of this version. Each is refused with exit status 2 and left as it
//! was.

use std::fs;
use std::path::Path;

use coin_tests::{Finished, Home, Program};
use rstest::rstest;
use rusqlite::Connection;

/// Ways of opening a database file.
const READ_WRITE: &[&str] = &[];
const READ_ONLY: &[&str] = &["--read-only"];

fn start(db: &Path, flags: &[&str]) -> Finished {
    Program::new("coin-server").arg("--db").arg(db).args(flags).run()
}

/// Starting on the file and importing into it are both refused in words that hold `parts`, and nothing changes.
#[track_caller]
fn assert_refused(db: &Path, parts: &[&str]) {
    let before = fs::read(db).ok();
    let name = db.to_str().unwrap();
    for flags in [READ_WRITE, READ_ONLY] {
        let refused = start(db, flags).expect_code(2);
        assert_eq!(refused.stdout, "", "standard output belongs to the protocol");
        refused.expect_stderr(&[name]).expect_stderr(parts);
        assert_eq!(refused.stderr.trim_end().lines().count(), 1, "one message: {}", refused.stderr);
    }
    let episode = super::furnished().write();
    let refused = super::import(episode.path(), db).run().expect_code(2);
    refused.expect_stderr(&[name]).expect_stderr(parts);
    assert_eq!(fs::read(db).ok(), before, "a refused file stays as it was");
}

#[test]
fn a_database_of_a_newer_version() {
    let home = Home::of(&super::furnished());
    let database = Connection::open(home.db()).unwrap();
    let version: i64 = database.query_row("PRAGMA user_version", [], |row| row.get(0)).unwrap();
    database.pragma_update(None, "journal_mode", "DELETE").unwrap();
    database.pragma_update(None, "user_version", version + 1).unwrap();
    database.close().unwrap();
    assert_refused(&home.db(), &["version", &(version + 1).to_string(), &version.to_string(), "newer"]);
}

#[test]
fn a_database_of_another_program() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("music.db");
    let database = Connection::open(&db).unwrap();
    database.execute_batch("CREATE TABLE songs (title TEXT); INSERT INTO songs VALUES ('Home');").unwrap();
    database.close().unwrap();
    assert_refused(&db, &["another program"]);
}

#[test]
fn a_database_of_another_program_with_a_mark_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("music.db");
    let database = Connection::open(&db).unwrap();
    database.pragma_update(None, "application_id", 0x0420_2025).unwrap();
    database.execute_batch("CREATE TABLE songs (title TEXT);").unwrap();
    database.close().unwrap();
    assert_refused(&db, &["another program", "0x04202025"]);
}

#[rstest]
#[case(
    "a letter to grandmother, long enough to be taken for a header of a hundred bytes or more, but no database\n"
)]
#[case("SQLite format 3\0 and then nothing that follows")]
fn a_file_that_is_no_database(#[case] content: &str) {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("letter.txt");
    fs::write(&db, content).unwrap();
    assert_refused(&db, &["not a SQLite database"]);
}

#[test]
fn a_folder() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(folder.path(), &["folder"]);
}

#[test]
fn a_damaged_database_is_told_and_does_not_end_the_server() {
    let home = Home::of(&super::furnished().caption("1", "2025-01-19 08:00 Bob takes the Marker"));
    let connection = Connection::open(home.db()).unwrap();
    let number = |sql: &str| connection.query_row(sql, [], |row| row.get::<_, u32>(0)).unwrap() as usize;
    let size = number("PRAGMA page_size");
    let page = number("SELECT rootpage FROM sqlite_schema WHERE name = 'objects'");
    drop(connection);
    let mut bytes = fs::read(home.db()).unwrap();
    // Only the things are overwritten, so that the database can be opened.
    bytes[(page - 1) * size..page * size].fill(0xA5);
    fs::write(home.db(), bytes).unwrap();
    let mut server = home.server();
    server.refused("list_objects", serde_json::json!({}), &["damaged"]);
    let (status, stderr) = server.finish();
    assert_eq!(status.code(), Some(0), "{stderr}");
}

#[test]
fn an_empty_file_becomes_a_database() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("empty.db");
    fs::write(&db, "").unwrap();
    start(&db, READ_WRITE).expect_code(0);
    super::assert_sound(&db);
}

#[test]
fn a_missing_file_and_its_folder_are_made_for_their_owner_alone() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("homes/ours/home.db");
    start(&db, READ_WRITE).expect_code(0);
    #[cfg(unix)]
    {
        let mode = std::os::unix::fs::PermissionsExt::mode(&fs::metadata(&db).unwrap().permissions());
        assert_eq!(mode & 0o777, 0o600, "what a family does all day is nobody else's business");
    }
}

#[test]
fn a_missing_file_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let db = folder.path().join("home.db");
    start(&db, READ_ONLY).expect_code(2).expect_stderr(&["home.db", "no such file"]);
    assert!(!db.exists());
}

#[test]
fn another_home_is_not_mixed_in() {
    let home = Home::of(&super::furnished());
    let before = super::count(&home.db(), "objects");
    let other = super::furnished().with("/name", serde_json::json!("other")).write();
    super::import(other.path(), &home.db()).run().expect_code(2).expect_stderr(&["another home", "other"]);
    assert_eq!(super::count(&home.db(), "objects"), before);
}

#[test]
fn a_longer_take_of_the_same_recording_adds_what_is_new() {
    let episode = super::furnished().caption("1", "2025-01-18 08:00 Bob takes the Marker");
    let home = Home::of(&episode);
    let longer = episode.caption("1", "2025-01-19 08:00 Bob takes the Marker").write();
    super::import(longer.path(), &home.db()).run().expect_code(0);
    assert_eq!(super::count(&home.db(), "usage_events"), 2);
}
