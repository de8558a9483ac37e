//! Why a tape cannot be used.

use std::path::PathBuf;

use coin_schemas::tape::TAPE_VERSION;
use thiserror::Error;

use crate::model::ModelError;

/// Why a tape cannot be used.
#[derive(Debug, Error)]
pub enum TapeError {
    /// The path names a folder.
    #[error("{} is a folder; name a file for the tape", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The file cannot be opened or made.
    #[error("the tape {} cannot be opened: {source}; name another file", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Another run is at it.
    #[error("another run is recording to {}; wait for its end or name another file", path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("the tape {} cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file cannot take another line.
    #[error("the tape {} cannot be written: {source}; make room there or name another file", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is something else, or was cut within its first line.
    #[error(
        "{} is no tape: its first line is not {{\"tape_version\": …, \"model\": …}}; name a file that --record wrote",
        path.display()
    )]
    OtherFile {
        /// The file.
        path: PathBuf,
    },
    /// The file has a form that this program does not know.
    #[error(
        "{} is a tape of version {given}, and this program reads version {TAPE_VERSION}; record anew with --record FILE",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        given: String,
    },
    /// The replies are another model's.
    #[error("{} keeps replies of the model {given:?}, and this is {wanted:?}; name another file for it", path.display())]
    OtherModel {
        /// The file.
        path: PathBuf,
        /// Whose replies it keeps.
        given: String,
        /// The model that is used.
        wanted: String,
    },
    /// A line is damaged.
    #[error("{}:{line}: this is no exchange with a model: {problem}; delete the line, or record anew", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        problem: serde_json::Error,
    },
}

/// What is not on the disk now will not be there for the next request either.
impl From<TapeError> for ModelError {
    fn from(error: TapeError) -> Self {
        Self::Unusable { reason: error.to_string() }
    }
}
