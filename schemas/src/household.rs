//! People, things and what is said of them: the nouns of every other module.

use std::borrow::Borrow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The longest name or id that is accepted, in bytes. A longer one is a caption or a prompt gone astray.
pub const MAX_NAME_BYTES: usize = 200;

/// Why a text is no name, id or number of the kind that was asked for.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InvalidValue {
    /// The text is empty or holds white space only.
    #[error("{what} is empty")]
    Empty {
        /// What the text was meant to be.
        what: &'static str,
    },
    /// The text is longer than [`MAX_NAME_BYTES`].
    #[error("{what} has {length} bytes; at most {MAX_NAME_BYTES} are allowed")]
    TooLong {
        /// What the text was meant to be.
        what: &'static str,
        /// Its length in bytes.
        length: usize,
    },
    /// The text holds a control character, which no screen and no prompt would show.
    #[error("{what} holds a control character")]
    ControlCharacter {
        /// What the text was meant to be.
        what: &'static str,
    },
    /// The number is no score.
    #[error("a score lies between 0 and 1, and {given} does not")]
    Score {
        /// The number.
        given: f64,
    },
    /// A coordinate is infinite or not a number.
    #[error("a position has three finite numbers (metres), not {given:?}")]
    Position {
        /// The numbers.
        given: [f64; 3],
    },
}

fn check_text(what: &'static str, text: &str) -> Result<(), InvalidValue> {
    if text.trim().is_empty() {
        return Err(InvalidValue::Empty { what });
    }
    if text.len() > MAX_NAME_BYTES {
        return Err(InvalidValue::TooLong { what, length: text.len() });
    }
    if text.chars().any(char::is_control) {
        return Err(InvalidValue::ControlCharacter { what });
    }
    Ok(())
}

macro_rules! text_newtype {
    ($(#[$doc:meta])* $name:ident, $what:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
        #[serde(try_from = "String", into = "String")]
        #[schemars(with = "String")]
        pub struct $name(String);

        impl $name {
            /// Checks the text: not empty, no control character, at most [`MAX_NAME_BYTES`] bytes.
            pub fn new(text: impl Into<String>) -> Result<Self, InvalidValue> {
                let text = text.into();
                check_text($what, &text)?;
                Ok(Self(text))
            }

            /// The text itself.
            pub fn as_str(&self) -> &str {
                &self.0
            }
        }

        impl TryFrom<String> for $name {
            type Error = InvalidValue;
            fn try_from(text: String) -> Result<Self, InvalidValue> {
                Self::new(text)
            }
        }

        impl From<$name> for String {
            fn from(value: $name) -> String {
                value.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str(&self.0)
            }
        }

        impl Borrow<str> for $name {
            fn borrow(&self) -> &str {
                &self.0
            }
        }
    };
}

text_newtype!(
    /// The name of a member of the household; it identifies the person.
    UserName,
    "a user name"
);
text_newtype!(
    /// The id of a thing in the home's map, unique there.
    ObjectId,
    "an object id"
);
text_newtype!(
    /// The class label of a thing, as a detector or a person gives it (`marker`, `coffee table`).
    ClassLabel,
    "an object class"
);

/// How strongly a thing is held to belong to a person: 0 (not at all) to 1 (surely).
///
/// Scores of several people need not sum to 1, because things can be shared.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "f64", into = "f64")]
#[schemars(with = "f64", extend("minimum" = 0.0, "maximum" = 1.0))]
pub struct Score(f64);

impl Score {
    /// Surely not an owner.
    pub const ZERO: Self = Self(0.0);
    /// Surely an owner.
    pub const ONE: Self = Self(1.0);

    /// Refuses what is not in 0…1, NaN included; nothing is clamped.
    pub fn new(value: f64) -> Result<Self, InvalidValue> {
        // Adding zero turns -0.0, which would rank below 0, into 0.0.
        if (0.0..=1.0).contains(&value) {
            Ok(Self(value + 0.0))
        } else {
            Err(InvalidValue::Score { given: value })
        }
    }

    /// The number, in 0…1.
    pub fn value(self) -> f64 {
        self.0
    }
}

impl TryFrom<f64> for Score {
    type Error = InvalidValue;
    fn try_from(value: f64) -> Result<Self, InvalidValue> {
        Self::new(value)
    }
}

impl From<Score> for f64 {
    fn from(score: Score) -> f64 {
        score.0
    }
}

/// A place in the home's map frame: `[x, y, z]` in metres, all finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "[f64; 3]", into = "[f64; 3]")]
#[schemars(with = "[f64; 3]")]
pub struct Position([f64; 3]);

impl Position {
    /// Refuses infinite numbers and NaN.
    pub fn new(metres: [f64; 3]) -> Result<Self, InvalidValue> {
        if metres.iter().all(|coordinate| coordinate.is_finite()) {
            Ok(Self(metres))
        } else {
            Err(InvalidValue::Position { given: metres })
        }
    }

    /// `[x, y, z]` in metres.
    pub fn metres(self) -> [f64; 3] {
        self.0
    }
}

impl TryFrom<[f64; 3]> for Position {
    type Error = InvalidValue;
    fn try_from(metres: [f64; 3]) -> Result<Self, InvalidValue> {
        Self::new(metres)
    }
}

impl From<Position> for [f64; 3] {
    fn from(position: Position) -> [f64; 3] {
        position.0
    }
}

/// What is known of a person in advance (the paper's user background, Section 4.1).
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Background {
    /// The person's place in the home, such as `father` or `flatmate`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub role: Option<String>,
    /// What the person does, such as `office worker`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub occupation: Option<String>,
}

/// The members of a household by name, in the order of their names.
pub type Users = BTreeMap<UserName, Background>;

/// A set of owners, in the order of their names.
pub type Owners = BTreeSet<UserName>;

/// A score for every member of the household.
pub type Scores = BTreeMap<UserName, Score>;

/// A truth value for members of the household: is this person an owner?
pub type OwnershipBoolean = BTreeMap<UserName, bool>;

/// How a thing is used (the paper's three conditions, Section 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum UsageType {
    /// Its owner alone uses it.
    SingleUser,
    /// Others borrow it now and then.
    TemporarySharing,
    /// Its owners use it about equally often.
    MultiUserSharing,
}

/// Where a belief about an owner comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A person said so.
    Answer,
    /// A model concluded it from what was seen.
    Inferred,
}
