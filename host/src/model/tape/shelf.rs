//! The file in which replies are kept, shared with other processes.
//!
//! Whoever writes holds the lock of the file and appends whole lines; whoever reads never sees half of one, unless a
//! process died over it. That half is cut off by the next one that writes.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{BufReader, ErrorKind, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use coin_schemas::tape::{Exchange, Fingerprint, Outcome};
use serde::Serialize;

use super::lines::{Line, next_line, read_exchange, read_header, write_line};
use super::{TapeError, header, open_private};
use crate::model::{ChatReply, Ending};

/// The kept replies of one model.
pub(super) struct Shelf {
    path: PathBuf,
    model: String,
    file: File,
    replies: HashMap<Fingerprint, ChatReply>,
    /// How much of the file was read, in whole lines and in bytes.
    lines: usize,
    bytes: u64,
}

/// What to do with a last line that was torn.
#[derive(Clone, Copy)]
enum TornLine {
    /// Cut it off; only for whoever may write.
    Cut,
    /// Leave it to whoever writes next.
    Leave,
}

/// Whether a reply is one that another asking need not improve on.
pub(super) fn is_worth_keeping(reply: &ChatReply) -> bool {
    reply.ending == Ending::Finished
}

impl Shelf {
    pub(super) fn open(path: &Path, model: &str) -> Result<Self, TapeError> {
        let file = open_private(path, OpenOptions::new().read(true).append(true).create(true))?;
        let mut shelf = Self {
            path: path.to_owned(),
            model: model.to_owned(),
            file,
            replies: HashMap::new(),
            lines: 0,
            bytes: 0,
        };
        shelf.locked(Shelf::prepare)?;
        Ok(shelf)
    }

    /// The reply that is kept, by this process or another one.
    pub(super) fn find(&mut self, fingerprint: Fingerprint) -> Result<Option<ChatReply>, TapeError> {
        if !self.replies.contains_key(&fingerprint) && self.length()? != self.bytes {
            self.locked(|shelf| shelf.catch_up(TornLine::Leave))?;
        }
        Ok(self.replies.get(&fingerprint).cloned())
    }

    /// Keeps the reply of an exchange. It is on the disk afterwards.
    pub(super) fn keep(&mut self, exchange: &Exchange) -> Result<(), TapeError> {
        self.locked(|shelf| {
            shelf.prepare()?;
            // Another process may have asked the same meanwhile.
            if !shelf.replies.contains_key(&exchange.fingerprint) {
                shelf.append(exchange)?;
                shelf.remember(exchange.fingerprint, &exchange.outcome);
            }
            Ok(())
        })
    }

    /// Brings the file to the end of a line, and begins it where it is empty.
    fn prepare(&mut self) -> Result<(), TapeError> {
        self.catch_up(TornLine::Cut)?;
        if self.lines == 0 {
            self.append(&header(&self.model))?;
            self.sync_folder();
        }
        Ok(())
    }

    /// Does something while no other process does.
    fn locked<T>(&mut self, work: impl FnOnce(&mut Self) -> Result<T, TapeError>) -> Result<T, TapeError> {
        match self.file.lock() {
            Ok(()) => {}
            // Some file systems have no locks. A line is still appended with one call.
            Err(error) if error.kind() == ErrorKind::Unsupported => {
                tracing::debug!(tape = %self.path.display(), "the file system has no locks");
            }
            Err(source) => return Err(self.unreadable(source)),
        }
        let outcome = work(self);
        if let Err(error) = self.file.unlock() {
            tracing::debug!(tape = %self.path.display(), %error, "the lock is kept until the file is closed");
        }
        outcome
    }

    /// Reads the lines that are new.
    fn catch_up(&mut self, torn: TornLine) -> Result<(), TapeError> {
        let length = self.length()?;
        if length < self.bytes {
            // Somebody emptied the file; it is read from its beginning again.
            (self.lines, self.bytes) = (0, 0);
        }
        let mut file = self.file.try_clone().map_err(|source| self.unreadable(source))?;
        file.seek(SeekFrom::Start(self.bytes)).map_err(|source| self.unreadable(source))?;
        let mut reader = BufReader::new(file);
        while let Some(line) = next_line(&self.path, &mut reader)? {
            match (line, torn) {
                (Line::Whole(line), _) => self.take(&line)?,
                (Line::Torn(line), _) if self.lines == 0 && !self.could_begin_with(&line) => {
                    return Err(TapeError::OtherFile { path: self.path.clone() });
                }
                (Line::Torn(_), TornLine::Leave) => {}
                (Line::Torn(_), TornLine::Cut) => {
                    tracing::warn!(tape = %self.path.display(), line = self.lines + 1, "a torn line is cut off");
                    self.file.set_len(self.bytes).map_err(|source| self.unwritable(source))?;
                }
            }
        }
        Ok(())
    }

    fn take(&mut self, line: &[u8]) -> Result<(), TapeError> {
        if self.lines == 0 {
            let given = read_header(&self.path, line)?.model;
            if given != self.model {
                return Err(TapeError::OtherModel {
                    path: self.path.clone(),
                    given,
                    wanted: self.model.clone(),
                });
            }
        } else if let Some(exchange) = read_exchange(&self.path, self.lines + 1, line)? {
            self.remember(exchange.fingerprint, &exchange.outcome);
        }
        self.lines += 1;
        self.bytes += line.len() as u64;
        Ok(())
    }

    /// Of several replies to one request the first counts, so that every process goes on alike.
    fn remember(&mut self, fingerprint: Fingerprint, outcome: &Outcome) {
        if let Outcome::Reply(reply) = outcome
            && is_worth_keeping(reply)
        {
            self.replies.entry(fingerprint).or_insert_with(|| reply.clone());
        }
    }

    /// Whether this is a part of the first line that this program would write. If not, the file is not ours to cut.
    fn could_begin_with(&self, torn: &[u8]) -> bool {
        let Ok(mut line) = serde_json::to_vec(&header(&self.model)) else { return false };
        let version = format!("{}\"}}", env!("CARGO_PKG_VERSION"));
        line.truncate(line.len().saturating_sub(version.len()));
        torn.starts_with(&line) || line.starts_with(torn)
    }

    fn append(&mut self, value: &impl Serialize) -> Result<(), TapeError> {
        let written = write_line(&self.file, value).and_then(|bytes| self.file.sync_data().map(|()| bytes));
        match written {
            Ok(bytes) => {
                self.lines += 1;
                self.bytes += bytes;
                Ok(())
            }
            Err(source) => {
                if let Err(error) = self.file.set_len(self.bytes) {
                    tracing::warn!(tape = %self.path.display(), %error, "the last line may be torn");
                }
                Err(self.unwritable(source))
            }
        }
    }

    /// A new file is found again after a crash only once its folder is on the disk as well.
    fn sync_folder(&self) {
        #[cfg(unix)]
        if let Some(folder) = self.path.parent().filter(|folder| !folder.as_os_str().is_empty())
            && let Err(error) = File::open(folder).and_then(|folder| folder.sync_all())
        {
            tracing::debug!(tape = %self.path.display(), %error, "the folder cannot be synchronised");
        }
    }

    fn length(&self) -> Result<u64, TapeError> {
        self.file.metadata().map(|about| about.len()).map_err(|source| self.unreadable(source))
    }

    fn unreadable(&self, source: std::io::Error) -> TapeError {
        TapeError::Read { path: self.path.clone(), source }
    }

    fn unwritable(&self, source: std::io::Error) -> TapeError {
        TapeError::Write { path: self.path.clone(), source }
    }
}
