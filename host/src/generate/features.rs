//! Synthetic visual features: the recipe, and nothing that a camera saw.
//!
//! The feature of a thing is `f = a·c + b·w + s·e`, with a² = .55, b² = .20, s² = .25 and three vectors of 512
//! independent normal components of variance 1/512:
//!
//! - `c` belongs to the class and is the same in every home (a mug looks like a mug);
//! - `w` belongs to the owner set in this home (people have a taste);
//! - `e` is the thing's own.
//!
//! The cosine of two things is therefore about .55 for one class, .20 for one owner set, .75 for both and
//! 0 ± .05 for neither: a hint of who owns what, and no more.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use coin_schemas::episode::FEATURE_DIMENSIONS;

use super::belongings::Belonging;
use super::random::normal;

/// One visual feature.
pub type Feature = [f32; FEATURE_DIMENSIONS];

const CLASS_PART: f64 = 0.55;
const OWNER_PART: f64 = 0.20;
const OWN_PART: f64 = 0.25;

/// Draws the features of all things, in their order.
pub(super) fn draw(belongings: &[Belonging], generator: &mut ChaCha8Rng) -> Vec<Feature> {
    let mut of_class: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let mut of_owners: BTreeMap<&[usize], Vec<f64>> = BTreeMap::new();
    belongings
        .iter()
        .map(|belonging| {
            let class = belonging.thing.class;
            let class_direction =
                of_class.entry(class).or_insert_with(|| direction(&mut class_generator(class)));
            let owner_direction = of_owners.entry(&belonging.owners).or_insert_with(|| direction(generator));
            let own_direction = direction(generator);
            let mut feature = [0.0_f32; FEATURE_DIMENSIONS];
            for (dimension, component) in feature.iter_mut().enumerate() {
                *component = (CLASS_PART.sqrt() * class_direction[dimension]
                    + OWNER_PART.sqrt() * owner_direction[dimension]
                    + OWN_PART.sqrt() * own_direction[dimension]) as f32;
            }
            feature
        })
        .collect()
}

/// A vector of about unit length in a direction drawn evenly.
fn direction(generator: &mut ChaCha8Rng) -> Vec<f64> {
    let scale = 1.0 / (FEATURE_DIMENSIONS as f64).sqrt();
    (0..FEATURE_DIMENSIONS).map(|_| scale * normal(generator)).collect()
}

/// The random numbers of a class: they are the same in every home.
fn class_generator(class: &str) -> ChaCha8Rng {
    let mut key = [0_u8; 32];
    key.iter_mut().zip(class.bytes()).for_each(|(to, from)| *to = from);
    ChaCha8Rng::from_seed(key)
}
