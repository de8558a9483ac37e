//! A `coin-server --http` in its own process.

use std::ffi::OsStr;
use std::net::SocketAddr;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::binaries::{Collected, binary};
use crate::repository::repository;

/// How long a server may take to start or to end.
const PATIENCE: Duration = Duration::from_secs(30);

/// How often it is looked whether it did.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// A running server. It is killed when this is dropped.
#[derive(Debug)]
pub struct HttpServer {
    child: Child,
    stderr: Collected,
    address: SocketAddr,
}

impl HttpServer {
    /// Starts a server of a database on a free port of this computer.
    #[track_caller]
    pub fn start(db: impl AsRef<OsStr>) -> Self {
        Self::start_with(db, &["--http", "127.0.0.1:0"], &[])
    }

    /// Starts a server with further arguments, which name an address, and environment variables.
    #[track_caller]
    pub fn start_with(db: impl AsRef<OsStr>, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut child = Command::new(binary("coin-server"))
            .arg("--db")
            .arg(db)
            .args(arguments)
            .env_remove("COIN_TOKEN")
            .env_remove("RUST_LOG")
            .envs(environment.iter().copied())
            .current_dir(repository())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("coin-server can be started");
        let (stderr, _) = Collected::of(child.stderr.take().expect("standard error is a pipe"));
        let deadline = Instant::now() + PATIENCE;
        let address = loop {
            let ended = child.try_wait().expect("a child can be waited for");
            let text = stderr.text();
            if let Some(address) = text.lines().find_map(address_in) {
                break address;
            }
            if ended.is_some() || Instant::now() > deadline {
                // It may have ended already, which is no failure.
                child.kill().ok();
                child.wait().ok();
                panic!("the server names no address (ended: {ended:?}): {}", stderr.text());
            }
            thread::sleep(LOOK_EVERY);
        };
        Self { child, stderr, address }
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What it wrote to standard error so far.
    pub fn stderr(&self) -> String {
        self.stderr.text()
    }

    /// Waits until it has written `part` to standard error, which comes later than its answers.
    #[track_caller]
    pub fn wait_for_stderr(&self, part: &str) {
        let deadline = Instant::now() + PATIENCE;
        while !self.stderr().contains(part) {
            assert!(Instant::now() < deadline, "it never wrote {part:?}: {}", self.stderr());
            thread::sleep(LOOK_EVERY);
        }
    }

    /// Its process.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Asks it to end, as the system does when it shuts down.
    pub fn terminate(&self) {
        let status = Command::new("kill").arg("-TERM").arg(self.process().to_string()).status();
        assert!(status.expect("kill can be run").success(), "the server is gone: {}", self.stderr());
    }

    /// Waits for its end.
    #[track_caller]
    pub fn wait(mut self) -> ExitStatus {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.child.try_wait().expect("a child can be waited for") {
                return status;
            }
            assert!(Instant::now() < deadline, "the server does not end: {}", self.stderr());
            thread::sleep(LOOK_EVERY);
        }
    }
}

impl Drop for HttpServer {
    fn drop(&mut self) {
        // It may have ended already, which is no failure.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// The address in `coin-server: serving MCP at http://127.0.0.1:43210/mcp`.
fn address_in(line: &str) -> Option<SocketAddr> {
    let url = line.strip_prefix("coin-server: serving MCP at http://")?;
    url.strip_suffix("/mcp")?.parse().ok()
}
