//! `add_user`: somebody joins the household.

use coin_schemas::household::{Background, MAX_NAME_BYTES, UserName};
use coin_schemas::tools::{AddUser, AddUserResult};

use super::fields;
use super::list_users::listed;
use super::{Effect, Tool, ToolError};
use crate::scene;
use crate::store::{Store, Writer};

pub(super) struct AddUserTool;

impl Tool for AddUserTool {
    const NAME: &'static str = "add_user";
    const TITLE: &'static str = "Add a member of the household";
    const DESCRIPTION: &'static str = "Adds somebody who has joined the household, or changes the role or occupation \
        of a member. What is believed of things that others have used stays as it is: the newcomer is a candidate \
        for things that this person has used, for those that nobody has used, and for those that come later. Things \
        that were everybody's are open again. Captions that name the newcomer and were recorded before count from now \
        on. It also takes the first members of an empty home.";
    const EXAMPLE: &'static str = r#"{"name": "Ann", "role": "flatmate"}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = AddUser;
    type Output = AddUserResult;

    fn call(store: &Store, arguments: AddUser) -> Result<AddUserResult, ToolError> {
        let name = UserName::new(arguments.name.trim())
            .map_err(|source| ToolError::field("name", source.to_string()))?;
        let background = Background {
            role: line("role", arguments.role)?,
            occupation: line("occupation", arguments.occupation)?,
        };
        store.write(|writer| add(writer, &name, background))
    }
}

fn add(writer: &Writer<'_>, name: &UserName, given: Background) -> Result<AddUserResult, ToolError> {
    let before = writer.household()?;
    let known = before.as_ref().and_then(|household| {
        let roster = household.roster();
        roster.index_of(name.as_str()).ok().map(|user| roster.background(user).clone())
    });
    let is_newcomer = known.is_none();
    let known = known.unwrap_or_default();
    let background =
        Background { role: given.role.or(known.role), occupation: given.occupation.or(known.occupation) };
    writer.put_user(name, &background)?;
    let household = fields::household(writer)?;
    let (mut attributed_events, mut reopened) = (0, Vec::new());
    if is_newcomer && writer.is_lived_in()? {
        let present = scene::present(writer)?;
        writer.put_joined_at(name, present)?;
        let household = fields::household(writer)?;
        attributed_events =
            writer.attribute_to(&household, fields::user(&household, "name", name.as_str())?)?;
        if let Some(before) = &before {
            let keys = writer.reopen_shared(before, present)?;
            let objects = writer.objects()?;
            reopened =
                objects.iter().filter(|object| keys.contains(&object.key)).map(fields::object_ref).collect();
        }
    }
    Ok(AddUserResult { users: listed(household.roster()), attributed_events, reopened })
}

/// One line that says something of a person.
fn line(field: &str, given: Option<String>) -> Result<Option<String>, ToolError> {
    let Some(text) = given.map(|text| text.trim().to_owned()).filter(|text| !text.is_empty()) else {
        return Ok(None);
    };
    if text.len() > MAX_NAME_BYTES {
        let length = text.len();
        return Err(ToolError::field(
            field,
            format!("it has {length} bytes; at most {MAX_NAME_BYTES} are allowed"),
        ));
    }
    if text.chars().any(char::is_control) {
        return Err(ToolError::field(field, "it holds a control character; one line of text is expected"));
    }
    Ok(Some(text))
}
