//! The command line of `coin-server`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::{Args, Parser, Subcommand};
use directories::ProjectDirs;
use rmcp::ServiceExt;
use rmcp::service::ServerInitializeError;
use rmcp::transport::io::stdio_pipes;

use crate::episode;
use crate::service::{CoinService, ServiceOptions, service};
use crate::store::{Access, Store};
use crate::tools::ToolSelection;

const EXAMPLES: &str = "\
Examples:
  coin-server import --episode fixtures/episodes/small-house --db home.db
  coin-server --db home.db                       # serve an MCP client on stdin and stdout
  coin-server --db home.db --read-only --tools get_usage_summary,list_objects

Exit status: 0 done; 1 failed; 2 wrong use, a refused episode, or a database that cannot be opened.
Log messages go to stderr; RUST_LOG=debug shows more of them.";

/// Serve what a home knows about its things to an MCP client, over standard input and output.
#[derive(Debug, Parser)]
#[command(name = "coin-server", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    serve: Serve,
}

#[derive(Debug, Args)]
struct Serve {
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

#[derive(Debug, Subcommand)]
enum Command {
    /// Import a recorded episode into a database, all of it or nothing
    Import(Import),
}

#[derive(Debug, Args)]
struct Import {
    /// The episode's folder: it holds an episode.json
    #[arg(long, value_name = "DIR")]
    episode: PathBuf,
    /// The database; it is created where it is missing [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
}

/// How the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    /// Everything was done.
    Done = 0,
    /// Something failed that was rightly asked for.
    Failed = 1,
    /// It was used wrongly, or a file that it was given is refused.
    Refused = 2,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// A message for the person at the terminal, and how the program ends.
struct Failure {
    exit: Exit,
    message: String,
}

#[expect(clippy::needless_pass_by_value, reason = "it is handed to map_err")]
fn refused(source: impl ToString) -> Failure {
    Failure { exit: Exit::Refused, message: source.to_string() }
}

#[expect(clippy::needless_pass_by_value, reason = "it is handed to map_err")]
fn failed(source: impl ToString) -> Failure {
    Failure { exit: Exit::Failed, message: source.to_string() }
}

/// Runs the program. The one place that writes to stderr directly.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    start_log();
    let outcome = match &arguments.command {
        Some(Command::Import(import)) => run_import(import),
        None => run_server(&arguments.serve),
    };
    match outcome {
        Ok(()) => Exit::Done.into(),
        Err(Failure { exit, message }) => {
            say(&format!("coin-server: {message}"));
            exit.into()
        }
    }
}

/// stdout belongs to the protocol, so everything for people goes to stderr.
#[expect(clippy::print_stderr, reason = "messages for the person at the terminal")]
fn say(message: &str) {
    eprintln!("{message}");
}

fn start_log() {
    let filter = tracing_subscriber::EnvFilter::try_from_default_env()
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("warn"));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()))
        .init();
}

/// The database that is used where none is named: in the folder that the platform has for a user's data, and
/// never in the folder that a client happened to start the server in.
fn default_database() -> Result<PathBuf, Failure> {
    let folders = ProjectDirs::from("", "", "coin")
        .ok_or_else(|| refused("there is no home folder to keep the database in; name a file with --db"))?;
    Ok(folders.data_dir().join("home.db"))
}

fn open(database: Option<&Path>, access: Access) -> Result<Store, Failure> {
    let path = match database {
        Some(path) => path.to_owned(),
        None => default_database()?,
    };
    Store::open(&path, access).map_err(refused)
}

fn run_import(import: &Import) -> Result<(), Failure> {
    let loaded = episode::load(&import.episode).map_err(refused)?;
    let store = open(import.db.as_deref(), Access::ReadWrite)?;
    let summary = store.import(&loaded).map_err(|source| match source {
        other_home @ crate::store::StoreError::OtherHome { .. } => refused(other_home),
        other => failed(other),
    })?;
    say(&format!(
        "Imported {:?}: users {}, objects {}, captions {} new ({} without a known person) and {} already there.",
        loaded.episode.name,
        summary.users,
        summary.objects,
        summary.usage.recorded,
        summary.usage.unattributed,
        summary.usage.duplicates,
    ));
    Ok(())
}

fn run_server(serve: &Serve) -> Result<(), Failure> {
    let access = if serve.read_only { Access::ReadOnly } else { Access::ReadWrite };
    let store = open(serve.db.as_deref(), access)?;
    let options = ServiceOptions { tools: serve.tools.clone() };
    let service = service(Arc::new(store), options);
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(failed)?;
    runtime.block_on(serve_standard_streams(service))
}

/// Serves until the client closes its end; answers that are under way are still sent.
async fn serve_standard_streams(service: CoinService) -> Result<(), Failure> {
    match service.serve(stdio_pipes()).await {
        Ok(running) => running.waiting().await.map(drop).map_err(failed),
        // A client that only looks whether the program starts says nothing and leaves.
        Err(ServerInitializeError::ConnectionClosed(_)) => Ok(()),
        Err(source) => Err(failed(source)),
    }
}
