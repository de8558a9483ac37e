//! Resources: the home as documents that a host can show or attach.

use std::borrow::Cow;

use coin::map::detection::Sighting;
use coin_schemas::household::ObjectId;
use coin_schemas::tools::{ListObjects, ListUsers, MAX_LIMIT, ObjectRef, WhoseIs, display_name};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use rmcp::ErrorData;
use rmcp::model::{ListResourcesResult, Resource, ResourceContents, ResourceTemplate};
use serde_json::{Value, json};

use crate::cursor;
use crate::scene::Scene;
use crate::store::{Reader, RecordedAnswer, Store, StoreError, StoredObject};
use crate::tools::document;

const HOUSEHOLD: &str = "coin://household";
const OBJECTS: &str = "coin://objects";
const HISTORY: &str = "history";

const JSON: &str = "application/json";

/// How many resources a page of their list holds.
const PAGE: usize = 100;

/// How many captions a history shows, the latest ones.
const CAPTIONS_SHOWN: usize = 200;

/// How many sightings a history shows, the latest ones.
const SIGHTINGS_SHOWN: u32 = 50;

/// Everything but letters, digits and what RFC 3986 leaves unreserved.
const RESERVED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~');

/// What a URI names.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Document {
    Household,
    Objects,
    Object(String),
    History(String),
}

impl Document {
    /// Reads a URI. Ids are percent-encoded in it; there are no folders, and `..` is an id like any other.
    fn of(uri: &str) -> Option<Self> {
        let decoded = |text: &str| percent_decode_str(text).decode_utf8().ok().map(Cow::into_owned);
        match uri {
            HOUSEHOLD => Some(Self::Household),
            OBJECTS => Some(Self::Objects),
            _ => {
                let rest = uri.strip_prefix(OBJECTS)?.strip_prefix('/')?;
                match rest.split_once('/') {
                    None => decoded(rest).map(Self::Object),
                    Some((id, HISTORY)) => decoded(id).map(Self::History),
                    Some(_) => None,
                }
            }
        }
    }
}

fn uri_of(id: &ObjectId) -> String {
    format!("{OBJECTS}/{}", utf8_percent_encode(id.as_str(), RESERVED))
}

/// The templates of the resources that every thing has.
pub(super) fn templates() -> Vec<ResourceTemplate> {
    vec![
        ResourceTemplate::new(format!("{OBJECTS}/{{object_id}}"), "object")
            .with_title("A thing and its owners")
            .with_description("Whose a thing is held to be, how surely and why, as whose_is tells it.")
            .with_mime_type(JSON),
        ResourceTemplate::new(format!("{OBJECTS}/{{object_id}}/{HISTORY}"), "object-history")
            .with_title("The history of a thing")
            .with_description(
                "What was seen of a thing, where it was, and what people said of it, oldest first.",
            )
            .with_mime_type(JSON),
    ]
}

/// A page of the resources: the home as a whole, then every thing by id.
pub(super) fn list(store: &Store, cursor: Option<&str>) -> Result<ListResourcesResult, ErrorData> {
    let after = cursor.map(|cursor| {
        cursor::read(cursor).ok_or_else(|| {
            ErrorData::invalid_params(
                format!(
                    "cursor: {cursor:?} is none of this list; give nextCursor of the page before, or none"
                ),
                None,
            )
        })
    });
    let after = after.transpose()?;
    store
        .read(|reader| Ok::<_, StoreError>(page(&reader.objects()?, after.as_deref())))
        .map_err(|source| internal(&source))
}

fn page(objects: &[StoredObject], after: Option<&str>) -> ListResourcesResult {
    let mut page = if after.is_none() { of_home() } else { Vec::new() };
    let mut rest =
        objects.iter().filter(|object| after.is_none_or(|after| object.id.as_str() > after)).peekable();
    let mut last = None;
    for object in rest.by_ref().take(PAGE) {
        page.push(of_thing(object));
        last = Some(&object.id);
    }
    let next_cursor = last.filter(|_| rest.peek().is_some()).map(|last| cursor::after(last.as_str()));
    ListResourcesResult { next_cursor, ..ListResourcesResult::with_all_items(page) }
}

/// The documents about the home as a whole.
fn of_home() -> Vec<Resource> {
    vec![
        Resource::new(HOUSEHOLD, "household")
            .with_title("The people")
            .with_description("The members of the household with their roles and occupations.")
            .with_mime_type(JSON),
        Resource::new(OBJECTS, "objects")
            .with_title("The things")
            .with_description(
                "The first 500 things of the home, where they are and who is recorded to own them.",
            )
            .with_mime_type(JSON),
    ]
}

fn of_thing(object: &StoredObject) -> Resource {
    let name = display_name(&object.class);
    let place = object.room.as_ref().map_or(String::new(), |room| format!(" in the {room}"));
    Resource::new(uri_of(&object.id), object.id.as_str())
        .with_title(format!("{name}{place}"))
        .with_mime_type(JSON)
}

/// The document of a URI.
pub(super) fn read(store: &Store, uri: &str) -> Result<ResourceContents, ErrorData> {
    let unknown = || {
        ErrorData::resource_not_found(
            format!(
                "there is no resource {uri:?}; there are {HOUSEHOLD}, {OBJECTS}, {OBJECTS}/ID and \
                 {OBJECTS}/ID/{HISTORY}, with ids percent-encoded"
            ),
            Some(json!({"uri": uri})),
        )
    };
    let document = Document::of(uri).ok_or_else(unknown)?;
    let content = match document {
        Document::Household => document::household(store, ListUsers {}),
        Document::Objects => {
            document::objects(store, ListObjects { limit: MAX_LIMIT, ..ListObjects::default() })
        }
        Document::Object(id) if is_known(store, &id)? => {
            document::whose_is(store, WhoseIs { object_id: id, as_of: None })
        }
        Document::History(id) if is_known(store, &id)? => {
            Ok(history(store, &id).map_err(|source| internal(&source))?)
        }
        Document::Object(_) | Document::History(_) => return Err(unknown()),
    };
    let content = content.map_err(|source| ErrorData::internal_error(source.to_string(), None))?;
    Ok(ResourceContents::text(content.to_string(), uri).with_mime_type(JSON))
}

fn is_known(store: &Store, id: &str) -> Result<bool, ErrorData> {
    store
        .read(|reader| Ok::<_, StoreError>(reader.object_key(id)?.is_some()))
        .map_err(|source| internal(&source))
}

/// What was seen of a thing and what people said of it.
fn history(store: &Store, id: &str) -> Result<Value, StoreError> {
    store.read(|reader: &Reader<'_>| {
        let scene = Scene::new(reader)?;
        let Some(object) = reader.object(id)? else { return Ok(Value::Null) };
        let log = reader.usage(scene.household(), object.key, i64::MIN, i64::MAX)?;
        let omitted = log.events.len().saturating_sub(CAPTIONS_SHOWN);
        let captions: Vec<&str> = (omitted..log.events.len()).map(|place| log.caption(place)).collect();
        let answers = reader.answers(scene.household(), object.key)?;
        let sightings = reader.latest_sightings(object.key, SIGHTINGS_SHOWN)?;
        let shown = sightings.len() as u64;
        let changes = reader.changes(object.key)?;
        let places = reader.former_places(object.key)?;
        Ok(json!({
            "object": ObjectRef { id: object.id, name: display_name(&object.class) },
            "captions": captions,
            "omitted_captions": omitted,
            "answers": answers.iter().map(of_answer).collect::<Vec<_>>(),
            "sightings": sightings.iter().map(|(_, sighting)| of_sighting(sighting)).collect::<Vec<_>>(),
            "omitted_sightings": reader.sighting_count(object.key)? - shown,
            "former_places": places
                .iter()
                .map(|place| json!({"position": place.position, "until": place.until}))
                .collect::<Vec<_>>(),
            "changes": changes
                .iter()
                .map(|change| json!({"kind": change.kind.as_str(), "other": change.other, "at": change.at}))
                .collect::<Vec<_>>(),
        }))
    })
}

fn of_sighting(sighting: &Sighting) -> Value {
    let mut told = json!({"at": sighting.at, "class": sighting.class, "position": sighting.position});
    if let Some(view) = &sighting.view {
        told["view"] = json!(view.0);
    }
    told
}

fn of_answer(answer: &RecordedAnswer) -> Value {
    let mut told = json!({
        "at": answer.at,
        "question": answer.question,
        "answer": answer.answer,
        "owners": answer.owners(),
        "owner_outside_household": answer.owner_outside_household,
        "status": answer.status,
    });
    let further = [
        ("answered_by", json!(answer.answered_by)),
        ("retracted_at", json!(answer.retracted_at)),
        ("reopened_at", json!(answer.reopened_at)),
    ];
    for (field, value) in further.into_iter().filter(|(_, value)| !value.is_null()) {
        told[field] = value;
    }
    told
}

pub(super) fn internal(source: &StoreError) -> ErrorData {
    ErrorData::internal_error(source.to_string(), None)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_id_has_a_uri_of_its_own(id in "[^\\p{Cc}]{1,20}") {
            let Ok(id) = ObjectId::new(id.as_str()) else { return Ok(()) };
            let uri = uri_of(&id);
            prop_assert!(uri.is_ascii());
            prop_assert_eq!(Document::of(&uri), Some(Document::Object(id.to_string())));
            prop_assert_eq!(Document::of(&format!("{uri}/history")), Some(Document::History(id.to_string())));
        }

        #[test]
        fn no_uri_is_too_strange(uri in ".*") {
            let _ = Document::of(&uri);
        }
    }

    #[test]
    fn there_are_no_folders() {
        for uri in [
            "coin://objects/../household",
            "coin://objects/1/2/history",
            "coin://objects/1/",
            "file:///etc/passwd",
        ] {
            assert_eq!(Document::of(uri), None, "{uri}");
        }
        assert_eq!(
            Document::of("coin://objects/%2e%2e%2f"),
            Some(Document::Object("../".to_owned())),
            "it is an id like any other"
        );
        assert_eq!(Document::of("coin://objects/%ff"), None);
    }
}
