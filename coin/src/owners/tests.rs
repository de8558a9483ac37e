//! Laws of owner sets and of distributions over them.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::support::{any_scores, any_set, name, places, roster, roster_of, scores, set, user, values};

const EXACT: f64 = 1e-12;

fn binomial(n: usize, k: usize) -> usize {
    (1..=k).fold(1, |product, factor| product * (n - k + factor) / factor)
}

/// A distribution from arbitrary positive weights over the candidates of a household of one to five.
fn any_distribution() -> impl Strategy<Value = (usize, OwnerSetDistribution)> {
    (1..=5_usize).prop_flat_map(|members| {
        let sets = candidate_sets(members);
        proptest::collection::vec(-30.0..5.0_f64, sets.len()).prop_map(move |weights| {
            (members, OwnerSetDistribution::from_log_weights(sets.iter().copied().zip(weights)))
        })
    })
}

/// Owner sets as names with blanks between.
fn named(sets: &[(&str, f64)]) -> Vec<OwnerSetProbability> {
    sets.iter()
        .map(|&(owners, probability)| OwnerSetProbability {
            owners: owners.split_whitespace().map(name).collect(),
            probability,
        })
        .collect()
}

mod candidates {
    use super::*;

    #[rstest]
    fn up_to_eight_members_every_non_empty_set_is_one(#[values(1, 2, 3, 4, 5, 6, 7, 8)] members: usize) {
        let sets = candidate_sets(members);
        assert_eq!(sets.len(), (1 << members) - 1);
        for size in 1..=members {
            assert_eq!(sets.iter().filter(|set| set.len() == size).count(), binomial(members, size));
        }
    }

    #[rstest]
    fn beyond_eight_they_have_up_to_four_members_or_all(#[values(9, 10, 13, 20, 64)] members: usize) {
        let sets = candidate_sets(members);
        for size in 1..=members {
            let expected = match size {
                1..=LARGEST_PARTIAL_SET => binomial(members, size),
                _ if size == members => 1,
                _ => 0,
            };
            assert_eq!(sets.iter().filter(|set| set.len() == size).count(), expected, "size {size}");
        }
    }

    #[rstest]
    fn they_are_distinct_and_of_the_household(#[values(1, 3, 8, 9, 12)] members: usize) {
        let sets = candidate_sets(members);
        let everyone: OwnerSet = (0..members).map(user).collect();
        assert_eq!(sets.iter().collect::<BTreeSet<_>>().len(), sets.len());
        assert!(sets.iter().all(|set| !set.is_empty() && set.is_subset(everyone)));
    }

    #[test]
    fn smaller_sets_come_first_then_the_order_of_the_roster() {
        let members: Vec<Vec<usize>> = candidate_sets(4).into_iter().map(places).collect();
        let expected: Vec<Vec<usize>> = vec![
            vec![0],
            vec![1],
            vec![2],
            vec![3],
            vec![0, 1],
            vec![0, 2],
            vec![0, 3],
            vec![1, 2],
            vec![1, 3],
            vec![2, 3],
            vec![0, 1, 2],
            vec![0, 1, 3],
            vec![0, 2, 3],
            vec![1, 2, 3],
            vec![0, 1, 2, 3],
        ];
        assert_eq!(members, expected);
    }

    #[rstest]
    fn the_order_of_sets_is_the_order_of_candidates(#[values(1, 5, 8, 9)] members: usize) {
        assert!(candidate_sets(members).is_sorted_by_key(|set| set.order()));
    }

    #[test]
    fn nobody_has_no_candidates() {
        assert_eq!(candidate_sets(0), Vec::new());
    }
}

mod set_algebra {
    use super::*;

    proptest! {
        #[test]
        fn agrees_with_sets_of_places(left in any_set(10), right in any_set(10)) {
            let of = |set: OwnerSet| places(set).into_iter().collect::<BTreeSet<usize>>();
            let (l, r) = (of(left), of(right));
            prop_assert_eq!(of(left.union(right)), &l | &r);
            prop_assert_eq!(of(left.intersection(right)), &l & &r);
            prop_assert_eq!(left.is_subset(right), l.is_subset(&r));
            prop_assert_eq!(left.len(), l.len());
            prop_assert_eq!(left.is_empty(), l.is_empty());
            for place in 0..10 {
                prop_assert_eq!(left.contains(user(place)), l.contains(&place));
                prop_assert_eq!(of(left.with(user(place))), &l | &BTreeSet::from([place]));
            }
        }
    }

    #[test]
    fn reaches_the_last_member_of_the_largest_household() {
        let last = user(crate::roster::MAX_USERS - 1);
        assert_eq!(OwnerSet::single(last).iter().collect::<Vec<_>>(), vec![last]);
    }
}

mod distribution {
    use super::*;

    proptest! {
        #[test]
        fn sums_to_one_and_its_marginals_are_sums((members, distribution) in any_distribution()) {
            let sum: f64 = distribution.entries().iter().map(|&(_, probability)| probability).sum();
            prop_assert!((sum - 1.0).abs() < EXACT);
            for (place, marginal) in distribution.marginals(members).into_iter().enumerate() {
                let expected: f64 = candidate_sets(members)
                    .into_iter()
                    .filter(|set| set.contains(user(place)))
                    .map(|set| distribution.probability(set))
                    .sum();
                prop_assert!((0.0..=1.0).contains(&marginal.value()));
                prop_assert!((marginal.value() - expected).abs() < EXACT);
            }
        }

        #[test]
        fn best_is_the_largest((_, distribution) in any_distribution()) {
            let (set, confidence) = distribution.best();
            prop_assert_eq!(confidence, distribution.probability(set));
            prop_assert!(distribution.entries().iter().all(|&(_, probability)| probability <= confidence));
        }

        #[test]
        fn weights_need_no_common_scale((_, distribution) in any_distribution(), shift in -2000.0..2000.0_f64) {
            let shifted = OwnerSetDistribution::from_log_weights(
                distribution.entries().iter().map(|&(set, probability)| (set, probability.ln() + shift)),
            );
            for &(set, probability) in distribution.entries() {
                prop_assert!((shifted.probability(set) - probability).abs() < 1e-10);
            }
        }

        #[test]
        fn entropy_lies_between_none_and_that_of_ignorance((members, distribution) in any_distribution()) {
            let most = (candidate_sets(members).len() as f64).ln();
            prop_assert!((0.0..=most + EXACT).contains(&distribution.entropy()));
        }

        /// By brute force: draw every combination of independent owners, drop "nobody", renormalise.
        #[test]
        fn from_scores_is_independence_given_that_somebody_owns_it(scores in any_scores(1..=8)) {
            let members = scores.len();
            let mut weights: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
            for bits in 1..1_u32 << members {
                let owners: Vec<usize> = (0..members).filter(|place| bits >> place & 1 == 1).collect();
                let weight = (0..members)
                    .map(|place| if owners.contains(&place) { scores[place].value() } else { 1.0 - scores[place].value() })
                    .product();
                weights.insert(owners, weight);
            }
            let sum: f64 = weights.values().sum();
            prop_assume!(sum > 0.0);
            let distribution = OwnerSetDistribution::from_scores(&scores);
            prop_assert_eq!(distribution.entries().len(), weights.len());
            for (owners, weight) in weights {
                prop_assert!((distribution.probability(set(&owners)) - weight / sum).abs() < EXACT);
            }
        }

        #[test]
        fn names_there_and_back_change_nothing((members, distribution) in any_distribution()) {
            let roster = roster_of(members);
            let named = distribution.to_named(&roster);
            prop_assert!(named.is_sorted_by(|left, right| left.probability >= right.probability));
            let back = OwnerSetDistribution::from_named(&roster, &named).unwrap();
            prop_assert_eq!(back.entries().len(), distribution.entries().len());
            for (&(set, probability), &(back_set, back_probability)) in
                distribution.entries().iter().zip(back.entries())
            {
                prop_assert_eq!(set, back_set);
                prop_assert!((probability - back_probability).abs() < EXACT);
            }
        }
    }

    #[test]
    fn surely_nobody_means_that_nothing_is_known() {
        let distribution = OwnerSetDistribution::from_scores(&scores(&[0.0, 0.0]));
        assert!(
            distribution.entries().iter().all(|&(_, probability)| (probability - 1.0 / 3.0).abs() < EXACT)
        );
    }

    #[test]
    fn five_sure_owners_of_nine_are_no_candidate_so_nothing_is_known() {
        let mut sure = vec![1.0; 5];
        sure.extend([0.0; 4]);
        let distribution = OwnerSetDistribution::from_scores(&scores(&sure));
        let uniform = 1.0 / distribution.entries().len() as f64;
        assert!(distribution.entries().iter().all(|&(_, probability)| (probability - uniform).abs() < EXACT));
    }

    #[test]
    fn a_set_of_weight_minus_infinity_is_excluded() {
        let distribution =
            OwnerSetDistribution::from_log_weights([(set(&[0]), -800.0), (set(&[1]), f64::NEG_INFINITY)]);
        assert_eq!(distribution.best(), (set(&[0]), 1.0));
        assert_eq!(distribution.probability(set(&[1])), 0.0);
    }

    #[test]
    #[should_panic(expected = "at least one owner set must be possible")]
    fn nothing_possible_is_a_fault_of_the_caller() {
        OwnerSetDistribution::from_log_weights([(set(&[0]), f64::NEG_INFINITY)]);
    }

    #[test]
    #[should_panic(expected = "every weight must be a number")]
    fn a_weight_that_is_no_number_is_a_fault_of_the_caller() {
        OwnerSetDistribution::from_log_weights([(set(&[0]), 0.0), (set(&[1]), f64::NAN)]);
    }

    /// Whatever the order in which the sets are handed in: {1, 2} as a number is smaller than {0, 3}.
    #[test]
    fn ties_go_to_the_smaller_set_then_to_the_roster() {
        let tied = [set(&[1, 2]), set(&[0, 3]), set(&[0, 1, 2])];
        let distribution = OwnerSetDistribution::from_log_weights(tied.map(|set| (set, 0.0)));
        assert_eq!(distribution.best().0, set(&[0, 3]));
        let roster = roster(&["Ann", "Bob", "Cid", "Dan"]);
        let given = named(&[("Bob Cid", 0.5), ("Ann Dan", 0.5)]);
        assert_eq!(OwnerSetDistribution::from_named(&roster, &given).unwrap().best().0, set(&[0, 3]));
    }

    #[test]
    fn certainty_has_no_entropy() {
        let certain = OwnerSetDistribution::from_log_weights([(set(&[0]), 3.0)]);
        assert_eq!(certain.entropy().to_bits(), 0.0_f64.to_bits());
    }

    /// The empty sum of floating-point numbers is −0 in Rust, which ranks below 0 and shows in files.
    #[test]
    fn the_marginal_of_somebody_in_no_set_is_plain_zero() {
        let distribution = OwnerSetDistribution::from_log_weights([(set(&[0]), 0.0)]);
        assert_eq!(values(&distribution.marginals(2))[1].to_bits(), 0.0_f64.to_bits());
    }
}

mod by_name {
    use super::*;

    #[rstest]
    #[case::negative(&[("Ann", -0.1)], "a probability lies between 0 and 1, and -0.1 does not")]
    #[case::above_one(&[("Ann", 1.5)], "a probability lies between 0 and 1, and 1.5 does not")]
    #[case::no_number(&[("Ann", f64::NAN)], "a probability lies between 0 and 1, and NaN does not")]
    #[case::too_little(&[("Ann", 0.5), ("Bob", 0.25)], "the probabilities of the owner sets sum to 0.75, not to 1")]
    #[case::nothing(&[], "the probabilities of the owner sets sum to 0, not to 1")]
    #[case::nobody(&[("", 1.0)], "the owner set {} is empty or stands twice")]
    #[case::twice(&[("Ann Bob", 0.5), ("Bob Ann", 0.5)], "the owner set {Ann, Bob} is empty or stands twice")]
    #[case::stranger(&[("Eve", 1.0)], "\"Eve\" is not a member of the household; its members are Ann, Bob")]
    fn what_is_no_distribution_is_refused(#[case] given: &[(&str, f64)], #[case] text: &str) {
        let refused = OwnerSetDistribution::from_named(&roster(&["Ann", "Bob"]), &named(given)).unwrap_err();
        assert_eq!(refused.to_string(), text);
    }

    #[rstest]
    #[case(1.0 + 0.9e-6, true)]
    #[case(1.0 + 1.1e-6, false)]
    #[case(1.0 - 0.9e-6, true)]
    #[case(1.0 - 1.1e-6, false)]
    fn a_sum_may_be_off_by_a_millionth(#[case] sum: f64, #[case] accepted: bool) {
        let given = named(&[("Ann", 0.5), ("Bob", sum - 0.5)]);
        let taken = OwnerSetDistribution::from_named(&roster(&["Ann", "Bob"]), &given);
        assert_eq!(taken.is_ok(), accepted);
        let total = taken.map_or(1.0, |taken| taken.entries().iter().map(|entry| entry.1).sum::<f64>());
        assert!((total - 1.0).abs() < EXACT);
    }

    /// A prediction set that may exclude nothing has to hold the sets that the model did not mention.
    #[test]
    fn sets_left_out_stay_candidates() {
        let roster = roster(&["Ann", "Bob"]);
        let taken = OwnerSetDistribution::from_named(&roster, &named(&[("Bob", 1.0)])).unwrap();
        assert_eq!(taken.entries(), &[(set(&[0]), 0.0), (set(&[1]), 1.0), (set(&[0, 1]), 0.0)]);
        assert_eq!(taken.to_named(&roster), named(&[("Bob", 1.0)]));
    }

    /// What is left out is as impossible to whoever takes the rest: it is a distribution again.
    #[test]
    fn the_likely_sets_are_a_distribution_of_their_own() {
        let roster = roster(&["Ann", "Bob"]);
        let weights = [(set(&[0]), 0.75), (set(&[1]), 0.05), (set(&[0, 1]), 0.20)];
        let taken = OwnerSetDistribution::from_weights(weights.to_vec());
        let likely = taken.likely(&roster, 0.1);
        assert_eq!(likely.iter().map(|set| set.owners.len()).collect::<Vec<_>>(), [1, 2]);
        assert!((likely[0].probability - 0.75 / 0.95).abs() < EXACT);
        assert!(OwnerSetDistribution::from_named(&roster, &likely).is_ok());
        // Where nothing is likely the best is the least that can be told.
        assert_eq!(taken.likely(&roster, 0.9), named(&[("Ann", 1.0)]));
    }

    #[test]
    fn a_large_household_may_name_a_set_beyond_the_candidates() {
        let roster = roster_of(9);
        let owners = roster.owners(set(&[0, 1, 2, 3, 4]));
        let given = [OwnerSetProbability { owners, probability: 1.0 }];
        let taken = OwnerSetDistribution::from_named(&roster, &given).unwrap();
        assert_eq!(taken.best(), (set(&[0, 1, 2, 3, 4]), 1.0));
        assert_eq!(taken.entries().len(), candidate_sets(9).len() + 1);
    }
}
