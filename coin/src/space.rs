//! Spatial context: which things lie near a thing (the paper's Section 4.3, "Spatially-Aware Context Extraction").

use std::cmp::Ordering;

use coin_schemas::household::Position;

/// How far a neighbourhood reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbourhood {
    /// At most this many neighbours (K_near).
    pub k: usize,
    /// Scale σ of the weight, in metres.
    pub sigma: f64,
    /// Factor γ on the vertical axis.
    pub gamma: f64,
    /// Neighbours of a smaller weight are left out.
    pub min_weight: f64,
}

impl Default for Neighbourhood {
    /// The paper's values: K_near = 5, σ = 0.5 m, γ = 1; weights below 0.01 are discarded.
    fn default() -> Self {
        Self { k: 5, sigma: 0.5, gamma: 1.0, min_weight: 0.01 }
    }
}

impl Neighbourhood {
    /// A distance in metres beyond which no thing has the least weight; infinite where every weight is enough.
    pub fn radius(&self) -> f64 {
        if self.min_weight <= 0.0 {
            return f64::INFINITY;
        }
        let scaled = libm::sqrt((-2.0 * libm::log(self.min_weight)).max(0.0));
        // Weights are rounded, which carries a thing a little farther, most of all where weights are next to 0 or 1.
        self.sigma * (1.001 * scaled + 1e-6)
    }
}

/// A thing near another.
#[derive(Debug, Clone, PartialEq)]
pub struct Near<T> {
    /// The thing.
    pub item: T,
    /// Its distance in metres, the vertical axis scaled by γ.
    pub distance: f64,
    /// Its Gaussian weight, 0…1.
    pub weight: f64,
}

/// The paper's distance d_i = √(Δx² + Δy² + (γ Δz)²), in metres.
pub fn distance(from: Position, to: Position, gamma: f64) -> f64 {
    let [x, y, z] = from.metres();
    let [other_x, other_y, other_z] = to.metres();
    libm::hypot(libm::hypot(other_x - x, other_y - y), gamma * (other_z - z))
}

/// The paper's Gaussian weight w_i = exp(−d_i² / 2σ²), 0…1.
pub fn weight(distance: f64, sigma: f64) -> f64 {
    let scaled = distance / sigma;
    libm::exp(-0.5 * scaled * scaled)
}

/// The neighbours of `target` among `others` (which must not hold the target itself): largest weight first,
/// then smallest distance, then lowest item.
pub fn neighbours<T: Ord>(
    target: Position,
    others: impl IntoIterator<Item = (T, Position)>,
    reach: &Neighbourhood,
) -> Vec<Near<T>> {
    let mut near: Vec<Near<T>> = others
        .into_iter()
        .map(|(item, position)| {
            let distance = distance(target, position, reach.gamma);
            Near { item, distance, weight: weight(distance, reach.sigma) }
        })
        .filter(|candidate| candidate.weight >= reach.min_weight)
        .collect();
    near.sort_by(nearest_first);
    near.truncate(reach.k);
    near
}

fn nearest_first<T: Ord>(left: &Near<T>, right: &Near<T>) -> Ordering {
    right
        .weight
        .total_cmp(&left.weight)
        .then_with(|| left.distance.total_cmp(&right.distance))
        .then_with(|| left.item.cmp(&right.item))
}

#[cfg(test)]
mod tests;
