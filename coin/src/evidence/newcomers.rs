//! People who join a home do not put in doubt whose the things are that were there before them.

use std::collections::BTreeSet;

use coin_schemas::household::{ClassLabel, UserName, Users};
use coin_schemas::model::GivenContext;
use coin_schemas::tools::KnownOwnership;

use super::{EvidenceParameters, Opinion, WeighedContext};
use crate::common_sense::expect;
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::{Roster, RosterError};

/// Who can own a thing, as far as joining the household goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrivals {
    /// Those who were not there yet at the moment for which a thing is judged. They are no candidates.
    pub absent: OwnerSet,
    /// Those who joined after the thing was first used.
    pub newcomers: OwnerSet,
}

/// What the evidence model and the common sense about classes make of a thing of this class.
///
/// A newcomer who has not used the thing is no candidate: it is judged as if this person were not there. There is one
/// exception, a thing that then seems to be everybody's. Whether "everybody" now means the newcomer too is just what is
/// open, so that it is judged anew among all who are there; so is a thing that would be left without a candidate.
///
/// # Errors
/// If the context names people who are not of the household.
pub fn judge(
    roster: &Roster,
    arrivals: Arrivals,
    class: &ClassLabel,
    context: &GivenContext,
    parameters: &EvidenceParameters,
) -> Result<OwnerSetDistribution, RosterError> {
    let sessions = WeighedContext::new(roster, class, context)?.sessions;
    let members: OwnerSet = roster.indices().filter(|&user| !arrivals.absent.contains(user)).collect();
    let candidates: OwnerSet = members
        .iter()
        .filter(|&user| !arrivals.newcomers.contains(user) || sessions[user.place()] > 0)
        .collect();
    if candidates.is_empty() {
        return judge_among(roster, members, class, context, parameters);
    }
    let among = judge_among(roster, candidates, class, context, parameters)?;
    if among.best().0 == candidates && candidates.len() > 1 && candidates != members {
        return judge_among(roster, members, class, context, parameters);
    }
    Ok(among)
}

/// The same among some, or among all where nobody was there.
fn judge_among(
    roster: &Roster,
    candidates: OwnerSet,
    class: &ClassLabel,
    context: &GivenContext,
    parameters: &EvidenceParameters,
) -> Result<OwnerSetDistribution, RosterError> {
    if candidates == roster.everyone() || candidates.is_empty() {
        return judge_all(roster, class, context, parameters);
    }
    let users: Users =
        candidates.iter().map(|user| (roster.name(user).clone(), roster.background(user).clone())).collect();
    let among = judge_all(&Roster::new(&users)?, class, &told_to(&users, context), parameters)?;
    // The candidates keep their order, so that the i-th of the smaller roster is the i-th candidate.
    let places: Vec<_> = candidates.iter().collect();
    let widened = |set: OwnerSet| set.iter().filter_map(|user| places.get(user.place()).copied()).collect();
    Ok(OwnerSetDistribution::from_log_weights(
        among.entries().iter().map(|&(set, probability)| (widened(set), libm::log(probability))),
    ))
}

fn judge_all(
    roster: &Roster,
    class: &ClassLabel,
    context: &GivenContext,
    parameters: &EvidenceParameters,
) -> Result<OwnerSetDistribution, RosterError> {
    let expectation = expect(class.as_str(), roster);
    let opinion = Opinion::from(expectation.as_ref());
    Ok(WeighedContext::new(roster, class, context)?.posterior(opinion, parameters))
}

/// The context without what it says of others: what they own says nothing of a thing that they cannot own.
fn told_to(users: &Users, context: &GivenContext) -> GivenContext {
    let strangers = |known: &KnownOwnership| known.owners.iter().any(|owner| !users.contains_key(owner));
    let mut told = context.clone();
    let near = told.nearby_objects.iter_mut().map(|neighbour| &mut neighbour.known_ownership);
    let alike = told.similar_objects.iter_mut().map(|look_alike| &mut look_alike.known_ownership);
    for known in near.chain(alike) {
        if known.as_ref().is_some_and(strangers) {
            *known = None;
        }
    }
    if let Some(usage) = &mut told.usage {
        let members: BTreeSet<&UserName> = users.keys().collect();
        usage.user_summary.retain(|line| members.contains(&line.user_id));
    }
    told
}

#[cfg(test)]
mod tests;
