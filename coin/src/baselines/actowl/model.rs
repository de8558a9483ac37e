//! The generative model with everything but the labels integrated out, and collapsed Gibbs sampling of the labels.

use libm::{exp, log};
use rand::{Rng, RngExt};

use super::position::{PositionPrior, Positions};

/// What is seen of the things that are not everybody's.
#[derive(Debug, Clone, PartialEq)]
pub struct Things {
    /// Where each lies, in metres.
    pub positions: Vec<[f64; 3]>,
    /// The attributes of each thing as numbers from 0, one for each kind of attribute; every thing has the same kinds
    /// in the same order.
    pub attributes: Vec<Vec<usize>>,
}

/// The hyperparameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Priors {
    /// γ: the concentration of the Dirichlet over labels, for each member.
    pub label: f64,
    /// The concentration of the Dirichlet over the values of an attribute, for each value.
    pub attribute: f64,
    /// Of the positions of one label.
    pub position: PositionPrior,
}

/// What is counted of the things of one label.
#[derive(Debug, Clone, PartialEq)]
struct Label {
    count: f64,
    positions: Positions,
    /// By kind of attribute and value.
    attributes: Vec<Vec<f64>>,
}

/// The labels of the things at one moment of the sampler, with the counts that follow from them.
#[derive(Debug, Clone)]
pub(super) struct State<'a> {
    things: &'a Things,
    priors: &'a Priors,
    labels: Vec<Label>,
    /// z; `None` for a thing that the model leaves out.
    pub(super) assigned: Vec<Option<usize>>,
}

impl<'a> State<'a> {
    /// Things that are observed have their label, things that are left out none, and the others a random one.
    pub(super) fn new(
        things: &'a Things,
        priors: &'a Priors,
        members: usize,
        known: &[Known],
        generator: &mut impl Rng,
    ) -> Self {
        let kinds = things.attributes.first().map_or(0, Vec::len);
        let values =
            |kind: usize| things.attributes.iter().map(|of_thing| of_thing[kind] + 1).max().unwrap_or(0);
        let empty = Label {
            count: 0.0,
            positions: Positions::default(),
            attributes: (0..kinds).map(|kind| vec![0.0; values(kind)]).collect(),
        };
        let mut state =
            Self { things, priors, labels: vec![empty; members], assigned: vec![None; known.len()] };
        for (thing, known) in known.iter().enumerate() {
            match *known {
                Known::Label(label) => state.assign(thing, label),
                Known::Nothing => state.assign(thing, generator.random_range(0..members)),
                Known::LeftOut => {}
            }
        }
        state
    }

    fn assign(&mut self, thing: usize, label: usize) {
        self.assigned[thing] = Some(label);
        let counts = &mut self.labels[label];
        counts.count += 1.0;
        counts.positions.add(&self.things.positions[thing]);
        for (of_kind, &value) in counts.attributes.iter_mut().zip(&self.things.attributes[thing]) {
            of_kind[value] += 1.0;
        }
    }

    fn withdraw(&mut self, thing: usize) {
        if let Some(label) = self.assigned[thing].take() {
            let counts = &mut self.labels[label];
            counts.count -= 1.0;
            counts.positions.remove(&self.things.positions[thing]);
            for (of_kind, &value) in counts.attributes.iter_mut().zip(&self.things.attributes[thing]) {
                of_kind[value] -= 1.0;
            }
        }
    }

    /// ln p(z_o = k | the other labels, positions and attributes), but for a constant.
    fn log_conditional(&self, thing: usize, label: usize) -> f64 {
        let Priors { label: concentration, attribute, position } = self.priors;
        let counts = &self.labels[label];
        let attributes: f64 = counts
            .attributes
            .iter()
            .zip(&self.things.attributes[thing])
            .map(|(of_kind, &value)| {
                log((of_kind[value] + attribute) / (counts.count + attribute * of_kind.len() as f64))
            })
            .sum();
        log(counts.count + concentration)
            + counts.positions.log_predictive(&self.things.positions[thing], position)
            + attributes
    }

    /// Draws every unobserved label anew, given all others, and then shuffles the labels that no answer has tied to a
    /// person: the model cannot tell them apart, and single draws would hardly ever swap them.
    pub(super) fn sweep(&mut self, known: &[Known], generator: &mut impl Rng) {
        for (thing, known) in known.iter().enumerate() {
            if *known == Known::Nothing {
                self.withdraw(thing);
                let weights: Vec<f64> =
                    (0..self.labels.len()).map(|label| self.log_conditional(thing, label)).collect();
                self.assign(thing, draw(&weights, generator));
            }
        }
        let tied = |label: usize| known.contains(&Known::Label(label));
        let free: Vec<usize> = (0..self.labels.len()).filter(|&label| !tied(label)).collect();
        let mut renamed: Vec<usize> = (0..self.labels.len()).collect();
        for place in (1..free.len()).rev() {
            renamed.swap(free[place], free[generator.random_range(0..=place)]);
        }
        let mut labels = self.labels.clone();
        for (label, counts) in self.labels.drain(..).enumerate() {
            labels[renamed[label]] = counts;
        }
        self.labels = labels;
        for label in self.assigned.iter_mut().flatten() {
            *label = renamed[*label];
        }
    }
}

/// What is known of a thing's label.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Known {
    /// Nothing: it is sampled.
    Nothing,
    /// A person named one owner: it is observed.
    Label(usize),
    /// Its owners are no label: several people, or nobody of the household.
    LeftOut,
}

fn draw(log_weights: &[f64], generator: &mut impl Rng) -> usize {
    let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = log_weights.iter().map(|weight| exp(weight - largest)).collect();
    let mut left = generator.random::<f64>() * weights.iter().sum::<f64>();
    for (label, weight) in weights.iter().enumerate() {
        left -= weight;
        if left < 0.0 {
            return label;
        }
    }
    weights.len() - 1
}
