//! Answers that were computed by other means: the scripts under `coin/tests/known_answers/`, whose headers say by
//! which, print the tables beside them.

use std::collections::BTreeMap;

use coin::calibration::{CalibrationSample, Levels, calibrate};
use coin::common_sense::Expectation;
use coin::conformal::risk::{Outcome, RiskSample, risk_threshold};
use coin::conformal::{Quantile, split};
use coin::evidence::home::{HomeEvidence, SeenThing, Told};
use coin::evidence::{EvidenceParameters, KnownRelative, Opinion, Relation, log_likelihood, posterior};
use coin::metrics::{Judged, summarise};
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin_schemas::calibration::NonconformityScore;
use serde_json::Value;

use crate::support::{level, provenance, scores, set, user, values};

fn table(text: &str) -> Vec<Value> {
    let rows: Vec<Value> = serde_json::from_str(text).unwrap();
    assert!(!rows.is_empty());
    rows
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn owners(value: &Value) -> OwnerSet {
    let places: Vec<usize> = numbers(value).into_iter().map(|place| place as usize).collect();
    set(&places)
}

fn counts(value: &Value) -> Vec<u64> {
    value.as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).collect()
}

fn assert_close(found: f64, expected: f64, tolerance: f64, row: &Value) {
    assert!((found - expected).abs() <= tolerance, "{found} instead of {expected} in {row}");
}

/// What a thing is related to, of rows of a thing, an earlier one, and a number.
fn related(rows: &Value, place: usize) -> Vec<(usize, f64)> {
    let rows = rows.as_array().unwrap().iter().map(numbers);
    rows.filter(|row| row[0] as usize == place).map(|row| (row[1] as usize, row[2])).collect()
}

#[test]
fn homes_are_judged_as_by_enumeration() {
    for row in table(include_str!("../known_answers/home.json")) {
        let members = row["members"].as_u64().unwrap() as usize;
        let things: Vec<SeenThing> = row["things"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
            .map(|(place, users)| SeenThing {
                class: place.to_string(),
                sessions: numbers(users).into_iter().map(|place| user(place as usize)).collect(),
                near: related(&row["near"], place),
                alike: related(&row["alike"], place),
                candidates: (0..members).map(user).collect(),
                latecomers: OwnerSet::EMPTY,
            })
            .collect();
        let opinions: BTreeMap<usize, Expectation> = row["opinions"]
            .as_array()
            .unwrap()
            .iter()
            .map(|opinion| {
                let (single, everyone) = (number(&opinion["single"]), number(&opinion["everyone"]));
                let suitability = numbers(&opinion["suitability"]);
                (number(&opinion["thing"]) as usize, Expectation { single, everyone, suitability })
            })
            .collect();
        let mut told = vec![Told { answer: None, opinion: Opinion::None }; things.len()];
        for answer in row["answers"].as_array().unwrap() {
            told[number(&answer["thing"]) as usize].answer = Some(owners(&answer["owners"]));
        }
        for (place, told) in told.iter_mut().enumerate() {
            told.opinion = opinions.get(&place).into();
        }
        let judgement = HomeEvidence::new(things, EvidenceParameters::default()).judge(&told);
        for (found, expected) in judgement.distributions().iter().zip(row["posteriors"].as_array().unwrap()) {
            for set in expected.as_array().unwrap() {
                let probability = found.probability(owners(&set["owners"]));
                assert_close(probability, number(&set["probability"]), 1e-8, &row);
            }
        }
    }
}

#[test]
fn posteriors_are_those_of_numerical_integration() {
    for row in table(include_str!("../known_answers/evidence.json")) {
        let sessions = counts(&row["sessions"]);
        let relatives: Vec<KnownRelative> = row["relatives"]
            .as_array()
            .unwrap()
            .iter()
            .map(|relative| {
                let strength = number(&relative["strength"]);
                let relation = match relative["relation"].as_str().unwrap() {
                    "near" => Relation::Near { weight: strength },
                    "looks_alike" => Relation::LooksAlike { similarity: strength },
                    other => panic!("no such relation: {other}"),
                };
                KnownRelative { owners: owners(&relative["owners"]), relation }
            })
            .collect();
        let found = posterior(&sessions, Opinion::None, &relatives, &EvidenceParameters::default());
        let expected = row["posterior"].as_array().unwrap();
        assert_eq!(found.entries().len(), expected.len());
        for entry in expected {
            let probability = number(&entry["probability"]);
            let tolerance = 1e-10 + 1e-8 * probability;
            assert_close(found.probability(owners(&entry["owners"])), probability, tolerance, &row);
        }
    }
}

#[test]
fn likelihoods_are_those_of_an_urn() {
    for row in table(include_str!("../known_answers/likelihood.json")) {
        let expected = number(&row["log_likelihood"]);
        let found =
            log_likelihood(&counts(&row["sessions"]), owners(&row["owners"]), &EvidenceParameters::default());
        assert_close(found, expected, 1e-9 + 1e-11 * expected.abs(), &row);
    }
}

#[test]
fn independent_scores_make_the_distribution_of_every_combination() {
    for row in table(include_str!("../known_answers/distributions.json")) {
        let given = scores(&numbers(&row["scores"]));
        let found = OwnerSetDistribution::from_scores(&given);
        for (marginal, expected) in
            values(&found.marginals(given.len())).into_iter().zip(numbers(&row["marginals"]))
        {
            assert_close(marginal, expected, 1e-12, &row);
        }
        assert_close(found.entropy(), number(&row["entropy"]), 1e-12, &row);
        let (best, confidence) = found.best();
        assert_close(confidence, number(&row["confidence"]), 1e-12, &row);
        // The script names no best set where several are equally probable.
        assert!(row["best"].is_null() || best == owners(&row["best"]), "{row}");
    }
}

#[test]
fn conformal_thresholds_are_those_of_fractions_and_of_search() {
    for row in table(include_str!("../known_answers/conformal.json")) {
        let nonconformities = numbers(&row["scores"]);
        let right = row["right"].as_array().unwrap().iter().map(|right| right.as_bool().unwrap());
        let things: Vec<RiskSample> = numbers(&row["confidences"])
            .into_iter()
            .zip(right)
            .map(|(confidence, right)| RiskSample {
                confidence,
                outcome: if right { Outcome::Right } else { Outcome::Wrong },
            })
            .collect();
        for expected in row["levels"].as_array().unwrap() {
            let level = level(number(&expected["level"]));
            let upper = expected["upper"].as_f64().map_or(Quantile::TooFewSamples, Quantile::Value);
            assert_eq!(split::coverage_threshold(&nonconformities, level), upper, "{expected}");
            let lower = Quantile::Value(number(&expected["lower"]));
            assert_eq!(split::stopping_threshold(&nonconformities, level), lower, "{expected}");
            assert_eq!(risk_threshold(&things, level), number(&expected["lambda"]), "{expected}");
        }
    }
}

/// The same table through `calibrate`, which turns scores into nonconformities first.
#[test]
fn a_calibration_has_the_same_thresholds() {
    for row in table(include_str!("../known_answers/conformal.json")) {
        let samples: Vec<CalibrationSample> = numbers(&row["scores"])
            .into_iter()
            .map(|nonconformity| CalibrationSample {
                scores: scores(&[1.0 - nonconformity, 0.0]),
                distribution: OwnerSetDistribution::from_log_weights([(set(&[0]), 0.0)]),
                owners: set(&[0]),
            })
            .collect();
        for expected in row["levels"].as_array().unwrap() {
            let level = level(number(&expected["level"]));
            let levels = Levels { alpha: level, alpha_cp: level, risk: level };
            let found =
                calibrate(provenance("a-model", 1), &samples, levels, NonconformityScore::AnyOwner).unwrap();
            assert_close(found.q_alpha, expected["upper"].as_f64().unwrap_or(1.0), 1e-15, expected);
        }
    }
}

#[test]
fn metrics_are_those_of_matrices() {
    for row in table(include_str!("../known_answers/metrics.json")) {
        let sets = |key: &str| row[key].as_array().unwrap().iter().map(owners).collect::<Vec<_>>();
        let judged: Vec<Judged> = sets("estimate")
            .into_iter()
            .zip(sets("truth"))
            .map(|(estimate, truth)| Judged { estimate, truth })
            .collect();
        let found = summarise(&judged);
        let expected = &row["expected"];
        assert_eq!(found.objects, judged.len());
        assert_close(found.subset_accuracy, number(&expected["subset_accuracy"]), 1e-12, &row);
        assert_close(found.mean_jaccard, number(&expected["mean_jaccard"]), 1e-12, &row);
        assert_close(found.micro_precision, number(&expected["micro_precision"]), 1e-12, &row);
        assert_close(found.micro_recall, number(&expected["micro_recall"]), 1e-12, &row);
        assert_close(found.micro_f1, number(&expected["micro_f1"]), 1e-12, &row);
    }
}
