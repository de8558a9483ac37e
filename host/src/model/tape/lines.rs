//! Reading and writing the lines of a tape.

use std::io::{BufRead, Write};
use std::path::Path;

use coin_schemas::tape::{Exchange, TAPE_VERSION, TapeHeader};
use serde::Serialize;
use serde_json::Value;

use super::TapeError;

/// A line as it stands in the file.
pub(super) enum Line {
    /// With its end.
    Whole(Vec<u8>),
    /// The last one, without an end: whoever wrote it was interrupted.
    Torn(Vec<u8>),
}

/// The next line; `None` at the end of the file.
pub(super) fn next_line(path: &Path, reader: &mut impl BufRead) -> Result<Option<Line>, TapeError> {
    let mut line = Vec::new();
    reader
        .read_until(b'\n', &mut line)
        .map_err(|source| TapeError::Read { path: path.to_owned(), source })?;
    Ok(match line.last() {
        None => None,
        Some(b'\n') => Some(Line::Whole(line)),
        Some(_) => Some(Line::Torn(line)),
    })
}

/// Reads the first line. Its version is looked at before its form, which another version may have changed.
pub(super) fn read_header(path: &Path, line: &[u8]) -> Result<TapeHeader, TapeError> {
    let other_file = || TapeError::OtherFile { path: path.to_owned() };
    let header: Value = serde_json::from_slice(line).map_err(|_| other_file())?;
    let version = header.get("tape_version").ok_or_else(other_file)?;
    if *version != TAPE_VERSION {
        return Err(TapeError::Version { path: path.to_owned(), given: version.to_string() });
    }
    serde_json::from_value(header).map_err(|_| other_file())
}

/// Reads the exchange on a line; white lines hold none.
pub(super) fn read_exchange(path: &Path, number: usize, line: &[u8]) -> Result<Option<Exchange>, TapeError> {
    let line = line.trim_ascii_end();
    if line.is_empty() {
        return Ok(None);
    }
    serde_json::from_slice(line).map(Some).map_err(|problem| TapeError::Line {
        path: path.to_owned(),
        line: number,
        problem,
    })
}

/// Writes a value as one line, with one call where the system takes it whole.
pub(super) fn write_line(mut file: impl Write, value: &impl Serialize) -> std::io::Result<u64> {
    let mut line = serde_json::to_vec(value)?;
    line.push(b'\n');
    file.write_all(&line)?;
    file.flush()?;
    Ok(line.len() as u64)
}
