//! The command line of `coin-server`: one file for each command.

mod doctor;
mod import;
mod install;
mod map;
mod observe;
mod serve;
mod split;
mod uninstall;

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use directories::ProjectDirs;

use crate::store::{Access, Store};

const EXAMPLES: &str = "\
Examples:
  coin-server import --episode fixtures/episodes/small-house --db home.db
  coin-server --db home.db                       # serve an MCP client on stdin and stdout
  coin-server --db home.db --read-only --tools get_usage_summary,list_objects
  coin-server --db home.db --http 127.0.0.1:8750 # serve many clients on this computer
  coin-server --db home.db --http 0.0.0.0:8750 --token-file token.txt    # and for other computers
  coin-server install claude-desktop             # or claude-code, cursor, vscode
  coin-server observe --file detections.jsonl --db home.db    # what a robot saw becomes things
  coin-server map --db home.db --html home.html  # the plan of the home: whose is what, and how sure
  coin-server doctor                             # what is wrong, if anything

Exit status: 0 done; 1 failed; 2 wrong use, a refused episode, or a database or address that cannot be opened.
Log messages go to stderr; RUST_LOG=debug shows more of them.";

/// Serve what a home knows about its things to an MCP client, over standard input and output or HTTP.
#[derive(Debug, Parser)]
#[command(name = "coin-server", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    serve: serve::Serve,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Import a recorded episode into a database, all of it or nothing
    Import(import::Import),
    /// Enter the server into the configuration of a program that speaks MCP
    Install(install::Install),
    /// Take the server out of the configuration of such a program
    Uninstall(uninstall::Uninstall),
    /// Put recorded detections on the map: each joins the thing that it is a sighting of, or becomes a new one
    Observe(observe::Observe),
    /// Undo a wrong join: take sightings out of a thing and make another thing of them
    Split(split::Split),
    /// Draw the plan of the home, or list it: rooms, things, whose they are and how sure that is; nothing is changed
    Map(map::Map),
    /// Say what is wrong with the database, its permissions and the programs that use it; nothing is changed
    Doctor(doctor::Doctor),
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
        Some(Command::Import(import)) => import::run(import).map(|()| Exit::Done),
        Some(Command::Install(install)) => install::run(install).map(|()| Exit::Done),
        Some(Command::Uninstall(uninstall)) => uninstall::run(uninstall).map(|()| Exit::Done),
        Some(Command::Observe(observe)) => observe::run(observe).map(|()| Exit::Done),
        Some(Command::Split(split)) => split::run(split).map(|()| Exit::Done),
        Some(Command::Map(map)) => map::run(map).map(|()| Exit::Done),
        Some(Command::Doctor(doctor)) => doctor::run(doctor),
        None => serve::run(&arguments.serve).map(|()| Exit::Done),
    };
    match outcome {
        Ok(exit) => exit.into(),
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

/// Puts the result of a command that speaks no protocol on stdout. A reader that has seen enough is no failure.
fn print(result: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(result.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(failed(error)),
        _ => Ok(()),
    }
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
