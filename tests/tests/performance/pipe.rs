//! A client that adds as little time as possible: it writes a line and reads a line, on the measuring thread.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use coin_tests::{LEGACY_VERSION, binary};
use serde_json::{Value, json};

pub(crate) struct Pipe {
    child: Child,
    stdin: ChildStdin,
    stdout: BufReader<ChildStdout>,
    line: String,
}

impl Pipe {
    /// Starts a server, says hello, and tells how long it took from the start to the answer.
    pub(crate) fn open(db: &Path) -> (Self, Duration) {
        let program = binary("coin-server");
        let hello = line(
            "initialize",
            json!({
                "protocolVersion": LEGACY_VERSION,
                "capabilities": {},
                "clientInfo": {"name": "coin-tests", "version": "0"},
            }),
        );
        let started = Instant::now();
        let mut child = Command::new(program)
            .arg("--db")
            .arg(db)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let stdin = child.stdin.take().unwrap();
        let stdout = BufReader::with_capacity(1 << 20, child.stdout.take().unwrap());
        let mut pipe = Self { child, stdin, stdout, line: String::new() };
        pipe.exchange(&hello);
        let duration = started.elapsed();
        pipe.stdin.write_all(b"{\"jsonrpc\":\"2.0\",\"method\":\"notifications/initialized\"}\n").unwrap();
        (pipe, duration)
    }

    /// Sends a prepared call and waits for its answer.
    pub(crate) fn exchange(&mut self, request: &str) -> &str {
        self.stdin.write_all(request.as_bytes()).unwrap();
        self.line.clear();
        let read = self.stdout.read_line(&mut self.line).unwrap();
        assert!(read > 0, "the server ended");
        &self.line
    }

    /// The same, with the time that it took.
    pub(crate) fn time(&mut self, request: &str) -> Duration {
        let started = Instant::now();
        self.exchange(request);
        started.elapsed()
    }

    /// The structured content of an answer that must be none of an error.
    pub(crate) fn result(&mut self, request: &str) -> Value {
        let answer: Value = serde_json::from_str(self.exchange(request)).unwrap();
        let content = answer["result"].get("structuredContent");
        content.unwrap_or_else(|| panic!("the call failed: {answer:.500}")).clone()
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

fn line(method: &str, parameters: Value) -> String {
    let mut line = json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters}).to_string();
    line.push('\n');
    line
}

/// A call, ready to be sent.
pub(crate) fn call(tool: &str, arguments: Value) -> String {
    line("tools/call", json!({"name": tool, "arguments": arguments}))
}
