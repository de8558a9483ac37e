//! Reading a JSON object from between a model's other words.

use std::borrow::Cow;
use std::fmt;

use coin_server::display::excerpt;
use serde::de::{DeserializeOwned, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Number, Value};
use thiserror::Error;

use super::{UnreadableReply, check_length};

/// Why a reply is not the JSON that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum JsonFault {
    /// There is no object in it.
    #[error("it holds no JSON object; answer with one, {{\"KEY\": …}}")]
    NoObject,
    /// It is a list of something.
    #[error("it is a list; answer with one JSON object, {{\"KEY\": …}}")]
    List,
    /// The last object does not end.
    #[error("the object that begins with {start} has no end; close every string, bracket and brace")]
    Unclosed {
        /// Its first characters.
        start: String,
    },
    /// The last object is not written as JSON is.
    #[error(
        "{place}: {reason}; keys and texts stand in double quotes, numbers are plain ones such as 0.25, without % \
         and never NaN, and a comma stands between two entries"
    )]
    Malformed {
        /// What was expected.
        reason: String,
        /// The keys that lead there.
        place: String,
    },
    /// The same key stands twice in one object, so that two values contradict each other.
    #[error("{place}: {reason}; give every key once")]
    DuplicateKey {
        /// Which key.
        reason: String,
        /// The keys that lead to the object.
        place: String,
    },
    /// A value is not one of those that are allowed.
    #[error("{place}: {reason}")]
    Value {
        /// What was given, and what is allowed.
        reason: String,
        /// The keys that lead to the value.
        place: String,
    },
}

/// Reads the JSON object that a model was asked for.
///
/// Words before and after it, code fences, a byte order mark, and commas before a closing brace or bracket are passed
/// over. Of several objects the last one counts, since models think aloud first; later ones that do not have the keys
/// that are wanted are remarks and passed over. Where the last one that is meant is faulty, an earlier one is a draft
/// and does not stand in for it. A key may stand in an object once.
///
/// The time is linear in the length of the text.
///
/// # Errors
/// If the text is longer than [`MOST_BYTES`](super::MOST_BYTES), or holds no such object. The error tells the model
/// what was wrong.
pub fn read_json<T: DeserializeOwned>(text: &str) -> Result<T, UnreadableReply> {
    check_length(text)?;
    if is_list(text) {
        return Err(UnreadableReply::Json(JsonFault::List));
    }
    let mut remark = None;
    for found in objects(text).into_iter().rev() {
        match read_object(found) {
            Ok(value) => return Ok(value),
            Err(Misread::Remark(fault)) => {
                remark.get_or_insert(fault);
            }
            Err(Misread::Faulty(fault)) => return Err(UnreadableReply::Json(fault)),
        }
    }
    Err(UnreadableReply::Json(remark.unwrap_or(JsonFault::NoObject)))
}

/// Whether the text, fences aside, is a JSON list; an object in it is one of several and not the answer.
fn is_list(text: &str) -> bool {
    let bare = text.trim_matches(|character: char| {
        character.is_whitespace() || character == '\u{feff}' || character == '`'
    });
    let bare = bare.strip_prefix("json").unwrap_or(bare).trim_start();
    bare.starts_with('[') && serde_json::from_str::<IgnoredAny>(bare).is_ok()
}

/// What looks like an object.
#[derive(Clone, Copy)]
enum Found<'a> {
    /// From its first brace to the one that closes it.
    Closed(&'a str),
    /// From its first brace to the end of the text.
    Unclosed(&'a str),
}

/// The outermost objects of a text. A brace that no key and no closing brace follows is a part of the prose.
fn objects(text: &str) -> Vec<Found<'_>> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut place = 0;
    while place < bytes.len() {
        if bytes[place] != b'{' || !matches!(next_visible(bytes, place + 1), Some(b'"' | b'}')) {
            place += 1;
            continue;
        }
        let Some(end) = end_of_object(bytes, place) else {
            found.push(Found::Unclosed(&text[place..]));
            break;
        };
        found.push(Found::Closed(&text[place..end]));
        place = end;
    }
    found
}

fn next_visible(bytes: &[u8], from: usize) -> Option<u8> {
    bytes[from..].iter().copied().find(|byte| !byte.is_ascii_whitespace())
}

/// The place after the brace that closes the one at `start`.
fn end_of_object(bytes: &[u8], start: usize) -> Option<usize> {
    let mut depth = 0_usize;
    let mut strings = Strings::default();
    for (place, &byte) in bytes.iter().enumerate().skip(start) {
        if strings.covers(byte) {
            continue;
        }
        match byte {
            b'{' => depth += 1,
            b'}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(place + 1);
        }
    }
    None
}

/// Tells what is inside strings while JSON is read byte by byte.
#[derive(Default)]
enum Strings {
    #[default]
    Outside,
    Inside,
    Escaped,
}

impl Strings {
    /// Takes the next byte; says whether it belongs to a string, its quotes included.
    fn covers(&mut self, byte: u8) -> bool {
        let (next, covered) = match (&self, byte) {
            (Self::Outside, b'"') => (Self::Inside, true),
            (Self::Outside, _) => (Self::Outside, false),
            (Self::Inside, b'"') => (Self::Outside, true),
            (Self::Inside, b'\\') => (Self::Escaped, true),
            (Self::Inside | Self::Escaped, _) => (Self::Inside, true),
        };
        *self = next;
        covered
    }
}

/// Why something that looks like an object is not the one that is wanted.
enum Misread {
    /// It is JSON with other keys.
    Remark(JsonFault),
    /// It is meant, and it is wrong.
    Faulty(JsonFault),
}

fn read_object<T: DeserializeOwned>(found: Found<'_>) -> Result<T, Misread> {
    let text = match found {
        Found::Closed(text) => text,
        Found::Unclosed(text) => {
            return Err(Misread::Faulty(JsonFault::Unclosed { start: excerpt(first_words(text)) }));
        }
    };
    let text = without_trailing_commas(text);
    let mut deserializer = serde_json::Deserializer::from_str(&text);
    let UniqueKeys(value) = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let (reason, place) = (reason(error.inner()), place(error.path()));
        Misread::Faulty(match error.inner().classify() {
            serde_json::error::Category::Data => JsonFault::DuplicateKey { reason, place },
            _ => JsonFault::Malformed { reason, place },
        })
    })?;
    serde_path_to_error::deserialize(value).map_err(|error| {
        let at_the_top = error.path().iter().next().is_none();
        let fault = JsonFault::Value { reason: reason(error.inner()), place: place(error.path()) };
        if at_the_top { Misread::Remark(fault) } else { Misread::Faulty(fault) }
    })
}

/// Enough of an object to tell it from others.
fn first_words(text: &str) -> &str {
    const LONGEST: usize = 40;
    &text[..text.floor_char_boundary(LONGEST)]
}

/// What is wrong, without line and column: they count from a place that the model does not know.
fn reason(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    let text = text.strip_suffix(&position).unwrap_or(&text);
    match text.strip_suffix("expected f64") {
        Some(given) => format!("{} expected a number", excerpt(given)),
        None => excerpt(text),
    }
}

fn place(path: &serde_path_to_error::Path) -> String {
    if path.iter().next().is_none() {
        return "the object".to_owned();
    }
    let path = path.to_string();
    // A question mark stands for a key that was not read yet.
    excerpt(path.trim_end_matches(".?"))
}

/// The text without commas that stand after a value and before a closing brace or bracket.
fn without_trailing_commas(text: &str) -> Cow<'_, str> {
    let bytes = text.as_bytes();
    let mut strings = Strings::default();
    let mut kept = String::new();
    let mut kept_to = 0;
    let mut before = b'{';
    for (place, &byte) in bytes.iter().enumerate() {
        if strings.covers(byte) {
            before = byte;
            continue;
        }
        let after_a_value = !matches!(before, b'{' | b'[' | b',' | b':');
        if byte == b',' && after_a_value && matches!(next_visible(bytes, place + 1), Some(b'}' | b']')) {
            kept.push_str(&text[kept_to..place]);
            kept_to = place + 1;
        }
        if !byte.is_ascii_whitespace() {
            before = byte;
        }
    }
    if kept_to == 0 {
        return Cow::Borrowed(text);
    }
    kept.push_str(&text[kept_to..]);
    Cow::Owned(kept)
}

/// A JSON value in which no object has the same key twice.
struct UniqueKeys(Value);

impl<'de> Deserialize<'de> for UniqueKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UniqueKeysVisitor).map(Self)
    }
}

struct UniqueKeysVisitor;

impl<'de> Visitor<'de> for UniqueKeysVisitor {
    type Value = Value;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("a number is not finite"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::String(value.to_owned()))
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(Value::String(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(UniqueKeys(value)) = entries.next_element()? {
            list.push(value);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format_args!("the key {key:?} stands twice")));
            }
            let UniqueKeys(value) = entries.next_value()?;
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}
