//! Last-User, in the manner of Tan, Brawer and Scassellati, *That's Mine! Learning Ownership Relations and Norms for
//! Robots* (2019): who used a thing last owns it.

use crate::owners::OwnerSet;
use crate::usage::UsageEvent;

/// The most recent attributed user; of events at the same moment the later in the list counts. Nobody where no event
/// has an actor.
pub fn last_user(events: &[UsageEvent]) -> OwnerSet {
    events
        .iter()
        .filter_map(|event| event.actor.map(|actor| (event.at_seconds, actor)))
        .max_by_key(|&(at_seconds, _)| at_seconds)
        .map_or(OwnerSet::EMPTY, |(_, actor)| OwnerSet::single(actor))
}
