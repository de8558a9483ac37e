//! Checks that several tools make on their fields.

use std::fmt::Display;
use std::ops::RangeInclusive;

use coin::roster::UserIndex;
use coin_schemas::household::UserName;
use coin_schemas::tools::{MAX_TEXT_BYTES, ObjectRef, PlacedObjectRef, display_name};
use jiff::civil::DateTime;
use jiff::{ToSpan, Zoned};

use super::ToolError;
use crate::near_miss;
use crate::store::{Household, Reader, StoreError, StoredObject};

/// How many ids a message names.
const NAMED_IDS: usize = 3;

/// How much of a wrong value a message repeats, in characters.
pub(super) const QUOTED_CHARACTERS: usize = 80;

/// The thing of this id.
pub(super) fn object(reader: &Reader<'_>, id: &str) -> Result<StoredObject, ToolError> {
    match reader.object(id)? {
        Some(object) => Ok(object),
        None => Err(ToolError::field("object_id", unknown_object(reader, id)?)),
    }
}

/// Says that there is no thing of this id, and which may be meant: models give a class for an id.
pub(super) fn unknown_object(reader: &Reader<'_>, id: &str) -> Result<String, StoreError> {
    let objects = reader.objects()?;
    let class = id.to_lowercase();
    let of_class: Vec<String> = objects
        .iter()
        .filter(|object| object.class.as_str().to_lowercase() == class)
        .take(NAMED_IDS)
        .map(|object| format!("{:?}", object.id.as_str()))
        .collect();
    let hint = if of_class.is_empty() {
        near_miss::hint(id, objects.iter().map(|object| object.id.as_str()))
    } else {
        format!(" Of that class are {}.", of_class.join(", "))
    };
    Ok(format!("there is no object {}.{hint} list_objects gives all ids.", quoted(id)))
}

/// The members of the household.
pub(super) fn household(reader: &Reader<'_>) -> Result<Household, ToolError> {
    Ok(reader.household()?.ok_or(StoreError::NobodyLivesHere)?)
}

/// The member of this name.
pub(super) fn user(household: &Household, field: &str, name: &str) -> Result<UserIndex, ToolError> {
    household.roster().index_of(name).map_err(|_| {
        let names = || household.roster().names().map(UserName::as_str);
        ToolError::field(
            field,
            format!(
                "{} is no member of the household.{} The members are {}.",
                quoted(name),
                near_miss::hint(name, names()),
                names().collect::<Vec<_>>().join(", ")
            ),
        )
    })
}

/// A number within its range.
pub(super) fn within<N: PartialOrd + Display + Copy>(
    field: &str,
    given: N,
    allowed: &RangeInclusive<N>,
) -> Result<N, ToolError> {
    if allowed.contains(&given) {
        Ok(given)
    } else {
        Err(ToolError::field(
            field,
            format!("{given} is out of range; from {} to {} is allowed", allowed.start(), allowed.end()),
        ))
    }
}

/// A text that fits into the store and into a conversation.
pub(super) fn text<'a>(field: &str, given: &'a str) -> Result<&'a str, ToolError> {
    if given.len() > MAX_TEXT_BYTES {
        let length = given.len();
        Err(ToolError::field(field, format!("it has {length} bytes; at most {MAX_TEXT_BYTES} are allowed")))
    } else {
        Ok(given)
    }
}

/// A local time, where one was given.
pub(super) fn time(field: &str, given: Option<&str>) -> Result<Option<DateTime>, ToolError> {
    given
        .map(|text| {
            text.trim().parse().map_err(|_| {
                ToolError::field(
                    field,
                    format!(
                        "{} is no local time that exists; give one without a time zone, such as 2025-01-19T19:00:00",
                        quoted(text)
                    ),
                )
            })
        })
        .transpose()
}

/// A wrong value as a message repeats it: quoted, and not longer than a line.
pub(crate) fn quoted(text: &str) -> String {
    match text.char_indices().nth(QUOTED_CHARACTERS) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}

pub(super) fn object_ref(object: &StoredObject) -> ObjectRef {
    ObjectRef { id: object.id.clone(), name: display_name(&object.class) }
}

pub(super) fn placed_object_ref(object: &StoredObject) -> PlacedObjectRef {
    PlacedObjectRef {
        id: object.id.clone(),
        name: display_name(&object.class),
        position: object.shown_position(),
    }
}

/// A day from now by the wall clock; no camera has seen anything later.
pub(super) fn tomorrow() -> DateTime {
    Zoned::now().datetime().saturating_add(1.day())
}
