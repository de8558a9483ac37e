//! The calibrations that the programs carry.

use std::collections::BTreeSet;
use std::fs;

use coin_tests::{Program, fixture, is_slow_run, repository};
use serde_json::Value;

/// The commands of `fixtures/README.md` that make the built-in calibrations, as words.
fn commands_of_the_built_in_calibrations() -> Vec<Vec<String>> {
    let readme = fs::read_to_string(fixture("README.md")).unwrap();
    let (_, section) = readme.split_once("## The built-in calibrations").expect("the README has the section");
    let block = section.split("```").nth(1).expect("the section has a block of commands");
    block.lines().filter(|line| !line.is_empty()).map(words).collect()
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

#[test]
fn the_built_in_calibrations_are_what_their_commands_make() {
    if !is_slow_run("the built-in calibrations") {
        return;
    }
    let commands = commands_of_the_built_in_calibrations();
    let folder = tempfile::tempdir().unwrap();
    let mut made = BTreeSet::new();
    for command in commands {
        assert_eq!(command[0], "host");
        let mut program = Program::new("host");
        for word in &command[1..] {
            // Folders are named in capitals.
            let is_folder =
                |name: &str| !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_uppercase());
            program = match (word.strip_suffix("/*"), word.strip_prefix("fixtures/calibrations/")) {
                // What a shell makes of the star.
                (Some(homes), _) => {
                    let homes = fs::read_dir(folder.path().join(homes)).unwrap();
                    let mut found: Vec<_> = homes.map(|entry| entry.unwrap().path()).collect();
                    found.sort();
                    program.args(found)
                }
                (None, Some(name)) => {
                    made.insert(name.to_owned());
                    program.arg(folder.path().join(name))
                }
                (None, None) if is_folder(word) => program.arg(folder.path().join(word)),
                (None, None) => program.arg(word),
            };
        }
        program.run().expect_code(0);
    }
    let committed = repository().join("fixtures/calibrations");
    let names: BTreeSet<String> = fs::read_dir(&committed)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(made, names);
    for name in &names {
        let [made, committed] = [folder.path(), committed.as_path()]
            .map(|at| serde_json::from_slice::<Value>(&fs::read(at.join(name)).unwrap()).unwrap());
        assert_eq!(made, committed, "{name}");
    }
}
