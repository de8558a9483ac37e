//! Clients that mean no good, or that are broken: what they send has a defined answer, nobody else notices, and
//! memory does not grow. `docs/transports.md` promises what is tested here.

mod endings;
mod eras;
mod limits;
mod local;
mod messages;
mod names;
#[cfg(target_os = "linux")]
mod sessions;
mod sizes;
mod strangers;

use coin_tests::{EpisodeBuilder, Home, HttpRequest, HttpServer};
use serde_json::json;

/// A home of one marker, in which nothing was seen.
fn home() -> Home {
    Home::of(&EpisodeBuilder::new().object("1", "marker", [0.0, 0.0, 0.8]))
}

/// Fails unless the server answers a plain call.
#[track_caller]
fn assert_serves(server: &HttpServer) {
    let users = HttpRequest::call("list_users", json!({})).send(server.address()).content();
    assert_eq!(users["users"].as_array().unwrap().len(), 3);
    assert!(!server.stderr().contains("panicked"), "{}", server.stderr());
}
