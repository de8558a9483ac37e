//! What some tools tell, for others who show it.

use coin_schemas::tools::{ListObjects, ListUsers, WhoseIs};
use serde_json::Value;

use super::list_objects::ListObjectsTool;
use super::list_users::ListUsersTool;
use super::whose_is::WhoseIsTool;
use super::{Tool, ToolError};
use crate::store::Store;

/// The people, as `list_users` tells of them.
pub(crate) fn household(store: &Store, arguments: ListUsers) -> Result<Value, ToolError> {
    told::<ListUsersTool>(store, arguments)
}

/// The things, as `list_objects` tells of them.
pub(crate) fn objects(store: &Store, arguments: ListObjects) -> Result<Value, ToolError> {
    told::<ListObjectsTool>(store, arguments)
}

/// A thing, as `whose_is` tells of it.
pub(crate) fn whose_is(store: &Store, arguments: WhoseIs) -> Result<Value, ToolError> {
    told::<WhoseIsTool>(store, arguments)
}

fn told<T: Tool>(store: &Store, arguments: T::Arguments) -> Result<Value, ToolError> {
    serde_json::to_value(T::call(store, arguments)?).map_err(ToolError::Output)
}
