//! Streamable HTTP: one MCP endpoint that many clients use at once, and that a hostile one cannot stop.
//!
//! A request passes, from the outside in: `connections` (how many, and how slowly they may send), `callers` (who may
//! be behind a browser), `load` (how often), `token` (who may ask at all), `load` (how much they may send, and how
//! many at once), and only then rmcp's service, which speaks the protocol. Nothing here knows which tools are
//! served, and what any client can cause is logged at the level `debug` at most, so that a flood of requests is no
//! flood of messages.

mod callers;
mod connections;
mod load;
mod options;
mod sessions;
mod token;

use std::net::SocketAddr;
use std::sync::Arc;

use axum::Router;
use axum::http::StatusCode;
use axum::http::header::{RETRY_AFTER, WWW_AUTHENTICATE};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use rmcp::ServerHandler;
use rmcp::transport::streamable_http_server::{StreamableHttpServerConfig, StreamableHttpService};
use thiserror::Error;
use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

pub use options::{HttpOptions, Limits};
pub use token::{Token, TokenError};

use callers::Callers;
use load::Load;
use sessions::Sessions;

/// Where clients speak MCP.
const ENDPOINT: &str = "/mcp";

/// Where it can be asked whether the server lives.
const HEALTH: &str = "/healthz";

/// Why a server does not start.
#[derive(Debug, Error)]
pub enum BindError {
    /// Other computers could ask without saying who they are.
    #[error(
        "{0} can be reached from other computers, so a token is needed: name a file that holds one with \
         --token-file, set COIN_TOKEN, or listen on 127.0.0.1"
    )]
    Unprotected(SocketAddr),
    /// The system gives no such address.
    #[error(
        "cannot listen on {address}: {source}; choose another port (0 takes a free one), or end the other program"
    )]
    Address {
        /// The address that was asked for.
        address: SocketAddr,
        /// What the system says.
        source: std::io::Error,
    },
}

/// An address that is listened on, before anything is served there.
#[derive(Debug)]
pub struct HttpServer {
    listener: TcpListener,
    address: SocketAddr,
    options: HttpOptions,
}

/// Takes an address.
///
/// # Errors
/// If the address is taken, or if it can be reached from other computers and there is no token.
pub async fn bind(options: HttpOptions) -> Result<HttpServer, BindError> {
    let address = options.address;
    if !address.ip().is_loopback() && options.token.is_none() {
        return Err(BindError::Unprotected(address));
    }
    let listening = async {
        let listener = TcpListener::bind(address).await?;
        let address = listener.local_addr()?;
        Ok((listener, address))
    };
    let (listener, bound) = listening.await.map_err(|source| BindError::Address { address, source })?;
    Ok(HttpServer { listener, address: bound, options })
}

impl HttpServer {
    /// Where it listens, with the port that the system chose where 0 was asked for.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The URL of the MCP endpoint.
    pub fn url(&self) -> String {
        format!("http://{}{ENDPOINT}", self.address)
    }

    /// Serves until `shutdown` is cancelled. Requests that are under way are then finished, within
    /// [`Limits::shutdown`].
    pub async fn serve<S: ServerHandler + Clone>(self, service: S, shutdown: CancellationToken) {
        let Self { listener, options, .. } = self;
        let abort = CancellationToken::new();
        let router = router(service, &options, &shutdown, &abort);
        connections::serve(listener, router, &options.limits, &shutdown, &abort).await;
    }
}

fn router<S: ServerHandler + Clone>(
    service: S,
    options: &HttpOptions,
    shutdown: &CancellationToken,
    abort: &CancellationToken,
) -> Router {
    let limits = &options.limits;
    let config = StreamableHttpServerConfig::default()
        // Clients of 2026-07-28 get plain JSON where one message is the whole answer.
        .with_json_response(true)
        .with_max_request_body_bytes(limits.body_bytes)
        .with_cancellation_token(abort.clone())
        // `callers` has checked Host and Origin, for every path and against the address of the very connection.
        .disable_allowed_hosts();
    let sessions = Arc::new(Sessions::new(limits.sessions, limits.session_idle));
    let protocol = StreamableHttpService::new(move || Ok(service.clone()), sessions, config);
    let load = Arc::new(Load::new(limits));
    let callers = Arc::new(Callers::new(&options.allowed_hosts));
    Router::new()
        .route_service(ENDPOINT, protocol)
        .layer(from_fn_with_state(shutdown.clone(), connections::end_listening_streams))
        .layer(from_fn_with_state(Arc::clone(&load), load::take_turns))
        .layer(from_fn_with_state(Arc::clone(&load), load::read_body))
        .layer(from_fn_with_state(options.token.clone(), token::require))
        .route(HEALTH, get(async || "ok\n"))
        .fallback(async || refused(StatusCode::NOT_FOUND, "There is nothing here; MCP is spoken at /mcp."))
        .layer(from_fn_with_state(Arc::clone(&load), load::limit_rate))
        .layer(from_fn_with_state(callers, callers::refuse_strangers))
        .layer(from_fn_with_state(load, load::hear_out))
}

/// The answer to a request that does not reach the protocol: words for the person who looks for the reason.
fn refused(status: StatusCode, reason: &str) -> Response {
    note(status, reason);
    (status, format!("{reason}\n")).into_response()
}

/// The answer to a request that may be sent again after a second.
fn refused_for_now(status: StatusCode, reason: &str) -> Response {
    note(status, reason);
    (status, [(RETRY_AFTER, "1")], format!("{reason}\n")).into_response()
}

/// The answer to a request without the token.
fn refused_without_token() -> Response {
    let (status, reason) =
        (StatusCode::UNAUTHORIZED, "This server wants its token: Authorization: Bearer TOKEN.");
    note(status, reason);
    (status, [(WWW_AUTHENTICATE, "Bearer")], format!("{reason}\n")).into_response()
}

/// A flood of requests must be no flood of messages.
fn note(status: StatusCode, reason: &str) {
    tracing::debug!(status = status.as_u16(), reason, "a request was turned away");
}
