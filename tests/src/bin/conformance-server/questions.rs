//! Tools that say or ask something while a call is under way, as clients of 2025-11-25 know it.
#![expect(deprecated, reason = "the suite also judges what newer revisions have left behind")]

use std::time::Duration;

use rmcp::model::{
    CallToolResult, ClientCapabilities, ContentBlock, ElicitRequestParams, JsonObject, LoggingLevel,
    LoggingMessageNotificationParam, ProgressNotificationParam, ProtocolVersion, Tool,
};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer};
use serde_json::{Value, json};
use tokio::time::sleep;

use crate::content::{self, tool};

/// The suite wants to see that notifications come one by one.
const PAUSE: Duration = Duration::from_millis(50);

/// The tools.
pub(crate) fn tools() -> Vec<Tool> {
    let plain = [
        "test_tool_with_logging",
        "test_logging_tool",
        "test_tool_with_progress",
        "test_reconnection",
        "test_missing_capability",
        "test_elicitation_sep1034_defaults",
        "test_elicitation_sep1330_enums",
    ];
    let mut tools = Vec::from(plain.map(|name| tool(name, json!({"type": "object"}))));
    for (name, argument) in [("test_sampling", "prompt"), ("test_elicitation", "message")] {
        let properties = json!({argument: {"type": "string"}});
        tools.push(tool(name, json!({"type": "object", "properties": properties, "required": [argument]})));
    }
    tools
}

/// Calls one of the tools; `None` where there is no such tool here.
pub(crate) async fn call(
    name: &str,
    arguments: &JsonObject,
    context: &RequestContext<RoleServer>,
) -> Option<Result<CallToolResult, ErrorData>> {
    let argument = |name: &str| arguments.get(name).and_then(Value::as_str).unwrap_or_default();
    let said = match name {
        "test_tool_with_logging" | "test_logging_tool" => log(context).await,
        "test_tool_with_progress" => report_progress(context).await,
        "test_reconnection" => {
            sleep(2 * PAUSE).await;
            Ok("Reconnection test completed".to_owned())
        }
        "test_missing_capability" => return Some(need_sampling(context)),
        "test_sampling" => sample(argument("prompt"), context).await,
        "test_elicitation" => elicit(argument("message"), user_form(), context).await,
        "test_elicitation_sep1034_defaults" => {
            elicit("All fields have defaults", defaults_form(), context).await
        }
        "test_elicitation_sep1330_enums" => elicit("Choose", choices_form(), context).await,
        _ => return None,
    };
    Some(Ok(match said {
        Ok(text) => CallToolResult::success(vec![ContentBlock::text(text)]),
        Err(text) => CallToolResult::error(vec![ContentBlock::text(text)]),
    }))
}

/// Logs, unless the client is of 2026-07-28 and did not say that it wants to read the log of this request.
async fn log(context: &RequestContext<RoleServer>) -> Result<String, String> {
    let is_modern =
        context.protocol_version().is_some_and(|version| version >= ProtocolVersion::V_2026_07_28);
    let is_wanted = !is_modern || context.meta.log_level().is_some();
    for line in ["Tool execution started", "Tool processing data", "Tool execution completed"] {
        if is_wanted {
            let line = LoggingMessageNotificationParam::new(LoggingLevel::Info, json!(line));
            context.peer.notify_logging_message(line).await.map_err(|source| source.to_string())?;
        }
        sleep(PAUSE).await;
    }
    Ok("Logging test completed".to_owned())
}

async fn report_progress(context: &RequestContext<RoleServer>) -> Result<String, String> {
    for progress in [0.0, 50.0, 100.0] {
        if let Some(token) = context.meta.get_progress_token() {
            let note = ProgressNotificationParam::new(token, progress).with_total(100.0);
            context.peer.notify_progress(note).await.map_err(|source| source.to_string())?;
        }
        sleep(PAUSE).await;
    }
    Ok("Progress test completed".to_owned())
}

fn need_sampling(context: &RequestContext<RoleServer>) -> Result<CallToolResult, ErrorData> {
    let able = context.client_capabilities().unwrap_or_default();
    if able.sampling.is_none() {
        let needed: ClientCapabilities = content::of(json!({"sampling": {}}));
        return Err(ErrorData::missing_required_client_capability(needed));
    }
    Ok(CallToolResult::success(vec![ContentBlock::text("The client can sample.")]))
}

async fn sample(prompt: &str, context: &RequestContext<RoleServer>) -> Result<String, String> {
    let message = json!({"role": "user", "content": {"type": "text", "text": prompt}});
    let request = content::of(json!({"messages": [message], "maxTokens": 100}));
    let result = context.peer.create_message(request).await.map_err(|source| source.to_string())?;
    let text = result.message.content.first().and_then(|content| content.as_text());
    Ok(format!("LLM response: {}", text.map_or("", |text| &text.text)))
}

async fn elicit(
    message: &str,
    schema: Value,
    context: &RequestContext<RoleServer>,
) -> Result<String, String> {
    let request: ElicitRequestParams =
        content::of(json!({"mode": "form", "message": message, "requestedSchema": schema}));
    let result = context.peer.create_elicitation(request).await.map_err(|source| source.to_string())?;
    Ok(format!("Elicitation completed: {}", json!(result)))
}

fn user_form() -> Value {
    json!({
        "type": "object",
        "properties": {
            "username": {"type": "string", "description": "User's response"},
            "email": {"type": "string", "description": "User's email address"},
        },
        "required": ["username", "email"],
    })
}

fn defaults_form() -> Value {
    json!({"type": "object", "properties": {
        "name": {"type": "string", "default": "John Doe"},
        "age": {"type": "integer", "default": 30},
        "score": {"type": "number", "default": 95.5},
        "status": {"type": "string", "enum": ["active", "inactive", "pending"], "default": "active"},
        "verified": {"type": "boolean", "default": true},
    }})
}

fn choices_form() -> Value {
    let options = ["option1", "option2", "option3"];
    let titled = |noun: &str| {
        let title = |(value, number)| json!({"const": value, "title": format!("{number} {noun}")});
        let values = [("value1", "First"), ("value2", "Second"), ("value3", "Third")];
        json!(values.map(title))
    };
    let names = ["Option One", "Option Two", "Option Three"];
    json!({"type": "object", "properties": {
        "untitledSingle": {"type": "string", "enum": options},
        "titledSingle": {"type": "string", "oneOf": titled("Option")},
        "legacyEnum": {"type": "string", "enum": ["opt1", "opt2", "opt3"], "enumNames": names},
        "untitledMulti": {"type": "array", "items": {"type": "string", "enum": options}},
        "titledMulti": {"type": "array", "items": {"anyOf": titled("Choice")}},
    }})
}
