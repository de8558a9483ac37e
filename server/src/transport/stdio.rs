//! Standard input and output, as an MCP client that starts the program itself uses them.

use std::io;

use rmcp::service::ServerInitializeError;
use rmcp::transport::io::stdio_pipes;
use rmcp::{ServerHandler, ServiceExt};

/// Serves until the client closes its end; answers that are under way are still sent.
///
/// # Errors
/// If the streams fail, or what the client says first is no request.
pub async fn serve<S: ServerHandler>(service: S) -> io::Result<()> {
    match service.serve(stdio_pipes()).await {
        Ok(running) => running.waiting().await.map(drop).map_err(io::Error::other),
        // A client that only looks whether the program starts says nothing and leaves.
        Err(ServerInitializeError::ConnectionClosed(_)) => Ok(()),
        Err(source) => Err(io::Error::other(source)),
    }
}
