//! `coin-server`: an MCP server over standard input and output, and the import of episodes.

use std::process::ExitCode;

use mimalloc::MiMalloc;

#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    coin_server::cli::run()
}
