//! The robot's walk through the simulated home, and what it sees.

use coin_schemas::household::{ClassLabel, InvalidValue, Position};
use jiff::civil::{DateTime, date};
use jiff::{SignedDuration, ToSpan};
use rand::{Rng, RngExt};

use super::Plan;
use super::sampling::{happens, normal, scatter, uniform};
use super::things::{CLASSES, PITCH, ROOM, Thing, furnish, looks_of_classes, thing};
use crate::map::detection::{Detection, Region, View, ViewId};

const FIRST_MORNING: DateTime = date(2025, 3, 1).at(9, 0, 0, 0);
const BETWEEN_VIEWS: SignedDuration = SignedDuration::from_secs(5);
/// The part of a room that a view covers.
const COVERED: f64 = 0.6;

/// A tour, and what is true of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tour {
    /// The things of the home.
    pub things: Vec<Thing>,
    /// The views, in the order of time.
    pub views: Vec<View>,
    /// The thing that each detection of each view shows; `None` for what does not exist.
    pub truth: Vec<Vec<Option<usize>>>,
    /// How many views are of the first day.
    pub first_day: usize,
}

/// Simulates a tour; the same generator in the same state gives the same tour.
///
/// # Errors
/// If the plan leads to a position that is not finite.
pub fn simulate(plan: &Plan, generator: &mut impl Rng) -> Result<Tour, InvalidValue> {
    let classes = looks_of_classes(plan.dimension, generator);
    let labels: Vec<ClassLabel> =
        CLASSES.iter().map(|(name, _)| ClassLabel::new(*name)).collect::<Result<_, _>>()?;
    let things = furnish(plan, &classes, generator);
    let mut tour = Tour { things, views: Vec::new(), truth: Vec::new(), first_day: 0 };
    for day in 0..2 {
        let mut clock = FIRST_MORNING.saturating_add((day as i64).days());
        for _ in 0..plan.views_per_day {
            for room in 0..plan.rooms {
                clock = clock.saturating_add(BETWEEN_VIEWS);
                let look = Look { plan, labels: &labels, classes: &classes, day, clock };
                let number = tour.views.len();
                let (view, truth) = look.at_room(room, number, &tour.things, generator)?;
                tour.views.push(view);
                tour.truth.push(truth);
            }
        }
        if day == 0 {
            tour.first_day = tour.views.len();
        }
    }
    Ok(tour)
}

/// One look of the robot.
struct Look<'a> {
    plan: &'a Plan,
    labels: &'a [ClassLabel],
    classes: &'a [Vec<f64>],
    day: usize,
    clock: DateTime,
}

impl Look<'_> {
    fn at_room(
        &self,
        room: usize,
        number: usize,
        things: &[Thing],
        generator: &mut impl Rng,
    ) -> Result<(View, Vec<Option<usize>>), InvalidValue> {
        let region = part_of_room(room, generator)?;
        let noise = uniform(self.plan.noise, generator);
        let mut detections = Vec::new();
        let mut truth = Vec::new();
        for (index, thing) in things.iter().enumerate() {
            let place = thing.places[self.day];
            if !region.holds(place, 0.0) {
                continue;
            }
            if !happens(self.plan.missed, generator) {
                detections.push(self.detection(thing, place, noise, generator));
                truth.push(Some(index));
            }
            if happens(self.plan.invented, generator) {
                detections.push(self.invented(&region, generator));
                truth.push(None);
            }
        }
        let id = Some(ViewId(format!("view-{number}")));
        Ok((View { id, taken_at: self.clock, covered: vec![region], detections }, truth))
    }

    fn detection(&self, thing: &Thing, place: [f64; 3], noise: f64, generator: &mut impl Rng) -> Detection {
        let error = scatter(noise, generator);
        let mislabelled = happens(self.plan.mislabelled, generator);
        let class = if mislabelled { generator.random_range(0..CLASSES.len()) } else { thing.class };
        Detection {
            class: self.labels[class].clone(),
            position: std::array::from_fn(|axis| place[axis] + error[axis]),
            radius: thing.radius * libm::exp(0.15 * normal(generator)),
            at: self.clock,
            feature: Some(thing.feature(generator)),
        }
    }

    /// Something of a random class and look at a random place of the region.
    fn invented(&self, region: &Region, generator: &mut impl Rng) -> Detection {
        let nothing = thing(self.classes, 1, generator);
        let (least, greatest) = (region.least.metres(), region.greatest.metres());
        let place = std::array::from_fn(|axis| uniform([least[axis], greatest[axis]], generator));
        self.detection(&nothing, place, 0.0, generator)
    }
}

/// Most of a room, without what is behind the robot.
fn part_of_room(room: usize, generator: &mut impl Rng) -> Result<Region, InvalidValue> {
    let mut least = [room as f64 * PITCH, 0.0, 0.0];
    let mut greatest = [least[0] + ROOM[0], ROOM[1], ROOM[2]];
    let axis = generator.random_range(0..2);
    let hidden = (1.0 - COVERED) * ROOM[axis];
    if happens(0.5, generator) {
        least[axis] += hidden;
    } else {
        greatest[axis] -= hidden;
    }
    Ok(Region { least: Position::new(least)?, greatest: Position::new(greatest)? })
}
