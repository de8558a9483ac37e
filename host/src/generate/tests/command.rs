//! `host generate routine`: its arguments, its folders, what it refuses.

use clap::Parser;

use super::Protocol;
use crate::generate::{GenerateArguments, run};

/// The command line as the binary would have it.
#[derive(Debug, Parser)]
struct CommandLine {
    #[command(flatten)]
    arguments: GenerateArguments,
}

fn parse(words: &[&str]) -> Result<GenerateArguments, clap::Error> {
    CommandLine::try_parse_from(std::iter::once(&"routine").chain(words)).map(|line| line.arguments)
}

#[test]
fn one_home_goes_to_the_folder_and_several_to_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let (one, many) = (folder.path().join("one"), folder.path().join("many"));
    run(&parse(&["--protocol", "two-days", "--seed", "4", "--out", one.to_str().unwrap()]).unwrap()).unwrap();
    assert!(one.join("episode.json").is_file());

    let words = ["--protocol", "two-days", "--seed", "4", "--count", "3", "--out", many.to_str().unwrap()];
    run(&parse(&words).unwrap()).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(&many)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["two-days-4", "two-days-5", "two-days-6"]);
    for file in ["episode.json", "captions.jsonl", "embeddings.npy", "truth.json"] {
        let read = |folder: &std::path::Path| std::fs::read(folder.join(file)).unwrap();
        assert!(read(&one) == read(&many.join("two-days-4")), "{file}");
    }
}

#[test]
fn wrong_arguments_are_refused() {
    assert_eq!(parse(&["--out", "x"]).unwrap().protocol, Protocol::Week);
    let unknown = parse(&["--out", "x", "--protocol", "month"]).unwrap_err().to_string();
    assert!(unknown.contains("two-days") && unknown.contains("other-homes"), "{unknown}");
    parse(&["--out", "x", "--count", "0"]).unwrap_err();
    parse(&["--protocol", "week"]).unwrap_err();

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap().to_owned();
    let last = u64::MAX.to_string();
    let words = ["--protocol", "two-days", "--seed", &last, "--count", "2", "--out", &out];
    let error = run(&parse(&words).unwrap()).unwrap_err();
    assert!(error.to_string().contains("--seed"), "{error}");
}
