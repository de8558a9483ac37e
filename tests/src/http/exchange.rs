//! A request, a response, and a connection that carries them.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use serde_json::{Value, json};

use crate::server::{LEGACY_VERSION, MODERN_VERSION, initialize_parameters, modern_meta};

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// A request that a test may spoil before it is sent.
#[derive(Debug, Clone)]
pub struct HttpRequest {
    method: String,
    path: String,
    headers: Vec<(String, String)>,
    body: Vec<u8>,
    kept_back: usize,
}

/// What came back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HttpResponse {
    /// The status code.
    pub status: u16,
    /// The headers, with names in lower case.
    pub headers: Vec<(String, String)>,
    /// The body.
    pub body: String,
}

/// A connection that is kept open between requests.
#[derive(Debug)]
pub struct HttpConnection {
    stream: BufReader<TcpStream>,
}

impl HttpRequest {
    /// A request without a body.
    pub fn new(method: &str, path: &str) -> Self {
        let headers = vec![("Host".to_owned(), "localhost".to_owned())];
        Self { method: method.to_owned(), path: path.to_owned(), headers, body: Vec::new(), kept_back: 0 }
    }

    /// Bytes for the MCP endpoint, with the headers that every message has.
    pub fn post(body: impl Into<Vec<u8>>) -> Self {
        let mut request = Self::new("POST", "/mcp")
            .header("Accept", "application/json, text/event-stream")
            .header("Content-Type", "application/json");
        request.body = body.into();
        request
    }

    /// The first message of a client of the older protocol.
    pub fn initialize() -> Self {
        let parameters = initialize_parameters();
        let message = json!({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": parameters});
        Self::post(message.to_string())
    }

    /// A request of the older protocol within a session.
    pub fn in_session(session: &str, method: &str, parameters: Value) -> Self {
        let message = json!({"jsonrpc": "2.0", "id": 2, "method": method, "params": parameters});
        Self::post(message.to_string())
            .header("Mcp-Session-Id", session)
            .header("MCP-Protocol-Version", LEGACY_VERSION)
    }

    /// A request of the newer protocol.
    pub fn modern(method: &str, mut parameters: Value) -> Self {
        parameters["_meta"] = modern_meta();
        let name = parameters.get("name").or_else(|| parameters.get("uri")).and_then(Value::as_str);
        let name = name.map(str::to_owned);
        let message = json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters});
        let request = Self::post(message.to_string())
            .header("MCP-Protocol-Version", MODERN_VERSION)
            .header("Mcp-Method", method);
        name.into_iter().fold(request, |request, name| request.header("Mcp-Name", &name))
    }

    /// A call of a tool in the newer protocol.
    pub fn call(tool: &str, arguments: Value) -> Self {
        Self::modern("tools/call", json!({"name": tool, "arguments": arguments}))
    }

    /// Asks with another method.
    #[must_use]
    pub fn method(mut self, method: &str) -> Self {
        method.clone_into(&mut self.method);
        self
    }

    /// Announces so many bytes more than are sent.
    #[must_use]
    pub fn keeping_back(mut self, bytes: usize) -> Self {
        self.kept_back = bytes;
        self
    }

    /// Sets a header, in the place of one that has the same name.
    #[must_use]
    pub fn header(mut self, name: &str, value: &str) -> Self {
        self = self.without(name);
        self.headers.push((name.to_owned(), value.to_owned()));
        self
    }

    /// Takes a header away.
    #[must_use]
    pub fn without(mut self, name: &str) -> Self {
        self.headers.retain(|(other, _)| !other.eq_ignore_ascii_case(name));
        self
    }

    /// Everything before the body.
    pub fn head(&self) -> String {
        let mut head = format!("{} {} HTTP/1.1\r\n", self.method, self.path);
        for (name, value) in &self.headers {
            head += &format!("{name}: {value}\r\n");
        }
        head + &format!("Content-Length: {}\r\n\r\n", self.body.len() + self.kept_back)
    }

    /// Sends the request over a connection of its own.
    #[track_caller]
    pub fn send(&self, address: SocketAddr) -> HttpResponse {
        let outcome = HttpConnection::open(address).and_then(|mut connection| connection.exchange(self));
        outcome.unwrap_or_else(|error| panic!("no answer to {self:.300?}: {error}"))
    }
}

impl HttpResponse {
    /// The first header of this name.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(other, _)| other == name).map(|(_, value)| value.as_str())
    }

    /// The JSON-RPC message in the body: the body itself, or the last event of a stream.
    #[track_caller]
    pub fn message(&self) -> Value {
        let text = match self.header("content-type") {
            Some("text/event-stream") => {
                let mut events = self.body.lines().filter_map(|line| line.strip_prefix("data: {"));
                events.next_back().map(|event| format!("{{{event}")).unwrap_or_default()
            }
            _ => self.body.clone(),
        };
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("no message in {self:?}: {error}"))
    }

    /// The structured content of a tool's success.
    #[track_caller]
    pub fn content(&self) -> Value {
        let message = self.message();
        let content = message["result"].get("structuredContent");
        content.unwrap_or_else(|| panic!("the call failed: {self:.500?}")).clone()
    }
}

impl HttpConnection {
    /// Connects.
    ///
    /// # Errors
    /// If nobody listens.
    pub fn open(address: SocketAddr) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        Ok(Self { stream: BufReader::new(stream) })
    }

    /// Sends a request and reads its response to the end.
    ///
    /// # Errors
    /// If the connection breaks off, or if what comes is no response.
    pub fn exchange(&mut self, request: &HttpRequest) -> io::Result<HttpResponse> {
        self.send(request)?;
        self.read()
    }

    /// Sends a request.
    ///
    /// # Errors
    /// If the connection broke off.
    pub fn send(&mut self, request: &HttpRequest) -> io::Result<()> {
        self.write(request.head().as_bytes())?;
        self.write(&request.body)
    }

    /// Sends bytes as they are.
    ///
    /// # Errors
    /// If the connection broke off.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.get_mut().write_all(bytes)
    }

    /// The same connection, for another thread.
    ///
    /// # Errors
    /// If the system has no room for it.
    pub fn share(&self) -> io::Result<Self> {
        Ok(Self { stream: BufReader::new(self.stream.get_ref().try_clone()?) })
    }

    /// Reads a response to its end.
    ///
    /// # Errors
    /// If the connection breaks off, or if what comes is no response.
    pub fn read(&mut self) -> io::Result<HttpResponse> {
        let mut response = self.read_head()?;
        let mut body = Vec::new();
        if response.header("transfer-encoding") == Some("chunked") {
            loop {
                let size = self.line()?;
                let size = usize::from_str_radix(&size, 16).map_err(io::Error::other)?;
                let start = body.len();
                body.resize(start + size, 0);
                self.stream.read_exact(&mut body[start..])?;
                self.line()?;
                if size == 0 {
                    break;
                }
            }
        } else {
            let size = response.header("content-length").unwrap_or("0");
            body.resize(size.parse().map_err(io::Error::other)?, 0);
            self.stream.read_exact(&mut body)?;
        }
        response.body = String::from_utf8(body).map_err(io::Error::other)?;
        Ok(response)
    }

    /// Reads a response up to its body, which may never end.
    ///
    /// # Errors
    /// If the connection breaks off, or if what comes is no response.
    pub fn read_head(&mut self) -> io::Result<HttpResponse> {
        let status = self.line()?;
        let code = status.split(' ').nth(1).and_then(|code| code.parse().ok());
        let status = code.ok_or_else(|| io::Error::other(format!("{status:?} is no status line")))?;
        let mut headers = Vec::new();
        loop {
            let line = self.line()?;
            if line.is_empty() {
                return Ok(HttpResponse { status, headers, body: String::new() });
            }
            let (name, value) = line.split_once(": ").ok_or_else(|| io::Error::other(line.clone()))?;
            headers.push((name.to_ascii_lowercase(), value.to_owned()));
        }
    }

    fn line(&mut self) -> io::Result<String> {
        let mut line = String::new();
        if self.stream.read_line(&mut line)? == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(line.trim_end_matches(['\r', '\n']).to_owned())
    }
}
