//! How often the guarantees hold: thresholds from some homes, counted on others.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use coin::calibration::{CalibrationError, CalibrationSample, Provenance, calibrate};
use coin::conformal::{label_set, split};
use coin::evidence::EvidenceParameters;
use coin::statistics::clopper_pearson;
use coin_schemas::calibration::{Calibration, History, NonconformityScore};
use coin_schemas::experiment::{Coverage, Guarantee};
use coin_schemas::report::Gate;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use tempfile::TempDir;

use super::methods::{self, MethodOutcome};
use super::{
    Calibrations, CoverageHomes, ExperimentError, ExperimentSettings, JudgedHome, Progress, default_kind,
    load_home,
};
use crate::calibrate::{HomeScoring, ScoredHome, score_homes};
use crate::generate::{self, Protocol, RoutineSettings};
use crate::model::ChatModel;
use crate::parallel;
use crate::person::ErrorRate;
use crate::run::default_scoring;

/// The homes that thresholds are made from where none are given: those of the built-in calibration.
const CALIBRATION_SEED: u64 = 1001;
const CALIBRATION_HOMES: usize = 100;

/// The first seed of the homes that are judged here and used for nothing else.
const JUDGED_SEED: u64 = 9001;

/// The share of intervals that hold what they are about.
const INTERVAL_LEVEL: f64 = 0.95;

/// How often the homes are split anew, and the seed of the splits.
const SPLITS: usize = 200;
const SPLIT_SEED: u64 = 1;

/// Thresholds with both nonconformity scores, from the same homes.
struct Promises {
    any_owner: Calibration,
    all_owners: Calibration,
}

impl Promises {
    fn from_homes<'a>(
        homes: impl Iterator<Item = &'a ScoredHome> + Clone,
        settings: &ExperimentSettings,
        model: &str,
    ) -> Result<Self, CalibrationError> {
        let samples: Vec<CalibrationSample> =
            homes.clone().flat_map(|home| home.samples.iter().cloned()).collect();
        let provenance = Provenance {
            model: model.to_owned(),
            episodes: homes.map(|home| home.name.clone()).collect(),
            history: History::Whole,
            withheld: BTreeSet::new(),
            scoring: default_scoring(model),
        };
        let with = |score| calibrate(provenance.clone(), &samples, settings.levels, score);
        Ok(Self {
            any_owner: with(NonconformityScore::AnyOwner)?,
            all_owners: with(NonconformityScore::AllOwners)?,
        })
    }

    /// Whether what a guarantee is about is so for a thing.
    fn holds(&self, guarantee: Guarantee, sample: &CalibrationSample) -> bool {
        let members = |calibration: &Calibration| split::prediction_set(&sample.scores, calibration.q_alpha);
        match guarantee {
            Guarantee::AnyOwner => !members(&self.any_owner).intersection(sample.owners).is_empty(),
            Guarantee::AllOwners => sample.owners.is_subset(members(&self.all_owners)),
            Guarantee::OwnerSet => label_set::prediction_set(&sample.distribution, self.all_owners.q_set)
                .contains(&sample.owners),
            Guarantee::SettledWrong
            | Guarantee::WrongInTheEnd
            | Guarantee::WrongDespiteErrors
            | Guarantee::WrongAdapted
            | Guarantee::WrongAdaptedDespiteErrors => {
                let (owners, confidence) = sample.distribution.best();
                confidence >= self.all_owners.lambda && owners != sample.owners
            }
        }
    }

    fn promised(&self, guarantee: Guarantee) -> f64 {
        if guarantee.is_loss() { self.all_owners.risk } else { 1.0 - self.all_owners.alpha }
    }
}

/// What is known before a question is asked.
const AT_ONCE: [Guarantee; 4] =
    [Guarantee::AnyOwner, Guarantee::AllOwners, Guarantee::OwnerSet, Guarantee::SettledWrong];

/// What is known when the questions were asked, and who asked them and who answered.
const IN_THE_END: [(Guarantee, Gate, ErrorRate); 4] = [
    (Guarantee::WrongInTheEnd, Gate::Risk, ErrorRate::NONE),
    (Guarantee::WrongDespiteErrors, Gate::Risk, ErrorRate::ONE_IN_TWENTY),
    (Guarantee::WrongAdapted, Gate::Adaptive, ErrorRate::NONE),
    (Guarantee::WrongAdaptedDespiteErrors, Gate::Adaptive, ErrorRate::ONE_IN_TWENTY),
];

/// Counts how often every guarantee held, for each kind of home.
pub(super) async fn measure(
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<Coverage>, ExperimentError> {
    if settings.coverage.is_empty() {
        return Ok(Vec::new());
    }
    let folder = TempDir::new()?;
    let calibrated_on = match settings.calibrate_on.is_empty() {
        true => make(Protocol::Week, CALIBRATION_SEED, CALIBRATION_HOMES, folder.path())?,
        false => settings.calibrate_on.clone(),
    };
    let calibrated_on = score(&calibrated_on, settings, model, progress).await?;
    let promises = Promises::from_homes(calibrated_on.iter(), settings, model.name())?;
    let mut coverage = Vec::new();
    for &homes in &settings.coverage {
        coverage.extend(of_kind(homes, settings, &calibrated_on, &promises, model, progress).await?);
    }
    Ok(coverage)
}

async fn score(
    homes: &[PathBuf],
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<ScoredHome>, ExperimentError> {
    progress.begin(homes.len(), "homes scored");
    let how = HomeScoring {
        history: History::Whole,
        withheld: BTreeSet::new(),
        scoring: default_scoring(model.name()),
        parameters: EvidenceParameters::default(),
        concurrency: settings.concurrency,
    };
    let scored = score_homes(homes, &how, model, || progress.step()).await?;
    progress.end();
    Ok(scored)
}

/// Makes so many homes of a kind with seeds from this one on.
pub(super) fn make(
    protocol: Protocol,
    seed: u64,
    count: usize,
    folder: &Path,
) -> Result<Vec<PathBuf>, ExperimentError> {
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
    settings: &ExperimentSettings,
    calibrated_on: &[ScoredHome],
    promises: &Promises,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<Coverage>, ExperimentError> {
    let folder = TempDir::new()?;
    let homes = make(protocol, JUDGED_SEED, households, folder.path())?;
    let judged = score(&homes, settings, model, progress).await?;
    let same_kind = protocol == Protocol::Week && settings.calibrate_on.is_empty();
    let row = |guarantee, count: usize, things: usize| {
        let (low, high) = clopper_pearson(count, things, INTERVAL_LEVEL);
        Coverage {
            protocol: protocol.name().to_owned(),
            guarantee,
            promised: promises.promised(guarantee),
            households,
            things,
            count,
            share: count as f64 / things.max(1) as f64,
            low,
            high,
            over_splits: None,
            questions: None,
        }
    };
    let mut rows = Vec::new();
    for guarantee in AT_ONCE {
        let things = judged.iter().flat_map(|home| &home.samples);
        let count = things.clone().filter(|sample| promises.holds(guarantee, sample)).count();
        rows.push(row(guarantee, count, things.count()));
    }
    if same_kind {
        let means = over_splits(calibrated_on, &judged, settings, model.name())?;
        for (row, mean) in rows.iter_mut().zip(means) {
            row.over_splits = Some(mean);
        }
    }
    for (guarantee, gate, wrong_answers) in IN_THE_END {
        let end = asked(&homes, (gate, wrong_answers), promises, settings, model, progress).await?;
        let questions = Some(end.questions as f64 / households.max(1) as f64);
        rows.push(Coverage { questions, ..row(guarantee, end.wrong, end.things) });
    }
    Ok(rows)
}

/// The mean share of every guarantee of [`AT_ONCE`] over random splits: as many homes as were calibrated on make
/// thresholds, the others are judged by them.
fn over_splits(
    calibrated_on: &[ScoredHome],
    judged: &[ScoredHome],
    settings: &ExperimentSettings,
    model: &str,
) -> Result<[f64; AT_ONCE.len()], ExperimentError> {
    let mut homes: Vec<&ScoredHome> = calibrated_on.iter().chain(judged).collect();
    let mut generator = ChaCha8Rng::seed_from_u64(SPLIT_SEED);
    let mut sums = [0.0; AT_ONCE.len()];
    for _ in 0..SPLITS {
        homes.shuffle(&mut generator);
        let (calibration, rest) = homes.split_at(calibrated_on.len());
        let promises = Promises::from_homes(calibration.iter().copied(), settings, model)?;
        let things: Vec<&CalibrationSample> = rest.iter().flat_map(|home| &home.samples).collect();
        for (sum, guarantee) in sums.iter_mut().zip(AT_ONCE) {
            let count = things.iter().filter(|sample| promises.holds(guarantee, sample)).count();
            *sum += count as f64 / things.len().max(1) as f64;
        }
    }
    Ok(sums.map(|sum| sum / SPLITS as f64))
}

/// What came of the questions in some homes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct End {
    wrong: usize,
    things: usize,
    questions: usize,
}

/// Lets COIN ask in every home with a gate, where people err in some of their answers.
async fn asked(
    homes: &[PathBuf],
    (gate, wrong_answers): (Gate, ErrorRate),
    promises: &Promises,
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    progress: &mut (dyn Progress + Send),
) -> Result<End, ExperimentError> {
    let calibrations: Arc<Calibrations> =
        Arc::new([(default_kind(model.name()), Some(promises.all_owners.clone()))].into());
    let (concurrency, seed) = (settings.concurrency, settings.seed);
    let jobs = homes.iter().cloned().map(|folder| {
        let (model, calibrations) = (Arc::clone(model), Arc::clone(&calibrations));
        async move {
            let home = load_home(&folder).await?;
            let model = model.as_ref();
            let outcome =
                methods::with_gate(gate, wrong_answers, &home, model, &calibrations, concurrency, seed)
                    .await
                    .map_err(|source| ExperimentError::Episode {
                        episode: folder,
                        source: Box::new(source),
                    })?;
            Ok::<_, ExperimentError>(end(&outcome, &home))
        }
    });
    progress.begin(homes.len(), "homes asked");
    let counted = parallel::in_order(jobs, || progress.step()).await?;
    progress.end();
    Ok(counted.into_iter().fold(End::default(), |all, home| End {
        wrong: all.wrong + home.wrong,
        things: all.things + home.things,
        questions: all.questions + home.questions,
    }))
}

fn end(outcome: &MethodOutcome, home: &JudgedHome) -> End {
    let owners = home.true_owners();
    let Some((last, before)) = outcome.history.split_last() else { return End::default() };
    let wrong = owners.iter().filter(|(object, truth)| last.get(**object) != Some(truth)).count();
    End { wrong, things: owners.len(), questions: before.len() }
}

#[cfg(test)]
mod tests;
