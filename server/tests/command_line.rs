//! The program as a person or an MCP client starts it.

#![expect(clippy::unwrap_used, reason = "a test stops at the first fault")]

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

fn server(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_coin-server"));
    command.args(arguments).env_remove("RUST_LOG").env_remove("COLUMNS").stdin(Stdio::null());
    command
}

fn run(arguments: &[&str]) -> Output {
    server(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A folder with an episode of one object and one caption.
fn episode() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let home = r#"{"name": "one thing", "users": {"Bob": {}}, "captions": "captions.jsonl", "now": "2025-01-19T23:00:00",
        "objects": [{"id": "1", "class": "marker", "position": [0, 0, 0]}]}"#;
    fs::write(folder.path().join("episode.json"), home).unwrap();
    let caption = r#"{"object_id": "1", "caption": "2025-01-19 19:00 Bob takes the Marker"}"#;
    fs::write(folder.path().join("captions.jsonl"), caption).unwrap();
    folder
}

fn path(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn help_shows_examples() {
    let output = run(&["--help"]);
    assert!(output.status.success());
    insta::assert_snapshot!(text(&output.stdout));
}

#[test]
fn an_import_says_what_it_stored_and_can_be_repeated() {
    let folder = episode();
    let database = folder.path().join("home.db");
    let arguments = ["import", "--episode", path(folder.path()), "--db", path(&database)];
    let first = run(&arguments);
    assert_eq!(first.status.code(), Some(0));
    assert_eq!(first.stdout, b"");
    insta::assert_snapshot!(text(&first.stderr), @r#"Imported "one thing": users 1, objects 1, captions 1 new (0 without a known person) and 0 already there."#);
    let second = run(&arguments);
    assert_eq!(second.status.code(), Some(0));
    insta::assert_snapshot!(text(&second.stderr), @r#"Imported "one thing": users 1, objects 1, captions 0 new (0 without a known person) and 1 already there."#);
}

#[test]
fn a_malformed_episode_is_refused_before_the_database_is_made() {
    let folder = episode();
    fs::write(folder.path().join("captions.jsonl"), "{\"object_id\": \"2\"}\n").unwrap();
    let database = folder.path().join("home.db");
    let output = run(&["import", "--episode", path(folder.path()), "--db", path(&database)]);
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(text(&output.stderr), @r#"coin-server: captions.jsonl:1: missing field `caption`; a line is such as {"object_id": "3", "caption": "2025-01-19 19:00 Bob takes the Marker"}"#);
    assert!(!database.exists());
}

#[test]
fn wrong_use_is_explained() {
    let output = run(&["--tools", "list_object"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(output.stdout, b"");
    insta::assert_snapshot!(text(&output.stderr), @r#"
error: invalid value 'list_object' for '--tools <all|core|NAME,…>': there is no tool "list_object". Did you mean "list_objects" or "list_users" or "similar_objects"? The tools are add_user, ask_owner, find_object, get_usage_summary, list_objects, list_users, nearby_objects, next_question, observe_objects, record_answer, record_scores, record_usage, retract_answer, similar_objects, whose_is.

For more information, try '--help'.
"#);
}

#[test]
fn a_database_that_cannot_be_opened_is_refused_at_the_start() {
    let folder = episode();
    let file = folder.path().join("episode.json");
    let output = run(&["--db", path(&file)]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(output.stdout, b"");
    assert!(text(&output.stderr).ends_with("it is not a SQLite database; name another file with --db\n"));
}

#[test]
fn a_client_that_says_nothing_and_leaves_is_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(&["--db", path(&folder.path().join("home.db"))]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!((text(&output.stdout), text(&output.stderr)), (String::new(), String::new()));
}

#[test]
fn the_database_is_made_in_the_users_data_folder() {
    let folder = tempfile::tempdir().unwrap();
    let output = server(&[])
        .env("HOME", folder.path())
        .env("XDG_DATA_HOME", folder.path().join("data"))
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let made: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(
        made.iter().all(|name| name != "home.db"),
        "nothing is put where the client happens to be: {made:?}"
    );
}

#[test]
fn calls_that_are_under_way_when_the_client_leaves_are_answered() {
    let folder = episode();
    let database = folder.path().join("home.db");
    run(&["import", "--episode", path(folder.path()), "--db", path(&database)]);
    let mut child = server(&["--db", path(&database)])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input
        .write_all(
            concat!(
                r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"protocolVersion":"2025-11-25","capabilities":{},"clientInfo":{"name":"test","version":"0"}}}"#,
                "\n",
                r#"{"jsonrpc":"2.0","method":"notifications/initialized"}"#,
                "\n",
            )
            .as_bytes(),
        )
        .unwrap();
    for id in 2..20 {
        let call = format!(
            r#"{{"jsonrpc":"2.0","id":{id},"method":"tools/call","params":{{"name":"get_usage_summary","arguments":{{"object_id":"1"}}}}}}"#
        );
        input.write_all(format!("{call}\n").as_bytes()).unwrap();
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stderr), "");
    let mut ids: Vec<u64> = text(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["id"].as_u64().unwrap())
        .collect();
    ids.sort_unstable();
    assert_eq!(ids, (1..20).collect::<Vec<_>>());
}
