//! What the contract and end-to-end tests of COIN share: the built programs, driven from outside.
//!
//! The tests treat the programs as strangers do. They start the built binaries, speak to them over real pipes and
//! read the files that they leave; the JSON-RPC client here is written by hand on purpose, so that a fault of an
//! MCP library cannot hide a fault of ours. A helper that cannot do its work panics with what it saw.

mod answer;
mod binaries;
mod episode;
mod home;
mod http;
#[cfg(target_os = "linux")]
mod memory;
pub mod provider;
mod repository;
mod schema;
mod server;

pub use answer::{RpcError, ToolAnswer};
pub use binaries::{Finished, Program, binary};
pub use episode::{EpisodeBuilder, EpisodeFolder, feature};
pub use home::Home;
pub use http::{HttpConnection, HttpRequest, HttpResponse, HttpServer};
#[cfg(target_os = "linux")]
pub use memory::resident_memory;
pub use repository::{fixture, is_slow_run, repository, small_house};
pub use schema::{assert_conforms, published_schema};
pub use server::{Era, LEGACY_VERSION, MODERN_VERSION, ServerProcess};
