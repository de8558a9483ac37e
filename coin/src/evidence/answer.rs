//! What a person's answer makes of a belief: evidence, and not the truth.

use super::TRUST;
use crate::owners::{OwnerSet, OwnerSetDistribution};

/// The share of errors that are about one person: one too many, one too few, or one taken for another. Any other set is as
/// likely as the next to be named in the rest of them.
const ABOUT_ONE_PERSON: f64 = 0.75;

/// An answer that is less probably right than this, by everything that is known of the thing, is doubtful.
pub const DOUBTFUL: f64 = 0.5;

/// Whom everything but the answer speaks for, where the answer is doubtful.
pub fn against_answer(belief: &OwnerSetDistribution, named: OwnerSet, members: usize) -> Option<OwnerSet> {
    let after = after_answer(belief, named, members);
    let is_weighed = after.entries().iter().any(|&(set, _)| set == named);
    (is_weighed && after.probability(named) < DOUBTFUL).then(|| belief.best().0)
}

/// p(S | answer A) ∝ p(S)·p(A | S) in a household of so many members, where A is named with a probability of .95 if it is right.
/// Unchanged where A is none of the sets, as where somebody outside the household owns the thing.
pub fn after_answer(belief: &OwnerSetDistribution, named: OwnerSet, members: usize) -> OwnerSetDistribution {
    let entries = belief.entries();
    if entries.len() < 2 || !entries.iter().any(|&(set, _)| set == named) {
        return belief.clone();
    }
    let others = (entries.len() - 1) as f64;
    let likelihood = |set: OwnerSet| {
        if set == named {
            return TRUST;
        }
        let about_one = match differ_by_one_person(set, named) {
            true => ABOUT_ONE_PERSON / about_one_person(set.len(), members) as f64,
            false => 0.0,
        };
        (1.0 - TRUST) * (about_one + (1.0 - ABOUT_ONE_PERSON) / others)
    };
    OwnerSetDistribution::from_weights(
        entries.iter().map(|&(set, weight)| (set, weight * likelihood(set))).collect(),
    )
}

fn differ_by_one_person(one: OwnerSet, other: OwnerSet) -> bool {
    let both = one.intersection(other).len();
    one != other && one.len() - both <= 1 && other.len() - both <= 1
}

/// How many sets differ by one person from a set of so many of the members.
fn about_one_person(owners: usize, members: usize) -> usize {
    let others = members - owners;
    let fewer = if owners > 1 { owners } else { 0 };
    others + fewer + owners * others
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::owners::candidate_sets;
    use crate::support::set;

    fn belief(weights: &[(&[usize], f64)]) -> OwnerSetDistribution {
        OwnerSetDistribution::from_weights(
            weights.iter().map(|&(members, weight)| (set(members), weight)).collect(),
        )
    }

    /// p(right) = .95·p / (.95·p + .05·Σ …), by hand: of {0} four sets differ by one person, of {0, 1, 2} three.
    #[test]
    fn an_answer_is_weighed_against_an_error() {
        let before = belief(&[(&[0], 0.9), (&[1], 0.06), (&[0, 1, 2], 0.04)]);
        let right = 0.95 * 0.06;
        let wrong = 0.05 * (0.9 * (0.75 / 4.0 + 0.25 / 2.0) + 0.04 * (0.25 / 2.0));
        let after = after_answer(&before, set(&[1]), 3);
        assert!((after.probability(set(&[1])) - right / (right + wrong)).abs() < 1e-12);
    }

    #[test]
    fn only_a_doubtful_answer_has_something_against_it() {
        let before = belief(&[(&[0], 0.898), (&[1], 0.002), (&[0, 1], 0.1)]);
        assert_eq!(against_answer(&before, set(&[1]), 2), Some(set(&[0])));
        assert_eq!(against_answer(&before, set(&[0, 1]), 2), None);
        assert_eq!(against_answer(&before, set(&[0]), 2), None);
        assert_eq!(against_answer(&before, OwnerSet::EMPTY, 2), None, "a stranger's");
    }

    #[test]
    fn strangers_are_no_evidence() {
        let before = belief(&[(&[0], 0.9), (&[1], 0.1)]);
        assert_eq!(after_answer(&before, OwnerSet::EMPTY, 2), before);
        assert_eq!(after_answer(&belief(&[(&[0], 1.0)]), set(&[0]), 1), belief(&[(&[0], 1.0)]));
    }

    #[test]
    fn as_many_sets_differ_by_one_person_as_are_counted() {
        for members in 1..=5 {
            let sets = candidate_sets(members);
            for &one in &sets {
                let near = sets.iter().filter(|&&other| differ_by_one_person(one, other)).count();
                assert_eq!(near, about_one_person(one.len(), members));
            }
        }
    }

    proptest! {
        /// The answers that there may be have the probability 1 together, whatever is true.
        #[test]
        fn an_answer_makes_its_owners_likelier(weights in proptest::collection::vec(0.01..1.0_f64, 7), named in 0..7_usize) {
            let sets = candidate_sets(3);
            let before = OwnerSetDistribution::from_weights(sets.iter().copied().zip(weights).collect());
            let named = sets[named];
            let after = after_answer(&before, named, 3);
            prop_assert!(after.probability(named) > before.probability(named));
            let twice = after_answer(&after, named, 3);
            prop_assert!(twice.probability(named) > after.probability(named));
        }
    }
}
