//! Whether what a person said of a thing still holds: a change of hands since or a wrong answer, against a loan.

use libm::log;

use super::prior::{Candidates, log_mean, log_sum};
use super::{EvidenceParameters, TRUST, log_likelihood};
use crate::owners::{OwnerSet, OwnerSetDistribution};
use crate::roster::UserIndex;

/// An answer is held to be outdated from this probability on that the thing has changed hands since, or that the answer was
/// wrong. It is high because a loan goes through one pair of hands for days, which makes its sessions no independent
/// witnesses. In a simulation of three people, of things lent in 15 or 35 % of their sessions at most one in a hundred is
/// opened again within 30 sessions (in loans of three sessions on average 17 and 41), and half of those that change hands
/// are noticed within 8 or 9 sessions, nine of ten within 16.
pub const OUTDATED: f64 = 0.99;

/// A change of hands is looked for before no more than so many of the sessions, evenly spread.
const MOST_CUTS: usize = 16;

/// p(S | answer, use since): whose a thing is, of which a person said that it was owned by A, given who of a household of
/// so many members used it since, session by session in order of time.
///
/// With the probability ω of a wrong answer, χ of a change of hands and π by the number of owners, A has the weight
/// `(1−ω)·(1−χ)·p(c|A)`, and every other S `π(S)/(1−π(A))` times `ω·p(c|S)` and the mean of `(1−ω)·χ·p(c before t | A)·p(c
/// from t on | S)` over the sessions t. `None` where A is no candidate, as where somebody outside the household owns the
/// thing, or where nothing was seen since.
pub fn since_answer(
    sessions: &[UserIndex],
    members: usize,
    answered: OwnerSet,
    parameters: &EvidenceParameters,
) -> Option<OwnerSetDistribution> {
    let candidates = Candidates::of((0..members).filter_map(UserIndex::new).collect());
    let by_size = candidates.by_size(parameters.sizes());
    let place = candidates.sets().iter().position(|&set| set == answered)?;
    if candidates.sets().len() < 2 || sessions.is_empty() {
        return None;
    }
    let (wrong, change) = (1.0 - TRUST, TRUST * parameters.change_of_hands);
    let others = 1.0 - by_size[place];
    let counted = |sessions: &[UserIndex]| -> Vec<u64> {
        let mut counts = vec![0; members];
        sessions.iter().for_each(|user| counts[user.place()] += 1);
        counts
    };
    let likelihood =
        |sessions: &[UserIndex], set: OwnerSet| log_likelihood(&counted(sessions), set, parameters);
    let cuts = sessions.len().min(MOST_CUTS);
    let splits: Vec<(f64, &[UserIndex])> = (0..cuts)
        .map(|cut| {
            let (before, since) = sessions.split_at(cut * sessions.len() / cuts);
            (likelihood(before, answered), since)
        })
        .collect();
    let weighed = candidates.sets().iter().zip(&by_size).map(|(&set, prior)| {
        let logarithm = match set == answered {
            true => log(1.0 - wrong - change) + likelihood(sessions, set),
            false => {
                let changed: Vec<f64> =
                    splits.iter().map(|(before, since)| before + likelihood(since, set)).collect();
                let changed = log(change) + log_mean(&changed);
                log(prior / others) + log_sum(&[log(wrong) + likelihood(sessions, set), changed])
            }
        };
        (set, logarithm)
    });
    Some(OwnerSetDistribution::from_log_weights(weighed))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rstest::rstest;

    use super::*;
    use crate::support::{set, user};

    fn changed(sessions: &str, members: usize, answered: &[usize]) -> f64 {
        let sessions: Vec<UserIndex> =
            sessions.bytes().map(|letter| user(usize::from(letter - b'a'))).collect();
        let posterior = since_answer(&sessions, members, set(answered), &EvidenceParameters::default());
        1.0 - posterior.unwrap().probability(set(answered))
    }

    #[rstest]
    #[case::a_short_loan("bbb")]
    #[case::lent_now_and_then("aabaabaaaabaaab")]
    #[case::a_loan_that_ended("aaabbbaaa")]
    #[case::nothing_new("aaaaaaaaaa")]
    fn an_answer_holds_as_long_as_a_loan_explains_the_use(#[case] sessions: &str) {
        assert!(changed(sessions, 3, &[0]) < OUTDATED, "{}", changed(sessions, 3, &[0]));
    }

    #[rstest]
    #[case::given_away_at_once("bbbbbbb")]
    #[case::given_away_later("aaaaaaaaaabbbbbbbb")]
    #[case::shared_by_others("bcbccbbcbccbcbbcbccbbc")]
    fn an_answer_is_outdated_where_other_owners_explain_the_use_far_better(#[case] sessions: &str) {
        assert!(changed(sessions, 3, &[0]) >= OUTDATED, "{}", changed(sessions, 3, &[0]));
    }

    #[test]
    fn what_was_everybodys_may_become_one_persons() {
        assert!(changed("abcabccccccccccccccccc", 3, &[0, 1, 2]) >= OUTDATED);
    }

    #[test]
    fn nothing_is_said_of_what_strangers_own_or_a_person_who_lives_alone() {
        let defaults = EvidenceParameters::default();
        assert_eq!(since_answer(&[user(0)], 3, OwnerSet::EMPTY, &defaults), None);
        assert_eq!(since_answer(&[user(0)], 1, set(&[0]), &defaults), None);
        assert_eq!(since_answer(&[], 3, set(&[0]), &defaults), None);
    }

    proptest! {
        /// Before anything was seen the answer holds with (1−ω)·(1−χ), and that is what is expected to be thought afterwards.
        #[test]
        fn the_expected_posterior_is_the_prior(length in 1..5_usize, answered in 0..2_usize) {
            let defaults = EvidenceParameters::default();
            let all = (0..length).fold(vec![Vec::new()], |sequences: Vec<Vec<UserIndex>>, _| {
                sequences.iter().flat_map(|sequence| (0..2).map(|next| {
                    sequence.iter().copied().chain([user(next)]).collect()
                })).collect()
            });
            let counts = |sequence: &[UserIndex]| -> Vec<u64> {
                (0..2).map(|place| sequence.iter().filter(|&&by| by == user(place)).count() as u64).collect()
            };
            let answered = set(&[answered]);
            // p(c | A) = posterior(A)·p(c) / ((1−ω)·(1−χ)), so that the sum of p(c) over all sequences must be 1.
            let total: f64 = all.iter().map(|sequence| {
                let posterior = since_answer(sequence, 2, answered, &defaults).unwrap();
                let likelihood = libm::exp(log_likelihood(&counts(sequence), answered, &defaults));
                likelihood * TRUST * (1.0 - defaults.change_of_hands) / posterior.probability(answered)
            }).sum();
            prop_assert!((total - 1.0).abs() < 1e-9, "{}", total);
        }
    }
}
