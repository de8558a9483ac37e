//! Draws from the distributions that a tour needs.

use rand::{Rng, RngExt};

/// A standard normal number (Box and Muller 1958).
pub(super) fn normal(generator: &mut impl Rng) -> f64 {
    let open = 1.0 - generator.random::<f64>();
    let angle = std::f64::consts::TAU * generator.random::<f64>();
    libm::sqrt(-2.0 * libm::log(open)) * libm::cos(angle)
}

/// A point in space whose coordinates are normal with one standard deviation.
pub(super) fn scatter(deviation: f64, generator: &mut impl Rng) -> [f64; 3] {
    std::array::from_fn(|_| deviation * normal(generator))
}

/// A random direction, of length about 1 in many dimensions.
pub(super) fn direction(dimension: usize, generator: &mut impl Rng) -> Vec<f64> {
    let deviation = libm::sqrt(1.0 / dimension as f64);
    (0..dimension).map(|_| deviation * normal(generator)).collect()
}

pub(super) fn uniform([least, greatest]: [f64; 2], generator: &mut impl Rng) -> f64 {
    least + (greatest - least) * generator.random::<f64>()
}

/// True with the given probability.
pub(super) fn happens(probability: f64, generator: &mut impl Rng) -> bool {
    generator.random::<f64>() < probability
}
