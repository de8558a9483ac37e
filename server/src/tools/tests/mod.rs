mod arguments;
mod asking;
mod definitions;
mod joining;
mod judging;
mod observing;
mod reading;
mod recording;
mod retracting;

use rmcp::model::JsonObject;
use serde_json::Value;

use super::{Person, Registry, ToolError, ToolSelection, Turn};
use crate::store::{Access, Store};

fn registry() -> Registry {
    Registry::new(&ToolSelection::all(), Access::ReadWrite)
}

fn call(store: &Store, tool: &str, arguments: Value) -> Result<Value, ToolError> {
    let arguments: JsonObject = serde_json::from_value(arguments).unwrap();
    match registry().get(tool).unwrap().call(store, &arguments, Person::OutOfReach)? {
        Turn::Done(result) => Ok(result),
        Turn::Ask(form) => panic!("{tool} gave a form to a client that shows none: {form:?}"),
    }
}

/// The result of a call that is in order.
fn done(store: &Store, tool: &str, arguments: Value) -> Value {
    call(store, tool, arguments).unwrap()
}

/// The message of a call that is not.
fn refused(store: &Store, tool: &str, arguments: Value) -> String {
    call(store, tool, arguments).expect_err("the call was accepted").to_string()
}
