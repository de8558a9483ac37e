//! Where the things of one label lie: a Gaussian with a Normal–inverse-Wishart prior, integrated out.

use libm::{lgamma, log};

/// The dimensions of a position.
const D: usize = 3;

type Vector = [f64; D];
type Matrix = [[f64; D]; D];

/// The Normal–inverse-Wishart prior of the mean and covariance of positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionPrior {
    /// μ₀: where things are expected, in metres.
    pub mean: Vector,
    /// κ₀: how many things that expectation is worth.
    pub mean_weight: f64,
    /// ν₀: the degrees of freedom, above 2.
    pub degrees_of_freedom: f64,
    /// The diagonal of Ψ₀, in square metres.
    pub scatter: Vector,
}

/// Sufficient statistics of the positions of one label.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Positions {
    count: f64,
    sum: Vector,
    /// Σ x xᵀ.
    products: Matrix,
}

impl Positions {
    pub(super) fn add(&mut self, position: &Vector) {
        self.change(position, 1.0);
    }

    pub(super) fn remove(&mut self, position: &Vector) {
        self.change(position, -1.0);
    }

    fn change(&mut self, position: &Vector, sign: f64) {
        self.count += sign;
        for (row, &x) in position.iter().enumerate() {
            self.sum[row] += sign * x;
            for (column, &y) in position.iter().enumerate() {
                self.products[row][column] += sign * x * y;
            }
        }
    }

    /// ln p(x | the positions so far): a multivariate Student t with ν_n − d + 1 degrees of freedom (Murphy,
    /// *Conjugate Bayesian analysis of the Gaussian distribution*, 2007).
    pub(super) fn log_predictive(&self, position: &Vector, prior: &PositionPrior) -> f64 {
        let weight = prior.mean_weight + self.count;
        let degrees_of_freedom = prior.degrees_of_freedom + self.count;
        let prior_mean = |row: usize| prior.mean_weight * prior.mean[row];
        let mean: Vector = std::array::from_fn(|row| (prior_mean(row) + self.sum[row]) / weight);
        let t_freedom = degrees_of_freedom - D as f64 + 1.0;
        let factor = (weight + 1.0) / (weight * t_freedom);
        let scale: Matrix = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let own = if row == column { prior.scatter[row] } else { 0.0 };
                let scatter = own + self.products[row][column] + prior_mean(row) * prior.mean[column]
                    - weight * mean[row] * mean[column];
                factor * scatter
            })
        });
        let (inverse, determinant) = inverted(&scale);
        let away: Vector = std::array::from_fn(|row| position[row] - mean[row]);
        let distance: f64 = (0..D)
            .flat_map(|row| (0..D).map(move |column| (row, column)))
            .map(|(row, column)| away[row] * inverse[row][column] * away[column])
            .sum();
        lgamma((t_freedom + D as f64) / 2.0)
            - lgamma(t_freedom / 2.0)
            - D as f64 / 2.0 * log(t_freedom * std::f64::consts::PI)
            - 0.5 * log(determinant)
            - (t_freedom + D as f64) / 2.0 * libm::log1p(distance / t_freedom)
    }
}

/// The inverse and the determinant of a positive definite matrix, by cofactors.
fn inverted(m: &Matrix) -> (Matrix, f64) {
    let cofactor = |row: usize, column: usize| {
        let (r1, r2) = ((row + 1) % D, (row + 2) % D);
        let (c1, c2) = ((column + 1) % D, (column + 2) % D);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..D).map(|column| m[0][column] * cofactor(0, column)).sum();
    let inverse =
        std::array::from_fn(|row| std::array::from_fn(|column| cofactor(column, row) / determinant));
    (inverse, determinant)
}
