//! What a camera made of the sessions: some are missed, some are put down to the wrong person or to nobody.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::parameters::RoutineParameters;
use super::plan::Minute;
use super::sessions::{Action, Session};

/// One event and what became of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sighting {
    pub(super) day: usize,
    pub(super) minute: Minute,
    pub(super) action: Action,
    /// Who really did it.
    pub(super) actor: usize,
    pub(super) fate: Fate,
}

/// How far one failure of the camera reaches. Homes differ in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FailureReach {
    /// Every caption fails by itself.
    Caption,
    /// A session fails as a whole.
    Session,
}

/// What becomes of an event on its way into the history.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fate {
    /// It is told of the person who did it.
    Seen,
    /// It is not told.
    Missed,
    /// It is told of this other person.
    TakenFor(usize),
    /// It is told of nobody.
    Unattributed,
}

/// Watches the sessions of one thing. The shares of [`RoutineParameters`] hold for captions and for whole
/// sessions alike, whichever `reach` says.
pub(super) fn watch(
    sessions: &[Session],
    people: usize,
    parameters: &RoutineParameters,
    reach: FailureReach,
    generator: &mut ChaCha8Rng,
) -> Vec<Sighting> {
    let mut sightings = Vec::new();
    for session in sessions {
        let mut fate = draw_fate(session.user, people, parameters, generator);
        for step in &session.steps {
            if reach == FailureReach::Caption {
                fate = draw_fate(session.user, people, parameters, generator);
            }
            sightings.push(Sighting {
                day: session.day,
                minute: step.minute,
                action: step.action,
                actor: session.user,
                fate,
            });
        }
    }
    sightings
}

fn draw_fate(user: usize, people: usize, parameters: &RoutineParameters, generator: &mut ChaCha8Rng) -> Fate {
    if generator.random_bool(parameters.missed) {
        return Fate::Missed;
    }
    // The two ways of being wrong exclude each other and are shares of what is seen.
    let chance = generator.random_range(0.0..1.0);
    if chance < parameters.mistaken {
        let others: Vec<usize> = (0..people).filter(|&person| person != user).collect();
        others.choose(generator).map_or(Fate::Seen, |&other| Fate::TakenFor(other))
    } else if chance < parameters.mistaken + parameters.unattributed {
        Fate::Unattributed
    } else {
        Fate::Seen
    }
}
