//! Laws of the evidence model. `coin/tests/method/known_answers.rs` compares it with numerical integration.

use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::owners::candidate_sets;
use crate::support::{any_order, any_set, moved, places, set, user};

const EXACT: f64 = 1e-12;

fn defaults() -> EvidenceParameters {
    EvidenceParameters::default()
}

fn any_sessions(members: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<u64>> {
    proptest::collection::vec(prop_oneof![0..6_u64, 0..60_u64], members)
}

fn any_relatives(members: usize) -> impl Strategy<Value = Vec<KnownRelative>> {
    let relation = prop_oneof![
        (0.0..=1.0_f64).prop_map(|weight| Relation::Near { weight }),
        (-1.0..=1.0_f64).prop_map(|similarity| Relation::LooksAlike { similarity }),
    ];
    let relative =
        (any_set(members), relation).prop_map(|(owners, relation)| KnownRelative { owners, relation });
    proptest::collection::vec(relative, 0..6)
}

fn any_evidence() -> impl Strategy<Value = (Vec<u64>, Vec<KnownRelative>)> {
    (1..=5_usize).prop_flat_map(|members| (any_sessions(members..=members), any_relatives(members)))
}

fn near(owners: &[usize], weight: f64) -> KnownRelative {
    KnownRelative { owners: set(owners), relation: Relation::Near { weight } }
}

fn looks_alike(owners: &[usize], similarity: f64) -> KnownRelative {
    KnownRelative { owners: set(owners), relation: Relation::LooksAlike { similarity } }
}

fn assert_same(left: &OwnerSetDistribution, right: &OwnerSetDistribution, tolerance: f64) {
    assert_eq!(left.entries().len(), right.entries().len());
    for (&(set, probability), &(other_set, other)) in left.entries().iter().zip(right.entries()) {
        assert_eq!(set, other_set);
        assert!((probability - other).abs() <= tolerance, "{:?}: {probability} and {other}", places(set));
    }
}

mod likelihood {
    use super::*;

    /// ln p(c|S) is the probability of the ordered sequence of users, not of the counts: over all n^N sequences
    /// of N sessions the probabilities sum to 1, for every owner set.
    #[rstest]
    fn sums_to_one_over_all_sequences_of_users(
        #[values(1, 2, 3)] members: usize,
        #[values(0, 1, 2, 3, 4)] length: u32,
    ) {
        for owners in candidate_sets(members) {
            let total: f64 = (0..members.pow(length))
                .map(|sequence| {
                    let mut counts = vec![0; members];
                    (0..length).for_each(|place| counts[sequence / members.pow(place) % members] += 1);
                    libm::exp(log_likelihood(&counts, owners, &defaults()))
                })
                .sum();
            assert!((total - 1.0).abs() < EXACT, "{:?}: {total}", places(owners));
        }
    }

    /// A sequence and the sequence before its last session: the first cannot be more probable.
    #[rstest]
    fn falls_with_every_session(#[values(1, 2, 3, 4)] members: usize) {
        for owners in candidate_sets(members) {
            let mut counts = vec![0; members];
            for round in 0..40 {
                let before = log_likelihood(&counts, owners, &defaults());
                counts[round * 7 % members] += 1;
                assert!(log_likelihood(&counts, owners, &defaults()) <= before + EXACT);
            }
        }
    }

    #[test]
    fn of_a_single_member_is_certain() {
        assert_eq!(log_likelihood(&[17], set(&[0]), &defaults()), 0.0);
    }

    proptest! {
        #[test]
        fn names_do_not_matter(
            (counts, owners, order) in (1..=5_usize).prop_flat_map(|n| (any_sessions(n..=n), any_set(n), any_order(n))),
        ) {
            let permuted = permute(&counts, &order);
            let before = log_likelihood(&counts, owners, &defaults());
            let after = log_likelihood(&permuted, moved(owners, &order), &defaults());
            prop_assert!((before - after).abs() < 1e-9);
        }
    }
}

fn permute(counts: &[u64], order: &[usize]) -> Vec<u64> {
    let mut permuted = vec![0; counts.len()];
    for (place, &count) in counts.iter().enumerate() {
        permuted[order[place]] = count;
    }
    permuted
}

mod prior {
    use super::*;

    /// Without sessions the posterior is π: .60 on one owner, .25 on everyone, the rest on the sizes between,
    /// evenly within a size. Two members leave no size between, so .60 and .25 are scaled up.
    #[rstest]
    #[case(1, &[1.0])]
    #[case(2, &[0.60 / 0.85, 0.25 / 0.85])]
    #[case(3, &[0.60, 0.15, 0.25])]
    #[case(4, &[0.60, 0.075, 0.075, 0.25])]
    #[case(8, &[0.60, 0.025, 0.025, 0.025, 0.025, 0.025, 0.025, 0.25])]
    #[case(9, &[0.60, 0.05, 0.05, 0.05, 0.0, 0.0, 0.0, 0.0, 0.25])]
    #[case(12, &[0.60, 0.05, 0.05, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25])]
    fn goes_by_the_number_of_owners(#[case] members: usize, #[case] by_size: &[f64]) {
        let prior = posterior(&vec![0; members], Opinion::None, &[], &defaults());
        for (size, &expected) in (1..=members).zip(by_size) {
            let of_size: Vec<f64> =
                prior.entries().iter().filter(|(set, _)| set.len() == size).map(|entry| entry.1).collect();
            assert!((of_size.iter().sum::<f64>() - expected).abs() < 1e-10);
            assert!(of_size.iter().all(|probability| (probability - of_size[0]).abs() < EXACT));
        }
    }
}

mod usage {
    use super::*;

    proptest! {
        #[test]
        fn the_posterior_is_a_distribution((sessions, relatives) in any_evidence()) {
            let posterior = posterior(&sessions, Opinion::None, &relatives, &defaults());
            let sum: f64 = posterior.entries().iter().map(|entry| entry.1).sum();
            prop_assert!((sum - 1.0).abs() < EXACT);
            prop_assert!(posterior.entries().iter().all(|entry| (0.0..=1.0).contains(&entry.1)));
            let sets: Vec<OwnerSet> = posterior.entries().iter().map(|entry| entry.0).collect();
            prop_assert_eq!(sets, candidate_sets(sessions.len()));
        }

        #[test]
        fn permuting_the_members_permutes_the_posterior(
            ((sessions, relatives), order) in any_evidence().prop_flat_map(|evidence| {
                let members = evidence.0.len();
                (Just(evidence), any_order(members))
            }),
        ) {
            let permuted_relatives: Vec<KnownRelative> = relatives
                .iter()
                .map(|relative| KnownRelative { owners: moved(relative.owners, &order), ..*relative })
                .collect();
            let before = posterior(&sessions, Opinion::None, &relatives, &defaults());
            let after = posterior(&permute(&sessions, &order), Opinion::None, &permuted_relatives, &defaults());
            for &(owners, probability) in before.entries() {
                prop_assert!((probability - after.probability(moved(owners, &order))).abs() < 1e-10);
            }
        }
    }

    fn score_of_first(sessions: &[u64], relatives: &[KnownRelative], parameters: &EvidenceParameters) -> f64 {
        posterior(sessions, Opinion::None, relatives, parameters).marginals(sessions.len())[0].value()
    }

    fn score_after_one_more(sessions: &[u64], parameters: &EvidenceParameters) -> (f64, f64) {
        let mut more = sessions.to_vec();
        more[0] += 1;
        (score_of_first(sessions, &[], parameters), score_of_first(&more, &[], parameters))
    }

    /// Searched, not proved: every household of two to four with up to this many sessions each.
    #[rstest]
    #[case(2, 60)]
    #[case(3, 16)]
    #[case(4, 7)]
    fn one_more_session_never_lowers_the_score_of_its_user(#[case] members: usize, #[case] most: usize) {
        for counts in 0..(most + 1).pow(members as u32) {
            let sessions: Vec<u64> = (0..members as u32)
                .map(|place| (counts / (most + 1).pow(place) % (most + 1)) as u64)
                .collect();
            let (before, after) = score_after_one_more(&sessions, &defaults());
            assert!(after >= before - EXACT, "{sessions:?}: {before} falls to {after}");
        }
    }

    /// It is a property of the defaults, not of the model: who thinks that things are hardly ever owned alone and
    /// are shared very evenly takes a user of nearly everything for a borrower.
    #[test]
    fn one_more_session_may_lower_the_score_where_sharing_must_be_even() {
        let even =
            EvidenceParameters { prior_single: 1e-9, prior_everyone: 1e-9, evenness: 100.0, ..defaults() };
        let (before, after) = score_after_one_more(&[15, 0, 0], &even);
        assert!(after < before - 0.01, "{before} to {after}");
    }

    #[rstest]
    #[case::a_single_user(&[20, 0, 0], &[0])]
    #[case::a_borrower(&[20, 3, 0], &[0])]
    #[case::two_alike(&[20, 19, 0], &[0, 1])]
    #[case::everyone_alike(&[12, 10, 11], &[0, 1, 2])]
    fn the_best_set_is_the_plain_reading(#[case] sessions: &[u64], #[case] owners: &[usize]) {
        assert_eq!(posterior(sessions, Opinion::None, &[], &defaults()).best().0, set(owners));
    }

    #[test]
    fn a_year_of_use_by_the_largest_home_stays_finite() {
        let sessions: Vec<u64> = (0..20).map(|place| 5000 / (place + 1)).collect();
        let posterior = posterior(&sessions, Opinion::None, &[near(&[0], 1.0)], &defaults());
        assert!(posterior.entries().iter().all(|entry| entry.1.is_finite()));
    }
}

mod relatives {
    use super::*;

    proptest! {
        #[test]
        fn switched_off_they_change_nothing((sessions, relatives) in any_evidence()) {
            let off = EvidenceParameters { place: 0.0, looks: 0.0, ..defaults() };
            assert_same(&posterior(&sessions, Opinion::None, &relatives, &off), &posterior(&sessions, Opinion::None, &[], &off), 0.0);
        }

        #[test]
        fn one_pulls_towards_its_owners(
            (sessions, owners) in (2..=5_usize).prop_flat_map(|n| (any_sessions(n..=n), any_set(n))),
            strength in 0.01..=1.0_f64,
        ) {
            prop_assume!(!owners.is_empty());
            let alone = posterior(&sessions, Opinion::None, &[], &defaults()).probability(owners);
            for relation in [Relation::Near { weight: strength }, Relation::LooksAlike { similarity: strength }] {
                let pulled = posterior(&sessions, Opinion::None, &[KnownRelative { owners, relation }], &defaults());
                prop_assert!(pulled.probability(owners) >= alone);
                let stronger = posterior(&sessions, Opinion::None, &[KnownRelative { owners, relation }; 2], &defaults());
                prop_assert!(stronger.probability(owners) >= pulled.probability(owners) - EXACT);
            }
        }

        /// However many relatives agree, the thing's own usage stays able to say otherwise: a set keeps at least
        /// ∏(1 − ρ) of its prior, and no other's prior grows beyond 1.
        #[test]
        fn they_make_nothing_certain((sessions, relatives) in any_evidence()) {
            let alone = posterior(&sessions, Opinion::None, &[], &defaults());
            let pulled = posterior(&sessions, Opinion::None, &relatives, &defaults());
            let strongest = defaults().place.max(defaults().looks);
            let independent = (1.0 - strongest).powi(relatives.len() as i32);
            let most_growth = independent + (1.0 - independent) / least_prior(sessions.len());
            for &(owners, probability) in alone.entries() {
                prop_assert!(pulled.probability(owners) >= 0.999_999 * probability * independent / most_growth);
            }
            let without_usage = posterior(&vec![0; sessions.len()], Opinion::None, &relatives, &defaults());
            prop_assert!(without_usage.entries().iter().all(|entry| entry.1 > 0.0));
        }

        #[test]
        fn unlike_things_and_things_of_strangers_say_nothing(
            sessions in any_sessions(1..=5), weight in 0.0..=1.0_f64, unlike in -1.0..=0.0_f64,
        ) {
            let silent = [near(&[], weight), looks_alike(&[], weight), looks_alike(&[0], unlike), near(&[0], 0.0)];
            assert_same(&posterior(&sessions, Opinion::None, &silent, &defaults()), &posterior(&sessions, Opinion::None, &[], &defaults()), EXACT);
        }
    }

    /// The smallest π(S) of a household.
    fn least_prior(members: usize) -> f64 {
        posterior(&vec![0; members], Opinion::None, &[], &defaults())
            .entries()
            .iter()
            .map(|entry| entry.1)
            .fold(1.0, f64::min)
    }

    /// The prior as a mixture, by hand: ρ₁ = .05 · .8, ρ₂ = .5 · .5, on two members without sessions.
    #[test]
    fn the_prior_is_a_mixture_of_relatives_and_pi() {
        let pulled =
            posterior(&[0, 0], Opinion::None, &[near(&[0], 0.8), looks_alike(&[0, 1], 0.5)], &defaults());
        let unrelated = (1.0 - 0.04) * (1.0 - 0.25);
        let (single, everyone) = (0.3 / 0.85, 0.25 / 0.85);
        let expected = [
            unrelated * single + (1.0 - unrelated) * 0.04 / 0.29,
            unrelated * single,
            unrelated * everyone + (1.0 - unrelated) * 0.25 / 0.29,
        ];
        for (entry, expected) in pulled.entries().iter().zip(expected) {
            assert!((entry.1 - expected).abs() < EXACT);
        }
    }

    /// Twenty neighbours of Ann's do not outvote twenty sessions of Bob.
    #[test]
    fn a_crowd_does_not_outvote_usage() {
        let posterior = posterior(&[0, 20, 0], Opinion::None, &[near(&[0], 1.0); 20], &defaults());
        assert_eq!(posterior.best().0, OwnerSet::single(user(1)));
    }

    /// Nine members, five owners: such a set is no candidate, so the relative cannot speak for one.
    #[test]
    fn one_whose_owners_are_no_candidate_says_nothing() {
        let sessions = [1, 0, 0, 0, 0, 0, 0, 0, 2];
        let certain = EvidenceParameters { place: 1.0, ..defaults() };
        let silent = posterior(&sessions, Opinion::None, &[near(&[0, 1, 2, 3, 4], 1.0)], &certain);
        assert_same(&silent, &posterior(&sessions, Opinion::None, &[], &certain), 0.0);
    }
}

mod opinion_of_a_model {
    use coin_schemas::household::Score;

    use super::*;
    use crate::common_sense::expect;

    fn scores(values: &[f64]) -> Vec<Score> {
        values.iter().map(|&value| Score::new(value).unwrap()).collect()
    }

    fn with(sessions: &[u64], values: &[f64]) -> OwnerSetDistribution {
        posterior(sessions, Opinion::OfModel(&scores(values)), &[], &defaults())
    }

    fn any_opinion() -> impl Strategy<Value = (Vec<u64>, Vec<f64>)> {
        (2..=5_usize).prop_flat_map(|members| {
            (any_sessions(members..=members), proptest::collection::vec(0.0..=1.0_f64, members))
        })
    }

    /// By fractions, for three members without a session: π is 1/5 for each alone, 1/20 for each pair and 1/4 for all.
    /// Scores .9, .3, .1 make e({0}) = 1/5 · 9/10 · 7/10 · 9/10 / Σ and so on; the mixture 3/4·π + 1/4·e was evaluated with
    /// Python's `fractions`.
    #[test]
    fn is_mixed_into_the_prior_as_odds_against_one_half() {
        let found = with(&[0, 0, 0], &[0.9, 0.3, 0.1]);
        let expected = [
            (vec![0], 4971.0 / 14240.0),
            (vec![1], 2271.0 / 14240.0),
            (vec![0, 1], 3351.0 / 56960.0),
            (vec![0, 1, 2], 2271.0 / 11392.0),
        ];
        for (members, probability) in expected {
            let found = found.probability(set(&members));
            assert!((found - probability).abs() < EXACT, "{members:?}: {found} and {probability}");
        }
    }

    #[rstest]
    #[case::of_one_half(&[0.5, 0.5, 0.5])]
    #[case::that_nobody_is_an_owner(&[0.0, 0.0, 0.0])]
    #[case::of_too_few_members(&[0.9, 0.1])]
    fn says_nothing(#[case] values: &[f64]) {
        assert_same(&with(&[3, 1, 0], values), &posterior(&[3, 1, 0], Opinion::None, &[], &defaults()), 1e-9);
    }

    #[test]
    fn outweighs_a_class_of_the_file_that_is_not_consulted_then() {
        let home = [("Bob", "father"), ("Mary", "mother"), ("Tom", "student")];
        let users = home.map(|(name, role)| {
            let background =
                coin_schemas::household::Background { role: Some(role.to_owned()), occupation: None };
            (coin_schemas::household::UserName::new(name).unwrap(), background)
        });
        let roster = crate::roster::Roster::new(&users.into_iter().collect()).unwrap();
        let expectation = expect("textbook", &roster).unwrap();
        let file = posterior(&[0; 3], Opinion::OfClass(&expectation), &[], &defaults());
        assert_eq!(file.best().0, set(&[2]));
        assert_eq!(with(&[0; 3], &[0.9, 0.05, 0.05]).best().0, set(&[0]));
    }

    proptest! {
        /// No opinion, however sure, excludes a set or takes more than (1 − w) of its prior odds.
        #[test]
        fn is_bounded((sessions, values) in any_opinion()) {
            let without = posterior(&sessions, Opinion::None, &[], &defaults());
            let with = with(&sessions, &values);
            let weight = defaults().language_model;
            for &(set, probability) in without.entries() {
                let least = (1.0 - weight) * probability
                    / ((1.0 - weight) + weight / smallest_prior(sessions.len()));
                prop_assert!(with.probability(set) >= least * (1.0 - 1e-9), "{:?}", places(set));
            }
        }

        /// A higher score makes nobody a less likely owner.
        #[test]
        fn is_monotone((sessions, values) in any_opinion(), raised in 0.0..=1.0_f64) {
            let mut higher = values.clone();
            higher[0] += (1.0 - higher[0]) * raised;
            prop_assume!(values.iter().any(|&value| value > 1e-6));
            let before = with(&sessions, &values).marginals(values.len())[0].value();
            let after = with(&sessions, &higher).marginals(values.len())[0].value();
            prop_assert!(after >= before - 1e-9, "{before} and {after}");
        }
    }

    /// The least prior probability of an owner set, which bounds how much the mixture can favour one.
    fn smallest_prior(members: usize) -> f64 {
        posterior(&vec![0; members], Opinion::None, &[], &defaults())
            .entries()
            .iter()
            .map(|&(_, probability)| probability)
            .fold(1.0, f64::min)
    }
}
