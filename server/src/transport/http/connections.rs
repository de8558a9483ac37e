//! Connections: how many there are, how slowly they may speak, and how they end.

use std::pin::pin;
use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::Method;
use axum::middleware::Next;
use axum::response::Response;
use axum::serve::Listener;
use futures::StreamExt;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::{GracefulShutdown, Watcher};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{Duration, timeout};
use tokio_io_timeout::TimeoutStream;
use tokio_util::sync::CancellationToken;
use tower_service::Service;

use super::Limits;
use super::callers::Ends;

/// The head of a request, all headers together.
const HEAD_BYTES: usize = 64 << 10;

/// How long connections may take to notice that their requests were broken off.
const BREAKING_OFF: Duration = Duration::from_secs(1);

/// Serves every connection until `shutdown`, and then those that are open until their requests are answered or
/// time is up; what is still under way then is told so with `abort`.
pub(super) async fn serve(
    mut listener: TcpListener,
    router: Router,
    limits: &Limits,
    shutdown: &CancellationToken,
    abort: &CancellationToken,
) {
    let slots = Arc::new(Semaphore::new(limits.connections));
    let open = GracefulShutdown::new();
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(limits.head).max_buf_size(HEAD_BYTES);
    loop {
        let next = async {
            let slot = Arc::clone(&slots).acquire_owned().await;
            (slot, Listener::accept(&mut listener).await)
        };
        let (slot, (stream, there)) = tokio::select! {
            biased;
            () = shutdown.cancelled() => break,
            next = next => next,
        };
        let Ok(here) = stream.local_addr() else { continue };
        let connection = serve_connection(
            http.clone(),
            stream,
            Ends { here, there },
            router.clone(),
            limits,
            open.watcher(),
        );
        tokio::spawn(async move {
            connection.await;
            drop(slot);
        });
    }
    drop(listener);
    let mut ended = pin!(open.shutdown());
    if timeout(limits.shutdown, &mut ended).await.is_err() {
        abort.cancel();
        timeout(BREAKING_OFF, ended).await.ok();
    }
}

fn serve_connection(
    http: http1::Builder,
    stream: TcpStream,
    ends: Ends,
    router: Router,
    limits: &Limits,
    watcher: Watcher,
) -> impl Future<Output = ()> + use<> {
    // An answer goes out in several small pieces, and waiting to join them costs 40 ms.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "a connection keeps Nagle's algorithm");
    }
    let mut stream = TimeoutStream::new(stream);
    stream.set_write_timeout(Some(limits.write));
    let service = service_fn(move |request: Request<hyper::body::Incoming>| {
        let mut request = request.map(Body::new);
        request.extensions_mut().insert(ends);
        router.clone().call(request)
    });
    async move {
        let connection = http.serve_connection(TokioIo::new(Box::pin(stream)), service);
        // Clients leave as they like; that is no fault of the server.
        if let Err(error) = watcher.watch(connection).await {
            tracing::debug!(from = %ends.there, %error, "a connection ended early");
        }
    }
}

/// Ends the streams that clients only listen to when the server is told to end; they would never end themselves.
pub(super) async fn end_listening_streams(
    State(shutdown): State<CancellationToken>,
    request: Request,
    next: Next,
) -> Response {
    let is_listening = request.method() == Method::GET;
    let response = next.run(request).await;
    if !is_listening {
        return response;
    }
    response.map(|body| Body::from_stream(body.into_data_stream().take_until(shutdown.cancelled_owned())))
}
