//! Who used a thing, how often and when.

use std::collections::BTreeMap;

use coin::captions::{Action, civil_seconds};
use coin::usage::{UserStatistics, days_since, session_order, summarise};
use coin_schemas::tools::{DEFAULT_WINDOW_DAYS, ObjectRef, UsageSummary, UserUsage, display_name};
use jiff::civil::DateTime;

use super::Scene;
use crate::store::{Household, StoreError, StoredObject, UsageLog};

const SECONDS_A_DAY: i64 = 86_400;

/// The part of the past that is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    /// Its end; what came later is hidden.
    pub(crate) as_of: DateTime,
    /// Its length.
    pub(crate) days: u32,
}

impl Window {
    /// As long as `get_usage_summary` looks back by default.
    pub(crate) fn usual(as_of: DateTime) -> Self {
        Self { as_of, days: DEFAULT_WINDOW_DAYS }
    }
}

/// How much of a usage is listed, the latest of each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Listed {
    /// Captions of each person.
    pub(crate) examples: usize,
    /// Sessions.
    pub(crate) sessions: usize,
}

impl Scene<'_> {
    /// The use of a thing.
    pub(crate) fn usage(
        &self,
        object: &StoredObject,
        window: Window,
        listed: Listed,
    ) -> Result<UsageSummary, StoreError> {
        let last = civil_seconds(window.as_of);
        let first = last.saturating_sub(i64::from(window.days) * SECONDS_A_DAY);
        let log = self.reader.usage(&self.household, object.key, first, last)?;
        let statistics = summarise(&log.events, listed.examples);
        let order = session_order(&log.events);
        let left_out = order.len().saturating_sub(listed.sessions);
        Ok(UsageSummary {
            object: ObjectRef { id: object.id.clone(), name: display_name(&object.class) },
            as_of: window.as_of,
            window_days: window.days,
            user_summary: statistics
                .users
                .iter()
                .map(|user| usage_of(user, &self.household, &log, last))
                .collect(),
            unattributed_events: statistics.unattributed_events,
            session_order: order[left_out..]
                .iter()
                .map(|&user| self.household.roster().name(user).clone())
                .collect(),
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
