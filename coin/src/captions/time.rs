//! The time at the beginning of a caption, and wall-clock times as numbers.

use jiff::SignedDuration;
use jiff::civil::{DateTime, date};

use super::CaptionError;

/// How much of a line an error repeats, in characters.
const SHOWN_CHARACTERS: usize = 24;

const EPOCH: DateTime = date(1970, 1, 1).at(0, 0, 0, 0);

/// Seconds from 1970-01-01T00:00:00 to `at` on the same wall clock, no zone involved. Fractions of a second
/// are dropped.
pub fn civil_seconds(at: DateTime) -> i64 {
    let since = at.duration_since(EPOCH);
    since.as_secs() - i64::from(since.subsec_nanos() < 0)
}

/// The wall-clock time `seconds` after 1970-01-01T00:00:00; `None` outside the years −9999 to 9999.
pub fn from_civil_seconds(seconds: i64) -> Option<DateTime> {
    EPOCH.checked_add(SignedDuration::from_secs(seconds)).ok()
}

/// Splits a line, trimmed and not empty, into its time and its text.
pub(super) fn split(line: &str) -> Result<(DateTime, &str), CaptionError> {
    let no_time = || CaptionError::NoTime { given: line.chars().take(SHOWN_CHARACTERS).collect() };
    let bytes = line.as_bytes();
    let fields = minutes(bytes).ok_or_else(no_time)?;
    let (second, length) = match bytes.get(16) {
        Some(b':') => (number(bytes, 17, 2).ok_or_else(no_time)?, 19),
        _ => (0, 16),
    };
    if bytes.get(length).is_some_and(|&byte| byte != b' ') {
        return Err(no_time());
    }
    let [year, month, day, hour, minute] = fields;
    // Two digits fit into an i8 and four into an i16, so that the conversions lose nothing.
    let at = DateTime::new(year, month as i8, day as i8, hour as i8, minute as i8, second as i8, 0)
        .map_err(|_| CaptionError::TimeDoesNotExist { given: line[..length].to_owned() })?;
    match line[length..].trim_start_matches(' ') {
        "" => Err(CaptionError::NoText),
        text => Ok((at, text)),
    }
}

/// Year, month, day, hour and minute, where the sixteen bytes have the shape of a time.
fn minutes(bytes: &[u8]) -> Option<[i16; 5]> {
    let separators = bytes.len() >= 16
        && bytes[4] == b'-'
        && bytes[7] == b'-'
        && matches!(bytes[10], b' ' | b'T')
        && bytes[13] == b':';
    if !separators {
        return None;
    }
    Some([
        number(bytes, 0, 4)?,
        number(bytes, 5, 2)?,
        number(bytes, 8, 2)?,
        number(bytes, 11, 2)?,
        number(bytes, 14, 2)?,
    ])
}

fn number(bytes: &[u8], start: usize, digits: usize) -> Option<i16> {
    bytes
        .get(start..start + digits)?
        .iter()
        .try_fold(0, |value: i16, byte| byte.is_ascii_digit().then(|| value * 10 + i16::from(byte - b'0')))
}
