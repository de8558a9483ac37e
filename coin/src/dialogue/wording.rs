//! How people are listed in a sentence.

use crate::owners::OwnerSet;
use crate::roster::Roster;

/// The word before the last name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Joined {
    /// They are meant together.
    And,
    /// One of them is meant.
    Or,
}

/// "Bob", "Bob and Mary", "Bob, Mary and Tom".
pub(crate) fn list(roster: &Roster, set: OwnerSet, joined: Joined) -> String {
    join(&set.iter().map(|user| roster.name(user).to_string()).collect::<Vec<_>>(), joined)
}

/// The parts with commas between them, and a word before the last one.
pub(crate) fn join(parts: &[String], joined: Joined) -> String {
    let word = match joined {
        Joined::And => "and",
        Joined::Or => "or",
    };
    match parts {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} {word} {last}", most.join(", ")),
    }
}
