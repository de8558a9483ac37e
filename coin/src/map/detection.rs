//! What a robot hands in: views, and what was detected in them.

use coin_schemas::household::{ClassLabel, Position};
use jiff::civil::DateTime;
use thiserror::Error;

use crate::similarity::normalise;

/// The id that the robot gives a view. All detections of one view were made from one image, so they show different
/// things.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ViewId(pub String);

/// One look at a part of the home.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Its id; a view that is handed in twice is known by it. Without an id, the detections still count as one view.
    pub id: Option<ViewId>,
    /// The clock of the robot, local time of the home. No detection can be later.
    pub taken_at: DateTime,
    /// What was in sight, so that a thing which is not among the detections was not there or was missed. Empty where
    /// the robot cannot tell: then nothing is ever found to be gone.
    pub covered: Vec<Region>,
    /// What was detected.
    pub detections: Vec<Detection>,
}

/// A box along the axes of the map, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// The corner with the smallest coordinates.
    pub least: Position,
    /// The corner with the largest coordinates.
    pub greatest: Position,
}

impl Region {
    /// Whether a place lies inside, at least `margin` metres from every face.
    pub fn holds(&self, place: [f64; 3], margin: f64) -> bool {
        let (least, greatest) = (self.least.metres(), self.greatest.metres());
        let inside = |axis: usize, at: f64| least[axis] + margin <= at && at <= greatest[axis] - margin;
        place.into_iter().enumerate().all(|(axis, at)| inside(axis, at))
    }
}

/// A detection as it arrives; its numbers are not checked yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Detection {
    /// What the detector calls the thing.
    pub class: ClassLabel,
    /// Its middle, `[x, y, z]` in metres in the map's frame.
    pub position: [f64; 3],
    /// Its extent as the radius of a ball, in metres.
    pub radius: f64,
    /// When it was seen, local time of the home.
    pub at: DateTime,
    /// What it looks like, as an embedding of the image; it need not have length 1.
    pub feature: Option<Vec<f32>>,
}

/// Why a detection was not taken in. The others of its view are.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Refusal {
    /// A coordinate is infinite or not a number.
    #[error("a position has three finite numbers (metres), not {given:?}")]
    Position {
        /// The numbers.
        given: [f64; 3],
    },
    /// The radius is no positive finite number, or so small that its inverse is infinite.
    #[error("a radius is a positive number (metres), not {given}")]
    Radius {
        /// The number.
        given: f64,
    },
    /// The feature has another dimension than those of the map.
    #[error("the features of this map have {expected} numbers, not {given}")]
    Dimension {
        /// How many numbers it has.
        given: usize,
        /// How many the map's features have.
        expected: usize,
    },
    /// The feature is zero or holds an infinite number or NaN, and so has no direction.
    #[error("a feature holds finite numbers that are not all zero")]
    Feature,
    /// The detection is later than the clock of its view.
    #[error("seen at {at}, which is after the view's clock ({taken_at})")]
    Future {
        /// The time of the detection.
        at: DateTime,
        /// The clock of the view.
        taken_at: DateTime,
    },
}

/// A detection that was checked: finite position, positive radius.
#[derive(Debug, Clone, PartialEq)]
pub struct Sighting {
    /// What the detector calls the thing.
    pub class: ClassLabel,
    /// Its middle.
    pub position: Position,
    /// Its extent, in metres.
    pub radius: f64,
    /// When it was seen, local time of the home.
    pub at: DateTime,
    /// The view that it is from.
    pub view: Option<ViewId>,
}

/// A sighting with what it looked like.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// What was seen.
    pub sighting: Sighting,
    /// What it looks like, at length 1.
    pub feature: Option<Vec<f32>>,
}

impl Seen {
    /// Checks a detection; `dimension` is that of the map's features.
    ///
    /// # Errors
    /// What is wrong with the detection.
    pub fn check(detection: &Detection, view: &View, dimension: usize) -> Result<Self, Refusal> {
        let Detection { class, position, radius, at, feature } = detection;
        let place = Position::new(*position).map_err(|_| Refusal::Position { given: *position })?;
        if !(*radius > 0.0 && radius.is_finite() && radius.recip().is_finite()) {
            return Err(Refusal::Radius { given: *radius });
        }
        if *at > view.taken_at {
            return Err(Refusal::Future { at: *at, taken_at: view.taken_at });
        }
        let feature = feature.as_deref().map(|feature| direction(feature, dimension)).transpose()?;
        let sighting = Sighting {
            class: class.clone(),
            position: place,
            radius: *radius,
            at: *at,
            view: view.id.clone(),
        };
        Ok(Self { sighting, feature })
    }
}

impl Sighting {
    /// Whether this is the same detection again: of one view, two things of one class are never at the very same place.
    pub(super) fn repeats(&self, other: &Self) -> bool {
        self.class == other.class && self.position == other.position
    }
}

fn direction(feature: &[f32], dimension: usize) -> Result<Vec<f32>, Refusal> {
    if feature.len() != dimension {
        return Err(Refusal::Dimension { given: feature.len(), expected: dimension });
    }
    normalise(feature).ok_or(Refusal::Feature)
}
