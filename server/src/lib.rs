//! The tool server of COIN: what a home knows about its things, kept in SQLite and handed out over MCP.
//!
//! [`episode`] reads a recording, [`store`] keeps a home, and [`service`](fn@service) offers a home's tools to
//! any MCP client: over standard input and output in the binary, over an in-memory pipe inside another program.

#[doc(hidden)]
pub mod cli;
mod cursor;
pub mod display;
mod doctor;
pub mod episode;
mod hosts;
mod map;
mod near_miss;
mod observations;
pub mod output_file;
pub mod pages;
mod scene;
pub mod service;
pub mod store;
#[cfg(test)]
mod test_home;
mod tools;
pub mod transport;

pub use service::{CallError, ServiceOptions, service};
pub use tools::{ToolSelection, UnknownTool};
