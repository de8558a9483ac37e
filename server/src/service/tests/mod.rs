//! The service as a client meets it: lines of JSON over a pipe.

mod asking;
mod documents;
mod tools;
mod work;

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use coin_schemas::tools::{ListUsers, ListUsersResult};
use rmcp::ServiceExt;
use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncWriteExt, BufReader, DuplexStream, Lines, ReadHalf, WriteHalf};

use super::*;
use crate::store::{Access, Progress, Stage};
use crate::test_home;
use crate::tools::{Effect, Tool as HomeTool, ToolError};

/// A tool that only panics.
struct Panics;

impl HomeTool for Panics {
    const NAME: &'static str = "panics";
    const TITLE: &'static str = "Panics";
    const DESCRIPTION: &'static str = "Panics";
    const EXAMPLE: &'static str = "{}";
    const EFFECT: Effect = Effect::Records;
    type Arguments = ListUsers;
    type Output = ListUsersResult;

    fn call(store: &Store, _: ListUsers) -> Result<ListUsersResult, ToolError> {
        store.write(|_| panic!("a fault in a tool"))
    }
}

/// A tool that goes on until it is given up.
struct Endless;

/// Whether the endless tool has ended.
static GIVEN_UP: AtomicBool = AtomicBool::new(false);

impl HomeTool for Endless {
    const NAME: &'static str = "endless";
    const TITLE: &'static str = "Endless";
    const DESCRIPTION: &'static str = "Endless";
    const EXAMPLE: &'static str = "{}";
    const EFFECT: Effect = Effect::Reads;
    type Arguments = ListUsers;
    type Output = ListUsersResult;

    fn call(store: &Store, _: ListUsers) -> Result<ListUsersResult, ToolError> {
        for done in 0.. {
            let progress = Progress { stage: Stage::Reading, done, total: 100_000_000 };
            if let Err(given_up) = store.call().advance(progress) {
                GIVEN_UP.store(true, Ordering::SeqCst);
                return Err(given_up.into());
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        unreachable!("it counts for years")
    }
}

struct Client {
    output: WriteHalf<DuplexStream>,
    input: Lines<BufReader<ReadHalf<DuplexStream>>>,
    next_id: u64,
    /// Notifications that came while an answer was waited for.
    notes: Vec<Value>,
    /// Requests of the service, and what they are answered with.
    asked: Vec<Value>,
    replies: VecDeque<Value>,
}

impl Client {
    /// Starts a service of the test home on one end of a pipe and holds the other.
    fn start() -> Self {
        Self::start_on(test_home::store())
    }

    /// The same for another home.
    fn start_on(store: Store) -> Self {
        Self::start_with(
            store,
            Registry::new(&ToolSelection::all(), Access::ReadWrite).with::<Panics>().with::<Endless>(),
        )
    }

    /// The same with other tools.
    fn start_with(store: Store, tools: Registry) -> Self {
        let service = CoinService::new(Arc::new(store), tools);
        let (ours, theirs) = tokio::io::duplex(1 << 20);
        tokio::spawn(
            async move { service.serve(theirs).await?.waiting().await.map_err(anyhow::Error::from) },
        );
        let (input, output) = tokio::io::split(ours);
        Self {
            output,
            input: BufReader::new(input).lines(),
            next_id: 1,
            notes: Vec::new(),
            asked: Vec::new(),
            replies: VecDeque::new(),
        }
    }

    /// Starts a service and shakes hands with it as clients up to 2025 do.
    async fn initialized() -> Self {
        Self::with_capabilities(json!({})).await
    }

    /// The same with a client that can do this.
    async fn with_capabilities(capabilities: Value) -> Self {
        let mut client = Self::start();
        client.initialize(capabilities).await;
        client
    }

    async fn initialize(&mut self, capabilities: Value) {
        let params = json!({
            "protocolVersion": "2025-11-25",
            "capabilities": capabilities,
            "clientInfo": {"name": "test", "version": "0"},
        });
        let answer = self.request("initialize", params).await;
        assert_eq!(answer["result"]["protocolVersion"], "2025-11-25");
        self.send(json!({"jsonrpc": "2.0", "method": "notifications/initialized"})).await;
    }

    async fn send(&mut self, message: Value) {
        self.output.write_all(format!("{message}\n").as_bytes()).await.unwrap();
    }

    async fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.next_id;
        self.next_id += 1;
        self.send(json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params})).await;
        self.answer(id).await
    }

    /// Waits for the answer to a request, and serves the service meanwhile.
    async fn answer(&mut self, id: u64) -> Value {
        loop {
            let message = self.next_message().await;
            if message.get("method").is_none() {
                assert_eq!(message["id"], id);
                return message;
            }
            match message.get("id").cloned() {
                None => self.notes.push(message),
                Some(id) => {
                    let result = self.replies.pop_front().expect("nobody is asked");
                    self.asked.push(message);
                    self.send(json!({"jsonrpc": "2.0", "id": id, "result": result})).await;
                }
            }
        }
    }

    async fn next_message(&mut self) -> Value {
        let line = self.input.next_line().await.unwrap().expect("the service closed the pipe");
        serde_json::from_str(&line).unwrap()
    }

    async fn call(&mut self, tool: &str, arguments: Value) -> Value {
        self.request("tools/call", json!({"name": tool, "arguments": arguments})).await
    }
}
