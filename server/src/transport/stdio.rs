//! Standard input and output, as an MCP client that starts the program itself uses them.

use std::io;

use rmcp::service::ServerInitializeError;
use rmcp::transport::async_rw::AsyncRwTransport;
use rmcp::transport::io::stdio_pipes;
use rmcp::{ServerHandler, ServiceExt};
use tokio::io::{AsyncRead, AsyncWrite};

use super::MESSAGE_BYTES;
use super::opening::Opening;

/// Serves on this program's standard input and output, as [`serve_streams`] does.
///
/// # Errors
/// If the streams fail, or what the client says first is no request.
pub async fn serve<S: ServerHandler>(service: S) -> io::Result<()> {
    let (input, output) = stdio_pipes();
    serve_streams(service, input, output).await
}

/// Serves until the client closes its end; answers that are under way are still sent. A line that is longer than
/// [`MESSAGE_BYTES`] is passed over, with a note in the log: nobody knows which request it was.
///
/// # Errors
/// If the streams fail, or what the client says first is no request.
pub async fn serve_streams<S: ServerHandler>(
    service: S,
    input: impl AsyncRead + Send + Unpin + 'static,
    output: impl AsyncWrite + Send + Unpin + 'static,
) -> io::Result<()> {
    let transport = AsyncRwTransport::new_server(input, output).with_max_line_length(MESSAGE_BYTES);
    let transport = Opening::of(transport, service.supported_protocol_versions());
    match service.serve(transport).await {
        Ok(running) => running.waiting().await.map(drop).map_err(io::Error::other),
        // A client that only looks whether the program starts says nothing and leaves.
        Err(ServerInitializeError::ConnectionClosed(_)) => Ok(()),
        Err(source) => Err(io::Error::other(source)),
    }
}
