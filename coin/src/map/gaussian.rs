//! A thing in space as a Gaussian with one variance on all axes (Appendix B: G_i = N(p_i, α r_i I)), and how much two of
//! them differ.

/// The dimensions of space.
const D: f64 = 3.0;

/// N(mean, variance · I).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// The middle, `[x, y, z]` in metres.
    pub mean: [f64; 3],
    /// The variance on each axis, in square metres, above 0.
    pub variance: f64,
}

fn squared_distance(from: [f64; 3], to: [f64; 3]) -> f64 {
    (0..3).map(|axis| (to[axis] - from[axis]) * (to[axis] - from[axis])).sum()
}

/// The Kullback–Leibler divergence KL(from ‖ to) in nats. For isotropic Gaussians in d dimensions, with ratio
/// ρ = σ²_from / σ²_to:
///
/// KL = ½ (d (ρ − 1 − ln ρ) + |Δ|² / σ²_to).
pub fn kl(from: &Gaussian, to: &Gaussian) -> f64 {
    let ratio = from.variance / to.variance;
    0.5 * (D * (ratio - 1.0 - libm::log(ratio)) + squared_distance(from.mean, to.mean) / to.variance)
}

/// The Jeffreys divergence J = KL(a ‖ b) + KL(b ‖ a) in nats (Jeffreys 1946). The logarithms cancel:
///
/// J = ½ (d (ρ + 1/ρ − 2) + |Δ|² (1/σ²_a + 1/σ²_b)).
///
/// The map goes by it and not by one direction of KL, because *are these one thing?* has no direction: which of two sightings
/// came first must not decide whether they join. One direction also lets a narrow Gaussian into a wide one: a cup on a
/// table has KL(cup ‖ table) = 2.3 and J = 15 (radii of 5 and 60 cm, one middle).
pub fn jeffreys(a: &Gaussian, b: &Gaussian) -> f64 {
    let difference = a.variance - b.variance;
    // ρ + 1/ρ − 2, written so that it is the same both ways round to the last bit.
    let extents = (difference / a.variance) * (difference / b.variance);
    let precisions = a.variance.recip() + b.variance.recip();
    0.5 * (D * extents + squared_distance(a.mean, b.mean) * precisions)
}

#[cfg(test)]
mod tests;
