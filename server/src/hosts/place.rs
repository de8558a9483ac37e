//! Where a host's configuration file is. Platform and environment are data, so that every platform can be tested on
//! any other.

use std::ffi::OsString;
use std::path::PathBuf;

use thiserror::Error;

use super::Host;

/// A family of operating systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Platform {
    /// Linux and its relatives.
    Linux,
    /// macOS.
    MacOs,
    /// Windows.
    Windows,
}

impl Platform {
    /// The one that the program was built for.
    pub(crate) const fn present() -> Self {
        if cfg!(windows) {
            Self::Windows
        } else if cfg!(target_os = "macos") {
            Self::MacOs
        } else {
            Self::Linux
        }
    }
}

/// The folders that the user's environment names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Environment {
    /// `HOME`, or `USERPROFILE` on Windows.
    pub(crate) home: Option<OsString>,
    /// `XDG_CONFIG_HOME`, where Linux keeps configurations.
    pub(crate) xdg_config_home: Option<OsString>,
    /// `APPDATA`, where Windows keeps configurations.
    pub(crate) appdata: Option<OsString>,
    /// `CLAUDE_CONFIG_DIR`, where Claude Code keeps its own.
    pub(crate) claude_config_dir: Option<OsString>,
}

impl Environment {
    /// What the variables of this process say. An empty one counts as none.
    pub(crate) fn present(platform: Platform) -> Self {
        let folder = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        let home = match platform {
            Platform::Windows => folder("USERPROFILE"),
            Platform::Linux | Platform::MacOs => folder("HOME"),
        };
        Self {
            home,
            xdg_config_home: folder("XDG_CONFIG_HOME"),
            appdata: folder("APPDATA"),
            claude_config_dir: folder("CLAUDE_CONFIG_DIR"),
        }
    }
}

/// The environment does not name the folder that the file would be in.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{variable} is not set, so the place of the configuration is unknown; set it to your folder")]
pub(crate) struct Unplaced {
    variable: &'static str,
}

/// The configuration file of a host.
///
/// # Errors
/// If the environment does not name the folder.
pub(crate) fn configuration(
    host: Host,
    platform: Platform,
    environment: &Environment,
) -> Result<PathBuf, Unplaced> {
    let home = || match (&environment.home, platform) {
        (Some(home), _) => Ok(home.clone()),
        (None, Platform::Windows) => Err(Unplaced { variable: "USERPROFILE" }),
        (None, Platform::Linux | Platform::MacOs) => Err(Unplaced { variable: "HOME" }),
    };
    let below = |base: OsString, parts: &[&str]| Ok(join(platform, base, parts));
    match host {
        Host::ClaudeDesktop => {
            below(settings(platform, environment, home)?, &["Claude", "claude_desktop_config.json"])
        }
        Host::ClaudeCode => match &environment.claude_config_dir {
            Some(folder) => below(folder.clone(), &[".claude.json"]),
            None => below(home()?, &[".claude.json"]),
        },
        Host::Cursor => below(home()?, &[".cursor", "mcp.json"]),
        Host::VsCode => below(settings(platform, environment, home)?, &["Code", "User", "mcp.json"]),
    }
}

/// The folder in which programs keep a user's settings.
fn settings(
    platform: Platform,
    environment: &Environment,
    home: impl Fn() -> Result<OsString, Unplaced>,
) -> Result<OsString, Unplaced> {
    match platform {
        Platform::Windows => environment.appdata.clone().ok_or(Unplaced { variable: "APPDATA" }),
        Platform::MacOs => Ok(join(platform, home()?, &["Library", "Application Support"]).into()),
        Platform::Linux => match &environment.xdg_config_home {
            Some(folder) => Ok(folder.clone()),
            None => Ok(join(platform, home()?, &[".config"]).into()),
        },
    }
}

/// Joins with the platform's own separator, and not with that of the machine which runs this.
fn join(platform: Platform, base: OsString, parts: &[&str]) -> PathBuf {
    let separator = match platform {
        Platform::Windows => "\\",
        Platform::Linux | Platform::MacOs => "/",
    };
    let mut path = base;
    for part in parts {
        path.push(separator);
        path.push(part);
    }
    path.into()
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    fn ann(platform: Platform) -> Environment {
        let home = match platform {
            Platform::Linux => "/people/ann",
            Platform::MacOs => "/people/ann",
            Platform::Windows => r"D:\people\ann",
        };
        let appdata = (platform == Platform::Windows).then(|| r"D:\people\ann\AppData\Roaming".into());
        Environment { home: Some(home.into()), appdata, ..Environment::default() }
    }

    #[rstest]
    #[case(Host::ClaudeDesktop, Platform::Linux, "/people/ann/.config/Claude/claude_desktop_config.json")]
    #[case(
        Host::ClaudeDesktop,
        Platform::MacOs,
        "/people/ann/Library/Application Support/Claude/claude_desktop_config.json"
    )]
    #[case(
        Host::ClaudeDesktop,
        Platform::Windows,
        r"D:\people\ann\AppData\Roaming\Claude\claude_desktop_config.json"
    )]
    #[case(Host::ClaudeCode, Platform::Linux, "/people/ann/.claude.json")]
    #[case(Host::ClaudeCode, Platform::MacOs, "/people/ann/.claude.json")]
    #[case(Host::ClaudeCode, Platform::Windows, r"D:\people\ann\.claude.json")]
    #[case(Host::Cursor, Platform::Linux, "/people/ann/.cursor/mcp.json")]
    #[case(Host::Cursor, Platform::MacOs, "/people/ann/.cursor/mcp.json")]
    #[case(Host::Cursor, Platform::Windows, r"D:\people\ann\.cursor\mcp.json")]
    #[case(Host::VsCode, Platform::Linux, "/people/ann/.config/Code/User/mcp.json")]
    #[case(Host::VsCode, Platform::MacOs, "/people/ann/Library/Application Support/Code/User/mcp.json")]
    #[case(Host::VsCode, Platform::Windows, r"D:\people\ann\AppData\Roaming\Code\User\mcp.json")]
    fn every_host_has_its_file(#[case] host: Host, #[case] platform: Platform, #[case] expected: &str) {
        assert_eq!(configuration(host, platform, &ann(platform)), Ok(PathBuf::from(expected)));
    }

    #[test]
    fn the_environment_can_move_the_folders() {
        let environment = Environment {
            xdg_config_home: Some("/settings".into()),
            claude_config_dir: Some("/claude".into()),
            ..ann(Platform::Linux)
        };
        let place = |host| configuration(host, Platform::Linux, &environment).unwrap();
        assert_eq!(place(Host::VsCode), PathBuf::from("/settings/Code/User/mcp.json"));
        assert_eq!(place(Host::ClaudeCode), PathBuf::from("/claude/.claude.json"));
        assert_eq!(place(Host::Cursor), PathBuf::from("/people/ann/.cursor/mcp.json"));
    }

    #[rstest]
    #[case(Host::Cursor, Platform::Linux, "HOME")]
    #[case(Host::Cursor, Platform::Windows, "USERPROFILE")]
    #[case(Host::VsCode, Platform::Windows, "APPDATA")]
    fn a_missing_folder_is_named(
        #[case] host: Host,
        #[case] platform: Platform,
        #[case] variable: &'static str,
    ) {
        assert_eq!(configuration(host, platform, &Environment::default()), Err(Unplaced { variable }));
    }
}
