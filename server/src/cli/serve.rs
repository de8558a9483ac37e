//! `coin-server` without a command: serving a home.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use super::{Failure, failed, open};
use crate::service::{ServiceOptions, service};
use crate::store::Access;
use crate::tools::ToolSelection;
use crate::transport::stdio;

#[derive(Debug, Args)]
pub(super) struct Serve {
    /// The home's database; it is created where it is missing [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// Offer only the tools that look, and write nothing to the database
    #[arg(long)]
    read_only: bool,
    /// The tools to offer: all, core (those that a program with an ownership loop of its own needs), or names
    #[arg(long, value_name = "all|core|NAME,…", default_value = "all")]
    tools: ToolSelection,
}

pub(super) fn run(serve: &Serve) -> Result<(), Failure> {
    let access = if serve.read_only { Access::ReadOnly } else { Access::ReadWrite };
    let store = open(serve.db.as_deref(), access)?;
    let options = ServiceOptions { tools: serve.tools.clone() };
    let service = service(Arc::new(store), options);
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(failed)?;
    runtime.block_on(stdio::serve(service)).map_err(failed)
}
