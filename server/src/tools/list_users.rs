//! `list_users`: who lives in the home.

use coin::roster::Roster;
use coin_schemas::household::Background;
use coin_schemas::tools::{ListUsers, ListUsersResult, ListedUser};

use super::{Effect, Effort, Tool, ToolError};
use crate::store::Store;

pub(super) struct ListUsersTool;

impl Tool for ListUsersTool {
    const NAME: &'static str = "list_users";
    const TITLE: &'static str = "Members of the household";
    const DESCRIPTION: &'static str = "The members of the household with their roles and occupations: all \
        candidates for an owner. Other tools take their names exactly as they stand here.";
    const EXAMPLE: &'static str = "{}";
    const EFFECT: Effect = Effect::Reads;
    const EFFORT: Effort = Effort::Brief;

    type Arguments = ListUsers;
    type Output = ListUsersResult;

    fn call(store: &Store, _: ListUsers) -> Result<ListUsersResult, ToolError> {
        let household = store.read(|reader| Ok::<_, ToolError>(reader.household()?))?;
        let users = household.map(|household| listed(household.roster())).unwrap_or_default();
        Ok(ListUsersResult { users })
    }
}

/// The members by name.
pub(super) fn listed(roster: &Roster) -> Vec<ListedUser> {
    roster
        .indices()
        .map(|user| {
            let Background { role, occupation } = roster.background(user).clone();
            ListedUser { name: roster.name(user).clone(), role, occupation }
        })
        .collect()
}
