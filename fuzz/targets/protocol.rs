//! Any bytes as what a client says on a pipe, in both protocol versions: nothing makes the server panic, every line that
//! it says is a message, and a call that follows is answered.

#![no_main]

use std::path::Path;
use std::sync::{Arc, LazyLock};
use std::time::Duration;

use coin_server::episode::{self, LoadedEpisode};
use coin_server::store::Store;
use coin_server::transport::stdio;
use coin_server::{ServiceOptions, service};
use libfuzzer_sys::fuzz_target;
use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncRead, AsyncWriteExt, BufReader, duplex, split};
use tokio::runtime::Builder;
use tokio::time::timeout;

/// How long the call that follows may take.
const PATIENCE: Duration = Duration::from_secs(10);

/// The id of the call that follows.
const AFTERWARDS: &str = "afterwards";

static HOME: LazyLock<LoadedEpisode> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes/three-things");
    episode::load(&folder).expect("the fixture is an episode")
});

#[derive(Debug, Clone, Copy)]
enum Era {
    Legacy,
    Modern,
}

/// What a client says before anything else.
fn hello(era: Era) -> String {
    let hello = match era {
        Era::Legacy => request(
            "hello",
            "initialize",
            json!({
                "protocolVersion": "2025-11-25",
                "capabilities": {},
                "clientInfo": {"name": "fuzz", "version": "0"},
            }),
        ),
        Era::Modern => request("hello", "server/discover", json!({"_meta": meta()})),
    };
    format!("{hello}{}\n", json!({"jsonrpc": "2.0", "method": "notifications/initialized"}))
}

/// The call that must be answered, whatever was said before.
fn afterwards(era: Era) -> String {
    let mut parameters = json!({"name": "list_users", "arguments": {}});
    if let Era::Modern = era {
        parameters["_meta"] = meta();
    }
    request(AFTERWARDS, "tools/call", parameters)
}

fn meta() -> Value {
    json!({
        "io.modelcontextprotocol/protocolVersion": "2026-07-28",
        "io.modelcontextprotocol/clientCapabilities": {},
        "io.modelcontextprotocol/clientInfo": {"name": "fuzz", "version": "0"},
    })
}

fn request(id: &str, method: &str, parameters: Value) -> String {
    format!("{}\n", json!({"jsonrpc": "2.0", "id": id, "method": method, "params": parameters}))
}

/// Listens until the call that follows is answered.
async fn listen(output: impl AsyncRead + Unpin) -> Value {
    let mut lines = BufReader::new(output).lines();
    while let Some(line) = lines.next_line().await.expect("the server says text") {
        let message: Value = serde_json::from_str(&line).expect("the server says JSON");
        assert_eq!(message["jsonrpc"], "2.0", "the server says messages");
        if message["id"] == AFTERWARDS {
            return message;
        }
    }
    panic!("the server ended");
}

async fn exchange(era: Era, said: &[u8]) {
    let store = Store::open_in_memory().expect("there is memory");
    store.import(&HOME).expect("the fixture can be imported");
    let service = service(Arc::new(store), ServiceOptions::default());
    let (client, server) = duplex(64 << 10);
    let (input, output) = split(server);
    let serving = tokio::spawn(stdio::serve_streams(service, input, output));
    let (answers, mut questions) = split(client);
    let speak = async {
        for part in [hello(era).as_bytes(), said, b"\n", afterwards(era).as_bytes()] {
            questions.write_all(part).await.expect("the server listens");
        }
    };
    let (answer, ()) = timeout(PATIENCE, async { tokio::join!(listen(answers), speak) })
        .await
        .unwrap_or_else(|_| panic!("there was no answer in {era:?}"));
    assert!(answer["result"]["structuredContent"]["users"].is_array(), "{era:?}: {answer}");
    serving.abort();
}

fuzz_target!(|said: &[u8]| {
    for era in [Era::Legacy, Era::Modern] {
        let runtime = Builder::new_current_thread().enable_time().build().expect("a runtime can be made");
        runtime.block_on(exchange(era, said));
    }
});
