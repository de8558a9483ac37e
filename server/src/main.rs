//! `coin-server`: an MCP server over standard input and output, and the import of episodes.

use std::process::ExitCode;

fn main() -> ExitCode {
    coin_server::cli::run()
}
