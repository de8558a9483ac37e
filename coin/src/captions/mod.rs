//! From one caption line to who did what when (the paper's usage history, Section 4).
//!
//! A caption comes from a camera: it is data, it may be wrong, and it never steers anything. A line whose time
//! cannot be read is refused with the reason; every other line gives an [`Observation`]. Where the actor cannot
//! be told for sure there is none: the event is kept and counted, never guessed.
//!
//! Decisions where everyday language is open:
//! * "Bob and Mary use the kettle" belongs to the first named; "Bob or Mary" belongs to nobody.
//! * "A boy takes …" belongs to nobody (which boy?), "the boy takes …" to the only son.
//! * "Tom's mother takes …" belongs to the mother where the roles say so, "his mother" to nobody.
//! * "Bob does not use the mug" is Bob's, and of the kind [`Action::Other`].

use coin_schemas::tools::MAX_TEXT_BYTES;
use jiff::civil::DateTime;
use thiserror::Error;

use crate::language::people::People;
use crate::roster::{Roster, UserIndex};

mod action;
mod clause;
mod lexicon;
mod time;
mod tokens;
mod verbs;

#[cfg(test)]
mod laws;
#[cfg(test)]
pub(crate) mod test_support;
#[cfg(test)]
mod tests;

pub use time::{civil_seconds, from_civil_seconds};

/// What was done with a thing, told by the verb.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Action {
    /// Uses, reads, drinks from, wears, turns on or off, …
    Use,
    /// Takes, picks up, grabs, gets, …
    Take,
    /// Puts back, away or down, returns, stores, leaves, …
    Place,
    /// Carries, moves, brings, takes to another place, …
    Transport,
    /// Washes, wipes, vacuums, …
    Clean,
    /// Looks for, searches for, finds, …
    Search,
    /// Hands, gives, lends, …
    Give,
    /// Anything else.
    Other,
}

impl Action {
    /// All actions in the order of their codes.
    pub const ALL: [Self; 8] = [
        Self::Use,
        Self::Take,
        Self::Place,
        Self::Transport,
        Self::Clean,
        Self::Search,
        Self::Give,
        Self::Other,
    ];

    /// The word that files, tools and the database's reader see.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Use => "use",
            Self::Take => "take",
            Self::Place => "place",
            Self::Transport => "transport",
            Self::Clean => "clean",
            Self::Search => "search",
            Self::Give => "give",
            Self::Other => "other",
        }
    }

    /// The number that a database stores, 0…7. These numbers never change.
    pub fn code(self) -> u8 {
        match self {
            Self::Use => 0,
            Self::Take => 1,
            Self::Place => 2,
            Self::Transport => 3,
            Self::Clean => 4,
            Self::Search => 5,
            Self::Give => 6,
            Self::Other => 7,
        }
    }

    /// The action of a stored number; `None` where no action has it.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }
}

/// What a caption says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observation {
    /// When, on the wall clock of the home.
    pub at: DateTime,
    /// Who, where exactly one member of the household can be meant.
    pub actor: Option<UserIndex>,
    /// What was done.
    pub action: Action,
}

/// Why a line is no caption.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CaptionError {
    /// The line is empty or holds spaces only.
    #[error("the caption is empty; write `YYYY-MM-DD HH:MM TEXT`")]
    Empty,
    /// The line is longer than [`MAX_TEXT_BYTES`].
    #[error("the caption has {length} bytes; at most {MAX_TEXT_BYTES} are allowed")]
    TooLong {
        /// Its length in bytes.
        length: usize,
    },
    /// The line holds a line break, a tab or another control character.
    #[error("the caption holds the control character {}; a caption is one line of plain text", character.escape_unicode())]
    ControlCharacter {
        /// The first such character.
        character: char,
    },
    /// The line does not begin with a date and a time.
    #[error(
        "the caption begins with {given:?}; it must begin with a local time, `YYYY-MM-DD HH:MM` or \
         `YYYY-MM-DDTHH:MM:SS`, without a zone, and a space"
    )]
    NoTime {
        /// The beginning of the line.
        given: String,
    },
    /// The date or the time of day does not exist.
    #[error(
        "the time {given} of the caption does not exist; give a day of the calendar and a time from 00:00 to 23:59"
    )]
    TimeDoesNotExist {
        /// The time as it is written.
        given: String,
    },
    /// Nothing follows the time.
    #[error("the caption has no text after its time; write who does what")]
    NoText,
}

/// Reads captions of one household. Names and roles are prepared once, so keep it for many captions.
#[derive(Debug, Clone)]
pub struct CaptionReader {
    people: People,
    lexicon: lexicon::Lexicon,
}

impl CaptionReader {
    /// Prepares the names and roles of the members.
    pub fn new(roster: &Roster) -> Self {
        Self { people: People::new(roster), lexicon: lexicon::Lexicon::new() }
    }

    /// Reads `YYYY-MM-DD HH:MM[:SS] TEXT` (or the same with `T`). Spaces around the line do not matter.
    pub fn read(&self, line: &str) -> Result<Observation, CaptionError> {
        let line = line.trim_matches(' ');
        if line.is_empty() {
            return Err(CaptionError::Empty);
        }
        if line.len() > MAX_TEXT_BYTES {
            return Err(CaptionError::TooLong { length: line.len() });
        }
        let plain = line.bytes().all(|byte| byte.is_ascii() && !byte.is_ascii_control());
        if !plain && let Some(character) = line.chars().find(|character| character.is_control()) {
            return Err(CaptionError::ControlCharacter { character });
        }
        let (at, text) = time::split(line)?;
        let (actor, action) = clause::read(&self.people, &self.lexicon, text);
        Ok(Observation { at, actor, action })
    }
}
