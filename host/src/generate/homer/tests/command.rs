//! `host generate homer`: its arguments, its folders, its help.

use clap::{CommandFactory, Parser};

use super::made_up;
use crate::generate::{HomerArguments, Protocol, run_homer};

/// The command line as the binary would have it.
#[derive(Debug, Parser)]
struct CommandLine {
    #[command(flatten)]
    arguments: HomerArguments,
}

fn parse(words: &[&str]) -> Result<HomerArguments, clap::Error> {
    CommandLine::try_parse_from(std::iter::once(&"homer").chain(words)).map(|line| line.arguments)
}

#[test]
fn several_homes_go_to_folders_that_are_named_as_they_are() {
    let (data, folder) = (made_up::folder(), tempfile::tempdir().unwrap());
    let (data, out) = (data.path().to_str().unwrap(), folder.path().join("homes"));
    let words = ["--data", data, "--protocol", "week", "--seed", "4", "--count", "2", "--out"];
    run_homer(&parse(&[&words[..], &[out.to_str().unwrap()]].concat()).unwrap()).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["homer-week-4", "homer-week-5"]);
}

#[test]
fn the_help_lists_every_protocol_that_is_not_refused_and_claims_nothing_exact() {
    let help = CommandLine::command().render_long_help().to_string();
    for protocol in Protocol::ALL {
        let listed = help.contains(&format!("- {}:", protocol.name()));
        assert_eq!(listed, protocol != Protocol::Office, "{}: {help}", protocol.name());
    }
    assert!(!help.contains("exactly"), "{help}");
    assert!(help.contains("homer-week-7"), "{help}");
}

#[test]
fn an_office_is_sent_where_there_is_one() {
    let (data, out) = (made_up::folder(), tempfile::tempdir().unwrap());
    let (data, out) = (data.path().to_str().unwrap(), out.path().to_str().unwrap());
    let arguments = parse(&["--data", data, "--out", out, "--protocol", "office"]).unwrap();
    let error = run_homer(&arguments).unwrap_err().to_string();
    assert!(error.contains("host generate routine --protocol office"), "{error}");

    assert_eq!(parse(&["--data", data, "--out", out]).unwrap().protocol, Protocol::Week);
    let unknown = parse(&["--data", data, "--out", out, "--protocol", "month"]).unwrap_err().to_string();
    assert!(unknown.contains("two-days") && !unknown.contains("office"), "{unknown}");
    parse(&["--out", out]).unwrap_err();
}
