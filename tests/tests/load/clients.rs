//! The three kinds of clients that a server has: over HTTP in both protocol versions, and over a pipe.

use std::net::SocketAddr;

use coin_tests::{Era, Home, HttpConnection, HttpRequest, ServerProcess};
use serde_json::{Value, json};

pub(crate) enum Client {
    Modern(HttpConnection),
    Session(HttpConnection, String),
    Pipe(Box<ServerProcess>),
}

impl Client {
    /// A client of 2026-07-28.
    pub(crate) fn modern(address: SocketAddr) -> Self {
        Self::Modern(HttpConnection::open(address).unwrap())
    }

    /// A client of 2025-11-25, which opens a session.
    pub(crate) fn session(address: SocketAddr) -> Self {
        let mut connection = HttpConnection::open(address).unwrap();
        let hello = connection.exchange(&HttpRequest::initialize()).unwrap();
        let session = hello.header("mcp-session-id").unwrap().to_owned();
        let ready = json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string();
        let ready = HttpRequest::post(ready).header("Mcp-Session-Id", &session);
        assert_eq!(connection.exchange(&ready).unwrap().status, 202);
        Self::Session(connection, session)
    }

    /// A client that starts a server of its own.
    pub(crate) fn pipe(home: &Home, era: Era) -> Self {
        Self::Pipe(Box::new(home.server_of(era)))
    }

    /// Calls a tool, which must succeed.
    #[track_caller]
    pub(crate) fn call(&mut self, tool: &str, arguments: &Value) -> Value {
        let parameters = json!({"name": tool, "arguments": arguments});
        let result = match self {
            Self::Modern(connection) => {
                let response = connection.exchange(&HttpRequest::modern("tools/call", parameters)).unwrap();
                response.message()["result"].clone()
            }
            Self::Session(connection, session) => {
                let request = HttpRequest::in_session(session, "tools/call", parameters);
                connection.exchange(&request).unwrap().message()["result"].clone()
            }
            Self::Pipe(server) => server.request("tools/call", parameters).unwrap(),
        };
        let content = result.get("structuredContent");
        content.unwrap_or_else(|| panic!("{tool} failed: {result:.500}")).clone()
    }
}
