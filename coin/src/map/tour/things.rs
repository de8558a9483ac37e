//! The things of a simulated home: what they are, whose, what they look like and where they lie on each day.

use rand::{Rng, RngExt};

use super::sampling::{direction, happens, uniform};
use super::{CLEARANCE, Plan};

/// Classes, with the range of their radii in metres.
pub(super) const CLASSES: [(&str, [f64; 2]); 20] = [
    ("cup", [0.035, 0.05]),
    ("mug", [0.04, 0.05]),
    ("glass", [0.03, 0.04]),
    ("plate", [0.09, 0.13]),
    ("bowl", [0.06, 0.09]),
    ("bottle", [0.04, 0.06]),
    ("pen", [0.02, 0.03]),
    ("marker", [0.02, 0.03]),
    ("scissors", [0.04, 0.07]),
    ("book", [0.08, 0.13]),
    ("notebook", [0.08, 0.12]),
    ("laptop", [0.14, 0.18]),
    ("phone", [0.04, 0.06]),
    ("tablet", [0.09, 0.13]),
    ("headphones", [0.07, 0.1]),
    ("charger", [0.03, 0.05]),
    ("remote control", [0.05, 0.08]),
    ("toothbrush", [0.03, 0.05]),
    ("towel", [0.1, 0.18]),
    ("bag", [0.14, 0.22]),
];

/// A room's length, depth and height in metres.
pub(super) const ROOM: [f64; 3] = [5.0, 4.0, 2.0];
/// From the beginning of a room to that of the next, in metres.
pub(super) const PITCH: f64 = 5.5;
const BOARDS: [f64; 4] = [0.4, 0.75, 1.1, 1.45];
/// What the class and the look have of a feature's squared length; the rest is the view's.
const CLASS_SHARE: f64 = 0.7;
const LOOK_SHARE: f64 = 0.2;

/// A thing of a simulated home.
#[derive(Debug, Clone, PartialEq)]
pub struct Thing {
    /// The place of its class in the list of classes.
    pub class: usize,
    /// Its radius, in metres.
    pub radius: f64,
    /// Whose it is.
    pub owner: usize,
    /// The thing that looks the same, where there is one.
    pub twin: Option<usize>,
    /// Where it lies on the first and on the second day, in metres.
    pub places: [[f64; 3]; 2],
    /// The part of its features that does not depend on the view.
    pub look: Vec<f64>,
}

impl Thing {
    /// Whether it lies elsewhere on the second day.
    pub fn moved(&self) -> bool {
        self.places[0] != self.places[1]
    }

    /// What one view shows of it.
    pub(super) fn feature(&self, generator: &mut impl Rng) -> Vec<f32> {
        let share = libm::sqrt(1.0 - CLASS_SHARE - LOOK_SHARE);
        let of_view = direction(self.look.len(), generator);
        self.look.iter().zip(of_view).map(|(look, of_view)| (look + share * of_view) as f32).collect()
    }
}

pub(super) fn looks_of_classes(dimension: usize, generator: &mut impl Rng) -> Vec<Vec<f64>> {
    CLASSES.iter().map(|_| direction(dimension, generator)).collect()
}

/// A thing that looks like no other, at no place yet.
pub(super) fn thing(classes: &[Vec<f64>], owners: usize, generator: &mut impl Rng) -> Thing {
    let class = generator.random_range(0..CLASSES.len());
    let own = direction(classes[class].len(), generator);
    let (of_class, of_look) = (libm::sqrt(CLASS_SHARE), libm::sqrt(LOOK_SHARE));
    Thing {
        class,
        radius: uniform(CLASSES[class].1, generator),
        owner: generator.random_range(0..owners),
        twin: None,
        places: [[0.0; 3]; 2],
        look: classes[class].iter().zip(own).map(|(class, own)| of_class * class + of_look * own).collect(),
    }
}

/// The things of a home, placed on both days.
pub(super) fn furnish(plan: &Plan, classes: &[Vec<f64>], generator: &mut impl Rng) -> Vec<Thing> {
    let mut things: Vec<Thing> = Vec::with_capacity(plan.things);
    while things.len() < plan.things {
        let number = things.len();
        let mut one = thing(classes, plan.owners, generator);
        let place = free_place(plan, &things, generator);
        one.places = [place; 2];
        if number / 2 >= plan.equal_pairs || number + 1 == plan.things {
            things.push(one);
            continue;
        }
        let mut twin = one.clone();
        twin.owner = (one.owner + 1) % plan.owners.max(2);
        (one.twin, twin.twin) = (Some(number + 1), Some(number));
        things.push(one);
        let at = beside(number / 2 % 3, place, generator);
        let at = at
            .filter(|&at| is_free(at, &things[..number]))
            .unwrap_or_else(|| free_place(plan, &things, generator));
        twin.places = [at; 2];
        things.push(twin);
    }
    for number in 0..things.len() {
        if happens(plan.moved, generator) {
            things[number].places[1] = free_place(plan, &things, generator);
        }
    }
    things
}

/// Beside a place on the same board, on the next board, or nowhere in particular.
fn beside(kind: usize, [x, y, z]: [f64; 3], generator: &mut impl Rng) -> Option<[f64; 3]> {
    match kind {
        0 => Some([x + uniform([0.12, 0.25], generator), y, z]),
        1 if z < BOARDS[BOARDS.len() - 1] => Some([x, y, z + BOARDS[1] - BOARDS[0]]),
        1 => Some([x, y, z - BOARDS[1] + BOARDS[0]]),
        _ => None,
    }
}

fn free_place(plan: &Plan, things: &[Thing], generator: &mut impl Rng) -> [f64; 3] {
    loop {
        let room = generator.random_range(0..plan.rooms) as f64;
        let at = [
            room * PITCH + uniform([0.5, ROOM[0] - 0.5], generator),
            uniform([0.3, ROOM[1] - 0.3], generator),
            BOARDS[generator.random_range(0..BOARDS.len())],
        ];
        if is_free(at, things) {
            return at;
        }
    }
}

fn is_free(at: [f64; 3], things: &[Thing]) -> bool {
    let apart = |place: [f64; 3]| (0..3).map(|axis| (place[axis] - at[axis]).powi(2)).sum::<f64>();
    things.iter().flat_map(|thing| thing.places).all(|place| apart(place) >= CLEARANCE * CLEARANCE)
}
