//! Runs that end early and go on later: nothing is lost, nothing is asked or paid for twice.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use coin_tests::provider::{Script, ScriptedProvider};
use coin_tests::{Program, binary, small_house};
use rstest::rstest;
use serde_json::Value;
use tempfile::TempDir;

use super::{KEY, asked, faultless, without_cost};

/// The model alone scores, which takes many calls and leaves many questions.
const SCORED: [&str; 4] = ["--estimator", "model", "--context", "given"];

fn host(provider: &ScriptedProvider, episode: &Path, arguments: &[&str]) -> Program {
    super::host(provider, episode, &[&SCORED, arguments].concat())
}

fn report(provider: &ScriptedProvider, episode: &Path, arguments: &[&str]) -> Value {
    super::report(provider, episode, &[&SCORED, arguments].concat())
}

/// A run in small-house with a database, which may be broken off.
struct Home {
    folder: TempDir,
}

impl Home {
    fn new() -> Self {
        Self { folder: TempDir::new().unwrap() }
    }

    fn db(&self) -> String {
        self.folder.path().join("home.db").to_str().unwrap().to_owned()
    }

    fn resumed(&self, provider: &ScriptedProvider) -> Value {
        report(provider, &small_house(), &["--db", &self.db(), "--resume"])
    }

    /// Starts a run and ends it by a signal once the provider has been asked so often.
    fn broken_off(&self, provider: &ScriptedProvider, signal: &str, requests: usize) -> std::process::Output {
        let child = Command::new(binary("host"))
            .arg("--episode")
            .arg(small_house())
            .args(["--model", "openai:scripted", "--db", &self.db(), "--json"])
            .args(SCORED)
            .env("OPENAI_BASE_URL", provider.openai_url())
            .env("OPENAI_API_KEY", KEY)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_requests(provider, requests);
        let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        assert!(killed.success());
        child.wait_with_output().unwrap()
    }
}

fn wait_for_requests(provider: &ScriptedProvider, requests: usize) {
    let started = Instant::now();
    while provider.request_count() < requests {
        assert!(started.elapsed() < Duration::from_secs(120), "the provider was not asked so often");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn slow() -> ScriptedProvider {
    ScriptedProvider::start(Script { delay: Duration::from_millis(20), ..Script::default() })
}

/// The requests for things to be scored, by the task that they carry.
fn tasks_to_score(provider: &ScriptedProvider) -> Vec<String> {
    let first_turns = provider.requests().into_iter().filter_map(|request| {
        let messages = request.body["messages"].as_array()?.clone();
        let task = messages.get(1)?["content"].as_str()?.to_owned();
        (messages.len() == 2 && task.contains("infer_ownership")).then_some(task)
    });
    first_turns.collect()
}

#[cfg(unix)]
#[rstest]
#[case::in_the_first_pass(30)]
#[case::among_the_questions(80)]
fn a_run_that_crashed_goes_on_where_it_was(#[case] requests: usize) {
    let whole = report(&faultless(), &small_house(), &[]);
    let home = Home::new();
    let provider = slow();
    home.broken_off(&provider, "-KILL", requests);
    let resumed = home.resumed(&provider);
    assert_eq!(without_cost(resumed), without_cost(whole));
    let mut scored = tasks_to_score(&provider);
    let all = scored.len();
    scored.sort();
    scored.dedup();
    assert!(all - scored.len() <= 4, "only what was under way is asked about again: {}", all - scored.len());
}

#[cfg(unix)]
#[rstest]
#[case::in_the_first_pass(30)]
#[case::among_the_questions(80)]
fn ctrl_c_saves_what_was_learnt_and_says_how_to_go_on(#[case] requests: usize) {
    let whole = report(&faultless(), &small_house(), &[]);
    let home = Home::new();
    let provider = slow();
    let output = home.broken_off(&provider, "-INT", requests);
    assert_eq!(output.status.code(), Some(1));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("--resume") && stderr.contains("home.db"), "{stderr}");
    let partial: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(partial["stopped"], "interrupted");
    let resumed = home.resumed(&provider);
    assert_eq!(without_cost(resumed), without_cost(whole));
}

/// The journal may end anywhere in its last line, as after a power cut: what is whole counts.
#[test]
fn a_journal_that_ends_in_the_middle_of_a_line_is_taken_up_to_it() {
    let home = Home::new();
    let provider = faultless();
    let whole = report(&provider, &small_house(), &["--db", &home.db()]);
    let journal = format!("{}.run.jsonl", home.db());
    let text = fs::read(&journal).unwrap();
    let last_line = text[..text.len() - 1].iter().rposition(|&byte| byte == b'\n').unwrap() + 1;
    for end in [last_line, last_line + 1, last_line + 20, text.len() - 1] {
        fs::write(&journal, &text[..end]).unwrap();
        assert_eq!(without_cost(home.resumed(&provider)), without_cost(whole.clone()), "{end} bytes");
        assert_eq!(fs::read(&journal).unwrap(), text, "{end} bytes");
    }
}

/// A journal that is behind the database, as one from a backup is: what the database knows is not asked again.
#[test]
fn what_the_database_knows_is_not_asked_again() {
    let home = Home::new();
    let provider = faultless();
    let whole = report(&provider, &small_house(), &["--db", &home.db()]);
    let journal = format!("{}.run.jsonl", home.db());
    let text = fs::read(&journal).unwrap();
    fs::write(&journal, &text[..text.len() / 10]).unwrap();
    let resumed = home.resumed(&provider);
    assert!(asked(&resumed).iter().all(|thing| !asked(&whole).contains(thing)), "{:?}", asked(&resumed));
    let owners = |report: &Value| -> Vec<Value> {
        report["objects"].as_array().unwrap().iter().map(|object| object["owners"].clone()).collect()
    };
    assert_eq!(owners(&resumed), owners(&whole));
}

#[test]
fn a_run_that_is_over_is_told_again_and_asks_nothing() {
    let home = Home::new();
    let provider = faultless();
    let whole = report(&provider, &small_house(), &["--db", &home.db()]);
    let requests = provider.request_count();
    assert_eq!(without_cost(home.resumed(&provider)), without_cost(whole));
    assert_eq!(provider.request_count(), requests);
}

/// With fewer questions allowed at first, the rest is asked later, and the report is that of one run.
#[test]
fn more_questions_may_be_allowed_later() {
    let home = Home::new();
    let provider = faultless();
    let whole = report(&provider, &small_house(), &[]);
    let all = asked(&whole).len().to_string();
    let few = report(&provider, &small_house(), &["--db", &home.db(), "--max-questions", "2"]);
    assert_eq!((asked(&few).len(), &few["stopped"]), (2, &Value::from("max_questions")));
    let resumed = home.resumed(&provider);
    assert_eq!(asked(&resumed), asked(&whole));
    assert_eq!(asked(&resumed).len().to_string(), all);
    assert_eq!(resumed["curve"], whole["curve"]);
}

/// Questions that were put stay put.
#[test]
fn fewer_questions_may_be_allowed_later() {
    let home = Home::new();
    let provider = faultless();
    let whole = report(&provider, &small_house(), &["--db", &home.db()]);
    let arguments = ["--db", &home.db(), "--resume", "--max-questions", "1"];
    let resumed = report(&provider, &small_house(), &arguments);
    assert_eq!((&resumed["questions"], &resumed["curve"]), (&whole["questions"], &whole["curve"]));
}

/// A file of answers goes on where it was, too.
#[test]
fn prepared_answers_are_not_given_twice() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("answers.jsonl");
    let lines: String = (1..=34)
        .flat_map(|thing| {
            ["I don't know", "Bob's"]
                .map(|answer| format!("{{\"object_id\": \"{thing}\", \"answer\": \"{answer}\"}}\n"))
        })
        .collect();
    fs::write(&file, lines).unwrap();
    let answers = file.to_str().unwrap();
    let run = |db: &str, more: &[&str]| {
        let arguments = [&["--model", "embedded", "--answers", answers, "--db", db][..], more].concat();
        let program = Program::new("host").arg("--episode").arg(small_house()).args(arguments);
        program.args(["--json", "--quiet"]).run().expect_code(0).json()
    };
    let (one, two) = (Home::new(), Home::new());
    let whole = run(&one.db(), &[]);
    run(&two.db(), &["--max-questions", "7"]);
    assert_eq!(without_cost(run(&two.db(), &["--resume"])), without_cost(whole));
}

/// Ctrl-C at a terminal reaches every program that it started; the server is still there to be told what was learnt.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_server_of_its_own_to_the_end() {
    use std::os::unix::process::CommandExt;

    let home = coin_tests::Home::import(&small_house());
    let provider = slow();
    let server = format!("'{}' --db '{}'", binary("coin-server").display(), home.db().display());
    let child = Command::new(binary("host"))
        .arg("--episode")
        .arg(small_house())
        .args(["--model", "openai:scripted", "--json", "--server", &server])
        .args(SCORED)
        .env("OPENAI_BASE_URL", provider.openai_url())
        .env("OPENAI_API_KEY", KEY)
        .process_group(0)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for_requests(&provider, 30);
    let group = format!("-{}", child.id());
    assert!(Command::new("kill").args(["-INT", "--", &group]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["stopped"], "interrupted");
}

#[rstest]
#[case(&["--batch", "2"], "--batch")]
#[case(&["--gate", "always"], "gate")]
#[case(&["--seed", "7"], "--seed")]
fn a_run_with_other_settings_is_not_gone_on_with(#[case] arguments: &[&str], #[case] named: &str) {
    let home = Home::new();
    let provider = faultless();
    report(&provider, &small_house(), &["--db", &home.db(), "--max-questions", "1"]);
    let db = home.db();
    let arguments = [arguments, &["--db", &db, "--resume"]].concat();
    host(&provider, &small_house(), &arguments).run().expect_code(2).expect_stderr(&[named, "--resume"]);
}

#[test]
fn there_must_be_a_database_to_go_on_with() {
    Program::new("host")
        .arg("--episode")
        .arg(small_house())
        .arg("--resume")
        .run()
        .expect_code(2)
        .expect_stderr(&["--db"]);
}
