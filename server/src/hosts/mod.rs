//! The programs that can use the server, and the configuration files in which they look for it.
//!
//! [`place`] says where such a file is, [`edit`] changes its text and keeps everything else in it as it is, [`entry`]
//! is what is put there, and [`file`] reads and replaces the file itself.

pub(crate) mod edit;
pub(crate) mod entry;
pub(crate) mod file;
pub(crate) mod place;

use clap::ValueEnum;

/// A program that speaks MCP and finds its servers in a JSON file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Host {
    /// Claude Desktop
    ClaudeDesktop,
    /// Claude Code, for all projects of the user
    ClaudeCode,
    /// Cursor, for all projects of the user
    Cursor,
    /// Visual Studio Code, for the user's default profile
    #[value(name = "vscode")]
    VsCode,
}

/// Whether an entry says how its server is spoken to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Transport {
    /// `"type": "stdio"` stands in it.
    Named,
    /// A command is taken for a server on standard input and output.
    Implied,
}

impl Host {
    /// Every host.
    pub(crate) const ALL: [Self; 4] = [Self::ClaudeDesktop, Self::ClaudeCode, Self::Cursor, Self::VsCode];

    /// The name that its makers use.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::ClaudeDesktop => "Claude Desktop",
            Self::ClaudeCode => "Claude Code",
            Self::Cursor => "Cursor",
            Self::VsCode => "VS Code",
        }
    }

    /// The name on the command line.
    pub(crate) fn argument(self) -> &'static str {
        match self {
            Self::ClaudeDesktop => "claude-desktop",
            Self::ClaudeCode => "claude-code",
            Self::Cursor => "cursor",
            Self::VsCode => "vscode",
        }
    }

    /// The key under which the file holds its servers.
    pub(crate) fn servers_key(self) -> &'static str {
        match self {
            Self::VsCode => "servers",
            Self::ClaudeDesktop | Self::ClaudeCode | Self::Cursor => "mcpServers",
        }
    }

    /// Whether its entries name their transport.
    pub(crate) fn transport(self) -> Transport {
        match self {
            Self::ClaudeCode | Self::VsCode => Transport::Named,
            Self::ClaudeDesktop | Self::Cursor => Transport::Implied,
        }
    }

    /// What makes it read its file again.
    pub(crate) fn restart(self) -> &'static str {
        match self {
            Self::ClaudeDesktop => "Quit Claude Desktop completely and start it again",
            Self::ClaudeCode => "Start a new session of Claude Code",
            Self::Cursor => "Restart Cursor",
            Self::VsCode => "Run “MCP: List Servers” in VS Code and start the server",
        }
    }
}
