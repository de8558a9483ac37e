//! Finds a thing by words: from "bring me my cup" to the thing that is meant, to a question, or to nothing.
//!
//! This is the language side of the paper's ownership-aware semantic map (Section 4.2 and Appendix B). A request is
//! read ([`interpret`]) as words for a thing, a reference to its owner, and places. Every thing of the map is judged by
//! three numbers, and [`find`] decides:
//!
//! * its *match*: the larger of how well the words fit its label and of how much it looks like them (Appendix B: the
//!   similarity D is the maximum over the encoders);
//! * its *place*: how well it fits the places that are named;
//! * its *ownership*: the probability that the reference is true of its owners.
//!
//! The score is their product, because each is a condition that has to hold and none makes up for another: a cup that
//! is Mary's is not half right for "my cup". The decision keeps ownership apart: somebody's thing is handed out only
//! where it is [`SURE`]ly the one of whom the request names, however well the rest fits.
//!
//! To judge whose a thing is costs far more than to read its label. [`find`] therefore asks for the owners of things only
//! where an answer depends on them.

use coin_schemas::household::{ObjectId, Position, Score};

mod finding;
mod interpretation;
mod labels;
mod likeness;
mod ownership;
mod phrases;
mod places;
mod question;
mod synonyms;

#[cfg(test)]
mod judged_tests;
#[cfg(test)]
mod laws;
#[cfg(test)]
mod tests;

pub use finding::{Decision, Finding, Match, find};
pub use interpretation::{Hint, Interpretation, NounPhrase, Purpose, Relation, interpret};
pub use likeness::{LEAST_COMPARED, likenesses};
pub use ownership::OwnerReference;

/// What one step away from the very words costs: a kind of the thing, a misspelling, a thing that others own too.
pub const STEP: f64 = 0.8;

/// A thing whose score is at least this share of the best one's could be meant as well. It lies between no step and
/// one, so that whatever is one step further away is no rival, and smaller differences are none.
pub const RIVAL: f64 = 0.9;

/// The least match of a thing that the words describe: two steps (0.64), not three (0.512).
pub const LEAST_MATCH: f64 = 0.6;

/// The least fit of a place: nearer to the place than not.
pub const LEAST_PLACE: f64 = 0.5;

/// From this probability on a thing is whose the request says. Below, a person is asked first: one wrong handing over
/// in five is what the paper's error level α = 0.2 tolerates for its owners.
pub const SURE: f64 = 0.8;

/// Up to this probability a thing is not whose the request says, and is not even asked about.
pub const EXCLUDED: f64 = 1.0 - SURE;

/// A thing in the map, as far as finding it is concerned.
#[derive(Debug, Clone, Copy)]
pub struct MappedThing<'a> {
    /// Its id.
    pub id: &'a ObjectId,
    /// Its class label.
    pub class: &'a str,
    /// The room that it is in.
    pub room: Option<&'a str>,
    /// Where it is, in metres.
    pub position: Position,
    /// How much it looks like what the request describes, on the scale of label matches, as [`likenesses`] gives it;
    /// `None` where no features were compared.
    pub likeness: Option<Score>,
}
