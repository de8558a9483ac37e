//! The one client through which the host reaches a tool server, wherever that server runs.

use std::sync::Arc;
use std::time::Duration;

use coin_server::service::CoinService;
use rmcp::model::{
    CallToolRequestParams, CallToolResult, ClientCapabilities, ClientConfig, ContentBlock, Implementation,
    ProtocolVersion,
};
use rmcp::service::{ClientLifecycleMode, ClientServiceExt, RoleClient, RunningService, ServiceError};
use rmcp::transport::{StreamableHttpClientTransport, TokioChildProcess};
use rmcp::{ServiceExt, handler::client::ClientHandler};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use thiserror::Error;

use crate::model::ToolDefinition;

/// How long the server may take for one call. Tools answer in microseconds; a locked database in seconds.
const CALL_TIMEOUT: Duration = Duration::from_secs(60);

/// The in-memory pipe holds this many bytes in each direction.
const PIPE_BYTES: usize = 1 << 20;

/// Where the tool server is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ServerAddress {
    /// In this process, over an in-memory pipe.
    InProcess,
    /// A program to start, with its arguments; it speaks over its standard input and output.
    Command(Vec<String>),
    /// A Streamable HTTP endpoint.
    Url(String),
}

/// Why a server address cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{given:?} names no server; give in-process, a URL, or a command such as 'coin-server --db home.db'")]
pub struct InvalidServerAddress {
    given: String,
}

impl std::str::FromStr for ServerAddress {
    type Err = InvalidServerAddress;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == "in-process" {
            return Ok(Self::InProcess);
        }
        if text.starts_with("http://") || text.starts_with("https://") {
            return Ok(Self::Url(text.to_owned()));
        }
        match shlex::split(text) {
            Some(words) if !words.is_empty() => Ok(Self::Command(words)),
            _ => Err(InvalidServerAddress { given: text.to_owned() }),
        }
    }
}

/// Why the server cannot be used.
#[derive(Debug, Error)]
pub enum ServerError {
    /// The program could not be started.
    #[error("cannot start the server {command:?}: {source}; is the program's path right?")]
    Start {
        /// The program.
        command: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The server did not complete the protocol's first exchange.
    #[error("the server {address} does not answer as an MCP server: {reason}")]
    Connect {
        /// Where it is.
        address: String,
        /// What went wrong.
        reason: String,
    },
    /// A call got no answer.
    #[error("the server did not answer {tool}: {reason}")]
    Call {
        /// The tool, or the request.
        tool: String,
        /// What went wrong.
        reason: String,
    },
    /// A tool answered with an error.
    #[error("{tool} answered: {text}")]
    Tool {
        /// The tool.
        tool: String,
        /// Its words.
        text: String,
    },
    /// A tool's answer is not in its form.
    #[error("the answer of {tool} is not in the form that this host expects: {source}")]
    Answer {
        /// The tool.
        tool: String,
        /// Where it differs.
        source: serde_json::Error,
    },
}

/// What a tool answered.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolOutcome {
    /// JSON, or an error in words.
    pub text: String,
    /// Whether it is an error.
    pub is_error: bool,
}

#[derive(Debug, Clone)]
struct Client;

impl ClientHandler for Client {
    fn get_info(&self) -> ClientConfig {
        ClientConfig::new(
            ClientCapabilities::builder().build(),
            Implementation::new("coin-host", env!("CARGO_PKG_VERSION")),
        )
    }
}

/// A connection to a tool server.
#[derive(Debug)]
pub struct ToolServer {
    client: RunningService<RoleClient, Client>,
    tools: Arc<[ToolDefinition]>,
}

fn lifecycle() -> ClientLifecycleMode {
    ClientLifecycleMode::Auto {
        preferred_versions: vec![ProtocolVersion::V_2026_07_28],
        legacy_version: Some(ProtocolVersion::V_2025_11_25),
    }
}

impl ToolServer {
    /// Serves `service` in this process, over an in-memory pipe.
    pub async fn in_process(service: CoinService) -> Result<Self, ServerError> {
        let failed = |reason: String| ServerError::Connect { address: "in this process".to_owned(), reason };
        let (near, far) = tokio::io::duplex(PIPE_BYTES);
        let serving = tokio::spawn(async move {
            match service.serve(far).await {
                Ok(running) => running.waiting().await.map(drop).map_err(|error| error.to_string()),
                Err(error) => Err(error.to_string()),
            }
        });
        let connected = Client.serve_with_lifecycle(near, lifecycle()).await;
        match connected {
            Ok(client) => Self::with_tools(client).await,
            Err(error) => {
                serving.abort();
                Err(failed(error.to_string()))
            }
        }
    }

    /// Starts a program and speaks over its standard input and output. Its standard error is passed through.
    pub async fn child(words: &[String]) -> Result<Self, ServerError> {
        let display = words.join(" ");
        let (program, arguments) = words.split_first().ok_or_else(|| ServerError::Start {
            command: display.clone(),
            source: std::io::ErrorKind::InvalidInput.into(),
        })?;
        let mut command = tokio::process::Command::new(program);
        command.args(arguments);
        // It ends with its standard input, and not with the Ctrl-C that ends a run in good order.
        #[cfg(unix)]
        command.process_group(0);
        let transport = TokioChildProcess::new(command)
            .map_err(|source| ServerError::Start { command: display.clone(), source })?;
        let client = Client
            .serve_with_lifecycle(transport, lifecycle())
            .await
            .map_err(|error| ServerError::Connect { address: display, reason: error.to_string() })?;
        Self::with_tools(client).await
    }

    /// Connects to a Streamable HTTP endpoint.
    pub async fn url(url: &str) -> Result<Self, ServerError> {
        // Ignored where another part of the process has chosen a provider first.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let client = Client
            .serve_with_lifecycle(StreamableHttpClientTransport::from_uri(url), lifecycle())
            .await
            .map_err(|error| ServerError::Connect { address: url.to_owned(), reason: error.to_string() })?;
        Self::with_tools(client).await
    }

    async fn with_tools(client: RunningService<RoleClient, Client>) -> Result<Self, ServerError> {
        let listed =
            client.peer().list_all_tools().await.map_err(|error| call_error("tools/list", &error))?;
        let tools = listed
            .into_iter()
            .filter(|tool| tool.annotations.as_ref().and_then(|hints| hints.read_only_hint).unwrap_or(false))
            .map(|tool| ToolDefinition {
                name: tool.name.into_owned(),
                description: tool.description.map(std::borrow::Cow::into_owned).unwrap_or_default(),
                input_schema: (*tool.input_schema).clone(),
            })
            .collect();
        Ok(Self { client, tools })
    }

    /// The tools that a model may call: those that only read.
    pub fn reading_tools(&self) -> &[ToolDefinition] {
        &self.tools
    }

    /// Calls a tool. An error of the tool is an outcome; only a broken connection is an error.
    pub async fn call_raw(
        &self,
        tool: &str,
        arguments: Map<String, Value>,
    ) -> Result<ToolOutcome, ServerError> {
        let parameters = CallToolRequestParams::new(tool.to_owned()).with_arguments(arguments);
        let answered = tokio::time::timeout(CALL_TIMEOUT, self.client.peer().call_tool(parameters))
            .await
            .map_err(|_| ServerError::Call {
                tool: tool.to_owned(),
                reason: format!("no answer within {} s", CALL_TIMEOUT.as_secs()),
            })?;
        match answered {
            Ok(result) => Ok(outcome(result)),
            // The server refuses the call as such, such as one of an unknown tool: the model may do better.
            Err(ServiceError::McpError(error)) => {
                Ok(ToolOutcome { text: error.message.into_owned(), is_error: true })
            }
            Err(error) => Err(call_error(tool, &error)),
        }
    }

    /// Calls a tool with typed arguments and reads its typed answer.
    pub async fn call<A: Serialize, R: DeserializeOwned>(
        &self,
        tool: &str,
        arguments: &A,
    ) -> Result<R, ServerError> {
        let form = |source| ServerError::Answer { tool: tool.to_owned(), source };
        let arguments = match serde_json::to_value(arguments).map_err(form)? {
            Value::Object(arguments) => arguments,
            _ => Map::new(),
        };
        let ToolOutcome { text, is_error } = self.call_raw(tool, arguments).await?;
        if is_error {
            return Err(ServerError::Tool { tool: tool.to_owned(), text });
        }
        serde_json::from_str(&text).map_err(form)
    }

    /// Ends the connection; a started program is given time to finish.
    pub async fn close(self) {
        if let Err(error) = self.client.cancel().await {
            tracing::debug!(%error, "the connection to the server did not end in order");
        }
    }
}

fn call_error(tool: &str, error: &ServiceError) -> ServerError {
    ServerError::Call { tool: tool.to_owned(), reason: error.to_string() }
}

/// Both forms of a result carry the same JSON; some servers fill in only one of them.
fn outcome(result: CallToolResult) -> ToolOutcome {
    let text: Vec<String> = result
        .content
        .into_iter()
        .filter_map(|block| match block {
            ContentBlock::Text(text) => Some(text.text),
            _ => None,
        })
        .collect();
    let text = match result.structured_content {
        Some(structured) if text.is_empty() => structured.to_string(),
        _ => text.join("\n"),
    };
    ToolOutcome { text, is_error: result.is_error.unwrap_or(false) }
}
