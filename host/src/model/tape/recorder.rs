//! A model whose exchanges are recorded.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use async_trait::async_trait;
use serde::Serialize;

use super::lines::write_line;
use super::{TapeError, exchange, fingerprint, header, open_private};
use crate::model::{ChatModel, ChatReply, ChatRequest, ModelError};

/// A model whose exchanges are written to a tape as they end, errors among them.
///
/// After a crash the tape holds every exchange that had ended, each as a whole line. Where the file takes no more, the
/// model is unusable.
pub struct Recorder {
    model: Arc<dyn ChatModel>,
    tape: Mutex<Tape>,
}

struct Tape {
    path: PathBuf,
    file: File,
    /// Where the last whole line ends, in bytes.
    length: u64,
}

impl Recorder {
    /// Makes the tape, or empties the one that is there. Only its owner can read it.
    ///
    /// # Errors
    /// If the path is a folder, the file cannot be written, or another run is recording to it.
    pub fn create(model: Arc<dyn ChatModel>, path: impl AsRef<Path>) -> Result<Self, TapeError> {
        let path = path.as_ref().to_owned();
        let file = open_private(&path, OpenOptions::new().write(true).create(true).truncate(false))?;
        // The lock is held until the file is closed.
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(TapeError::InUse { path });
        }
        begin(&file).map_err(|source| TapeError::Open { path: path.clone(), source })?;
        let mut tape = Tape { path, file, length: 0 };
        tape.append(&header(model.name()))?;
        Ok(Self { model, tape: Mutex::new(tape) })
    }
}

/// Empties the file. One that was there before becomes private, too.
fn begin(file: &File) -> std::io::Result<()> {
    if file.metadata()?.is_file() {
        file.set_len(0)?;
        #[cfg(unix)]
        file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o600))?;
    }
    Ok(())
}

impl Tape {
    fn append(&mut self, value: &impl Serialize) -> Result<(), TapeError> {
        match write_line(&self.file, value) {
            Ok(bytes) => {
                self.length += bytes;
                Ok(())
            }
            Err(source) => {
                self.cut();
                Err(TapeError::Write { path: self.path.clone(), source })
            }
        }
    }

    /// Takes off what was written of a line that did not fit, so that the next one does not continue it.
    fn cut(&mut self) {
        let cut = self.file.set_len(self.length).and_then(|()| self.file.seek(SeekFrom::Start(self.length)));
        if let Err(error) = cut {
            tracing::warn!(tape = %self.path.display(), %error, "the last line of the tape may be torn");
        }
    }
}

#[async_trait]
impl ChatModel for Recorder {
    fn name(&self) -> &str {
        self.model.name()
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let fingerprint = fingerprint(self.name(), request)?;
        let outcome = self.model.complete(request).await;
        let exchange = exchange(fingerprint, request, &outcome);
        self.tape.lock().unwrap_or_else(PoisonError::into_inner).append(&exchange)?;
        outcome
    }
}

#[cfg(test)]
impl Recorder {
    /// Writes to a file that is open already, however it is open.
    pub(super) fn over(model: Arc<dyn ChatModel>, path: PathBuf, file: File) -> Self {
        Self { model, tape: Mutex::new(Tape { path, file, length: 0 }) }
    }
}
