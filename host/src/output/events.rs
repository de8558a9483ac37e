//! The event log: JSON Lines in a file, one [`LogEvent`] a line, whole after every line.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use coin_schemas::events::LogEvent;
use thiserror::Error;

/// Why an event log could not be written.
#[derive(Debug, Error)]
pub enum EventLogError {
    /// The file cannot be made.
    #[error("the event log {} cannot be created: {source}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line cannot be written.
    #[error("event {line} cannot be written to the event log {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// Why.
        source: std::io::Error,
    },
}

/// An event log that is being written.
pub struct EventLog<W = File> {
    path: PathBuf,
    writer: W,
    lines: usize,
}

impl EventLog {
    /// Makes the file, or empties the one that is there.
    ///
    /// # Errors
    /// If the file cannot be made.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, EventLogError> {
        let path = path.as_ref().to_owned();
        match File::create(&path) {
            Ok(file) => Ok(Self::over(path, file)),
            Err(source) => Err(EventLogError::Create { path, source }),
        }
    }
}

impl<W: Write> EventLog<W> {
    fn over(path: PathBuf, writer: W) -> Self {
        Self { path, writer, lines: 0 }
    }

    /// Writes one event as one line. Whoever reads the file afterwards sees the line whole.
    ///
    /// # Errors
    /// If the file cannot take it.
    pub fn write(&mut self, event: &LogEvent) -> Result<(), EventLogError> {
        self.lines += 1;
        self.append(event).map_err(|source| EventLogError::Write {
            path: self.path.clone(),
            line: self.lines,
            source,
        })
    }

    fn append(&mut self, event: &LogEvent) -> std::io::Result<()> {
        let mut line = serde_json::to_vec(event)?;
        line.push(b'\n');
        self.writer.write_all(&line)?;
        self.writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use coin_schemas::household::ObjectId;

    use super::*;

    fn asked(step: usize, question: &str) -> LogEvent {
        LogEvent::QuestionAsked {
            step,
            object_id: ObjectId::new("3").unwrap(),
            also: Vec::new(),
            question: question.to_owned(),
        }
    }

    #[test]
    fn every_event_is_one_line_that_is_there_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("events.jsonl");
        let events = [asked(1, "Whose is it?"), asked(2, "And\nthis \"one\"?")];
        let mut log = EventLog::create(&path).unwrap();
        for (written, event) in events.iter().enumerate() {
            log.write(event).unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let read: Vec<LogEvent> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
            assert_eq!(read, events[..=written]);
            assert!(text.ends_with('\n'));
        }
    }

    #[test]
    fn a_new_log_replaces_an_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("events.jsonl");
        std::fs::write(&path, "of an earlier run\n").unwrap();
        EventLog::create(&path).unwrap().write(&asked(1, "Whose?")).unwrap();
        insta::assert_snapshot!(
            std::fs::read_to_string(&path).unwrap(),
            @r#"{"event":"question_asked","step":1,"object_id":"3","question":"Whose?"}"#
        );
    }

    #[test]
    fn a_file_that_cannot_be_made_is_named() {
        let error = EventLog::create("/dev/null/events.jsonl").err().unwrap();
        insta::assert_snapshot!(
            error,
            @"the event log /dev/null/events.jsonl cannot be created: Not a directory (os error 20)"
        );
    }

    #[test]
    fn a_full_disk_is_named_with_the_line() {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let mut log = EventLog::over(PathBuf::from("events.jsonl"), full);
        insta::assert_snapshot!(
            log.write(&asked(1, "Whose?")).unwrap_err(),
            @"event 1 cannot be written to the event log events.jsonl: No space left on device (os error 28)"
        );
    }
}
