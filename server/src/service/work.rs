//! The work of requests. What may take a while is done away from the threads that serve the protocol, with its progress
//! told to the client that wants to know it, and broken off when the client gives it up. Handing it over takes longer
//! than what is brief, which is done where it is.

use std::convert::Infallible;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

use rmcp::RoleServer;
use rmcp::model::ProgressNotificationParam;
use rmcp::service::RequestContext;
use thiserror::Error;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use tokio::time::{Instant, sleep_until, timeout};
use tokio_util::sync::CancellationToken;

use crate::store::{Call, Progress};

/// The least time between two notes on progress, so that a long call does not flood its client.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// How many requests of all clients are worked on at once. Those that wait for the disk count.
pub(super) const WORK_AT_ONCE: usize = 128;

/// How long a request waits for those before it. A client that sends hundreds of calls in one go over a slow disk gets
/// them all done, one after another; who is refused after this time should send fewer.
const WAIT_FOR_A_PLACE: Duration = Duration::from_secs(10);

/// Why work was not done to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub(super) enum Undone {
    /// It panicked.
    #[error(
        "the server has a fault: the call stopped, and nothing was changed; the server's log (stderr) says more"
    )]
    Fault,
    /// There is too much of it.
    #[error(
        "{WORK_AT_ONCE} requests are being worked on, and the turn of this one did not come within {} seconds; try \
         again later",
        WAIT_FOR_A_PLACE.as_secs()
    )]
    TooMuch,
    /// Nobody waits for it any more.
    #[error("the call was given up before its turn came; nothing was changed")]
    GivenUp,
}

/// A call that nobody waits for any more when this is dropped.
struct WaitedFor(Call);

impl Drop for WaitedFor {
    fn drop(&mut self) {
        self.0.interrupt();
    }
}

/// Does work at once, on this thread. It must be brief, because whatever else this thread serves waits for it.
///
/// # Errors
/// If the work panicked.
pub(super) fn run_brief<T>(work: impl FnOnce() -> T) -> Result<T, Undone> {
    // What the work has changed in the home was rolled back, and nothing else of it is seen again.
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| Undone::Fault)
}

/// One of the `places` that there are for work, given to those who want one in the order in which they came.
///
/// # Errors
/// If none becomes free in time, or if nobody waits for the work any more.
async fn place(
    places: &Arc<Semaphore>,
    given_up: &CancellationToken,
) -> Result<OwnedSemaphorePermit, Undone> {
    tokio::select! {
        biased;
        () = given_up.cancelled() => Err(Undone::GivenUp),
        place = timeout(WAIT_FOR_A_PLACE, Arc::clone(places).acquire_owned()) => match place {
            Ok(Ok(place)) => Ok(place),
            Ok(Err(_)) | Err(_) => Err(Undone::TooMuch),
        },
    }
}

/// Does the work of a request on a thread that may wait, in one of the `places` that there are for it.
///
/// # Errors
/// If none becomes free in time, if nobody waits for the work any more, or if it panicked.
pub(super) async fn run<T: Send + 'static>(
    places: &Arc<Semaphore>,
    context: &RequestContext<RoleServer>,
    work: impl FnOnce(&Call) -> T + Send + 'static,
) -> Result<T, Undone> {
    let place = place(places, &context.ct).await?;
    let (told, progress) = watch::channel(None);
    let call = match context.meta.get_progress_token() {
        Some(_) => Call::with_listener(move |progress| {
            told.send_replace(Some(progress));
        }),
        None => Call::default(),
    };
    let waited_for = WaitedFor(call.clone());
    let mut work = tokio::task::spawn_blocking(move || {
        let outcome = work(&call);
        drop(place);
        outcome
    });
    let outcome = tokio::select! {
        outcome = &mut work => outcome,
        never = tell(context, progress) => match never {},
        () = context.ct.cancelled() => {
            drop(waited_for);
            work.await
        }
    };
    outcome.map_err(|_| Undone::Fault)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_request_waits_for_those_before_it() {
        let places = Arc::new(Semaphore::new(1));
        let before = place(&places, &CancellationToken::new()).await.unwrap();
        let waiting = tokio::spawn({
            let places = Arc::clone(&places);
            async move { place(&places, &CancellationToken::new()).await.map(drop) }
        });
        tokio::time::sleep(WAIT_FOR_A_PLACE / 2).await;
        assert!(!waiting.is_finished());
        drop(before);
        assert_eq!(waiting.await.unwrap(), Ok(()));
    }

    #[tokio::test(start_paused = true)]
    async fn a_request_that_has_waited_too_long_is_refused() {
        let places = Arc::new(Semaphore::new(0));
        let came = Instant::now();
        assert_eq!(place(&places, &CancellationToken::new()).await.map(drop), Err(Undone::TooMuch));
        assert_eq!(came.elapsed(), WAIT_FOR_A_PLACE);
    }

    #[tokio::test(start_paused = true)]
    async fn a_request_that_is_given_up_gets_no_place() {
        let given_up = CancellationToken::new();
        let full = Arc::new(Semaphore::new(0));
        let waiting = tokio::spawn({
            let (full, given_up) = (Arc::clone(&full), given_up.clone());
            async move { place(&full, &given_up).await.map(drop) }
        });
        tokio::time::sleep(WAIT_FOR_A_PLACE / 2).await;
        given_up.cancel();
        assert_eq!(waiting.await.unwrap(), Err(Undone::GivenUp));
        // Also where a place is free at the same moment.
        let free = Arc::new(Semaphore::new(1));
        assert_eq!(place(&free, &given_up).await.map(drop), Err(Undone::GivenUp));
    }
}
