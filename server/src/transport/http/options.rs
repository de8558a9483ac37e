//! What the person who starts a server decides, and the limits with their defaults.

use std::net::SocketAddr;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Duration;

use super::Token;
use crate::transport::MESSAGE_BYTES;

/// How a server listens.
#[derive(Debug, Clone)]
pub struct HttpOptions {
    /// Where; port 0 takes a free one.
    pub address: SocketAddr,
    /// What a client must know. It may be missing only where other computers cannot connect.
    pub token: Option<Token>,
    /// Names by which clients reach the server, beside loopback names and the address they connected to.
    pub allowed_hosts: Vec<String>,
    /// How much is borne.
    pub limits: Limits,
}

impl HttpOptions {
    /// Listens on `address` with the usual limits and without a token.
    pub fn new(address: SocketAddr) -> Self {
        Self { address, token: None, allowed_hosts: Vec::new(), limits: Limits::default() }
    }
}

/// How much a server bears before it makes clients wait or turns them away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Open connections; further ones wait in the system's queue.
    pub connections: usize,
    /// How long a client may take for the head of a request, and how long a connection may be idle.
    pub head: Duration,
    /// How long a client may take for the body of a request.
    pub body: Duration,
    /// The size of a body.
    pub body_bytes: usize,
    /// The size of all bodies that are being read, or worked on until their answer begins.
    pub bodies_bytes: usize,
    /// How long a client may read nothing while an answer waits for it.
    pub write: Duration,
    /// Requests from one address in a second.
    pub requests_per_second: NonZeroU32,
    /// Requests that are worked on at once, until their answer begins. Those that wait for the disk count, so that a
    /// low number would have readers wait for writers.
    pub requests_at_once: usize,
    /// How long a request waits for its turn.
    pub turn: Duration,
    /// Sessions of clients of 2025-11-25; a further one ends the one that was silent for longest.
    pub sessions: NonZeroUsize,
    /// How long a session may be silent.
    pub session_idle: Duration,
    /// How long requests that are under way may take when the server is told to end.
    pub shutdown: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        const SESSIONS: NonZeroUsize = NonZeroUsize::new(256).unwrap();
        const REQUESTS_PER_SECOND: NonZeroU32 = NonZeroU32::new(1000).unwrap();
        Self {
            connections: 512,
            head: Duration::from_secs(30),
            body: Duration::from_secs(30),
            body_bytes: MESSAGE_BYTES,
            bodies_bytes: 64 << 20,
            write: Duration::from_secs(30),
            requests_per_second: REQUESTS_PER_SECOND,
            requests_at_once: 256,
            turn: Duration::from_secs(10),
            sessions: SESSIONS,
            session_idle: Duration::from_secs(30 * 60),
            shutdown: Duration::from_secs(10),
        }
    }
}
