//! People who join a home do not put in doubt whose the things are that were there before them.

use crate::owners::OwnerSet;

use super::home::SeenThing;

/// Who can own a thing, as far as joining the household goes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Arrivals {
    /// Those who were not there yet at the moment for which a thing is judged. They are no candidates.
    pub absent: OwnerSet,
    /// Those who joined after the thing was first used.
    pub newcomers: OwnerSet,
}

impl SeenThing {
    /// The thing of a home that some people joined.
    ///
    /// A newcomer who has not used the thing is no candidate: it is judged as if this person were not there. There is one
    /// exception, a thing that then seems to be everybody's. Whether "everybody" now means the newcomer too is just what
    /// is open. Where nobody would be left as a candidate, all who are there are.
    #[must_use]
    pub fn after(self, arrivals: Arrivals) -> Self {
        let present: OwnerSet =
            self.candidates.iter().filter(|&user| !arrivals.absent.contains(user)).collect();
        let latecomers: OwnerSet = present
            .iter()
            .filter(|&user| arrivals.newcomers.contains(user) && !self.sessions.contains(&user))
            .collect();
        let candidates: OwnerSet = present.iter().filter(|&user| !latecomers.contains(user)).collect();
        match (candidates.is_empty(), present.is_empty()) {
            (false, _) => Self { candidates, latecomers, ..self },
            (true, false) => Self { candidates: present, latecomers: OwnerSet::EMPTY, ..self },
            (true, true) => self,
        }
    }
}

#[cfg(test)]
mod tests;
