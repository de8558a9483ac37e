//! How a service reaches its clients.

pub mod stdio;
