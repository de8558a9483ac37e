//! A key is told to the provider and to nobody else.

use std::fs;
use std::path::Path;

use coin_tests::Program;
use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider};
use tempfile::TempDir;

use super::{KEY, host, seldom_seen};

/// Every file below a folder that holds the key.
fn files_with_the_key(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_with_the_key(&path));
        } else {
            let bytes = fs::read(&path).unwrap();
            if bytes.windows(KEY.len()).any(|part| part == KEY.as_bytes()) {
                found.push(path.display().to_string());
            }
        }
    }
    found
}

/// Logs at the most talkative level, reports, pages, recordings, caches, journals, databases and errors, also of a
/// provider that repeats the key in what it says.
#[test]
fn a_key_is_in_nothing_that_a_run_leaves_behind() {
    let folder = TempDir::new().unwrap();
    let episode = seldom_seen().write();
    let provider = ScriptedProvider::start(Script {
        key: Some(KEY.to_owned()),
        faults: FaultPlan::script(vec![Some(Fault::Status(500)), None, Some(Fault::Status(400))]),
        ..Script::default()
    });
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let arguments = [
        "--db",
        &file("home.db"),
        "--report",
        &file("report.json"),
        "--html",
        &file("page.html"),
        "--events",
        &file("events.jsonl"),
        "--record",
        &file("tape.jsonl"),
        "--gate",
        "always",
    ];
    let finished = host(&provider, episode.path(), &arguments).env("RUST_LOG", "trace").run().expect_code(0);
    assert!(!finished.stdout.contains(KEY) && !finished.stderr.contains(KEY));
    assert!(finished.stderr.contains("TRACE") || finished.stderr.contains("DEBUG"), "nothing was logged");
    assert_eq!(files_with_the_key(folder.path()), Vec::<String>::new());
    for name in ["home.db", "home.db.run.jsonl", "home.db.replies.jsonl", "report.json", "tape.jsonl"] {
        assert!(folder.path().join(name).is_file(), "{name} was not written");
    }

    let refused = ScriptedProvider::start(Script { key: Some("another".to_owned()), ..Script::default() });
    let finished = host(&refused, episode.path(), &[]).env("RUST_LOG", "trace").run().expect_code(1);
    assert!(!finished.stdout.contains(KEY) && !finished.stderr.contains(KEY));
    assert!(refused.requests()[0].headers["authorization"].contains(KEY), "the provider was told");
}

/// What other users of the machine see of a program is its arguments. There is no argument for a key.
#[test]
fn no_argument_takes_a_key() {
    let help = Program::new("host").arg("--help").run().expect_code(0).stdout;
    assert!(!help.contains("--key") && !help.contains("--api-key") && !help.contains("--token "), "{help}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_key_is_not_in_the_process_list() {
    let folder = TempDir::new().unwrap();
    let episode = seldom_seen().write();
    let delay = std::time::Duration::from_millis(200);
    let provider = ScriptedProvider::start(Script { delay, ..Script::default() });
    let run = {
        let program =
            host(&provider, episode.path(), &["--db", folder.path().join("home.db").to_str().unwrap()]);
        std::thread::spawn(move || program.run())
    };
    let mut seen = 0;
    while !run.is_finished() {
        for entry in fs::read_dir("/proc").unwrap().flatten() {
            let Ok(arguments) = fs::read(entry.path().join("cmdline")) else { continue };
            let arguments = String::from_utf8_lossy(&arguments);
            assert!(!arguments.contains(KEY), "{arguments}");
            seen += usize::from(arguments.contains("openai:scripted"));
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    run.join().unwrap().expect_code(0);
    assert!(seen > 0, "the program was never seen");
}
