//! A server in this process: with limits that a test need not wait for, and a tool that takes its time.

use std::net::SocketAddr;
use std::sync::mpsc::channel;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use coin_server::transport::http::{self, HttpOptions, Limits};
use rmcp::model::{
    CallToolRequestParams, CallToolResponse, CallToolResult, ContentBlock, ServerCapabilities, ServerConfig,
};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer, ServerHandler};
use serde_json::json;
use tokio::runtime::Builder;
use tokio_util::sync::CancellationToken;

use coin_tests::{HttpRequest, HttpResponse};

/// The server ends when this is dropped.
pub(crate) struct LocalServer {
    address: SocketAddr,
    shutdown: CancellationToken,
    thread: Option<JoinHandle<()>>,
}

impl LocalServer {
    pub(crate) fn start(limits: Limits) -> Self {
        let shutdown = CancellationToken::new();
        let told = shutdown.clone();
        let (tell, address) = channel();
        let thread = thread::spawn(move || {
            let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
            runtime.block_on(async {
                let mut options = HttpOptions::new("127.0.0.1:0".parse().unwrap());
                options.limits = limits;
                let server = http::bind(options).await.unwrap();
                tell.send(server.address()).unwrap();
                server.serve(Tools, told).await;
            });
        });
        Self { address: address.recv().unwrap(), shutdown, thread: Some(thread) }
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Tells the server to end.
    pub(crate) fn end(&self) {
        self.shutdown.cancel();
    }

    /// Waits until it has ended.
    pub(crate) fn wait(mut self) {
        self.thread.take().unwrap().join().unwrap();
    }
}

impl Drop for LocalServer {
    fn drop(&mut self) {
        self.shutdown.cancel();
    }
}

/// A call that is answered after a while.
pub(crate) fn sleep(duration: Duration) -> HttpRequest {
    HttpRequest::call("sleep", json!({"milliseconds": duration.as_millis() as u64}))
}

/// A call whose answer has so many bytes.
pub(crate) fn speak(bytes: usize) -> HttpRequest {
    HttpRequest::call("speak", json!({"bytes": bytes}))
}

/// Fails unless it is the answer to [`sleep`].
#[track_caller]
pub(crate) fn assert_slept(response: &HttpResponse) {
    assert_eq!(response.status, 200, "{response:?}");
    assert_eq!(response.message()["result"]["content"][0]["text"], "slept", "{response:?}");
}

/// The tools `sleep` and `speak`.
#[derive(Clone)]
struct Tools;

impl ServerHandler for Tools {
    fn get_info(&self) -> ServerConfig {
        ServerConfig::new(ServerCapabilities::builder().enable_tools().build())
    }

    async fn call_tool(
        &self,
        request: CallToolRequestParams,
        _: RequestContext<RoleServer>,
    ) -> Result<CallToolResponse, ErrorData> {
        let arguments = request.arguments.unwrap_or_default();
        let number = |name: &str| arguments[name].as_u64().unwrap();
        let text = match &*request.name {
            "sleep" => {
                tokio::time::sleep(Duration::from_millis(number("milliseconds"))).await;
                "slept".to_owned()
            }
            _ => "a".repeat(number("bytes").try_into().unwrap()),
        };
        Ok(CallToolResult::success(vec![ContentBlock::text(text)]).into())
    }
}
