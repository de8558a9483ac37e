//! The caption file: one JSON object a line.

use std::collections::HashSet;
use std::io::{BufRead, BufReader, Read};

use coin::captions::{CaptionReader, Observation};
use coin_schemas::episode::{CaptionLine, Episode};

use super::MAX_LINE_BYTES;
use super::error::EpisodeError;
use super::files::{Folder, unreadable};
use super::json::{self, Fault};
use crate::near_miss;

const EXAMPLE: &str = r#"{"object_id": "3", "caption": "2025-01-19 19:00 Bob takes the Marker"}"#;

const READ_BUFFER_BYTES: usize = 1 << 18;

/// Reads all lines, in their order. Blank lines are skipped.
pub(super) fn read(
    folder: &Folder,
    episode: &Episode,
    reader: &CaptionReader,
) -> Result<(Vec<CaptionLine>, Vec<Observation>), EpisodeError> {
    let name = episode.captions.as_str();
    let known: HashSet<&str> = episode.objects.iter().map(|object| object.id.as_str()).collect();
    let mut lines = Lines::new(BufReader::with_capacity(READ_BUFFER_BYTES, folder.file(name)?), name);
    let mut captions = Vec::new();
    let mut observations = Vec::new();
    while let Some((number, text)) = lines.next()? {
        let refuse = |problem: String| EpisodeError::at_line(name, number, problem);
        let line = parse_line(text).map_err(refuse)?;
        if !known.contains(line.object_id.as_str()) {
            return Err(refuse(format!(
                "object_id {:?} is no object of episode.json.{}",
                line.object_id.as_str(),
                near_miss::hint(line.object_id.as_str(), known.iter().copied()),
            )));
        }
        observations.push(reader.read(&line.caption).map_err(|source| refuse(source.to_string()))?);
        captions.push(line);
    }
    Ok((captions, observations))
}

fn parse_line(text: &str) -> Result<CaptionLine, String> {
    // The path of a fault costs time, so it is found out only where there is a fault.
    if text.trim_start().starts_with('{')
        && let Ok(line) = serde_json::from_str(text)
    {
        return Ok(line);
    }
    json::parse(text).map_err(|Fault { path, problem, .. }| {
        let path = path.map(|path| format!("{path}: ")).unwrap_or_default();
        format!("{path}{problem}; a line is such as {EXAMPLE}")
    })
}

/// Numbered lines of limited length.
struct Lines<'a, R> {
    reader: R,
    name: &'a str,
    line: Vec<u8>,
    number: usize,
}

impl<'a, R: BufRead> Lines<'a, R> {
    fn new(reader: R, name: &'a str) -> Self {
        Self { reader, name, line: Vec::new(), number: 0 }
    }

    /// The next line that is not blank, and its number from 1.
    fn next(&mut self) -> Result<Option<(usize, &str)>, EpisodeError> {
        loop {
            self.line.clear();
            let limit = MAX_LINE_BYTES as u64 + 1;
            let read = (&mut self.reader)
                .take(limit)
                .read_until(b'\n', &mut self.line)
                .map_err(|source| unreadable(self.name, &source))?;
            if read == 0 {
                return Ok(None);
            }
            self.number += 1;
            if self.line.last() == Some(&b'\n') {
                self.line.pop();
            }
            if self.line.len() > MAX_LINE_BYTES {
                return Err(EpisodeError::at_line(
                    self.name,
                    self.number,
                    format!("the line is longer than {MAX_LINE_BYTES} bytes; write one caption a line"),
                ));
            }
            if !self.line.iter().all(u8::is_ascii_whitespace) {
                break;
            }
        }
        let text = str::from_utf8(&self.line).map_err(|source| {
            EpisodeError::at_line(
                self.name,
                self.number,
                format!("it is not valid UTF-8 (byte {} of the line)", source.valid_up_to() + 1),
            )
        })?;
        Ok(Some((self.number, text)))
    }
}
