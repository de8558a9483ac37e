//! The built programs, and a run of one of them from start to end.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::repository::repository;

/// How long a program may run. This ends a test of a program that hangs and measures nothing: beside other tests on a
/// slow machine a whole experiment takes minutes.
const PATIENCE: Duration = Duration::from_secs(1_200);

/// How often it is looked whether a program has ended.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// The path of a program of this workspace, in the profile of the running test. The first call builds all
/// programs, so that no test ever runs an old one.
pub fn binary(name: &str) -> PathBuf {
    static FOLDER: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let folder = FOLDER.get_or_init(build_all).as_ref().unwrap_or_else(|errors| panic!("{errors}"));
    let path = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(path.is_file(), "the workspace builds no program {name:?} ({} is missing)", path.display());
    path
}

/// Builds every program and returns the folder in which they are, or what the compiler says.
fn build_all() -> Result<PathBuf, String> {
    let test = std::env::current_exe().expect("a running program has a path");
    // …/TARGET/PROFILE/deps/TEST
    let profile_folder = test.parent().and_then(Path::parent).expect("cargo puts tests two folders deep");
    let target = profile_folder.parent().expect("cargo puts profiles into the target folder");
    let profile = profile_folder.file_name().and_then(OsStr::to_str).expect("profiles have plain names");
    let profile = if profile == "debug" { "dev" } else { profile };
    let mut build = Command::new(env!("CARGO"));
    // Cargo tells a test about its package, and a dependency that looks for that would be built anew here, and once more
    // by whoever builds the programs outside a test.
    for (name, _) in std::env::vars_os() {
        if name
            .to_str()
            .is_some_and(|name| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_"))
        {
            build.env_remove(name);
        }
    }
    let output = build
        .args(["build", "--workspace", "--bins", "--quiet", "--profile", profile])
        .env("CARGO_TARGET_DIR", target)
        .current_dir(repository())
        .output()
        .expect("cargo can be started");
    if output.status.success() {
        Ok(profile_folder.to_owned())
    } else {
        Err(format!("the programs do not build:\n{}", String::from_utf8_lossy(&output.stderr)))
    }
}

/// A run of a program that ends by itself.
#[derive(Debug)]
pub struct Program {
    path: PathBuf,
    arguments: Vec<OsString>,
    environment: BTreeMap<String, OsString>,
    folder: PathBuf,
    input: Vec<u8>,
}

/// What a program left behind.
#[derive(Debug)]
pub struct Finished {
    /// How it ended.
    pub status: ExitStatus,
    /// What it wrote to standard output.
    pub stdout: String,
    /// What it wrote to standard error.
    pub stderr: String,
    /// From its start to its end.
    pub duration: Duration,
}

impl Program {
    /// A program of this workspace, to be run in the root of the repository with an empty standard input.
    pub fn new(name: &str) -> Self {
        Self {
            path: binary(name),
            arguments: Vec::new(),
            environment: BTreeMap::new(),
            folder: repository().to_owned(),
            input: Vec::new(),
        }
    }

    /// Adds an argument.
    #[must_use]
    pub fn arg(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.arguments.push(argument.as_ref().to_owned());
        self
    }

    /// Adds arguments.
    #[must_use]
    pub fn args(mut self, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Self {
        self.arguments.extend(arguments.into_iter().map(|argument| argument.as_ref().to_owned()));
        self
    }

    /// Sets an environment variable.
    #[must_use]
    pub fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.environment.insert(name.to_owned(), value.as_ref().to_owned());
        self
    }

    /// What the program finds on standard input.
    #[must_use]
    pub fn input(mut self, text: impl Into<Vec<u8>>) -> Self {
        self.input = text.into();
        self
    }

    /// Runs the program to its end. One that does not end is killed, and the test fails.
    pub fn run(self) -> Finished {
        let started = Instant::now();
        let mut child = Command::new(&self.path)
            .args(&self.arguments)
            .env_remove("COIN_TOKEN")
            .env_remove("RUST_LOG")
            .envs(&self.environment)
            .current_dir(&self.folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program can be started");
        let mut stdin = child.stdin.take().expect("standard input is a pipe");
        let input = self.input;
        // The program may end without reading; that it did is seen elsewhere.
        let writer = thread::spawn(move || stdin.write_all(&input).ok());
        let stdout = collect(child.stdout.take().expect("standard output is a pipe"));
        let stderr = collect(child.stderr.take().expect("standard error is a pipe"));
        let status = loop {
            if let Some(status) = child.try_wait().expect("a child can be waited for") {
                break Some(status);
            }
            if started.elapsed() > PATIENCE {
                break None;
            }
            thread::sleep(LOOK_EVERY);
        };
        let duration = started.elapsed();
        if status.is_none() {
            child.kill().expect("a child can be killed");
            child.wait().expect("a child can be waited for");
        }
        writer.join().expect("the writer does not panic");
        let stdout = stdout.join().expect("the reader does not panic");
        let stderr = stderr.join().expect("the reader does not panic");
        let Some(status) = status else {
            panic!(
                "{} {:?} did not end within {PATIENCE:?}\nstdout: {stdout}\nstderr: {stderr}",
                self.path.display(),
                self.arguments
            );
        };
        Finished { status, stdout, stderr, duration }
    }
}

impl Finished {
    /// The exit status as a number.
    pub fn code(&self) -> i32 {
        self.status.code().unwrap_or_else(|| panic!("the program was ended by a signal: {self:?}"))
    }

    /// Fails the test unless the program ended with `code`; shows both streams then.
    #[track_caller]
    pub fn expect_code(self, code: i32) -> Self {
        assert!(
            self.status.code() == Some(code),
            "expected exit status {code}, not {:?}\nstdout: {}\nstderr: {}",
            self.status,
            self.stdout,
            self.stderr
        );
        self
    }

    /// Standard output as one JSON document, and nothing else.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| {
            panic!("standard output is not one JSON document ({error}): {}", self.stdout)
        })
    }

    /// Fails the test unless standard error holds every one of `parts` and no sign of a panic.
    #[track_caller]
    pub fn expect_stderr(&self, parts: &[&str]) -> &Self {
        for part in parts {
            assert!(self.stderr.contains(part), "standard error does not name {part:?}: {}", self.stderr);
        }
        assert!(!self.stderr.contains("panicked"), "the program panicked: {}", self.stderr);
        self
    }
}

fn collect(mut stream: impl Read + Send + 'static) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("a pipe can be read");
        String::from_utf8(bytes).expect("programs write UTF-8")
    })
}

/// A text that one thread appends to and others look at.
#[derive(Debug, Clone, Default)]
pub(crate) struct Collected(std::sync::Arc<Mutex<String>>);

impl Collected {
    /// Collects a stream line by line until it ends.
    pub(crate) fn of(stream: impl Read + Send + 'static) -> (Self, thread::JoinHandle<()>) {
        let collected = Self::default();
        let shared = collected.clone();
        let reader = thread::spawn(move || {
            let mut stream = std::io::BufReader::new(stream);
            let mut line = Vec::new();
            while std::io::BufRead::read_until(&mut stream, b'\n', &mut line).is_ok_and(|read| read > 0) {
                let mut text = shared.0.lock().unwrap_or_else(PoisonError::into_inner);
                text.push_str(&String::from_utf8_lossy(&line));
                line.clear();
            }
        });
        (collected, reader)
    }

    /// What was collected so far.
    pub(crate) fn text(&self) -> String {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
