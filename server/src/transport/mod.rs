//! How a service reaches its clients.

pub mod http;
mod opening;
mod signals;
pub mod stdio;

pub use signals::until_told_to_end;

/// The size of one message of a client, over any transport: the longest call that a tool allows fits into it.
pub const MESSAGE_BYTES: usize = 16 << 20;
