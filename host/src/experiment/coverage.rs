//! How often the guarantees hold: thresholds from some homes, counted on others.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use coin::calibration::{CalibrationSample, Provenance, calibrate};
use coin::conformal::{label_set, split};
use coin::statistics::clopper_pearson;
use coin_schemas::calibration::{Calibration, History, NonconformityScore};
use coin_schemas::experiment::{Coverage, Guarantee, Method};
use tempfile::TempDir;

use super::methods::{self, MethodOutcome};
use super::{
    Calibrations, CoverageHomes, ExperimentError, ExperimentSettings, JudgedHome, Progress, load_home,
};
use crate::calibrate::{ScoredHome, score_homes};
use crate::generate::{self, Protocol, RoutineSettings};
use crate::model::ChatModel;
use crate::parallel;

/// The homes that thresholds are made from where none are given: those of the built-in calibration.
const CALIBRATION_SEED: u64 = 1001;
const CALIBRATION_HOMES: usize = 100;

/// The first seed of the homes that are judged here and used for nothing else.
const JUDGED_SEED: u64 = 9001;

/// The share of intervals that hold what they are about.
const INTERVAL_LEVEL: f64 = 0.95;

/// Thresholds with both nonconformity scores, from the same homes.
struct Promises {
    any_owner: Calibration,
    all_owners: Calibration,
}

/// Counts how often every guarantee held, for each kind of home.
pub(super) async fn measure(
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<Coverage>, ExperimentError> {
    if settings.coverage.is_empty() {
        return Ok(Vec::new());
    }
    let promises = promises(settings, model, progress).await?;
    let mut coverage = Vec::new();
    for &homes in &settings.coverage {
        coverage.extend(of_kind(homes, &promises, settings.seed, model, progress).await?);
    }
    Ok(coverage)
}

async fn promises(
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Promises, ExperimentError> {
    let folder = TempDir::new()?;
    let homes = match settings.calibrate_on.is_empty() {
        true => make(Protocol::Week, CALIBRATION_SEED, CALIBRATION_HOMES, folder.path())?,
        false => settings.calibrate_on.clone(),
    };
    let scored = score(&homes, model, progress).await?;
    let samples: Vec<CalibrationSample> =
        scored.iter().flat_map(|home| home.samples.iter().cloned()).collect();
    let provenance = Provenance {
        model: model.name().to_owned(),
        episodes: scored.into_iter().map(|home| home.name).collect(),
        history: History::Whole,
        withheld: BTreeSet::new(),
    };
    let with = |score| calibrate(provenance.clone(), &samples, settings.levels, score);
    Ok(Promises {
        any_owner: with(NonconformityScore::AnyOwner)?,
        all_owners: with(NonconformityScore::AllOwners)?,
    })
}

async fn score(
    homes: &[PathBuf],
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<ScoredHome>, ExperimentError> {
    progress.begin(homes.len(), "homes scored");
    let scored = score_homes(homes, History::Whole, &BTreeSet::new(), model, || progress.step()).await?;
    progress.end();
    Ok(scored)
}

fn make(protocol: Protocol, seed: u64, count: usize, folder: &Path) -> Result<Vec<PathBuf>, ExperimentError> {
    (0..count as u64)
        .map(|step| {
            let home = generate::generate(&RoutineSettings { seed: seed + step, protocol });
            let folder = folder.join(&home.episode.name);
            generate::write(&home, &folder)?;
            Ok(folder)
        })
        .collect()
}

async fn of_kind(
    CoverageHomes { protocol, households }: CoverageHomes,
    promises: &Promises,
    seed: u64,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<Coverage>, ExperimentError> {
    let folder = TempDir::new()?;
    let homes = make(protocol, JUDGED_SEED, households, folder.path())?;
    let samples: Vec<CalibrationSample> =
        score(&homes, model, progress).await?.into_iter().flat_map(|home| home.samples).collect();
    let count =
        |keeps: &dyn Fn(&CalibrationSample) -> bool| samples.iter().filter(|sample| keeps(sample)).count();
    let lambda = promises.all_owners.lambda;
    let counts = [
        (Guarantee::AnyOwner, Some(NonconformityScore::AnyOwner), 1.0 - promises.any_owner.alpha, {
            let q_alpha = promises.any_owner.q_alpha;
            count(&|sample| {
                let set = split::prediction_set(&sample.scores, q_alpha);
                !set.intersection(sample.owners).is_empty()
            })
        }),
        (Guarantee::AllOwners, Some(NonconformityScore::AllOwners), 1.0 - promises.all_owners.alpha, {
            let q_alpha = promises.all_owners.q_alpha;
            count(&|sample| sample.owners.is_subset(split::prediction_set(&sample.scores, q_alpha)))
        }),
        (Guarantee::OwnerSet, None, 1.0 - promises.all_owners.alpha, {
            let q_set = promises.all_owners.q_set;
            count(&|sample| label_set::prediction_set(&sample.distribution, q_set).contains(&sample.owners))
        }),
        (Guarantee::SettledWrong, None, promises.all_owners.risk, {
            count(&|sample| {
                let (owners, confidence) = sample.distribution.best();
                confidence >= lambda && owners != sample.owners
            })
        }),
    ];
    let row = |guarantee, score, promised, count: usize, things: usize| {
        let (low, high) = clopper_pearson(count, things, INTERVAL_LEVEL);
        let share = count as f64 / things.max(1) as f64;
        Coverage {
            protocol: protocol.name().to_owned(),
            guarantee,
            score,
            promised,
            households,
            things,
            count,
            share,
            low,
            high,
        }
    };
    let mut rows: Vec<Coverage> = counts
        .into_iter()
        .map(|(guarantee, score, promised, count)| row(guarantee, score, promised, count, samples.len()))
        .collect();
    let (wrong, things) = wrong_in_the_end(&homes, promises, seed, model, progress).await?;
    rows.push(row(Guarantee::WrongInTheEnd, None, promises.all_owners.risk, wrong, things));
    Ok(rows)
}

/// Lets COIN ask in every home, and counts what is wrong when it is done.
async fn wrong_in_the_end(
    homes: &[PathBuf],
    promises: &Promises,
    seed: u64,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<(usize, usize), ExperimentError> {
    let calibrations: Arc<Calibrations> =
        Arc::new([(BTreeSet::new(), Some(promises.all_owners.clone()))].into());
    let jobs = homes.iter().cloned().map(|folder| {
        let (model, calibrations) = (Arc::clone(model), Arc::clone(&calibrations));
        async move {
            let home = load_home(&folder).await?;
            let outcome = methods::run(Method::Coin, &home, model.as_ref(), &calibrations, seed)
                .await
                .map_err(|source| ExperimentError::Episode { episode: folder, source: Box::new(source) })?;
            Ok::<_, ExperimentError>(wrong(&outcome, &home))
        }
    });
    progress.begin(homes.len(), "homes asked");
    let counted = parallel::in_order(jobs, || progress.step()).await?;
    progress.end();
    Ok(counted.into_iter().fold((0, 0), |(wrong, things), home| (wrong + home.0, things + home.1)))
}

fn wrong(outcome: &MethodOutcome, home: &JudgedHome) -> (usize, usize) {
    let owners = home.true_owners();
    let Some(last) = outcome.history.last() else { return (0, 0) };
    let wrong = owners.iter().filter(|(object, truth)| last.get(**object) != Some(truth)).count();
    (wrong, owners.len())
}
