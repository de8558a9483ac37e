//! How a service reaches its clients.

pub mod http;
mod signals;
pub mod stdio;

pub use signals::until_told_to_end;
