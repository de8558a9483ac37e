//! The client: as little as can be, so that it costs the same with every server.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use coin_tests::LEGACY_VERSION;
use serde_json::{Value, json};

/// A server in a process of its own. It ends when this is dropped.
pub(crate) struct Connection {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    line: String,
    id: u64,
}

impl Connection {
    /// Starts a server and says hello, in the revision that hosts speak at present.
    pub(crate) fn open(command: &[String]) -> Self {
        let (program, arguments) = command.split_first().expect("a command has a program");
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| panic!("{program} cannot be started: {error}"));
        let input = child.stdin.take().expect("standard input is a pipe");
        let output = BufReader::new(child.stdout.take().expect("standard output is a pipe"));
        let mut connection = Self { child, input, output, line: String::new(), id: 0 };
        connection.exchange(
            "initialize",
            &json!({
                "protocolVersion": LEGACY_VERSION,
                "capabilities": {},
                "clientInfo": {"name": "measure-calls", "version": "0"},
            }),
        );
        connection.send(&json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string());
        connection
    }

    /// The server's process.
    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// Calls a tool; how long it took until the whole answer was here.
    pub(crate) fn call(&mut self, parameters: &Value) -> Duration {
        self.exchange("tools/call", parameters)
    }

    /// Calls a tool; what it returned.
    pub(crate) fn result(&mut self, parameters: &Value) -> Value {
        self.call(parameters);
        let answer: Value = serde_json::from_str(&self.line).expect("an answer is JSON");
        assert!(answer["id"] == self.id, "the answer to another request: {answer}");
        let content = &answer["result"]["structuredContent"];
        assert!(content.is_object(), "a result without structured content: {answer}");
        content.clone()
    }

    fn exchange(&mut self, method: &str, parameters: &Value) -> Duration {
        self.id += 1;
        let request =
            json!({"jsonrpc": "2.0", "id": self.id, "method": method, "params": parameters}).to_string();
        let started = Instant::now();
        self.send(&request);
        self.line.clear();
        self.output.read_line(&mut self.line).expect("the server answers");
        let took = started.elapsed();
        assert!(self.line.contains("\"result\""), "{method} failed: {}", self.line);
        took
    }

    fn send(&mut self, message: &str) {
        let line = format!("{message}\n");
        self.input.write_all(line.as_bytes()).expect("the server listens");
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // It may have ended already, which is no failure.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}
