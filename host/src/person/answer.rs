//! What becomes of a question, and how that is said.

#[cfg(test)]
mod tests;

use coin_schemas::household::{Owners, UserName};
use coin_schemas::model::TaskObject;

/// An owner who does not live here, in words that need no question beside them to be understood.
const OUTSIDE: &str = "somebody outside the household";

/// What became of a question.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Response {
    /// Somebody answered in words.
    Said {
        /// The answer as it was given.
        answer: String,
        /// Who gave it, where known, so that "mine" has a meaning.
        answered_by: Option<UserName>,
    },
    /// Somebody picked from the offered choices. No model needs to read it, and so none can misread it.
    Chose {
        /// The owners that were picked; they are members of the household.
        owners: Owners,
        /// Whether somebody who does not live here owns the thing, alone or with them.
        owner_outside_household: bool,
        /// Who picked them, where known.
        answered_by: Option<UserName>,
    },
    /// Somebody heard the question and would not answer it. Other questions may still be put.
    Declined,
    /// The answer before this question does not count: it is to be taken back, and its question put again. This is
    /// only ever the response to a question that has a [`PreviousAnswer`].
    Undo,
    /// Somebody wants to stop now and go on another time.
    Stop,
    /// There is nobody left who could answer anything.
    NobodyLeft,
}

impl Response {
    /// The answer as it is kept for the record: the words themselves, or a choice put in words, such as
    /// `Bob and Mary`, `everybody` or `somebody outside the household`. `None` where nothing was answered.
    pub fn in_words(&self, household: &Owners) -> Option<String> {
        match self {
            Self::Said { answer, .. } => Some(answer.clone()),
            Self::Chose { owners, owner_outside_household, .. } => {
                let mut parties = parties(owners, household);
                if *owner_outside_household {
                    parties.push(OUTSIDE.to_owned());
                }
                Some(joined(&parties))
            }
            Self::Declined | Self::Undo | Self::Stop | Self::NobodyLeft => None,
        }
    }
}

/// The answer before a question, which [`Response::Undo`] takes back.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviousAnswer {
    /// The thing that it was about.
    pub object: TaskObject,
    /// What it was understood to say.
    pub understood: Understood,
}

/// What an answer was understood to say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Understood {
    /// Whose the thing is.
    Named {
        /// The owners within the household.
        owners: Owners,
        /// Whether somebody who does not live here owns the thing, alone or with them.
        owner_outside_household: bool,
    },
    /// Nothing: it named nobody, as "I don't know" does.
    Nobody,
    /// The question was passed over.
    PassedOver,
}

impl PreviousAnswer {
    /// The answer as a sentence without a full stop, such as `the marker in the office belongs to Bob`.
    pub fn in_words(&self, household: &Owners) -> String {
        let place = self.object.room.as_ref().map(|room| format!(" in the {room}")).unwrap_or_default();
        let thing = format!("the {}{place}", self.object.class);
        match &self.understood {
            Understood::Named { owners, owner_outside_household } => {
                let mut parties = parties(owners, household);
                if *owner_outside_household {
                    parties.push(OUTSIDE.to_owned());
                }
                format!("{thing} belongs to {}", joined(&parties))
            }
            Understood::Nobody => format!("nobody could say whose {thing} is"),
            Understood::PassedOver => format!("{thing} was passed over"),
        }
    }
}

/// The names of the owners; `everybody` where that is shorter.
fn parties(owners: &Owners, household: &Owners) -> Vec<String> {
    if owners.len() > 2 && owners.is_superset(household) {
        return vec!["everybody".to_owned()];
    }
    owners.iter().map(ToString::to_string).collect()
}

/// `Bob, Mary and Tom`.
fn joined(parties: &[String]) -> String {
    match parties {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        all => all.concat(),
    }
}
