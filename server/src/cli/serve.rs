//! `coin-server` without a command: serving a home.

use std::env;
use std::net::{IpAddr, SocketAddr};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

use axum::http::uri::Authority;
use clap::Args;
use tokio::runtime;
use tokio_util::sync::CancellationToken;

use super::{Failure, failed, open, refused, say};
use crate::service::{CoinService, ServiceOptions, service};
use crate::store::Access;
use crate::tools::ToolSelection;
use crate::transport::http::{self, HttpOptions, Limits, Token};
use crate::transport::{stdio, until_told_to_end};

/// Holds the token where no file does.
const TOKEN_VARIABLE: &str = "COIN_TOKEN";

#[derive(Debug, Args)]
pub(super) struct Serve {
    /// The home's database; it is created where it is missing [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// Offer only the tools that look, and write nothing to the database
    #[arg(long)]
    read_only: bool,
    /// The tools to offer: all, core (the paper's four, for a program with an ownership loop of its own), or names
    #[arg(long, value_name = "all|core|NAME,…", default_value = "all")]
    tools: ToolSelection,
    /// Serve many clients over HTTP at /mcp, such as 127.0.0.1:8750; port 0 takes a free one, and stderr names it
    #[arg(long, value_name = "ADDRESS:PORT", value_parser = address)]
    http: Option<SocketAddr>,
    #[command(flatten)]
    network: Network,
}

/// What only matters with `--http`.
#[derive(Debug, Args)]
struct Network {
    /// A file whose first line is the token that clients must show; without it, COIN_TOKEN holds the token. Where
    /// other computers can connect, there must be one
    #[arg(long, value_name = "FILE", requires = "http")]
    token_file: Option<PathBuf>,
    /// A further name by which clients call this server, such as the computer's name; may be repeated
    #[arg(long, value_name = "NAME", requires = "http", value_parser = host)]
    allow_host: Vec<String>,
    /// How many requests one address may send in a second
    #[arg(long, value_name = "N", requires = "http", default_value_t = Limits::default().requests_per_second)]
    requests_per_second: NonZeroU32,
}

fn address(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_| {
        "an address is such as 127.0.0.1:8750 (for this computer alone) or 0.0.0.0:8750 (for others too, with a token)"
            .to_owned()
    })
}

fn host(text: &str) -> Result<String, String> {
    let names_no_more = match text.parse::<Authority>() {
        Ok(authority) => authority.host() == text,
        Err(_) => false,
    };
    match names_no_more || text.parse::<IpAddr>().is_ok() {
        true => Ok(text.to_owned()),
        false => Err("name the host alone, without a scheme, a port or a path, such as home.lan".to_owned()),
    }
}

pub(super) fn run(serve: &Serve) -> Result<(), Failure> {
    let access = if serve.read_only { Access::ReadOnly } else { Access::ReadWrite };
    let store = open(serve.db.as_deref(), access)?;
    let options = ServiceOptions { tools: serve.tools.clone() };
    let service = service(Arc::new(store), options);
    let runtime = runtime::Builder::new_multi_thread().enable_all().build().map_err(failed)?;
    runtime.block_on(async {
        match serve.http {
            Some(address) => serve_http(service, address, &serve.network).await,
            None => stdio::serve(service).await.map_err(failed),
        }
    })
}

async fn serve_http(service: CoinService, address: SocketAddr, network: &Network) -> Result<(), Failure> {
    let mut options = HttpOptions::new(address);
    options.token = token(network)?;
    options.allowed_hosts.clone_from(&network.allow_host);
    options.limits.requests_per_second = network.requests_per_second;
    let server = http::bind(options).await.map_err(refused)?;
    let shutdown = CancellationToken::new();
    let told_to_end = until_told_to_end().map_err(failed)?;
    say(&format!("coin-server: serving MCP at {}", server.url()));
    let when_told = shutdown.clone();
    tokio::spawn(async move {
        told_to_end.await;
        when_told.cancel();
    });
    server.serve(service, shutdown).await;
    Ok(())
}

/// The token that clients must show, if there is to be one. It is never an argument: others can read those.
fn token(network: &Network) -> Result<Option<Token>, Failure> {
    if let Some(file) = &network.token_file {
        return Token::from_file(file).map(Some).map_err(refused);
    }
    let Some(value) = env::var_os(TOKEN_VARIABLE) else { return Ok(None) };
    let token = Token::new(&value.to_string_lossy());
    token.map(Some).map_err(|source| refused(format!("{TOKEN_VARIABLE}: {source}")))
}
