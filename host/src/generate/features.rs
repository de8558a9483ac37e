//! Synthetic visual features: the recipe, and nothing that a camera saw.
//!
//! The feature of a thing is `f = a·c + b·t + g·m + s·e`, with a² = .25, b² drawn evenly from 0 to .40 and g² from .15 to
//! .35 for every thing, s² = 1 − a² − b² − g², and four vectors of 512 independent normal components of variance
//! 1/512:
//!
//! - `c` belongs to the class and is the same in every home (a mug looks like a mug);
//! - `t` is the taste of the owner set in this home, half its own and half the mean of its members'
//!   tastes, so that what Bob and Mary share looks a little like what is Bob's;
//! - `m` belongs to the brand, one of ten in this home, drawn for every thing whoever owns it;
//! - `e` is the thing's own.
//!
//! Taste is a hint and no more, because b² is often near 0 and a brand says nothing of owners. Two things of
//! different classes and one owner set have a cosine of .20 ± .10 or so; of overlapping owner sets, .07; of others, .03.
//! A pair of one owner set has the larger cosine with a probability (AUC) of about .85, and the thing that looks most
//! alike has the same owner set two times in three.

use std::collections::BTreeMap;
use std::ops::Range;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use coin_schemas::episode::FEATURE_DIMENSIONS;

use super::belongings::Belonging;
use super::random::{between, normal};

/// One visual feature.
pub type Feature = [f32; FEATURE_DIMENSIONS];

const CLASS_PART: f64 = 0.25;
const TASTE_PART: Range<f64> = 0.0..0.40;
const BRAND_PART: Range<f64> = 0.15..0.35;
/// How much of the taste of an owner set is not the taste of any one of its members.
const COMMON_TASTE: f64 = 0.5;
/// The brands of a home: three or four things look alike for a reason that has nothing to do with owners.
const BRANDS: usize = 10;

/// Draws the features of all things, in their order.
pub(super) fn draw(belongings: &[Belonging], generator: &mut ChaCha8Rng) -> Vec<Feature> {
    let brands: Vec<Vec<f64>> = (0..BRANDS).map(|_| direction(generator)).collect();
    let mut tastes = Tastes::default();
    belongings
        .iter()
        .map(|belonging| {
            let (taste_part, brand_part) = (between(&TASTE_PART, generator), between(&BRAND_PART, generator));
            let brand = &brands[generator.random_range(0..BRANDS)];
            let taste = tastes.of(&belonging.owners, generator);
            let class = direction(&mut class_generator(belonging.thing.class));
            let own = direction(generator);
            let own_part = 1.0 - CLASS_PART - taste_part - brand_part;
            let mut feature = [0.0_f32; FEATURE_DIMENSIONS];
            for (dimension, component) in feature.iter_mut().enumerate() {
                *component = (CLASS_PART.sqrt() * class[dimension]
                    + taste_part.sqrt() * taste[dimension]
                    + brand_part.sqrt() * brand[dimension]
                    + own_part.sqrt() * own[dimension]) as f32;
            }
            feature
        })
        .collect()
}

/// The tastes in a home, drawn when they are first met.
#[derive(Default)]
struct Tastes {
    of_people: BTreeMap<usize, Vec<f64>>,
    of_owner_sets: BTreeMap<Vec<usize>, Vec<f64>>,
}

impl Tastes {
    fn of(&mut self, owners: &[usize], generator: &mut ChaCha8Rng) -> &[f64] {
        let Self { of_people, of_owner_sets } = self;
        of_owner_sets.entry(owners.to_vec()).or_insert_with(|| {
            let mut taste = direction(generator);
            taste.iter_mut().for_each(|component| *component *= COMMON_TASTE.sqrt());
            let of_each = ((1.0 - COMMON_TASTE) / owners.len() as f64).sqrt();
            for &owner in owners {
                let of_owner = of_people.entry(owner).or_insert_with(|| direction(generator));
                taste.iter_mut().zip(of_owner).for_each(|(sum, component)| *sum += of_each * *component);
            }
            taste
        })
    }
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
