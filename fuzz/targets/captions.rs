//! Any text as a caption: nothing makes the reader panic, and what it says obeys laws.

#![no_main]

use std::sync::LazyLock;

use coin::captions::{Action, CaptionError, CaptionReader, Observation};
use coin::roster::Roster;
use coin_schemas::household::{Background, UserName, Users};
use coin_schemas::tools::MAX_TEXT_BYTES;
use libfuzzer_sys::fuzz_target;

/// A household in both orders of its members.
static READERS: LazyLock<[(Roster, CaptionReader); 2]> = LazyLock::new(|| {
    let mut members = [("Bob", "father"), ("Mary", "mother"), ("Zoé", "daughter"), ("Tom", "son")];
    let forward = reader(&members);
    members.reverse();
    [forward, reader(&members)]
});

fn reader(members: &[(&str, &str)]) -> (Roster, CaptionReader) {
    let mut users = Users::default();
    for (name, role) in members {
        let background = Background { role: Some((*role).to_owned()), occupation: None };
        users.insert(UserName::new(*name).expect("it is a name"), background);
    }
    let roster = Roster::new(&users).expect("it is a household");
    let reader = CaptionReader::new(&roster);
    (roster, reader)
}

/// What is read of a line, with the name of who is meant.
fn read(line: &str) -> Result<(Option<String>, Observation), CaptionError> {
    let [mut one, other] = READERS.each_ref().map(|(roster, reader)| {
        let observation = reader.read(line)?;
        let actor = observation.actor.map(|user| roster.name(user).to_string());
        Ok((actor, observation))
    });
    if let (Ok((actor, observation)), Ok((same_actor, same))) = (&mut one, &other) {
        assert_eq!(actor, same_actor, "the order of the members decides who is meant: {line:?}");
        assert_eq!((observation.at, observation.action), (same.at, same.action));
    } else {
        assert_eq!(one.as_ref().err(), other.as_ref().err());
    }
    one
}

fuzz_target!(|line: &str| {
    match read(line) {
        Ok(seen) => {
            assert!(line.trim_matches(' ').len() <= MAX_TEXT_BYTES);
            assert!(!line.chars().any(char::is_control), "a caption is one line: {line:?}");
            assert_eq!(Action::from_code(seen.1.action.code()), Some(seen.1.action));
            assert_eq!(read(&format!("  {line} ")), Ok(seen), "spaces around a line matter: {line:?}");
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.len() < 1_000, "an error repeats all that it was given: {message}");
            assert!(!message.chars().any(char::is_control), "an error is one line: {message:?}");
        }
    }
    let plain = line.trim_matches(' ');
    if !plain.is_empty() && plain.len() < MAX_TEXT_BYTES - 100 && !plain.chars().any(char::is_control) {
        let (_, seen) =
            read(&format!("2025-01-19 19:00 {plain}")).expect("plain text after a time is a caption");
        assert_eq!(seen.at.to_string(), "2025-01-19T19:00:00");
    }
});
