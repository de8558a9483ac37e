//! A home's server with the fixtures that MCP's conformance suite calls, served as `coin-server --http` is.
//!
//! The suite knows no tools of ours. It judges a server by tools, prompts and resources of its own (`test_…`), which a
//! server under test must have. Here they stand beside the home's; `clients/run conformance` runs the suite.

mod content;
mod dialogue;
mod handler;
mod questions;

use std::env;
use std::sync::Arc;

use coin_server::store::Store;
use coin_server::transport::http::{HttpOptions, bind};
use coin_server::{ServiceOptions, service};
use tokio_util::sync::CancellationToken;

use handler::WithFixtures;

#[tokio::main]
async fn main() {
    let address = env::args().nth(1).and_then(|address| address.parse().ok());
    let address = address.expect("usage: conformance-server ADDRESS:PORT");
    let store = Store::open_in_memory().expect("a home in memory can be made");
    let home = service(Arc::new(store), ServiceOptions::default());
    let server = bind(HttpOptions::new(address)).await.expect("the address is free");
    eprintln!("conformance-server: serving MCP at {}", server.url());
    server.serve(WithFixtures::new(home), CancellationToken::new()).await;
}
