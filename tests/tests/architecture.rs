//! The map of the house is true: `ARCHITECTURE.md`, the README and the invariants that can be seen in the files.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use coin_tests::{Program, repository};

fn read(path: &str) -> String {
    fs::read_to_string(repository().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Every file that belongs to the project, by its path from the root.
fn project_files() -> Vec<String> {
    let listed = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard", "-z"])
        .current_dir(repository())
        .output();
    let names: Vec<String> = match listed {
        Ok(output) if output.status.success() => String::from_utf8(output.stdout)
            .unwrap()
            .split('\0')
            .filter(|name| !name.is_empty() && repository().join(name).is_file())
            .map(str::to_owned)
            .collect(),
        // An unpacked archive is no repository; then everything but build results belongs to it.
        _ => walk(repository()),
    };
    assert!(names.len() > 50, "only {} files were found", names.len());
    names
}

fn walk(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path: PathBuf = entry.unwrap().path();
            let name = path.strip_prefix(repository()).unwrap().to_str().unwrap().to_owned();
            if path.is_dir() && name != "target" && name != ".git" {
                folders.push(path);
            } else if path.is_file() {
                found.push(name);
            }
        }
    }
    found
}

fn rust_files() -> Vec<String> {
    project_files().into_iter().filter(|name| name.ends_with(".rs")).collect()
}

/// What stands between backticks, outside of fenced blocks.
fn quoted(markdown: &str) -> Vec<String> {
    let mut fenced = false;
    let mut found = Vec::new();
    for line in markdown.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            found.extend(line.split('`').skip(1).step_by(2).map(str::to_owned));
        }
    }
    assert!(!found.is_empty());
    found
}

/// The folders of the workspace's crates and their names.
fn crates() -> Vec<(String, String)> {
    let workspace = read("Cargo.toml");
    let members = workspace.lines().find(|line| line.starts_with("members")).unwrap();
    members
        .split('"')
        .skip(1)
        .step_by(2)
        .map(|folder| {
            let manifest = read(&format!("{folder}/Cargo.toml"));
            let name = manifest.lines().find_map(|line| line.strip_prefix("name = ")).unwrap();
            (folder.to_owned(), name.trim_matches('"').to_owned())
        })
        .collect()
}

#[test]
fn every_path_on_the_map_exists() {
    for document in ["ARCHITECTURE.md", "CONTRIBUTING.md", "fixtures/README.md"] {
        for name in quoted(&read(document)) {
            let is_path = name.contains('/')
                && !name.contains([' ', '*', '(', '<', '$', '…', ':'])
                && !name.starts_with("tools/")
                && !name.starts_with('/');
            if is_path {
                let beside = repository().join(document).parent().unwrap().join(&name);
                assert!(
                    repository().join(&name).exists() || beside.exists(),
                    "{document} names {name}, which is not there"
                );
            }
        }
    }
}

#[test]
fn every_room_of_a_crate_is_on_the_map() {
    let map = quoted(&read("ARCHITECTURE.md"));
    for (folder, name) in crates() {
        assert!(map.contains(&name), "the map does not name the crate {name}");
        assert!(map.contains(&format!("{folder}/")), "the map does not name the folder {folder}/");
    }
    // Every module of the method has a line of its own, or stands in the folder of one that has.
    let modules = rust_files().into_iter().filter(|name| {
        name.starts_with("coin/src/") && name.matches('/').count() == 2 && !name.ends_with("lib.rs")
    });
    for module in modules {
        let known = map.iter().any(|room| *room == module || module == format!("{room}.rs"));
        let explained = ["coin/src/owners.rs", "coin/src/roster.rs"].contains(&module.as_str());
        assert!(known || explained, "{module} is in no room of the map");
    }
}

#[test]
fn no_rust_file_has_more_than_five_hundred_lines() {
    let long: Vec<(String, usize)> = rust_files()
        .into_iter()
        .map(|name| {
            let lines = read(&name).lines().count();
            (name, lines)
        })
        .filter(|(_, lines)| *lines > 500)
        .collect();
    assert!(long.is_empty(), "split these by concept: {long:?}");
}

#[test]
fn sql_stands_only_under_the_store() {
    let words = ["SELECT ", "INSERT INTO", "UPDATE ", "DELETE FROM", "CREATE TABLE", "PRAGMA ", "DROP TABLE"];
    let is_exempt = |name: &str| {
        name.starts_with("server/src/store/") || name.starts_with("tests/") || name.contains("/tests")
    };
    for name in rust_files().into_iter().filter(|name| !is_exempt(name)) {
        let text = read(&name);
        let product = text.split("#[cfg(test)]").next().unwrap();
        for word in words {
            assert!(!product.contains(word), "{name} holds {word:?}");
        }
    }
    for (folder, crate_name) in crates() {
        let manifest = read(&format!("{folder}/Cargo.toml"));
        let may_use = ["coin-server", "coin-tests"].contains(&crate_name.as_str());
        assert!(may_use || !manifest.contains("rusqlite"), "{crate_name} depends on rusqlite");
    }
}

#[test]
fn the_method_has_no_input_output_clock_or_chance() {
    let forbidden = [
        "std::fs",
        "std::io",
        "std::net",
        "std::env",
        "std::process",
        "std::thread",
        "SystemTime",
        "Instant",
        "Zoned::now",
        "Timestamp::now",
        "tokio",
        "async ",
        ".await",
        // Chance may be handed in as a generator; nothing may make one.
        "rand::rng",
        "rand::random",
        "SysRng",
        "OsRng",
        "SeedableRng",
    ];
    let is_test =
        |name: &str| name.contains("tests") || name.contains("laws") || name.contains("test_support");
    let files = rust_files().into_iter().filter(|name| name.starts_with("coin/src/") && !is_test(name));
    let mut looked_at = 0;
    for name in files {
        let text = read(&name);
        let product: String = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap()
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .collect::<Vec<_>>()
            .join("\n");
        for word in forbidden {
            assert!(!product.contains(word), "{name} holds {word:?}");
        }
        looked_at += 1;
    }
    assert!(looked_at > 15, "only {looked_at} files were looked at");
}

#[test]
fn each_floor_knows_only_the_floors_below_it() {
    let floors = ["coin-schemas", "coin", "coin-server", "coin-host", "coin-tests"];
    let found: BTreeSet<String> = crates().into_iter().map(|(_, name)| name).collect();
    assert_eq!(found, floors.iter().map(|name| (*name).to_owned()).collect());
    for (folder, name) in crates() {
        let floor = floors.iter().position(|other| *other == name).unwrap();
        let manifest = read(&format!("{folder}/Cargo.toml"));
        for line in manifest.lines() {
            let dependency = line.split(['.', ' ', '=']).next().unwrap();
            if let Some(other) = floors.iter().position(|floor| *floor == dependency) {
                assert!(other < floor, "{name} depends on {dependency}");
            }
        }
    }
}

#[test]
fn the_truth_is_loaded_only_where_a_person_is_simulated_and_a_run_is_judged() {
    let users: BTreeSet<String> = rust_files()
        .into_iter()
        .filter(|name| !name.starts_with("tests/") && !name.contains("tests"))
        .filter(|name| read(name).contains("load_truth"))
        .collect();
    let allowed = [
        "host/src/calibrate.rs",
        "host/src/experiment/mod.rs",
        "host/src/run.rs",
        "server/src/episode/mod.rs",
        "server/src/episode/truth.rs",
    ];
    for name in &users {
        assert!(allowed.contains(&name.as_str()), "{name} loads the truth");
    }
    assert!(users.contains("host/src/run.rs"), "the law looks for the wrong name");
}

#[test]
fn no_file_names_a_place_on_somebodys_machine() {
    let telling = ["/home/", "/Users/", "/root/", "/work/", "C:\\Users"].map(str::to_owned);
    for name in project_files() {
        let Ok(text) = fs::read_to_string(repository().join(&name)) else { continue };
        if name == "tests/tests/architecture.rs" {
            continue;
        }
        for place in &telling {
            assert!(!text.contains(place.as_str()), "{name} names {place}");
        }
    }
}

/// The lines of the fenced blocks of a document that call one of our programs.
fn commands(document: &str) -> Vec<String> {
    let text = read(document);
    let blocks = text.split("```").skip(1).step_by(2);
    let starts =
        ["host ", "coin-server ", "./target/release/coin-server ", "cargo run --release --bin host -- "];
    blocks
        .flat_map(str::lines)
        .map(str::trim)
        .filter_map(|line| starts.iter().find_map(|start| line.strip_prefix(start).map(|rest| (start, rest))))
        .map(|(start, rest)| {
            let program = if start.contains("server") { "coin-server" } else { "host" };
            format!("{program} {}", rest.split(" #").next().unwrap().trim())
        })
        .collect()
}

#[test]
fn every_flag_that_the_readme_shows_is_one() {
    let help = |program: &str, words: &[&str]| {
        Program::new(program).args(words).arg("--help").run().expect_code(0).stdout
    };
    let commands = commands("README.md");
    assert!(commands.len() >= 5, "the README shows {commands:?}");
    for command in commands {
        let mut words = command.split_whitespace();
        let program = words.next().unwrap();
        let subcommands: Vec<&str> = command
            .split_whitespace()
            .skip(1)
            .take_while(|word| word.chars().all(char::is_alphanumeric))
            .collect();
        let help = help(program, &subcommands);
        for flag in words.filter(|word| word.starts_with("--")) {
            assert!(help.contains(flag), "{command:?}: {flag} is no flag of {program} {subcommands:?}");
        }
    }
}

#[test]
fn the_readme_promises_its_two_commands_and_names_only_files_that_are_there() {
    let readme = read("README.md");
    assert!(readme.contains("cargo run --release --bin host -- --episode fixtures/episodes/small-house"));
    assert!(readme.contains("cargo test --workspace"));
    for link in readme.split("](").skip(1) {
        let target = link.split(')').next().unwrap();
        if !target.contains("://") {
            assert!(repository().join(target).exists(), "the README links to {target}, which is not there");
        }
    }
    for name in quoted(&readme) {
        if name.starts_with("fixtures/") && !name.contains(' ') {
            assert!(repository().join(&name).exists(), "the README names {name}, which is not there");
        }
    }
}
