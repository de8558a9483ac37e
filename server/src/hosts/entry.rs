//! What stands in a host's configuration about this server.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::Transport;

/// How a host starts the server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Entry {
    /// The program.
    pub(crate) command: String,
    /// Its arguments.
    pub(crate) args: Vec<String>,
}

impl Entry {
    /// Reads what a host's configuration holds under a server's name. `None` if it starts another program than
    /// `coin-server`, or none at all.
    pub(crate) fn ours(value: &Value) -> Option<Self> {
        let command = value.get("command")?.as_str()?.to_owned();
        if program_name(&command) != "coin-server" {
            return None;
        }
        let args = value.get("args").and_then(Value::as_array).into_iter().flatten();
        let args = args.filter_map(Value::as_str).map(str::to_owned).collect();
        Some(Self { command, args })
    }

    /// The keys of the entry, in the order in which hosts write them.
    pub(crate) fn keys(&self, transport: Transport) -> Map<String, Value> {
        let mut keys = Map::new();
        if transport == Transport::Named {
            keys.insert("type".to_owned(), json!("stdio"));
        }
        keys.insert("command".to_owned(), json!(self.command));
        keys.insert("args".to_owned(), json!(self.args));
        keys
    }

    /// The program as a path.
    pub(crate) fn program(&self) -> &Path {
        Path::new(&self.command)
    }

    /// The database that it names; `None` stands for the default one.
    pub(crate) fn database(&self) -> Option<PathBuf> {
        self.value_of("--db").map(PathBuf::from)
    }

    /// The tools that it selects; `None` stands for all.
    pub(crate) fn tools(&self) -> Option<&str> {
        self.value_of("--tools")
    }

    fn value_of(&self, option: &str) -> Option<&str> {
        let mut args = self.args.iter();
        while let Some(argument) = args.next() {
            if argument == option {
                return args.next().map(String::as_str);
            }
            if let Some(value) = argument.strip_prefix(option).and_then(|rest| rest.strip_prefix('=')) {
                return Some(value);
            }
        }
        None
    }
}

/// The last part of a path of any platform, without the ending of a Windows program.
fn program_name(command: &str) -> &str {
    let name = command.rsplit(['/', '\\']).next().unwrap_or(command);
    name.strip_suffix(".exe").unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case(json!({"command": "/opt/coin-server"}), true)]
    #[case(json!({"command": r"C:\coin\coin-server.exe"}), true)]
    #[case(json!({"command": "coin-server", "args": ["--db", "x"]}), true)]
    #[case(json!({"command": "/opt/not-coin-server"}), false)]
    #[case(json!({"command": "npx", "args": ["coin-server"]}), false)]
    #[case(json!({"url": "http://127.0.0.1/coin-server"}), false)]
    #[case(json!("coin-server"), false)]
    fn an_entry_is_ours_by_its_program(#[case] value: Value, #[case] ours: bool) {
        assert_eq!(Entry::ours(&value).is_some(), ours);
    }

    #[rstest]
    #[case(&["--db", "/a.db"], Some("/a.db"))]
    #[case(&["--read-only", "--db=/a.db"], Some("/a.db"))]
    #[case(&["--db"], None)]
    #[case(&[], None)]
    fn the_database_is_read_from_the_arguments(#[case] args: &[&str], #[case] expected: Option<&str>) {
        let entry =
            Entry { command: "coin-server".to_owned(), args: args.iter().map(ToString::to_string).collect() };
        assert_eq!(entry.database(), expected.map(PathBuf::from));
    }
}
