//! What a question is expected to tell: from samples of the labels to marginals, entropies and information gains.

use libm::log;

/// Samples of all labels; a thing that the model leaves out has none.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Samples {
    pub(super) members: usize,
    pub(super) labels: Vec<Vec<Option<usize>>>,
}

impl Samples {
    /// p(z_o = k), thing by thing.
    pub(super) fn marginals(&self, things: usize) -> Vec<Vec<f64>> {
        let mut counts = vec![vec![0.0; self.members]; things];
        for sample in &self.labels {
            for (thing, label) in sample.iter().enumerate() {
                if let Some(label) = *label {
                    counts[thing][label] += 1.0;
                }
            }
        }
        let total = self.labels.len().max(1) as f64;
        for of_thing in &mut counts {
            of_thing.iter_mut().for_each(|count| *count /= total);
        }
        counts
    }

    /// The expected information gain of asking about a thing, in nats: the sum of the entropies of the unasked labels
    /// now, minus what is expected of it after the answer; that is Σ_i I(z_i; z_o) over the unasked things i, the thing
    /// itself included. An answer k re-weights the samples: those with z_o = k stay. The asked label itself is known
    /// then.
    ///
    /// The sum over labels is meant: the entropy of all labels together falls by H(z_o) whatever z_o tells of the rest,
    /// and a question would earn nothing by settling a whole shelf. From n samples of independent labels of K members
    /// each other thing adds about (K − 1)² / 2n by chance.
    pub(super) fn expected_gain(&self, thing: usize, unasked: &[usize]) -> f64 {
        let total = self.labels.len().max(1) as f64;
        let mut together = vec![vec![vec![0.0; self.members]; unasked.len()]; self.members];
        let mut answers = vec![0.0; self.members];
        for sample in &self.labels {
            let Some(answer) = sample[thing] else { continue };
            answers[answer] += 1.0;
            for (place, &other) in unasked.iter().enumerate() {
                if let Some(label) = sample[other] {
                    together[answer][place][label] += 1.0;
                }
            }
        }
        let now: f64 = (0..unasked.len())
            .map(|place| {
                let counts: Vec<f64> =
                    (0..self.members).map(|label| together.iter().map(|of| of[place][label]).sum()).collect();
                entropy(&counts, total)
            })
            .sum();
        let after: f64 = answers
            .iter()
            .zip(&together)
            .filter(|(count, _)| **count > 0.0)
            .map(|(&count, of_answer)| {
                let rest: f64 = unasked
                    .iter()
                    .zip(of_answer)
                    .filter(|(other, _)| **other != thing)
                    .map(|(_, counts)| entropy(counts, count))
                    .sum();
                count / total * rest
            })
            .sum();
        now - after
    }
}

/// The entropy of counts that sum to `total`, in nats.
fn entropy(counts: &[f64], total: f64) -> f64 {
    counts
        .iter()
        .filter(|count| **count > 0.0)
        .map(|&count| {
            let share = count / total;
            -share * log(share)
        })
        .sum()
}
