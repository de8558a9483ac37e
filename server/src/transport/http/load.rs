//! How much is borne: how often an address may ask, how large and how slow a body may be, how many requests are
//! worked on at once.

use std::future::ready;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};

use axum::Extension;
use axum::body::{Body, HttpBody};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::middleware::Next;
use axum::response::Response;
use futures::StreamExt;
use governor::{DefaultKeyedRateLimiter, Quota, RateLimiter};
use tokio::sync::{Semaphore, SemaphorePermit};
use tokio::time::timeout;

use super::callers::Ends;
use super::{Limits, refused, refused_for_now};

/// How many addresses are remembered before those that have been quiet are forgotten.
const ADDRESSES: usize = 1024;

/// What is being borne.
pub(super) struct Load {
    limits: Limits,
    rate: DefaultKeyedRateLimiter<IpAddr>,
    memory: Semaphore,
    turns: Semaphore,
}

impl Load {
    pub(super) fn new(limits: &Limits) -> Self {
        Self {
            rate: RateLimiter::keyed(Quota::per_second(limits.requests_per_second)),
            memory: Semaphore::new(limits.bodies_bytes),
            turns: Semaphore::new(limits.requests_at_once),
            limits: limits.clone(),
        }
    }
}

/// Turns away an address that asks too often.
pub(super) async fn limit_rate(
    State(load): State<Arc<Load>>,
    Extension(ends): Extension<Ends>,
    request: Request,
    next: Next,
) -> Response {
    if load.rate.len() > ADDRESSES {
        load.rate.retain_recent();
    }
    match load.rate.check_key(&ends.there.ip()) {
        Ok(()) => next.run(request).await,
        Err(_) => {
            let allowed = load.limits.requests_per_second;
            refused_for_now(
                StatusCode::TOO_MANY_REQUESTS,
                &format!("Your address may send {allowed} requests a second; wait a moment."),
            )
        }
    }
}

/// The body of a request, until somebody reads it.
#[derive(Clone, Default)]
pub(super) struct Unread(Arc<Mutex<Option<Body>>>);

impl Unread {
    fn take(&self) -> Option<Body> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Hears a request that is turned away to its end, since most clients listen only after they have sent everything. What
/// they send is thrown away.
pub(super) async fn hear_out(State(load): State<Arc<Load>>, request: Request, next: Next) -> Response {
    let (mut parts, body) = request.into_parts();
    let unread = Unread(Arc::new(Mutex::new(Some(body))));
    parts.extensions.insert(unread.clone());
    let response = next.run(Request::from_parts(parts, Body::empty())).await;
    if let Some(body) = unread.take() {
        // The answer is there already; who sends too slowly to hear it is not waited for.
        timeout(load.limits.body, body.into_data_stream().for_each(|_| ready(()))).await.ok();
    }
    response
}

/// Reads the body of a request that may pass.
pub(super) async fn read_body(
    State(load): State<Arc<Load>>,
    Extension(unread): Extension<Unread>,
    request: Request,
    next: Next,
) -> Response {
    let Limits { body: patience, body_bytes, .. } = load.limits;
    let parts = request.into_parts().0;
    let body = unread.take().unwrap_or_default();
    match timeout(patience, read(body, body_bytes, &load.memory)).await {
        Ok(Ok((bytes, _held))) => next.run(Request::from_parts(parts, Body::from(bytes))).await,
        Ok(Err(Unusable::TooLong)) => refused(
            StatusCode::PAYLOAD_TOO_LARGE,
            &format!("A request may have {body_bytes} bytes; send less at once."),
        ),
        Ok(Err(Unusable::NoMemory)) => refused_for_now(
            StatusCode::SERVICE_UNAVAILABLE,
            "Too much is being sent at once; try again in a moment.",
        ),
        Ok(Err(Unusable::Broken)) => refused(StatusCode::BAD_REQUEST, "The body of the request broke off."),
        Err(_) => refused(
            StatusCode::REQUEST_TIMEOUT,
            &format!("The body of a request must be there within {} seconds.", patience.as_secs()),
        ),
    }
}

/// Why there is no body.
enum Unusable {
    TooLong,
    NoMemory,
    Broken,
}

/// A body of at most `limit` bytes, and the hold on the memory it takes.
async fn read(
    body: Body,
    limit: usize,
    memory: &Semaphore,
) -> Result<(Vec<u8>, SemaphorePermit<'_>), Unusable> {
    let no_memory = |_| Unusable::NoMemory;
    let announced = usize::try_from(body.size_hint().lower()).unwrap_or(usize::MAX);
    let mut pieces = body.into_data_stream();
    // One piece of memory of the right size leaves half as much behind as growing ones do, and the system gives none of it
    // before something is written there.
    let mut read = Vec::with_capacity(announced.min(limit));
    let mut held = memory.try_acquire_many(0).map_err(no_memory)?;
    while let Some(piece) = pieces.next().await {
        let piece = piece.map_err(|_| Unusable::Broken)?;
        if announced.max(read.len() + piece.len()) > limit {
            // It is heard to its end all the same, but nothing of it is kept.
            drop((read, held));
            pieces.for_each(|_| ready(())).await;
            return Err(Unusable::TooLong);
        }
        let more = u32::try_from(piece.len()).unwrap_or(u32::MAX);
        held.merge(memory.try_acquire_many(more).map_err(no_memory)?);
        read.extend_from_slice(&piece);
    }
    Ok((read, held))
}

/// Has a request wait until it can be worked on. What an answer streams later is not counted: a person may be
/// thinking at its other end.
pub(super) async fn take_turns(State(load): State<Arc<Load>>, request: Request, next: Next) -> Response {
    match timeout(load.limits.turn, load.turns.acquire()).await {
        Ok(Ok(_turn)) => next.run(request).await,
        _ => refused_for_now(
            StatusCode::SERVICE_UNAVAILABLE,
            "Too many requests are being worked on; try again in a moment.",
        ),
    }
}
