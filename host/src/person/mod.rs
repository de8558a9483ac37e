//! Whoever answers the agent's questions: a simulation that knows the truth, somebody at the terminal, or a file.
//!
//! A [`Person`] hears a question and says something in plain language, or picks from the offered choices, or
//! declines, or is not there any more. What words mean is not decided here: they go to the model that reads answers.
//! A choice means what it says, so that no model has to read it.

mod answer;
pub mod scripted;
pub mod simulated;
pub mod terminal;

use std::fmt;
use std::path::PathBuf;

use async_trait::async_trait;
use coin_schemas::household::{ObjectId, Score, UserName};
use coin_schemas::model::TaskObject;
use thiserror::Error;

pub use answer::{PreviousAnswer, Response, Understood};
pub use scripted::{ScriptError, ScriptedPerson};
pub use simulated::{ErrorRate, SimulatedPerson};
pub use terminal::TerminalPerson;

/// A member of the household, as somebody who may own the thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The member.
    pub name: UserName,
    /// How strongly the member is held to be an owner.
    pub score: Score,
}

/// A question as it is put to a person.
#[derive(Debug, Clone, Copy)]
pub struct PutQuestion<'a> {
    /// The number of the question, from 1.
    pub step: usize,
    /// The thing that it is about.
    pub object: &'a TaskObject,
    /// Other things that it is about as well, of the same class in the same room.
    pub also: &'a [TaskObject],
    /// The question itself.
    pub question: &'a str,
    /// The members of the household, the likeliest owner first.
    pub candidates: &'a [Candidate],
    /// How often the same thing has been asked about before.
    pub times_asked: u32,
    /// The answer before this question; `None` where there is none that could be taken back.
    pub before: Option<&'a PreviousAnswer>,
    /// How many more things may be asked about after this one, at most; `None` where that is not known.
    pub remaining: Option<usize>,
}

/// Who answers the questions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answers {
    /// A simulated person, who knows the truth of the episode.
    Simulated,
    /// The person at the terminal.
    Terminal,
    /// A file of answers.
    Scripted(PathBuf),
}

impl std::str::FromStr for Answers {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "simulated" => Self::Simulated,
            "terminal" => Self::Terminal,
            file => Self::Scripted(PathBuf::from(file)),
        })
    }
}

/// What kind of person answers; a report names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PersonKind {
    /// A simulation that knows the truth of the episode.
    Simulated,
    /// Somebody at the terminal.
    Terminal,
    /// A file of prepared answers.
    Scripted,
}

impl PersonKind {
    /// The word that reports use.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Simulated => "simulated",
            Self::Terminal => "terminal",
            Self::Scripted => "scripted",
        }
    }
}

impl fmt::Display for PersonKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// Why a question could not be put.
#[derive(Debug, Error)]
pub enum PersonError {
    /// The prompt could not be shown.
    #[error("the question could not be shown at the terminal: {0}")]
    Show(#[source] std::io::Error),
    /// The answer could not be read.
    #[error("the answer could not be read from standard input: {0}")]
    Read(#[source] std::io::Error),
}

/// Whoever answers questions.
#[async_trait]
pub trait Person: Send {
    /// What kind of person this is.
    fn kind(&self) -> PersonKind;

    /// Puts a question and waits for what becomes of it.
    ///
    /// # Errors
    /// If the way to the person is broken. That nobody answers is no error, but a [`Response`].
    async fn ask(&mut self, question: &PutQuestion<'_>) -> Result<Response, PersonError>;

    /// Hears that a question about this thing was put in an earlier part of the run. Who has prepared answers has given
    /// one of them.
    fn recall(&mut self, _object: &ObjectId) {}
}
