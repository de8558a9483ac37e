//! The adaptive gate: its threshold follows from the answers of the home that it judges.
//!
//! A threshold λ̂ from other homes keeps its promise in homes like those. Where a home is unlike them, what is thought of its
//! things may be wrong more often than it seems, and the answers show it: every answer either agrees with what was thought
//! most probable or does not. So the gate does after every answer what adaptive conformal inference does (Gibbs and Candès,
//! *Adaptive Conformal Inference Under Distribution Shift*, 2021): it moves its threshold by how far the errors that were
//! seen are from those that were expected. Only, a home has few answers, and so the step is no constant but that of Bayes.

use crate::conformal::Level;

/// With how many expected errors one takes the claims of the model at their word before anybody answered: the parameter m of
/// the Gamma(m, m) prior of the factor ρ by which errors are more frequent than is claimed.
const CREDIT: f64 = 1.0;

/// How the claims of a model have fared against the answers of people.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrackRecord {
    /// Σ (1 − conf(o)) over what was answered: how many errors were expected.
    pub expected: f64,
    /// How often the answer was another than the most probable owner set.
    pub wrong: usize,
}

impl TrackRecord {
    /// Takes in an answer about a thing, of whose best owner set so much was claimed.
    pub fn add(&mut self, confidence: f64, agrees: bool) {
        self.expected += 1.0 - confidence;
        self.wrong += usize::from(!agrees);
    }

    /// (m + errors) / (m + expected errors): the posterior mean of ρ, where errors are a Poisson process of ρ times the claimed
    /// rate.
    pub fn factor(&self) -> f64 {
        (CREDIT + self.wrong as f64) / (CREDIT + self.expected)
    }
}

/// What is held of a thing that may still be asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// Nobody has answered, and the best owner set is so probable.
    Inferred {
        /// conf(o).
        confidence: f64,
    },
    /// Somebody has, and is so probably right.
    Answered {
        /// p(A | answers, everything else).
        trust: f64,
    },
}

/// How much doubt about a thing is let stand: the most that leaves no more errors than ε allows among what is not asked about,
/// `Σ_{doubt(o) ≤ δ} doubt(o) ≤ ε·N`. The doubt is `ρ·(1 − conf(o))` before an answer, and `1 − p(right)` after one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdaptedThreshold {
    /// δ; `None` where only a question about everything will do.
    doubt: Option<f64>,
    /// ρ.
    factor: f64,
}

impl AdaptedThreshold {
    /// The threshold for these of N things, by the record so far.
    pub fn new(
        held: impl IntoIterator<Item = Held>,
        things: usize,
        risk: Level,
        record: TrackRecord,
    ) -> Self {
        let factor = record.factor();
        let mut doubts: Vec<f64> = held
            .into_iter()
            .map(|held| match held {
                Held::Inferred { confidence } => factor * (1.0 - confidence),
                Held::Answered { trust } => 1.0 - trust,
            })
            .collect();
        doubts.sort_by(f64::total_cmp);
        let allowed = risk.value() * things as f64;
        let (mut sum, mut doubt) = (0.0, None);
        // What is equally doubtful is asked about together.
        for equal in doubts.chunk_by(|left, right| left == right) {
            sum += equal.iter().sum::<f64>();
            if sum > allowed {
                break;
            }
            doubt = Some(equal[0]);
        }
        Self { doubt, factor }
    }

    /// Whether a thing that nobody has answered about is left as it is.
    pub fn settles(&self, confidence: f64) -> bool {
        self.lets_stand(self.factor * (1.0 - confidence))
    }

    /// Whether an answer is taken as it is.
    pub fn settles_answer(&self, trust: f64) -> bool {
        self.lets_stand(1.0 - trust)
    }

    /// λ_t, from which on a thing is settled without an answer: 1 − δ/ρ; infinite where none is.
    pub fn lambda(&self) -> f64 {
        self.doubt.map_or(f64::INFINITY, |doubt| 1.0 - doubt / self.factor)
    }

    fn lets_stand(&self, doubt: f64) -> bool {
        self.doubt.is_some_and(|most| doubt <= most)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn record(expected: f64, wrong: usize) -> TrackRecord {
        TrackRecord { expected, wrong }
    }

    fn threshold(confidences: &[f64], things: usize, record: TrackRecord) -> AdaptedThreshold {
        let held = confidences.iter().map(|&confidence| Held::Inferred { confidence });
        AdaptedThreshold::new(held, things, Level::new(0.012).unwrap(), record)
    }

    fn settled(confidences: &[f64], things: usize, record: TrackRecord) -> usize {
        let threshold = threshold(confidences, things, record);
        confidences.iter().filter(|&&confidence| threshold.settles(confidence)).count()
    }

    #[test]
    fn without_answers_the_model_is_taken_at_its_word() {
        assert_eq!(record(0.0, 0).factor(), 1.0);
        // 100 things may leave 1.2 errors: .4 + .3 + .2 + .1 would.
        assert_eq!(settled(&[0.6, 0.7, 0.8, 0.9], 100, record(0.0, 0)), 4);
        assert_eq!(settled(&[0.3, 0.7, 0.8, 0.9], 100, record(0.0, 0)), 3);
    }

    #[test]
    fn errors_raise_the_threshold_and_agreement_lowers_it() {
        // 40 things may leave .48 errors.
        let settled = |expected, wrong| settled(&[0.6, 0.7, 0.8, 0.9, 0.95], 40, record(expected, wrong));
        assert_eq!(settled(0.0, 0), 3);
        assert_eq!(settled(1.0, 3), 2);
        assert_eq!(settled(1.0, 0), 4);
    }

    #[test]
    fn equal_doubts_are_asked_about_together() {
        assert_eq!(settled(&[0.7, 0.7, 0.7, 0.9], 40, record(0.0, 0)), 1);
        assert_eq!(settled(&[0.3, 0.3], 40, record(0.0, 0)), 0);
        assert_eq!(threshold(&[0.3, 0.3], 40, record(0.0, 0)).lambda(), f64::INFINITY);
        assert_eq!(threshold(&[0.75, 0.3], 40, record(0.0, 0)).lambda(), 0.75);
    }

    #[test]
    fn an_answer_that_may_be_wrong_takes_its_part_of_what_is_allowed() {
        let held = [
            Held::Answered { trust: 0.7 },
            Held::Inferred { confidence: 0.8 },
            Held::Answered { trust: 0.99 },
        ];
        let threshold = AdaptedThreshold::new(held, 40, Level::new(0.012).unwrap(), record(0.0, 1));
        // The error doubles the doubt of what was inferred, and no answer's.
        assert!(threshold.settles_answer(0.99) && threshold.settles_answer(0.7));
        assert!(!threshold.settles(0.8));
    }

    proptest! {
        #[test]
        fn what_is_left_is_allowed_and_no_more_is_asked_than_that_takes(
            confidences in proptest::collection::vec(0.0..1.0_f64, 0..40),
            expected in 0.0..5.0_f64,
            wrong in 0..6_usize,
        ) {
            let record = record(expected, wrong);
            let threshold = threshold(&confidences, 40, record);
            let doubt = |confidence: &f64| record.factor() * (1.0 - confidence);
            let (left, asked): (Vec<f64>, Vec<f64>) = confidences.iter().partition(|&&sure| threshold.settles(sure));
            let sum: f64 = left.iter().map(doubt).sum();
            prop_assert!(sum <= 0.012 * 40.0 + 1e-9);
            if let Some(next) = asked.iter().map(doubt).min_by(f64::total_cmp) {
                prop_assert!(sum + next > 0.012 * 40.0 - 1e-9);
                prop_assert!(left.iter().map(doubt).all(|doubt| doubt < next));
            }
        }
    }
}
