//! The Kaplan–Meier estimate (Kaplan and Meier, 1958): which share of runs has not reached its target by a step.

use std::collections::BTreeMap;

use coin_schemas::experiment::SurvivalStep;

/// How a run ended, as far as its target goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// It reached the target at this step.
    Reached,
    /// It ended at this step without reaching it; when it would have is not known.
    Censored,
}

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observation {
    /// The number of questions.
    pub step: usize,
    /// What happened then.
    pub outcome: Outcome,
}

/// The steps at which something happened, in order. A run that is censored at a step was still at risk when others
/// reached the target with the same question.
pub fn kaplan_meier(observations: &[Observation]) -> Vec<SurvivalStep> {
    let mut by_step: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for observation in observations {
        let (reached, censored) = by_step.entry(observation.step).or_default();
        match observation.outcome {
            Outcome::Reached => *reached += 1,
            Outcome::Censored => *censored += 1,
        }
    }
    let mut at_risk = observations.len();
    let mut survival = 1.0;
    by_step
        .into_iter()
        .map(|(step, (reached, censored))| {
            survival *= 1.0 - reached as f64 / at_risk as f64;
            let row = SurvivalStep { step, survival, at_risk, reached, censored };
            at_risk -= reached + censored;
            row
        })
        .collect()
}
