//! `get_usage_summary`: who used a thing, how often and when.

use std::collections::BTreeMap;

use coin::captions::{Action, civil_seconds};
use coin::usage::{UserStatistics, days_since, summarise};
use coin_schemas::tools::{GetUsageSummary, MAX_EXAMPLES, MAX_WINDOW_DAYS, UsageSummary, UserUsage};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::store::{Household, Store, UsageLog};

const SECONDS_A_DAY: i64 = 86_400;

pub(super) struct GetUsageSummaryTool;

impl Tool for GetUsageSummaryTool {
    const NAME: &'static str = "get_usage_summary";
    const TITLE: &'static str = "Usage summary of a thing";
    const DESCRIPTION: &'static str = "Who used a thing, how often, how and how long ago: the main evidence of \
        who owns it. Call it first when you judge an owner, then nearby_objects and similar_objects. Judge by \
        sessions, not by total_events: the events of one session are one decision to use the thing. Somebody \
        who used it a few times may have borrowed it; about equal use by several people suggests that they \
        share it. as_of defaults to the home's present.";
    const EXAMPLE: &'static str = r#"{"object_id": "3"}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = GetUsageSummary;
    type Output = UsageSummary;

    fn call(store: &Store, arguments: GetUsageSummary) -> Result<UsageSummary, ToolError> {
        let window_days = fields::within("window_days", arguments.window_days, &(1..=MAX_WINDOW_DAYS))?;
        let max_examples = fields::within("max_examples", arguments.max_examples, &(0..=MAX_EXAMPLES))?;
        let as_of = fields::time("as_of", arguments.as_of.as_deref())?;
        store.read(|reader| {
            let object = fields::object(reader, &arguments.object_id)?;
            let household = fields::household(reader)?;
            let as_of = match as_of {
                Some(given) => given,
                None => fields::present(reader)?,
            };
            let last = civil_seconds(as_of);
            let first = last.saturating_sub(i64::from(window_days) * SECONDS_A_DAY);
            let log = reader.usage(&household, object.key, first, last)?;
            let statistics = summarise(&log.events, max_examples as usize);
            Ok(UsageSummary {
                object: fields::object_ref(&object),
                as_of,
                window_days,
                user_summary: statistics
                    .users
                    .iter()
                    .map(|user| usage_of(user, &household, &log, last))
                    .collect(),
                unattributed_events: statistics.unattributed_events,
            })
        })
    }
}

fn usage_of(user: &UserStatistics, household: &Household, log: &UsageLog, as_of_seconds: i64) -> UserUsage {
    let actions: BTreeMap<String, u64> = user
        .actions
        .iter()
        .zip(0..)
        .filter(|&(&events, _)| events > 0)
        .filter_map(|(&events, code)| Some((Action::from_code(code)?.as_str().to_owned(), events)))
        .collect();
    UserUsage {
        user_id: household.roster().name(user.user).clone(),
        total_events: user.total_events,
        sessions: user.sessions,
        actions,
        last_used_days_ago: days_since(user.last_at_seconds, as_of_seconds),
        example_events: user.examples.iter().map(|&place| log.caption(place).to_owned()).collect(),
    }
}
