//! Changing the text of a host's configuration: one entry comes or goes, and everything else stays as it is, comments,
//! trailing commas and line ends included.

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::{CstInputValue, CstObject, CstRootNode};
use serde_json::{Map, Value};
use thiserror::Error;

use super::Host;
use super::entry::Entry;

/// Why a configuration is left as it is.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(crate) enum EditError {
    /// It cannot be read.
    #[error("line {line}, column {column} is no valid JSON ({message}); mend it, then try again")]
    Syntax {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What the parser says.
        message: String,
    },
    /// Something that must be an object is not.
    #[error("{what} must be a JSON object, {{…}}; mend it, then try again")]
    NoObject {
        /// What it is.
        what: String,
    },
    /// The name belongs to another server.
    #[error(
        "the server {name:?} in it is not a coin-server, so it is left alone; choose another name with --name"
    )]
    NotOurs {
        /// The server's name.
        name: String,
    },
}

/// What is left when an entry is gone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Remainder {
    /// There was no such entry.
    Unchanged,
    /// This text.
    Text(String),
    /// Nothing: the file held the entry alone, as it was made for it.
    Nothing,
}

/// Enters a server under a name, or brings an older entry of ours up to date. The text is the same where it says all of
/// this already.
///
/// # Errors
/// If the text is no configuration, or if the name belongs to another server.
pub(crate) fn enter(text: &str, host: Host, name: &str, entry: &Entry) -> Result<String, EditError> {
    let (mark, body) = split_mark(text);
    let root = parse(body)?;
    let top = match root.value() {
        None => root.object_value_or_set(),
        Some(value) => value.as_object().ok_or_else(|| no_object("the whole file"))?,
    };
    let servers = match servers(&top, host)? {
        Some(servers) => servers,
        None => top.object_value_or_set(host.servers_key()),
    };
    let keys = entry.keys(host.transport());
    match servers.get(name) {
        None => {
            servers.append(name, input(&Value::Object(keys)));
        }
        Some(property) => {
            let present = property.object_value().ok_or_else(|| not_ours(name))?;
            if present.to_serde_value().as_ref().and_then(Entry::ours).is_none() {
                return Err(not_ours(name));
            }
            update(&present, &keys);
        }
    }
    Ok(format!("{mark}{root}"))
}

/// Removes the entry of a name. Where `before` or an empty file together with the entry gives this text, nobody else has
/// changed anything since, and what was there before is given back to the byte.
///
/// # Errors
/// If the text is no configuration, or if the name belongs to another server.
pub(crate) fn remove(
    text: &str,
    before: Option<&str>,
    host: Host,
    name: &str,
) -> Result<Remainder, EditError> {
    let (mark, body) = split_mark(text);
    let root = parse(body)?;
    let servers = match root.object_value() {
        Some(top) => servers(&top, host)?,
        None => None,
    };
    let Some(property) = servers.and_then(|servers| servers.get(name)) else {
        return Ok(Remainder::Unchanged);
    };
    let value = property.value().and_then(|value| value.to_serde_value());
    let entry = value.as_ref().and_then(Entry::ours).ok_or_else(|| not_ours(name))?;
    let made_this = |earlier: &str| enter(earlier, host, name, &entry).is_ok_and(|made| made == text);
    let without = |earlier: &str| remove(earlier, None, host, name) == Ok(Remainder::Unchanged);
    if let Some(before) = before.filter(|before| without(before) && made_this(before)) {
        return Ok(Remainder::Text(before.to_owned()));
    }
    if made_this("") {
        return Ok(Remainder::Nothing);
    }
    property.remove();
    Ok(Remainder::Text(format!("{mark}{root}")))
}

/// Every server of ours, by name.
///
/// # Errors
/// If the text is no configuration.
pub(crate) fn entries(text: &str, host: Host) -> Result<Vec<(String, Entry)>, EditError> {
    let root = parse(split_mark(text).1)?;
    let Some(value) = root.value() else { return Ok(Vec::new()) };
    let top = value.as_object().ok_or_else(|| no_object("the whole file"))?;
    let properties = servers(&top, host)?.map(|servers| servers.properties()).unwrap_or_default();
    let ours = properties.iter().filter_map(|property| {
        let entry = Entry::ours(&property.value()?.to_serde_value()?)?;
        Some((property.decoded_name()?, entry))
    });
    Ok(ours.collect())
}

/// The mark that some Windows editors put in front of a text, and the text.
fn split_mark(text: &str) -> (&str, &str) {
    match text.strip_prefix('\u{feff}') {
        Some(body) => ("\u{feff}", body),
        None => ("", text),
    }
}

fn parse(text: &str) -> Result<CstRootNode, EditError> {
    let options = ParseOptions {
        allow_comments: true,
        allow_trailing_commas: true,
        allow_loose_object_property_names: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    CstRootNode::parse(text, &options).map_err(|error| EditError::Syntax {
        line: error.line_display(),
        column: error.column_display(),
        message: error.kind().to_string(),
    })
}

fn servers(top: &CstObject, host: Host) -> Result<Option<CstObject>, EditError> {
    let key = host.servers_key();
    match top.get(key) {
        None => Ok(None),
        Some(property) => property.object_value().map(Some).ok_or_else(|| no_object(&format!("{key:?}"))),
    }
}

/// Sets the keys that differ. Others stay, such as an `env` that the user has added.
fn update(present: &CstObject, keys: &Map<String, Value>) {
    for (key, value) in keys {
        match present.get(key) {
            None => {
                present.append(key, input(value));
            }
            Some(property) => {
                let known = property.value().and_then(|value| value.to_serde_value());
                if known.as_ref() != Some(value) {
                    property.set_value(input(value));
                }
            }
        }
    }
}

fn input(value: &Value) -> CstInputValue {
    match value {
        Value::Null => CstInputValue::Null,
        Value::Bool(truth) => CstInputValue::Bool(*truth),
        Value::Number(number) => CstInputValue::Number(number.to_string()),
        Value::String(text) => CstInputValue::String(text.clone()),
        Value::Array(items) => CstInputValue::Array(items.iter().map(input).collect()),
        Value::Object(keys) => {
            CstInputValue::Object(keys.iter().map(|(key, value)| (key.clone(), input(value))).collect())
        }
    }
}

fn no_object(what: &str) -> EditError {
    EditError::NoObject { what: what.to_owned() }
}

fn not_ours(name: &str) -> EditError {
    EditError::NotOurs { name: name.to_owned() }
}

#[cfg(test)]
mod tests;
