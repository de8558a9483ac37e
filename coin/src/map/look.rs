//! What a thing looks like: the mean direction of the features it was seen with.

use crate::similarity::normalise;

/// The weighted sum of features of length 1, as a direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    sum: Vec<f64>,
    length: f64,
}

impl Look {
    /// The look of one feature of length 1, with a positive weight.
    pub fn new(feature: &[f32], weight: f64) -> Self {
        let mut look = Self { sum: vec![0.0; feature.len()], length: 0.0 };
        look.add(feature, weight);
        look
    }

    /// The look of this weighted sum of features, as [`Self::sum`] gave it.
    pub fn of_sum(sum: Vec<f64>) -> Self {
        let mut look = Self { sum, length: 0.0 };
        look.measure();
        look
    }

    /// The weighted sum of the features.
    pub fn sum(&self) -> &[f64] {
        &self.sum
    }

    /// Adds a feature of length 1 and the same dimension.
    pub fn add(&mut self, feature: &[f32], weight: f64) {
        for (sum, &component) in self.sum.iter_mut().zip(feature) {
            *sum += weight * f64::from(component);
        }
        self.measure();
    }

    /// Adds what another look was made of.
    pub fn absorb(&mut self, other: &Self) {
        for (sum, component) in self.sum.iter_mut().zip(&other.sum) {
            *sum += component;
        }
        self.measure();
    }

    fn measure(&mut self) {
        self.length = libm::sqrt(dot(&self.sum, &self.sum));
    }

    /// The re-normalised weighted mean of the features; `None` where they cancel out.
    pub fn feature(&self) -> Option<Vec<f32>> {
        let mean: Vec<f32> = self.sum.iter().map(|sum| (sum / self.length) as f32).collect();
        normalise(&mean)
    }

    /// The cosine with a feature of length 1, −1…1; NaN, which is like nothing, where the features cancel out.
    pub fn cosine(&self, feature: &[f32]) -> f64 {
        dot(&self.sum, feature) / self.length
    }

    /// The cosine of two looks.
    pub fn cosine_with(&self, other: &Self) -> f64 {
        dot(&self.sum, &other.sum) / (self.length * other.length)
    }
}

/// aᵀ b, in eight sums side by side: always in this order, and four times as fast as one sum.
fn dot<T: Copy + Into<f64>>(a: &[f64], b: &[T]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let (heads, tails) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = heads.remainder().iter().zip(tails.remainder()).map(|(&a, &b)| a * b.into()).sum();
    for (a, b) in heads.zip(tails) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane].into();
        }
    }
    sums.iter().sum::<f64>() + rest
}
