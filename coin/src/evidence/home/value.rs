//! What a question is worth: how much doubt its answer takes from a home, on average over what may be said.

use super::{HomeEvidence, HomeJudgement, Told};

/// Answers that are less probable than this are not thought through.
const WORTH_A_THOUGHT: f64 = 0.02;

impl HomeEvidence {
    /// The doubt that is expected to be left once a person has named the owners of a thing: `Σ_A p(A)·Σ_o (1 − conf(o | A))` over
    /// the things o that nobody has answered about and that are less sure than a gate settles them. The value of information
    /// of the question is the doubt before it less this (Howard, *Information Value Theory*, 1966); of several questions the
    /// one that leaves least is worth most.
    ///
    /// # Panics
    /// If the home was not judged with what is told.
    pub fn doubt_left(
        &self,
        told: &[Told<'_>],
        judgement: &HomeJudgement,
        place: usize,
        settled_from: f64,
    ) -> f64 {
        assert_eq!(told.len(), judgement.distributions().len(), "the home was judged with other things");
        let mut told = told.to_vec();
        let (mut left, mut all) = (0.0, 0.0);
        for &(owners, probability) in judgement.distributions()[place].entries() {
            if probability < WORTH_A_THOUGHT {
                continue;
            }
            told[place].answer = Some(owners);
            let then = self.judge_again(&told, judgement);
            let open = told.iter().zip(then.distributions()).filter(|(told, _)| told.answer.is_none());
            let confidences = open.map(|(_, distribution)| distribution.best().1);
            let doubts = confidences.filter(|&confidence| confidence < settled_from);
            left += probability * doubts.map(|confidence| 1.0 - confidence).sum::<f64>();
            all += probability;
        }
        left / all
    }
}
