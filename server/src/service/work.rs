//! The work of requests. What may take a while is done away from the threads that serve the protocol, with its progress
//! told to the client that wants to know it, and broken off when the client gives it up. Handing it over takes longer
//! than what is brief, which is done where it is.

use std::convert::Infallible;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use rmcp::RoleServer;
use rmcp::model::ProgressNotificationParam;
use rmcp::service::RequestContext;
use tokio::sync::watch;
use tokio::time::{Instant, sleep_until};

use crate::store::{Call, Progress};

/// The least time between two notes on progress, so that a long call does not flood its client.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// The work has a fault: it panicked.
#[derive(Debug)]
pub(super) struct Fault;

/// Does work at once, on this thread. It must be brief, because whatever else this thread serves waits for it.
///
/// # Errors
/// If the work panicked.
pub(super) fn run_brief<T>(work: impl FnOnce() -> T) -> Result<T, Fault> {
    // What the work has changed in the home was rolled back, and nothing else of it is seen again.
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| Fault)
}

/// Does the work of a request on a thread that may wait.
///
/// # Errors
/// If the work panicked.
pub(super) async fn run<T: Send + 'static>(
    context: &RequestContext<RoleServer>,
    work: impl FnOnce(&Call) -> T + Send + 'static,
) -> Result<T, Fault> {
    let (told, progress) = watch::channel(None);
    let call = match context.meta.get_progress_token() {
        Some(_) => Call::with_listener(move |progress| {
            told.send_replace(Some(progress));
        }),
        None => Call::default(),
    };
    let working = call.clone();
    let mut work = tokio::task::spawn_blocking(move || work(&working));
    let outcome = tokio::select! {
        outcome = &mut work => outcome,
        never = tell(context, progress) => match never {},
        () = context.ct.cancelled() => {
            call.interrupt();
            work.await
        }
    };
    outcome.map_err(|_| Fault)
}

/// Tells the client how far the work has come, where it wants to know, until nobody polls this any more.
async fn tell(
    context: &RequestContext<RoleServer>,
    mut progress: watch::Receiver<Option<Progress>>,
) -> Infallible {
    let Some(token) = context.meta.get_progress_token() else { return std::future::pending().await };
    while progress.changed().await.is_ok() {
        let reached = *progress.borrow_and_update();
        let next = Instant::now() + PROGRESS_INTERVAL;
        if let Some(reached) = reached {
            let note = ProgressNotificationParam::new(token.clone(), 100.0 * reached.share())
                .with_total(100.0)
                .with_message(reached.to_string());
            if context.peer.notify_progress(note).await.is_err() {
                break;
            }
        }
        sleep_until(next).await;
    }
    std::future::pending().await
}
