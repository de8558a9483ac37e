//! HTTP as it goes over the wire, so that a test can also send what no HTTP library would.

mod exchange;
mod server;

pub use exchange::{HttpConnection, HttpRequest, HttpResponse};
pub use server::HttpServer;
