//! A `coin-server` in its own process, and a JSON-RPC client of our own at the other end of its pipes.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::answer::{RpcError, ToolAnswer};
use crate::binaries::{Collected, binary};
use crate::repository::repository;
use crate::schema::assert_conforms;

/// The protocol version with an `initialize` exchange.
pub const LEGACY_VERSION: &str = "2025-11-25";

/// The protocol version in which every request stands on its own.
pub const MODERN_VERSION: &str = "2026-07-28";

/// How long an answer may take. A locked database holds a call back for seconds.
const PATIENCE: Duration = Duration::from_secs(60);

/// How long a server may take to end.
const PATIENCE_AT_THE_END: Duration = Duration::from_secs(20);

/// Which protocol the client speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Era {
    /// 2025-11-25: `initialize` first.
    Legacy,
    /// 2026-07-28: version and capabilities go with every request.
    Modern,
}

/// A running server. It is killed when this is dropped.
#[derive(Debug)]
pub struct ServerProcess {
    child: Child,
    stdin: Option<ChildStdin>,
    lines: Receiver<String>,
    stderr: Collected,
    era: Era,
    last_id: u64,
    early: BTreeMap<u64, Value>,
    tools: OnceCell<Vec<Value>>,
    _folder: Option<Arc<TempDir>>,
}

impl ServerProcess {
    /// Starts a server with `arguments` and, in the older protocol, says hello.
    #[track_caller]
    pub fn start(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>, era: Era) -> Self {
        let mut server = Self::start_silent(arguments, era);
        if era == Era::Legacy {
            let answer = server.request("initialize", initialize_parameters());
            let result = answer.unwrap_or_else(|error| panic!("initialize failed: {error:?}"));
            assert!(result["protocolVersion"] == LEGACY_VERSION, "the server speaks {result:#}");
            server.notify("notifications/initialized");
        }
        server
    }

    /// Starts a server and says nothing.
    pub fn start_silent(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>, era: Era) -> Self {
        let mut child = Command::new(binary("coin-server"))
            .args(arguments)
            .env_remove("COIN_TOKEN")
            .env_remove("RUST_LOG")
            .current_dir(repository())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("coin-server can be started");
        let stdin = child.stdin.take();
        let stdout = child.stdout.take().expect("standard output is a pipe");
        let (stderr, _) = Collected::of(child.stderr.take().expect("standard error is a pipe"));
        let (sender, lines) = channel();
        thread::spawn(move || {
            for line in BufReader::new(stdout).split(b'\n') {
                let Ok(line) = line else { return };
                if sender.send(String::from_utf8_lossy(&line).into_owned()).is_err() {
                    return;
                }
            }
        });
        Self {
            child,
            stdin,
            lines,
            stderr,
            era,
            last_id: 0,
            early: BTreeMap::new(),
            tools: OnceCell::new(),
            _folder: None,
        }
    }

    /// Keeps the folder of the server's database for as long as the server runs: it may still be opening it when
    /// its home goes out of scope.
    pub(crate) fn in_folder(mut self, folder: &Arc<TempDir>) -> Self {
        self._folder = Some(Arc::clone(folder));
        self
    }

    /// The server's process.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// What the server wrote to standard error so far.
    pub fn stderr(&self) -> String {
        self.stderr.text()
    }

    /// Sends a request and returns its id; the answer is fetched with [`wait`](Self::wait).
    #[track_caller]
    pub fn send(&mut self, method: &str, parameters: Value) -> u64 {
        self.last_id += 1;
        let id = self.last_id;
        let mut parameters = parameters;
        if self.era == Era::Modern {
            parameters["_meta"] = modern_meta();
        }
        let request = json!({"jsonrpc": "2.0", "id": id, "method": method, "params": parameters});
        self.send_line(&request.to_string());
        id
    }

    /// Sends a notification.
    #[track_caller]
    pub fn notify(&mut self, method: &str) {
        self.send_line(&json!({"jsonrpc": "2.0", "method": method}).to_string());
    }

    /// Sends a line as it is.
    #[track_caller]
    pub fn send_line(&mut self, line: &str) {
        self.send_bytes(format!("{line}\n").as_bytes());
    }

    /// Sends a line as it is, to a server that may be gone.
    pub fn try_send_line(&mut self, line: &str) -> std::io::Result<()> {
        self.try_send_bytes(line.as_bytes())?;
        self.try_send_bytes(b"\n")
    }

    /// Sends bytes as they are, whole lines or not.
    #[track_caller]
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.try_send_bytes(bytes).unwrap_or_else(|error| {
            panic!("the server does not listen ({error}); standard error: {}", self.stderr())
        });
    }

    fn try_send_bytes(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let stdin = self.stdin.as_mut().expect("standard input is still open");
        stdin.write_all(bytes)?;
        stdin.flush()
    }

    /// Waits for the answer to the request `id`.
    #[track_caller]
    pub fn wait(&mut self, id: u64) -> Result<Value, RpcError> {
        match self.try_wait(id) {
            Some(answer) => answer,
            None => panic!("request {id} got no answer; standard error: {}", self.stderr()),
        }
    }

    /// Waits for the answer to the request `id`; `None` if the server ends before it or takes too long.
    #[track_caller]
    pub fn try_wait(&mut self, id: u64) -> Option<Result<Value, RpcError>> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(message) = self.early.remove(&id) {
                return Some(take_apart(&message));
            }
            let message = self.next_message(deadline.saturating_duration_since(Instant::now()))?;
            if let Some(id) = message.get("id").and_then(Value::as_u64) {
                self.early.insert(id, message);
            }
        }
    }

    /// The next message of the server. Every line of standard output must be one.
    #[track_caller]
    pub fn next_message(&mut self, patience: Duration) -> Option<Value> {
        match self.lines.recv_timeout(patience) {
            Ok(line) => Some(parse_message(&line)),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => None,
        }
    }

    /// Sends a request and waits for its answer.
    #[track_caller]
    pub fn request(&mut self, method: &str, parameters: Value) -> Result<Value, RpcError> {
        let id = self.send(method, parameters);
        self.wait(id)
    }

    /// The tool definitions, asked for once.
    #[track_caller]
    pub fn tools(&mut self) -> Vec<Value> {
        if let Some(tools) = self.tools.get() {
            return tools.clone();
        }
        let result = self.request("tools/list", json!({})).expect("tools/list is answered");
        let tools = result["tools"].as_array().expect("tools/list has tools").clone();
        self.tools.get_or_init(|| tools).clone()
    }

    /// The definition of one tool.
    #[track_caller]
    pub fn tool(&mut self, name: &str) -> Value {
        let tools = self.tools();
        let found = tools.iter().find(|tool| tool["name"] == name);
        found.unwrap_or_else(|| panic!("there is no tool {name:?}")).clone()
    }

    /// Calls a tool. Whatever comes back has the form of a tool result, and a success satisfies the tool's output
    /// schema.
    #[track_caller]
    pub fn call(&mut self, tool: &str, arguments: Value) -> ToolAnswer {
        let result = self
            .request("tools/call", json!({"name": tool, "arguments": arguments}))
            .unwrap_or_else(|error| panic!("{tool} was answered with a protocol error: {error:?}"));
        if self.era == Era::Modern {
            assert!(
                result["resultType"] == "complete",
                "a result of {MODERN_VERSION} has a type: {result:#}"
            );
        }
        let answer = ToolAnswer::from_result(&result);
        if let Some(structured) = &answer.structured {
            let schema = self.tool(tool)["outputSchema"].clone();
            assert_conforms(&schema, structured, tool);
        }
        answer
    }

    /// Calls a tool that must succeed and returns its structured content.
    #[track_caller]
    pub fn ok(&mut self, tool: &str, arguments: Value) -> Value {
        self.call(tool, arguments).value()
    }

    /// Calls a tool that must refuse, with every one of `parts` in its words.
    #[track_caller]
    pub fn refused(&mut self, tool: &str, arguments: Value, parts: &[&str]) -> String {
        let given = arguments.to_string();
        let text = self.call(tool, arguments).refusal();
        for part in parts {
            assert!(text.contains(part), "{tool} {given:.300} is refused without naming {part:?}: {text}");
        }
        text
    }

    /// Ends the server the way the system does when memory runs out: at once, without a chance to tidy up.
    pub fn kill(&mut self) {
        self.child.kill().expect("a child can be killed");
        self.child.wait().expect("a child can be waited for");
    }

    /// Closes standard input and waits for the end. What is still said must be well-formed.
    #[track_caller]
    pub fn finish(mut self) -> (ExitStatus, String) {
        self.stdin = None;
        let deadline = Instant::now() + PATIENCE_AT_THE_END;
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("a child can be waited for") {
                break status;
            }
            assert!(
                Instant::now() < deadline,
                "the server does not end when its input ends: {}",
                self.stderr()
            );
            thread::sleep(Duration::from_millis(2));
        };
        while self.next_message(Duration::from_secs(1)).is_some() {}
        (status, self.stderr())
    }
}

impl Drop for ServerProcess {
    fn drop(&mut self) {
        // It may have ended already, which is no failure.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

pub(crate) fn initialize_parameters() -> Value {
    json!({
        "protocolVersion": LEGACY_VERSION,
        "capabilities": {},
        "clientInfo": {"name": "coin-tests", "version": "0"},
    })
}

pub(crate) fn modern_meta() -> Value {
    json!({
        "io.modelcontextprotocol/protocolVersion": MODERN_VERSION,
        "io.modelcontextprotocol/clientCapabilities": {},
        "io.modelcontextprotocol/clientInfo": {"name": "coin-tests", "version": "0"},
    })
}

#[track_caller]
fn parse_message(line: &str) -> Value {
    let message: Value = serde_json::from_str(line)
        .unwrap_or_else(|error| panic!("a line of standard output is no JSON ({error}): {line:.300}"));
    let is_request = message.get("method").is_some_and(Value::is_string);
    let is_answer = message.get("result").is_some() != message.get("error").is_some();
    assert!(
        message["jsonrpc"] == "2.0" && (is_request != is_answer),
        "a line of standard output is no JSON-RPC message: {line:.300}"
    );
    message
}

fn take_apart(message: &Value) -> Result<Value, RpcError> {
    match message.get("error") {
        None => Ok(message["result"].clone()),
        Some(error) => Err(RpcError {
            code: error["code"].as_i64().expect("an error has a code"),
            message: error["message"].as_str().expect("an error has a message").to_owned(),
        }),
    }
}
