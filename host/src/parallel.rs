//! Independent jobs over all cores, with results in the order of the jobs.

use std::future::Future;

use futures::{StreamExt, TryStreamExt};

/// Runs the jobs, as many at once as there are cores, and gives their results in the order of the jobs, so that
/// nothing depends on which of them ends first. `done` is called after each.
///
/// # Errors
/// The first error in the order of the jobs; no further job is begun then.
pub async fn in_order<Job, T, E>(
    jobs: impl IntoIterator<Item = Job>,
    mut done: impl FnMut(),
) -> Result<Vec<T>, E>
where
    Job: Future<Output = Result<T, E>> + Send + 'static,
    T: Send + 'static,
    E: Send + 'static,
{
    let at_once = std::thread::available_parallelism().map_or(1, usize::from);
    futures::stream::iter(jobs)
        .map(|job| async {
            match tokio::spawn(job).await {
                Ok(result) => result,
                Err(panic) => std::panic::resume_unwind(panic.into_panic()),
            }
        })
        .buffered(at_once)
        .inspect_ok(|_| done())
        .try_collect()
        .await
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[tokio::test(flavor = "multi_thread")]
    async fn results_stand_in_the_order_of_the_jobs() {
        let mut finished = 0;
        let jobs = (0..20_u64).map(|job| async move {
            tokio::time::sleep(std::time::Duration::from_millis(20 - job)).await;
            Ok::<_, ()>(job)
        });
        assert_eq!(in_order(jobs, || finished += 1).await, Ok((0..20).collect::<Vec<_>>()));
        assert_eq!(finished, 20);
    }

    #[tokio::test(flavor = "multi_thread")]
    async fn the_first_error_ends_it() {
        let jobs = (0..5).map(|job| async move { if job >= 2 { Err(job) } else { Ok(job) } });
        assert_eq!(in_order(jobs, || ()).await, Err::<Vec<i32>, _>(2));
    }
}
