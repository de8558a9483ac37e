//! Reading a configuration file, and replacing it so that no other program ever sees half of it.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// What stands at the end of a backup's name.
const BACKUP: &str = ".before-coin";

/// A configuration file could not be read or replaced. It is as it was.
#[derive(Debug, Error)]
#[error("{} cannot be {action}: {source}", path.display())]
pub(crate) struct FileError {
    path: PathBuf,
    action: &'static str,
    source: io::Error,
}

/// A configuration file, whether it is there or not.
#[derive(Debug)]
pub(crate) struct ConfigurationFile {
    path: PathBuf,
    target: PathBuf,
    text: Option<String>,
}

impl ConfigurationFile {
    /// Reads a file. A symbolic link is followed, so that it stays one when its target is replaced.
    ///
    /// # Errors
    /// If it is there and cannot be read, or is no text.
    pub(crate) fn read(path: PathBuf) -> Result<Self, FileError> {
        let failed = |source| FileError { path: path.clone(), action: "read", source };
        let target =
            if path.is_symlink() { dunce::canonicalize(&path).map_err(failed)? } else { path.clone() };
        let text = match fs::read_to_string(&target) {
            Ok(text) => Some(text),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error)),
        };
        Ok(Self { path, target, text })
    }

    /// Where the host looks for it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What stands in it; `None` if it is not there.
    pub(crate) fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    /// Where the text is kept that is about to be replaced.
    pub(crate) fn backup_path(&self) -> PathBuf {
        let mut name = self.target.as_os_str().to_owned();
        name.push(BACKUP);
        name.into()
    }

    /// What the last change replaced, if it can still be read.
    pub(crate) fn backup(&self) -> Option<String> {
        fs::read_to_string(self.backup_path()).ok()
    }

    /// Keeps a copy of the file and puts a new text in its place, in one step. Permissions stay; a new file can be read
    /// by its owner alone, since such files hold keys of other servers.
    ///
    /// # Errors
    /// If the disk refuses; the file is then as it was.
    pub(crate) fn replace(&self, text: &str) -> Result<Option<PathBuf>, FileError> {
        let failed = |source| FileError { path: self.target.clone(), action: "written", source };
        let folder = self.target.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder).map_err(failed)?;
        let backup = self.keep_copy()?;
        let mut fresh = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
        fresh.write_all(text.as_bytes()).map_err(failed)?;
        if self.text.is_some() {
            let permissions = fs::metadata(&self.target).map_err(failed)?.permissions();
            fresh.as_file().set_permissions(permissions).map_err(failed)?;
        }
        fresh.as_file().sync_all().map_err(failed)?;
        fresh.persist(&self.target).map_err(|error| failed(error.error))?;
        Ok(backup)
    }

    /// Keeps a copy of the file and removes it.
    ///
    /// # Errors
    /// If the disk refuses; the file is then as it was.
    pub(crate) fn remove(&self) -> Result<Option<PathBuf>, FileError> {
        let backup = self.keep_copy()?;
        fs::remove_file(&self.target).map_err(|source| FileError {
            path: self.target.clone(),
            action: "removed",
            source,
        })?;
        Ok(backup)
    }

    /// Copies the file, and makes sure that the copy is what was read: the host may be writing at the same time.
    fn keep_copy(&self) -> Result<Option<PathBuf>, FileError> {
        let Some(text) = &self.text else { return Ok(None) };
        let backup = self.backup_path();
        let failed = |source| FileError { path: backup.clone(), action: "written", source };
        fs::copy(&self.target, &backup).map_err(failed)?;
        if fs::read(&backup).map_err(failed)? != text.as_bytes() {
            let source = io::Error::other("another program is changing it; close that, then try again");
            return Err(FileError { path: self.target.clone(), action: "changed", source });
        }
        Ok(Some(backup))
    }
}
