//! `get_usage_summary`: who used a thing, how often and when.

use coin_schemas::tools::{GetUsageSummary, MAX_EXAMPLES, MAX_SESSIONS, MAX_WINDOW_DAYS, UsageSummary};

use super::fields;
use super::{Effect, Effort, Tool, ToolError};
use crate::scene::{Listed, Scene, Window};
use crate::store::Store;

pub(super) struct GetUsageSummaryTool;

impl Tool for GetUsageSummaryTool {
    const NAME: &'static str = "get_usage_summary";
    const TITLE: &'static str = "Usage summary of a thing";
    const DESCRIPTION: &'static str = "Who used a thing, how often, how and how long ago: the main evidence of \
        who owns it. Call it first when you judge an owner, then nearby_objects and similar_objects. Judge by \
        sessions, not by total_events: the events of one session are one decision to use the thing. Somebody \
        who used it a few times may have borrowed it; about equal use by several suggests that they \
        share it.";
    const EXAMPLE: &'static str = r#"{"object_id": "3"}"#;
    const EFFECT: Effect = Effect::Reads;
    const EFFORT: Effort = Effort::Brief;

    type Arguments = GetUsageSummary;
    type Output = UsageSummary;

    fn call(store: &Store, arguments: GetUsageSummary) -> Result<UsageSummary, ToolError> {
        let days = fields::within("window_days", arguments.window_days, &(1..=MAX_WINDOW_DAYS))?;
        let max_examples = fields::within("max_examples", arguments.max_examples, &(0..=MAX_EXAMPLES))?;
        let max_sessions = fields::within("max_sessions", arguments.max_sessions, &(0..=MAX_SESSIONS))?;
        let listed = Listed { examples: max_examples as usize, sessions: max_sessions as usize };
        let as_of = fields::time("as_of", arguments.as_of.as_deref())?;
        store.read(|reader| {
            let object = fields::object(reader, &arguments.object_id)?;
            let scene = Scene::new(reader)?;
            let as_of = match as_of {
                Some(given) => given,
                None => scene.present()?,
            };
            Ok(scene.usage(&object, Window { as_of, days }, listed)?)
        })
    }
}
