//! `install`, `uninstall` and `doctor`, as a person starts them.

#![expect(clippy::unwrap_used, reason = "a test stops at the first fault")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A user's home folder, in which every host keeps its files.
struct User {
    folder: TempDir,
}

impl User {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The database of `--db`, written as the program writes it.
    fn database(&self) -> String {
        self.path("home.db").to_str().unwrap().to_owned()
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let path = self.folder.path();
        Command::new(env!("CARGO_BIN_EXE_coin-server"))
            .args(arguments)
            .current_dir(path)
            .env("HOME", path)
            .env("USERPROFILE", path)
            .env("XDG_CONFIG_HOME", path.join(".config"))
            .env("XDG_DATA_HOME", path.join("data"))
            .env("APPDATA", path.join("appdata"))
            .env_remove("CLAUDE_CONFIG_DIR")
            .env_remove("RUST_LOG")
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    #[track_caller]
    fn succeeds(&self, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        output
    }

    /// Imports a home with one thing.
    fn import(&self) {
        let episode = self.path("episode");
        fs::create_dir(&episode).unwrap();
        let home = json!({
            "name": "one thing", "users": {"Bob": {}}, "captions": "captions.jsonl", "now": "2025-01-19T23:00:00",
            "objects": [{"id": "1", "class": "marker", "position": [0, 0, 0]}],
        });
        fs::write(episode.join("episode.json"), home.to_string()).unwrap();
        let caption = json!({"object_id": "1", "caption": "2025-01-19 19:00 Bob takes the Marker"});
        fs::write(episode.join("captions.jsonl"), caption.to_string()).unwrap();
        self.succeeds(&["import", "--episode", episode.to_str().unwrap(), "--db", &self.database()]);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn every_host_gets_an_entry_that_starts_this_program() {
    let user = User::new();
    let program = fs::canonicalize(env!("CARGO_BIN_EXE_coin-server")).unwrap();
    for (host, file, key, named) in [
        ("claude-desktop", ".config/Claude/claude_desktop_config.json", "mcpServers", false),
        ("claude-code", ".claude.json", "mcpServers", true),
        ("cursor", ".cursor/mcp.json", "mcpServers", false),
        ("vscode", ".config/Code/User/mcp.json", "servers", true),
    ] {
        if !cfg!(target_os = "linux") && file.starts_with(".config") {
            continue;
        }
        let output = user.succeeds(&["install", host, "--db", "home.db", "--tools", "core"]);
        let mut expected = json!({"command": program, "args": ["--db", user.database(), "--tools", "core"]});
        if named {
            expected["type"] = json!("stdio");
        }
        assert_eq!(read(&user.path(file))[key]["coin"], expected);
        let said = text(&output.stderr);
        assert!(said.contains("does not exist yet") && said.contains("whose is the marker"), "{said}");

        user.succeeds(&["uninstall", host]);
        assert!(!user.path(file).exists(), "a file that was made for the entry goes with it");
    }
}

#[test]
fn a_file_comes_back_as_it_was_and_a_copy_is_kept() {
    let user = User::new();
    let file = user.path(".claude.json");
    let before = "{\r\n    // mine\r\n    \"projects\": {},\r\n    \"mcpServers\": { }\r\n}";
    fs::write(&file, before).unwrap();
    let output = user.succeeds(&["install", "claude-code"]);
    assert!(text(&output.stderr).contains(".claude.json.before-coin"), "{}", text(&output.stderr));
    let made = fs::read_to_string(&file).unwrap();
    assert_ne!(made, before);
    assert_eq!(fs::read_to_string(user.path(".claude.json.before-coin")).unwrap(), before);

    let again = user.succeeds(&["install", "claude-code"]);
    assert!(text(&again.stderr).contains("nothing was changed"), "{}", text(&again.stderr));
    assert_eq!(fs::read_to_string(&file).unwrap(), made);

    user.succeeds(&["uninstall", "claude-code"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), before);
    let again = user.succeeds(&["uninstall", "claude-code"]);
    assert!(text(&again.stderr).contains("nothing was changed"), "{}", text(&again.stderr));
}

#[test]
fn print_shows_the_entry_and_writes_nothing() {
    let user = User::new();
    let output = user.succeeds(&["install", "cursor", "--print", "--name", "office"]);
    let shown = text(&output.stdout);
    let (path, entry) = shown.split_once('\n').unwrap();
    assert_eq!(Path::new(path), user.path(".cursor/mcp.json"));
    let entry: Value = serde_json::from_str(entry).unwrap();
    assert!(entry["mcpServers"]["office"]["command"].is_string(), "{entry}");
    assert_eq!(fs::read_dir(user.folder.path()).unwrap().count(), 0);
}

#[test]
fn a_file_that_is_no_json_or_holds_another_server_of_that_name_stays() {
    let user = User::new();
    let file = user.path(".claude.json");
    for (before, expected) in [
        ("{\n  \"mcpServers\": {]\n}", "line 2, column 18"),
        (r#"{"mcpServers": {"coin": {"command": "npx"}}}"#, "is not a coin-server"),
    ] {
        fs::write(&file, before).unwrap();
        for command in ["install", "uninstall"] {
            let output = user.run(&[command, "claude-code"]);
            assert_eq!(output.status.code(), Some(2));
            assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
            assert_eq!(fs::read_to_string(&file).unwrap(), before);
        }
        assert!(!user.path(".claude.json.before-coin").exists());
    }
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let user = User::new();
    let target = user.path("dotfiles.json");
    fs::write(&target, "{}").unwrap();
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&target, user.path(".claude.json")).unwrap();
    user.succeeds(&["install", "claude-code"]);
    assert!(user.path(".claude.json").is_symlink());
    assert!(read(&target)["mcpServers"]["coin"].is_object());
    for file in [&target, &user.path("dotfiles.json.before-coin")] {
        assert_eq!(fs::metadata(file).unwrap().permissions().mode() & 0o777, 0o640, "{}", file.display());
    }
}

#[test]
fn the_doctor_finds_a_healthy_home_and_leaves_no_trace() {
    let user = User::new();
    user.import();
    user.succeeds(&["install", "claude-code", "--db", &user.database()]);
    let names = || {
        let mut names: Vec<_> =
            fs::read_dir(user.folder.path()).unwrap().map(|file| file.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    let output = user.succeeds(&["doctor", "--db", &user.database(), "--json"]);
    let diagnosis: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(diagnosis["home"]["people"], json!(["Bob"]));
    assert_eq!((&diagnosis["home"]["things"], &diagnosis["home"]["events"]), (&json!(1), &json!(1)));
    let levels: Vec<_> =
        diagnosis["findings"].as_array().unwrap().iter().map(|finding| &finding["level"]).collect();
    assert!(levels.iter().all(|level| *level == "ok" || *level == "note"), "{diagnosis:#}");
    assert_eq!(names(), before);

    let shown = text(&user.succeeds(&["doctor", "--db", &user.database()]).stdout);
    let shown = shown.replace(user.folder.path().to_str().unwrap(), "~");
    if cfg!(target_os = "linux") {
        insta::assert_snapshot!(shown);
    }
}

#[test]
fn the_doctor_names_what_is_wrong_and_what_to_do() {
    let user = User::new();
    user.import();
    let entry = json!({"mcpServers": {"coin": {
        "command": user.path("gone/coin-server"),
        "args": ["--db", user.path("office.db"), "--tools=core"],
    }}});
    fs::write(user.path(".claude.json"), entry.to_string()).unwrap();
    fs::create_dir(user.path(".cursor")).unwrap();
    fs::write(user.path(".cursor/mcp.json"), "{").unwrap();
    fs::write(user.path("other.db"), "this is no database, and it is long enough to be looked at").unwrap();
    // What is advised keeps the entry's own database, and not the one that the doctor was asked about.
    let again = format!(
        "→ coin-server install claude-code --name \"coin\" --db {:?} --tools core",
        user.path("office.db")
    );
    let output = user.run(&["doctor", "--db", "other.db"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let shown = text(&output.stdout);
    for part in
        ["it is not a SQLite database", "which does not exist", &again, "is no valid JSON", "Problems 3"]
    {
        assert!(shown.contains(part), "{part:?} is missing:\n{shown}");
    }
}

#[cfg(unix)]
#[test]
fn the_doctor_warns_of_a_database_that_others_can_read() {
    use std::os::unix::fs::PermissionsExt;

    let user = User::new();
    user.import();
    fs::set_permissions(user.path("home.db"), fs::Permissions::from_mode(0o644)).unwrap();
    let shown = text(&user.succeeds(&["doctor", "--db", "home.db"]).stdout);
    assert!(shown.contains("mode 644") && shown.contains("chmod 600"), "{shown}");
}

#[test]
fn a_database_that_is_not_there_yet_is_a_warning() {
    let user = User::new();
    let shown = text(&user.succeeds(&["doctor"]).stdout);
    assert!(shown.contains("does not exist yet") && shown.contains("import --episode DIR"), "{shown}");
    assert!(!user.path("data").exists());
}
