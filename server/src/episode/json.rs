//! Strict JSON: unknown and repeated keys are refused, and a fault is named by its path.

use std::collections::HashSet;
use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use super::error::EpisodeError;

/// Parses a file that is one JSON object.
pub(super) fn parse_document<T: DeserializeOwned>(file: &str, bytes: &[u8]) -> Result<T, EpisodeError> {
    let text = str::from_utf8(bytes).map_err(|source| {
        let line = bytes[..source.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        EpisodeError::at_line(file, line, "it is not valid UTF-8")
    })?;
    let value = parse(text).map_err(|fault| match fault.path {
        Some(path) => EpisodeError::at_key(file, path, fault.problem),
        None => EpisodeError::at_line(file, fault.line, fault.problem),
    })?;
    // Maps take the last of two equal keys in silence, so repeated keys are looked for on their own.
    serde_json::from_str::<UniqueKeys>(text)
        .map_err(|source| EpisodeError::at_line(file, source.line(), without_position(&source)))?;
    Ok(value)
}

/// What is wrong with a JSON text.
#[derive(Debug)]
pub(super) struct Fault {
    /// The path of the value that is wrong; `None` where it is the whole text.
    pub(super) path: Option<String>,
    /// The line, from 1.
    pub(super) line: usize,
    /// What is wrong.
    pub(super) problem: String,
}

/// Parses a text that is one JSON object.
pub(super) fn parse<T: DeserializeOwned>(text: &str) -> Result<T, Fault> {
    // A structure would also be read from a list of its fields, which no episode may use.
    if text.trim_start().starts_with('[') {
        let problem = "this is a list; expected an object in braces".to_owned();
        return Err(Fault { path: None, line: 1, problem });
    }
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|source| {
        let path = Some(source.path().to_string()).filter(|path| !matches!(path.as_str(), "." | "?"));
        fault(path, source.inner(), text)
    })?;
    deserializer.end().map_err(|source| fault(None, &source, text))?;
    Ok(value)
}

fn fault(path: Option<String>, source: &serde_json::Error, text: &str) -> Fault {
    let mut problem = without_position(source);
    if source.is_syntax() || source.is_eof() {
        let line = if text.contains('\n') { format!("line {}, ", source.line()) } else { String::new() };
        problem = format!("this is no JSON ({line}column {}: {problem})", source.column());
        let rest = text.lines().nth(source.line().saturating_sub(1)).and_then(|line| {
            let before = source.column().saturating_sub(1);
            line.get(before..).map(|rest| rest.trim_start_matches('-'))
        });
        if rest.is_some_and(|rest| ["NaN", "nan", "Inf", "inf"].iter().any(|word| rest.starts_with(word))) {
            problem.push_str("; JSON has no NaN and no infinity, and every number must be finite");
        }
    }
    Fault { path, line: source.line().max(1), problem }
}

/// serde_json appends " at line 3 column 7", which the place says already.
fn without_position(source: &serde_json::Error) -> String {
    let text = source.to_string();
    match text.rfind(" at line ") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}

/// Any JSON value in which no object has a key twice. The value itself is thrown away.
struct UniqueKeys;

impl<'de> Deserialize<'de> for UniqueKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UniqueKeysVisitor)
    }
}

impl<'de> DeserializeSeed<'de> for UniqueKeys {
    type Value = Self;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UniqueKeysVisitor)
    }
}

struct UniqueKeysVisitor;

impl<'de> Visitor<'de> for UniqueKeysVisitor {
    type Value = UniqueKeys;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_bool<E: Error>(self, _: bool) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_i64<E: Error>(self, _: i64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_u64<E: Error>(self, _: u64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_f64<E: Error>(self, _: f64) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_unit<E: Error>(self) -> Result<UniqueKeys, E> {
        Ok(UniqueKeys)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<UniqueKeys, A::Error> {
        while sequence.next_element::<UniqueKeys>()?.is_some() {}
        Ok(UniqueKeys)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<UniqueKeys, A::Error> {
        let mut keys = HashSet::new();
        while let Some(key) = map.next_key::<String>()? {
            map.next_value_seed(UniqueKeys)?;
            if let Some(twice) = keys.replace(key) {
                return Err(A::Error::custom(format!("the key {twice:?} stands twice")));
            }
        }
        Ok(UniqueKeys)
    }
}
