//! Thresholds that can be worked out by hand, and what they settle.

use coin_schemas::model::OwnerSetProbability;
use coin_schemas::report::Scoring;
use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::conformal::risk::ASK_EVERYTHING;
use crate::owners::candidate_sets;
use crate::support::{any_scores, any_set, level, provenance, roster, scores, set};

fn levels(alpha: f64, alpha_cp: f64, risk: f64) -> Levels {
    Levels { alpha: level(alpha), alpha_cp: level(alpha_cp), risk: level(risk) }
}

/// A distribution over a household of two: the first alone, else the second alone.
fn first_or_second(first: f64) -> OwnerSetDistribution {
    let roster = roster(&["Ann", "Bob"]);
    let named = [(0, first), (1, 1.0 - first)].map(|(place, probability)| OwnerSetProbability {
        owners: roster.owners(set(&[place])),
        probability,
    });
    OwnerSetDistribution::from_named(&roster, &named).unwrap()
}

/// Nine things, i = 1 … 9, in numbers that binary holds exactly. The owner scores 1 − i/16, the other 0; the first
/// member is held to be the only owner with probability 1 − i/32, wrongly for i = 2 and i = 5.
fn nine_things() -> Vec<CalibrationSample> {
    (1..=9_u32)
        .map(|i| {
            let score = 1.0 - f64::from(i) / 16.0;
            let wrong = i == 2 || i == 5;
            CalibrationSample {
                scores: scores(&if wrong { [0.0, score] } else { [score, 0.0] }),
                distribution: first_or_second(1.0 - f64::from(i) / 32.0),
                owners: if wrong { set(&[1]) } else { set(&[0]) },
            }
        })
        .collect()
}

fn calibrated(samples: &[CalibrationSample], levels: Levels) -> Calibration {
    calibrate(provenance("a-model", 3), samples, levels, NonconformityScore::AllOwners).unwrap()
}

/// N = 9 and α = .2: rank 8. Nonconformity i/16, so q_α = 8/16; Γ of i = 9 is empty, cp_s = 1, the others' i/16, and
/// rank ⌈10 · .3⌉ = 3 gives q_cp = 3/16. 1 − p(S_true) is i/32, but 30/32 and 27/32 for the wrong ones: rank 8 is
/// 27/32. ε = .2 tolerates ⌊10 · .2⌋ − 1 = 1 error: λ̂ is the next number above 27/32.
#[test]
fn nine_things_have_the_thresholds_of_the_equations() {
    let expected = Calibration {
        version: 1,
        model: "a-model".to_owned(),
        alpha: 0.2,
        alpha_cp: 0.3,
        risk: 0.2,
        score: NonconformityScore::AllOwners,
        samples: 9,
        households: 3,
        q_alpha: 0.5,
        q_cp: 3.0 / 16.0,
        q_set: 27.0 / 32.0,
        lambda: (27.0_f64 / 32.0).next_up(),
        episodes: ["home-1", "home-2", "home-3"].map(str::to_owned).to_vec(),
        history: History::Whole,
        withheld: BTreeSet::new(),
        scoring: Scoring::default(),
        created_with: concat!("coin ", env!("CARGO_PKG_VERSION")).to_owned(),
    };
    assert_eq!(calibrated(&nine_things(), levels(0.2, 0.3, 0.2)), expected);
}

#[test]
fn the_two_scores_look_at_the_best_and_at_the_worst_owner() {
    let sample = CalibrationSample {
        scores: scores(&[0.75, 0.25]),
        distribution: first_or_second(0.5),
        owners: set(&[0, 1]),
    };
    let q_alpha = |score| {
        calibrate(provenance("a-model", 1), &vec![sample.clone(); 9], levels(0.2, 0.05, 0.1), score)
            .unwrap()
            .q_alpha
    };
    assert_eq!(q_alpha(NonconformityScore::AnyOwner), 0.25);
    assert_eq!(q_alpha(NonconformityScore::AllOwners), 0.75);
}

/// Three things are one too few for α = .2, and (0 + 1)/4 is more than ε: nothing is excluded, everything asked.
#[test]
fn too_few_things_exclude_nothing_and_settle_nothing() {
    let things = nine_things();
    let few = calibrated(&[things[0].clone(), things[2].clone(), things[3].clone()], levels(0.2, 0.05, 0.2));
    assert_eq!((few.q_alpha, few.q_set, few.lambda), (1.0, 1.0, ASK_EVERYTHING));
    assert_eq!(few.q_cp, 0.5 + 1.0 / 32.0, "the mean of 1/16 and 1: everybody is in Γ");
    let sure = Thresholds::from(&few).assess(
        &scores(&[1.0, 0.0]),
        &first_or_second(1.0),
        &ShareThresholds::default(),
    );
    assert_eq!(sure.prediction_set, set(&[0, 1]));
    assert_eq!(sure.plausible_sets, candidate_sets(2).len());
    assert!(!sure.settled);
}

/// q_α is computed on the nine owned things alone: with eleven its rank would be 10. The two of strangers count as
/// wrong: q_set has rank ⌈12 · .8⌉ = 10 of i/32, 27/32, 30/32, 1, 1, and λ̂ tolerates ⌊12 · .2⌋ − 1 = 1 error.
#[test]
fn things_that_nobody_owns_are_left_out_of_one_threshold_and_wrong_in_two() {
    let mut things = nine_things();
    for confidence in [31.0 / 32.0, 25.0 / 32.0] {
        let strange = CalibrationSample {
            scores: scores(&[0.25, 0.0]),
            distribution: first_or_second(confidence),
            owners: OwnerSet::EMPTY,
        };
        things.push(strange);
    }
    let calibration = calibrated(&things, levels(0.2, 0.3, 0.2));
    assert_eq!(calibration.samples, 11);
    assert_eq!(calibration.q_alpha, 0.5);
    assert_eq!(calibration.q_cp, 4.0 / 16.0, "⌈12 · .3⌉ = 4");
    assert_eq!(calibration.q_set, 1.0);
    assert_eq!(calibration.lambda, (30.0_f64 / 32.0).next_up());
}

#[test]
fn without_an_owned_thing_there_is_no_calibration() {
    let strange = CalibrationSample { owners: OwnerSet::EMPTY, ..nine_things().remove(0) };
    for things in [vec![], vec![strange]] {
        let refused = calibrate(
            provenance("a-model", 1),
            &things,
            levels(0.2, 0.05, 0.012),
            NonconformityScore::AnyOwner,
        )
        .unwrap_err();
        assert_eq!(
            refused.to_string(),
            "no calibration sample has an owner in the household; give episodes with a truth file"
        );
    }
}

mod embedded {
    use super::*;

    #[test]
    fn the_built_in_calibration_is_one() {
        let calibration =
            embedded_calibration(EMBEDDED_SCORING, NonconformityScore::AllOwners, &BTreeSet::new())
                .unwrap()
                .unwrap();
        assert_eq!(calibration.model, EMBEDDED_MODEL);
        for value in [calibration.alpha, calibration.alpha_cp, calibration.risk] {
            assert_eq!(level(value).value(), value);
        }
        for threshold in [calibration.q_alpha, calibration.q_cp, calibration.q_set] {
            assert!((0.0..=1.0).contains(&threshold));
        }
        assert!((0.0..=ASK_EVERYTHING).contains(&calibration.lambda));
        assert_eq!(Thresholds::for_model(Some(EMBEDDED_MODEL)), Thresholds::from(&calibration));
    }

    #[rstest]
    #[case(None)]
    #[case(Some("gpt-4o"))]
    #[case(Some("Embedded"))]
    fn no_other_model_has_one(#[case] model: Option<&str>) {
        assert_eq!(Thresholds::for_model(model), Thresholds::Uncalibrated);
        assert_eq!(Thresholds::for_model(model).lambda(), UNCALIBRATED_CONFIDENCE);
    }
}

fn any_sample() -> impl Strategy<Value = CalibrationSample> {
    (any_scores(3..=3), any_set(3)).prop_map(|(scores, owners)| {
        let distribution = OwnerSetDistribution::from_scores(&scores);
        CalibrationSample { scores, distribution, owners }
    })
}

proptest! {
    /// The thresholds do to their own samples what they promise: that much is arithmetic, without any chance.
    #[test]
    fn thresholds_keep_their_promise_on_their_own_samples(
        samples in proptest::collection::vec(any_sample(), 1..60), alpha in 1..1000_u32, risk in 1..1000_u32,
    ) {
        prop_assume!(samples.iter().any(|sample| !sample.owners.is_empty()));
        let levels = levels(f64::from(alpha) / 1000.0, 0.05, f64::from(risk) / 1000.0);
        let calibration = calibrated(&samples, levels);
        let thresholds = Thresholds::from(&calibration);
        let assessed: Vec<(&CalibrationSample, Assessment)> = samples
            .iter()
            .map(|sample| (sample, thresholds.assess(&sample.scores, &sample.distribution, &ShareThresholds::default())))
            .collect();
        let owned = samples.iter().filter(|sample| !sample.owners.is_empty()).count();
        let covered = assessed
            .iter()
            .filter(|(sample, thought)| !sample.owners.is_empty() && sample.owners.is_subset(thought.prediction_set))
            .count();
        prop_assert!(covered >= levels.alpha.upper_rank(owned).min(owned));
        let wrong = assessed.iter().filter(|(sample, thought)| thought.settled && thought.owners != sample.owners).count();
        let settled = assessed.iter().filter(|(_, thought)| thought.settled).count();
        prop_assert!(settled == 0 || wrong < levels.risk.allowed_losses(samples.len()));
    }

    /// λ̂ is one ulp above the confidence of a wrong thing, so a file that loses an ulp loses the guarantee.
    #[test]
    fn a_calibration_survives_its_file_to_the_last_bit(samples in proptest::collection::vec(any_sample(), 20..60)) {
        prop_assume!(samples.iter().any(|sample| !sample.owners.is_empty()));
        let calibration = calibrated(&samples, levels(0.2, 0.05, 0.1));
        let text = serde_json::to_string(&calibration).unwrap();
        prop_assert_eq!(serde_json::from_str::<Calibration>(&text).unwrap(), calibration);
    }
}

mod assessment {
    use super::*;

    const CALIBRATED: Thresholds =
        Thresholds::Calibrated { q_alpha: 0.5, q_cp: 0.1, q_set: 0.5, lambda: 0.75 };

    #[test]
    fn puts_together_what_the_gates_ask_for() {
        let scores = scores(&[0.75, 0.5, 0.25]);
        let named = [(set(&[0]), 0.5_f64), (set(&[1]), 0.375), (set(&[2]), 0.125)];
        let distribution = OwnerSetDistribution::from_log_weights(
            named.map(|(owners, probability)| (owners, probability.ln())),
        );
        let expected = Assessment {
            owners: set(&[0]),
            confidence: distribution.probability(set(&[0])),
            prediction_set: set(&[0, 1]),
            uncertainty: 0.375,
            plausible_sets: 1,
            shared_owners: None,
            shared: false,
            settled: false,
        };
        assert_eq!(CALIBRATED.assess(&scores, &distribution, &ShareThresholds::default()), expected);
    }

    #[test]
    fn says_who_shares() {
        let scores = scores(&[0.9, 0.85, 0.1]);
        let thought = CALIBRATED.assess(
            &scores,
            &OwnerSetDistribution::from_scores(&scores),
            &ShareThresholds::default(),
        );
        assert_eq!((thought.shared_owners, thought.shared), (Some(set(&[0, 1])), true));
    }

    #[rstest]
    #[case(0.75, true)]
    #[case(0.75_f64.next_down(), false)]
    fn settles_from_lambda_on(#[case] confidence: f64, #[case] settled: bool) {
        let distribution = first_or_second(confidence);
        let thought = CALIBRATED.assess(&scores(&[0.5, 0.5]), &distribution, &ShareThresholds::default());
        assert_eq!(thought.settled, settled);
    }

    #[test]
    fn excludes_nobody_without_a_calibration() {
        let thought = Thresholds::Uncalibrated.assess(
            &scores(&[1.0, 0.0]),
            &first_or_second(1.0),
            &ShareThresholds::default(),
        );
        assert_eq!(thought.prediction_set, set(&[0, 1]));
        assert_eq!(thought.plausible_sets, 3);
        assert_eq!(thought.uncertainty, 0.5);
        assert!(thought.settled);
    }
}

#[rstest]
#[case::none(0, &["q_alpha", "q_set", "lambda"])]
#[case::one_short_of_alpha(3, &["q_alpha", "q_set", "lambda"])]
#[case::enough_for_alpha(4, &["lambda"])]
#[case::one_short_of_risk(82, &["lambda"])]
#[case::enough(83, &[])]
fn too_few_samples_are_told(#[case] samples: usize, #[case] lacking: &[&str]) {
    let found = too_few_samples(samples, levels(0.2, 0.05, 0.012));
    assert_eq!(found.iter().map(|lack| lack.threshold).collect::<Vec<_>>(), lacking);
    for lack in found {
        assert_eq!(lack.needed, if lack.threshold == "lambda" { 83 } else { 4 });
    }
}
