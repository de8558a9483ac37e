//! A file that a command writes its result to.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;
use thiserror::Error;

/// Why a result cannot be kept in a file.
#[derive(Debug, Error)]
pub enum OutputFileError {
    /// Nothing can be written there; it is known before the work begins.
    #[error("cannot write {}: {reason}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The work is done, and its result could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Failed {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// A file for a result. What was there before stays until the new content is whole.
#[derive(Debug)]
pub struct OutputFile {
    path: PathBuf,
    partial: NamedTempFile,
}

impl OutputFile {
    /// Prepares a file, before the work whose result it is for.
    ///
    /// # Errors
    /// [`OutputFileError::Refused`] if nothing can be written there.
    pub fn create(path: &Path) -> Result<Self, OutputFileError> {
        let refused = |reason: String| OutputFileError::Refused { path: path.to_owned(), reason };
        if path.is_dir() {
            return Err(refused("it is a folder; name a file".to_owned()));
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let partial = NamedTempFile::new_in(folder).map_err(|error| refused(error.to_string()))?;
        Ok(Self { path: path.to_owned(), partial })
    }

    /// Writes a value as JSON.
    ///
    /// # Errors
    /// [`OutputFileError::Failed`] if that fails.
    pub fn write_json(self, value: &impl serde::Serialize) -> Result<(), OutputFileError> {
        let json = serde_json::to_string_pretty(value).map_err(|error| self.failed(&error))?;
        self.write(&format!("{json}\n"))
    }

    /// Writes a text.
    ///
    /// # Errors
    /// [`OutputFileError::Failed`] if that fails.
    pub fn write(mut self, text: &str) -> Result<(), OutputFileError> {
        self.partial.write_all(text.as_bytes()).map_err(|error| self.failed(&error))?;
        let Self { path, partial } = self;
        partial
            .persist(&path)
            .map(drop)
            .map_err(|error| OutputFileError::Failed { path, reason: error.error.to_string() })
    }

    fn failed(&self, reason: &impl std::fmt::Display) -> OutputFileError {
        OutputFileError::Failed { path: self.path.clone(), reason: reason.to_string() }
    }
}
