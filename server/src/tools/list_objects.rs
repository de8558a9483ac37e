//! `list_objects`: the things of the home and what is believed of them, page by page.

use coin_schemas::household::UserName;
use coin_schemas::tools::{ListObjects, ListObjectsResult, ListedObject, MAX_LIMIT, display_name};

use super::fields::{self, quoted};
use super::{Effect, Tool, ToolError};
use crate::cursor;
use crate::scene::Scene;
use crate::store::{Belief, Reader, Store, StoredObject};

pub(super) struct ListObjectsTool;

impl Tool for ListObjectsTool {
    const NAME: &'static str = "list_objects";
    const TITLE: &'static str = "Things in the home";
    const DESCRIPTION: &'static str = "The things in the home, by id, with position and who is held to own them. \
        Other tools take the ids exactly as they stand here. Owners are those that a person named or a model \
        handed in; ask whose_is about any other thing. Filter by class, owner or settled. Where next_cursor is \
        given there are more: call again with it as cursor.";
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
            let scene = if beliefs.is_empty() { None } else { Some(Scene::new(reader)?) };
            let mut matching: Vec<Held> = Vec::new();
            for object in reader.objects()? {
                let belief = beliefs.remove(&object.key);
                let settled = match (&belief, &scene) {
                    (Some(Belief::Answered { .. }), Some(scene)) => !scene.is_reopened(&object)?,
                    (belief, _) => belief.as_ref().is_some_and(Belief::is_settled),
                };
                matching.push(Held { object, belief, settled });
            }
            matching.retain(|held| filter.accepts(held));
            let total = matching.len() as u64;
            let mut rest = matching
                .into_iter()
                .filter(|held| after.as_ref().is_none_or(|after| held.object.id.as_str() > after.as_str()))
                .peekable();
            let objects: Vec<ListedObject> = rest.by_ref().take(limit).map(listed).collect();
            let more = rest.peek().is_some();
            let next_cursor = objects.last().filter(|_| more).map(|last| cursor::after(last.id.as_str()));
            Ok(ListObjectsResult { objects, total, next_cursor })
        })
    }
}

/// A thing and what is believed of it.
struct Held {
    object: StoredObject,
    belief: Option<Belief>,
    /// Whether no question is needed.
    settled: bool,
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

    fn accepts(&self, held: &Held) -> bool {
        let owned_by = |owner| held.belief.as_ref().is_some_and(|belief| belief.owners().contains(owner));
        self.class.as_ref().is_none_or(|class| held.object.class.as_str().to_lowercase() == *class)
            && self.settled.is_none_or(|wanted| wanted == held.settled)
            && self.owner.as_ref().is_none_or(owned_by)
    }
}

fn listed(Held { object, belief, settled }: Held) -> ListedObject {
    let belief = belief.as_ref();
    ListedObject {
        id: object.id.clone(),
        name: display_name(&object.class),
        position: object.shown_position(),
        room: object.room.clone(),
        owners: belief.map(Belief::owners).cloned().unwrap_or_default(),
        confidence: belief.map_or(0.0, Belief::confidence),
        settled,
        source: belief.map(Belief::source),
    }
}

fn read_cursor(given: &str) -> Result<String, ToolError> {
    cursor::read(given).ok_or_else(|| {
        ToolError::field(
            "cursor",
            format!(
                "{} is no cursor of list_objects; give next_cursor of the page before, or leave it out for the first page",
                quoted(given)
            ),
        )
    })
}
