//! Requests as they go out, and replies as they are read. The whole way over HTTP is tested in `tests/tests/providers`.

mod bodies;
mod breaking;
mod endpoints;
mod replies;
mod retrying;

use std::time::Duration;

use super::failure::{Failure, Refusal};

/// An error of the server.
fn status(status: u16, body: &str) -> Failure {
    Failure::Status(Refusal::read(status, body, None))
}

/// The same, with a time to wait.
fn wait(seconds: u64) -> Failure {
    Failure::Status(Refusal::read(429, "", Some(Duration::from_secs(seconds))))
}
