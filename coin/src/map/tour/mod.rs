//! A simulated tour with a known truth: a robot looks through a home on two days, and in the night between some things
//! are moved. It is what the map is judged on.
//!
//! Rooms of 5 × 4 m stand side by side. Things lie on boards at four heights, 35 cm apart, at least
//! [`CLEARANCE`] from each other. Some come in pairs that look the same and belong to two people: a third of the pairs
//! side by side (12 to 25 cm), a third above one another on two boards, a third anywhere in the home. Every view covers
//! 60 % of a room, cut from a random side. What is in it is detected, or missed; its position has independent normal
//! noise on each axis; its radius is off by some 15 %; its class is wrong now and then. Beside that, things are detected
//! that do not exist.
//!
//! A feature is the sum of three random directions: of the class, of the look within the class, and of the view. Two views
//! of a thing have a cosine of 0.9, and things of one class that do not look the same one of 0.7.

mod judge;
mod sampling;
mod things;
mod walk;

pub use judge::{TourScores, judge};
pub use things::Thing;
pub use walk::{Tour, simulate};

/// The least distance between things, in metres, but for the pairs, which choose theirs.
pub const CLEARANCE: f64 = 0.15;

/// What a tour is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// How many rooms there are.
    pub rooms: usize,
    /// How many things there are, pairs included.
    pub things: usize,
    /// How many pairs look the same.
    pub equal_pairs: usize,
    /// How many people own them.
    pub owners: usize,
    /// Views of every room on each of the two days.
    pub views_per_day: usize,
    /// The least and greatest standard deviation of a position on each axis, in metres; each view draws its own.
    pub noise: [f64; 2],
    /// The share of things in view that are missed.
    pub missed: f64,
    /// False detections for every thing in view.
    pub invented: f64,
    /// The share of detections that get the class of another thing.
    pub mislabelled: f64,
    /// The share of things that lie elsewhere on the second day.
    pub moved: f64,
    /// The dimension of the features.
    pub dimension: usize,
}

impl Default for Plan {
    /// Two hundred things in five rooms, each in some thirty views (25 views a day, of which 60 % show it).
    fn default() -> Self {
        Self {
            rooms: 5,
            things: 200,
            equal_pairs: 20,
            owners: 4,
            views_per_day: 25,
            noise: [0.03, 0.08],
            missed: 0.1,
            invented: 0.02,
            mislabelled: 0.05,
            moved: 0.1,
            dimension: 512,
        }
    }
}

#[cfg(test)]
mod tests;
