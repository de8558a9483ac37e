//! `list_objects`: the things of the home and what is believed of them, page by page.

use std::fmt::Write as _;

use coin_schemas::household::UserName;
use coin_schemas::tools::{ListObjects, ListObjectsResult, ListedObject, MAX_LIMIT, display_name};

use super::fields::{self, quoted};
use super::{Effect, Tool, ToolError};
use crate::store::{Belief, Reader, Store, StoredObject};

/// What a cursor begins with; another layout of cursors would begin with something else.
const CURSOR_MARK: &str = "after-";

pub(super) struct ListObjectsTool;

impl Tool for ListObjectsTool {
    const NAME: &'static str = "list_objects";
    const TITLE: &'static str = "Things in the home";
    const DESCRIPTION: &'static str = "The things in the home, by id, with position and who is held to own them. \
        Other tools take the ids exactly as they stand here. Filter by class, owner or settled (false: things \
        about which a person may have to be asked). Where next_cursor is given there are more: call again \
        with it as cursor.";
    const EXAMPLE: &'static str = r#"{"class": "marker", "settled": false}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = ListObjects;
    type Output = ListObjectsResult;

    fn call(store: &Store, arguments: ListObjects) -> Result<ListObjectsResult, ToolError> {
        let limit = fields::within("limit", arguments.limit, &(1..=MAX_LIMIT))? as usize;
        let after = arguments.cursor.as_deref().map(read_cursor).transpose()?;
        store.read(|reader| {
            let filter = Filter::new(reader, &arguments)?;
            let mut beliefs = reader.beliefs()?;
            let matching: Vec<(StoredObject, Option<Belief>)> = reader
                .objects()?
                .into_iter()
                .map(|object| {
                    let belief = beliefs.remove(&object.key);
                    (object, belief)
                })
                .filter(|(object, belief)| filter.accepts(object, belief.as_ref()))
                .collect();
            let total = matching.len() as u64;
            let mut rest = matching
                .into_iter()
                .filter(|(object, _)| after.as_ref().is_none_or(|after| object.id.as_str() > after.as_str()))
                .peekable();
            let objects: Vec<ListedObject> =
                rest.by_ref().take(limit).map(|(object, belief)| listed(&object, belief.as_ref())).collect();
            let more = rest.peek().is_some();
            let next_cursor = objects.last().filter(|_| more).map(|last| write_cursor(last.id.as_str()));
            Ok(ListObjectsResult { objects, total, next_cursor })
        })
    }
}

/// Which things are wanted.
struct Filter {
    class: Option<String>,
    owner: Option<UserName>,
    settled: Option<bool>,
}

impl Filter {
    fn new(reader: &Reader<'_>, arguments: &ListObjects) -> Result<Self, ToolError> {
        let owner = arguments
            .owner
            .as_deref()
            .map(|name| {
                let household = fields::household(reader)?;
                let user = fields::user(&household, "owner", name)?;
                Ok::<_, ToolError>(household.roster().name(user).clone())
            })
            .transpose()?;
        let class = arguments.class.as_deref().map(str::to_lowercase);
        Ok(Self { class, owner, settled: arguments.settled })
    }

    fn accepts(&self, object: &StoredObject, belief: Option<&Belief>) -> bool {
        let settled = belief.is_some_and(Belief::is_settled);
        self.class.as_ref().is_none_or(|class| object.class.as_str().to_lowercase() == *class)
            && self.settled.is_none_or(|wanted| wanted == settled)
            && self
                .owner
                .as_ref()
                .is_none_or(|owner| belief.is_some_and(|belief| belief.owners().contains(owner)))
    }
}

fn listed(object: &StoredObject, belief: Option<&Belief>) -> ListedObject {
    ListedObject {
        id: object.id.clone(),
        name: display_name(&object.class),
        position: object.position,
        room: object.room.clone(),
        owners: belief.map(Belief::owners).cloned().unwrap_or_default(),
        confidence: belief.map_or(0.0, Belief::confidence),
        settled: belief.is_some_and(Belief::is_settled),
        source: belief.map(Belief::source),
    }
}

/// A cursor names the last thing of its page, so that a thing that is added meanwhile moves no page.
fn write_cursor(last_id: &str) -> String {
    let mut cursor = CURSOR_MARK.to_owned();
    for byte in last_id.bytes() {
        // Writing to a string does not fail.
        let _ = write!(cursor, "{byte:02x}");
    }
    cursor
}

fn read_cursor(cursor: &str) -> Result<String, ToolError> {
    let refuse = || {
        ToolError::field(
            "cursor",
            format!(
                "{} is no cursor of list_objects; give next_cursor of the page before, or leave it out for the first page",
                quoted(cursor)
            ),
        )
    };
    let digits = cursor.strip_prefix(CURSOR_MARK).filter(|digits| digits.is_ascii()).ok_or_else(refuse)?;
    let bytes = digits
        .as_bytes()
        .chunks(2)
        .map(|pair| str::from_utf8(pair).ok().and_then(|pair| u8::from_str_radix(pair, 16).ok()))
        .collect::<Option<Vec<u8>>>()
        .filter(|_| digits.len() % 2 == 0)
        .ok_or_else(refuse)?;
    String::from_utf8(bytes).map_err(|_| refuse())
}
