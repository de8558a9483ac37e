//! What is reliably known of a thing's owners, for its neighbours and look-alikes (the paper's BUILD-KNOWN).

use coin::roster::Roster;
use coin_schemas::household::{Owners, Score, Scores, Source};
use coin_schemas::tools::KnownOwnership;

use crate::store::Belief;

/// An inference is passed on as known from this confidence on. The paper passes on every inference, and so its
/// unsure guesses return as facts.
const LEAST_CONFIDENCE: f64 = 0.9;

/// The belief, if it was answered, or inferred with a confidence of at least 0.9.
pub(super) fn known_ownership(roster: &Roster, belief: &Belief) -> Option<KnownOwnership> {
    let scores = match belief {
        Belief::Answered { owners, .. } => indicator(roster, owners),
        Belief::Inferred(inference) if inference.confidence >= LEAST_CONFIDENCE => {
            complete(roster, &inference.scores)
        }
        Belief::Inferred(_) => return None,
    };
    Some(KnownOwnership { owners: belief.owners().clone(), scores, source: belief.source() })
}

/// What a person named.
pub(super) fn answered_ownership(roster: &Roster, owners: &Owners) -> KnownOwnership {
    KnownOwnership { owners: owners.clone(), scores: indicator(roster, owners), source: Source::Answer }
}

/// 1 for the owners and 0 for the other members.
fn indicator(roster: &Roster, owners: &Owners) -> Scores {
    let score = |name| if owners.contains(name) { Score::ONE } else { Score::ZERO };
    roster.names().map(|name| (name.clone(), score(name))).collect()
}

/// The scores, and 0 for members who have joined since.
fn complete(roster: &Roster, scores: &Scores) -> Scores {
    let score = |name| scores.get(name).copied().unwrap_or(Score::ZERO);
    roster.names().map(|name| (name.clone(), score(name))).collect()
}
