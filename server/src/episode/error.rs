//! What is wrong with an episode, by file and line or key.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

/// A place in an episode: a file, and in it a line or a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file, as episode.json names it.
    pub file: String,
    /// Where in the file.
    pub within: Within,
}

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Within {
    /// The file as a whole.
    File,
    /// A line, from 1.
    Line(usize),
    /// A key, such as `objects[3].position`.
    Key(String),
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.within {
            Within::File => formatter.write_str(&self.file),
            Within::Line(line) => write!(formatter, "{}:{line}", self.file),
            // A key comes from the file and may hold anything, line breaks too.
            Within::Key(key) => write!(formatter, "{}: {}", self.file, key.escape_debug()),
        }
    }
}

/// Why an episode was refused. Nothing of it was loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EpisodeError {
    /// The folder is not there or no folder.
    #[error("{}: this is no episode folder ({reason}); an episode is a folder with an episode.json", path.display())]
    NoFolder {
        /// What was given.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A file cannot be read.
    #[error("{file}: {reason}")]
    Unreadable {
        /// The file.
        file: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Something stands in a file that may not stand there.
    #[error("{place}: {problem}")]
    Malformed {
        /// Where.
        place: Place,
        /// What was given and what is expected.
        problem: String,
    },
}

impl EpisodeError {
    pub(super) fn in_file(file: &str, problem: impl Into<String>) -> Self {
        Self::malformed(file, Within::File, problem)
    }

    pub(super) fn at_line(file: &str, line: usize, problem: impl Into<String>) -> Self {
        Self::malformed(file, Within::Line(line), problem)
    }

    pub(super) fn at_key(file: &str, key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::malformed(file, Within::Key(key.into()), problem)
    }

    fn malformed(file: &str, within: Within, problem: impl Into<String>) -> Self {
        Self::Malformed { place: Place { file: file.to_owned(), within }, problem: problem.into() }
    }
}
