//! The counting, on things whose every figure is written down by hand.

use std::collections::BTreeMap;

use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::roster::UserIndex;
use coin_schemas::household::Score;
use rstest::rstest;

use super::*;
use crate::cli::default_levels;

/// Thresholds that leave out whom the model gives less than .6 (any owner) or .3 (all owners), and settle from .9 on.
fn promises() -> Promises {
    let calibration = |score, q_alpha| Calibration {
        version: 1,
        model: "a model".to_owned(),
        alpha: 0.2,
        alpha_cp: 0.05,
        risk: 0.012,
        score,
        samples: 100,
        households: 3,
        q_alpha,
        q_cp: 0.1,
        q_set: 0.7,
        lambda: 0.9,
        episodes: Vec::new(),
        history: History::Whole,
        withheld: BTreeSet::new(),
        scoring: coin_schemas::report::Scoring::default(),
        created_with: "a test".to_owned(),
    };
    Promises {
        any_owner: calibration(NonconformityScore::AnyOwner, 0.4),
        all_owners: calibration(NonconformityScore::AllOwners, 0.7),
    }
}

fn owners(members: &[usize]) -> OwnerSet {
    members.iter().filter_map(|&member| UserIndex::new(member)).fold(OwnerSet::EMPTY, OwnerSet::with)
}

/// A thing of two people: their scores, p({0}), p({1}), p({0, 1}), and the true owners.
fn thing(scores: [f64; 2], sets: [f64; 3], truth: &[usize]) -> CalibrationSample {
    let named = [owners(&[0]), owners(&[1]), owners(&[0, 1])];
    let weights = named.into_iter().zip(sets.map(f64::ln));
    CalibrationSample {
        scores: scores.map(|score| Score::new(score).unwrap()).to_vec(),
        distribution: OwnerSetDistribution::from_log_weights(weights),
        owners: owners(truth),
    }
}

#[rstest]
#[case::sure_and_right(&[0], [0.95, 0.1], [0.95, 0.02, 0.03], [true, true, true, false])]
#[case::sure_and_wrong(&[1], [0.95, 0.1], [0.95, 0.02, 0.03], [false, false, false, true])]
#[case::one_of_two_is_found(&[0, 1], [0.95, 0.1], [0.95, 0.02, 0.03], [true, false, false, true])]
#[case::unsure_and_wrong(&[1], [0.55, 0.5], [0.5, 0.35, 0.15], [false, true, true, false])]
#[case::both_are_plausible(&[0, 1], [0.7, 0.65], [0.3, 0.1, 0.6], [true, true, true, false])]
fn each_promise_is_about_its_own(
    #[case] truth: &[usize],
    #[case] scores: [f64; 2],
    #[case] sets: [f64; 3],
    #[case] expected: [bool; 4],
) {
    let sample = thing(scores, sets, truth);
    assert_eq!(AT_ONCE.map(|guarantee| promises().holds(guarantee, &sample)), expected);
}

fn scored(name: &str, samples: Vec<CalibrationSample>) -> ScoredHome {
    ScoredHome { name: name.to_owned(), samples }
}

/// In homes that are all alike every split has the share of the whole.
#[test]
fn the_mean_over_splits_is_a_share_of_the_things_that_were_left() {
    let right = thing([0.95, 0.1], [0.95, 0.02, 0.03], &[0]);
    let wrong = thing([0.3, 0.25], [0.4, 0.35, 0.25], &[1]);
    let mut samples = vec![right; 9];
    samples.push(wrong);
    let homes: Vec<ScoredHome> = (0..40).map(|home| scored(&home.to_string(), samples.clone())).collect();
    let (calibrated_on, judged) = homes.split_at(30);
    let settings = ExperimentSettings {
        episodes: Vec::new(),
        calibrate_on: Vec::new(),
        levels: default_levels(),
        methods: BTreeSet::new(),
        trials: 1,
        seed: 0,
        concurrency: 4,
        coverage: Vec::new(),
        kinds: Vec::new(),
    };
    let means = over_splits(calibrated_on, judged, &settings, "a model").unwrap();
    // With α = .2 the threshold lets go of every tenth thing, and nothing wrong is as sure as what is right.
    for (mean, expected) in means.into_iter().zip([0.9, 0.9, 0.9, 0.0]) {
        assert!((mean - expected).abs() < 1e-12, "{means:?}");
    }
}

#[tokio::test]
async fn what_is_wrong_in_the_end_is_counted_against_the_truth() {
    let episode = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes/three-things");
    let home = load_home(&episode).await.unwrap();
    let truth: BTreeMap<_, _> =
        home.true_owners().into_iter().map(|(object, owners)| (object.clone(), owners)).collect();
    let nobody: BTreeMap<_, _> = truth.keys().map(|object| (object.clone(), OwnerSet::EMPTY)).collect();
    let mut but_one = truth.clone();
    *but_one.values_mut().next().unwrap() = OwnerSet::EMPTY;
    let after = |history: [&BTreeMap<_, _>; 2]| MethodOutcome {
        history: history.map(Clone::clone).to_vec(),
        cost: Default::default(),
    };
    let ended = |wrong| End { wrong, things: 3, questions: 1 };
    assert_eq!(end(&after([&nobody, &truth]), &home), ended(0));
    assert_eq!(end(&after([&truth, &nobody]), &home), ended(3));
    assert_eq!(end(&after([&truth, &but_one]), &home), ended(1));
}
