//! Frequency, in the manner of Wu et al., *Item Ownership Relationship Semantic Learning Strategy for Personalized
//! Service Robot* (2020): who used a thing most often owns it.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::owners::OwnerSet;
use crate::roster::UserIndex;
use crate::usage::UsageEvent;

/// The user with most events; of equals the one seen last, and then the first by name. Nobody where no event has an
/// actor.
pub fn frequency(events: &[UsageEvent]) -> OwnerSet {
    let mut counts: BTreeMap<UserIndex, (usize, i64)> = BTreeMap::new();
    for event in events {
        if let Some(actor) = event.actor {
            let (count, last) = counts.entry(actor).or_insert((0, event.at_seconds));
            *count += 1;
            *last = event.at_seconds.max(*last);
        }
    }
    counts
        .into_iter()
        .max_by_key(|&(actor, (count, last))| (count, last, Reverse(actor)))
        .map_or(OwnerSet::EMPTY, |(actor, _)| OwnerSet::single(actor))
}
