//! What every term of the evidence model is worth, and what a question is worth, on fresh homes of a kind.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use coin::agent::{AgentSettings, QuestionChoice, Reinference};
use coin::calibration::{Provenance, Thresholds, calibrate};
use coin::evidence::{EvidenceParameters, HabitSource};
use coin::sharing::ShareThresholds;
use coin_schemas::calibration::{History, NonconformityScore};
use coin_schemas::experiment::{KindResults, Method, Term, TermResult};
use coin_schemas::report::Gate;
use tempfile::TempDir;

use super::coverage::make;
use super::methods::{self, MethodOutcome};
use super::summary::{self, Scored};
use super::{
    Calibrations, CoverageHomes, ExperimentError, ExperimentSettings, JudgedHome, Progress, load_home,
};
use crate::calibrate::{HomeScoring, score_homes};
use crate::course::Course;
use crate::model::ChatModel;
use crate::parallel;
use crate::run::default_scoring;

/// The first seeds of the homes that are judged and of those that thresholds are made from. They are used for nothing
/// else.
const JUDGED_SEED: u64 = 7001;
const CALIBRATION_SEED: u64 = 7101;

/// As many homes of the same kind make the thresholds, so that every variant keeps the accuracy that it aims at and a
/// term shows its worth in questions.
const CALIBRATION_HOMES: usize = 30;

/// The terms, in the order of the table.
const TERMS: [Term; 7] = [
    Term::Class,
    Term::Place,
    Term::Looks,
    Term::Turns,
    Term::ChangeOfHands,
    Term::Habits,
    Term::BestQuestion,
];

/// How things are judged and questions chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Variant {
    parameters: EvidenceParameters,
    choice: QuestionChoice,
}

/// Everything but a term.
fn without(term: Option<Term>) -> Variant {
    let whole = EvidenceParameters::default();
    let choice = match term {
        Some(Term::BestQuestion) => QuestionChoice::LeastSure,
        _ => QuestionChoice::MostInformative,
    };
    let parameters = match term {
        None | Some(Term::BestQuestion) => whole,
        Some(Term::Class) => EvidenceParameters { common_sense: 0.0, language_model: 0.0, ..whole },
        Some(Term::Place) => EvidenceParameters { place: 0.0, nearness: 0.0, ..whole },
        Some(Term::Looks) => EvidenceParameters { looks: 0.0, resemblance: 0.0, ..whole },
        Some(Term::Turns) => EvidenceParameters { turns: 0.0, ..whole },
        Some(Term::ChangeOfHands) => EvidenceParameters { change_of_hands: 0.0, ..whole },
        Some(Term::Habits) => EvidenceParameters { habits: HabitSource::Ordinary, ..whole },
    };
    Variant { parameters, choice }
}

/// Judges fresh homes of every kind that is asked for, with all terms and without each.
pub(super) async fn measure(
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    calibrations: &Arc<Calibrations>,
    progress: &mut (dyn Progress + Send),
) -> Result<Vec<KindResults>, ExperimentError> {
    let mut results = Vec::new();
    for &kind in &settings.kinds {
        results.push(of_kind(kind, settings, model, calibrations, progress).await?);
    }
    Ok(results)
}

async fn of_kind(
    CoverageHomes { protocol, households }: CoverageHomes,
    settings: &ExperimentSettings,
    model: &Arc<dyn ChatModel>,
    calibrations: &Arc<Calibrations>,
    progress: &mut (dyn Progress + Send),
) -> Result<KindResults, ExperimentError> {
    let folder = TempDir::new()?;
    let calibrated_on =
        make(protocol, CALIBRATION_SEED, CALIBRATION_HOMES, &folder.path().join("calibration"))?;
    let judged = make(protocol, JUDGED_SEED, households, &folder.path().join("judged"))?;
    let mut homes = Vec::new();
    for folder in &judged {
        homes.push(Arc::new(load_home(folder).await?));
    }
    let trial = Trial { homes, calibrated_on, settings, model, calibrations };
    let mut terms = Vec::new();
    for left_out in std::iter::once(None).chain(TERMS.map(Some)) {
        progress.begin(CALIBRATION_HOMES + households, "homes judged by terms");
        let scored = trial.by_gate(without(left_out), Gate::Risk, progress).await?;
        progress.end();
        let of =
            |figure: &dyn Fn(&Scored) -> f64| super::spread(&scored.iter().map(figure).collect::<Vec<_>>());
        terms.push(TermResult {
            left_out,
            at_once: of(&|home| home.curve.first().copied().unwrap_or(0.0)),
            in_the_end: of(&|home| home.run.overall.subset_accuracy),
            questions: of(&|home| home.run.questions as f64),
        });
    }
    progress.begin(2 * households, "homes asked about everything");
    let asked_on = trial.asked_on(progress).await?;
    let paper = trial.by_the_papers_gate(progress).await?;
    progress.end();
    let things: usize = asked_on.iter().map(|home| home.run.overall.objects).sum();
    let curve = |scored: &[Scored]| {
        summary::mean_curve(&scored.iter().map(|home| home.curve.as_slice()).collect::<Vec<_>>())
    };
    let oracle: Vec<Vec<f64>> = asked_on
        .iter()
        .map(|home| summary::wrong_ones_first(home.curve.first().copied(), home.run.overall.objects))
        .collect();
    Ok(KindResults {
        protocol: protocol.name().to_owned(),
        households,
        calibrated_on: CALIBRATION_HOMES,
        things,
        terms,
        asked_on: curve(&asked_on),
        paper: curve(&paper),
        oracle: summary::mean_curve(&oracle.iter().map(Vec::as_slice).collect::<Vec<_>>()),
    })
}

/// Homes of one kind and what they are judged with.
struct Trial<'a> {
    homes: Vec<Arc<JudgedHome>>,
    calibrated_on: Vec<PathBuf>,
    settings: &'a ExperimentSettings,
    model: &'a Arc<dyn ChatModel>,
    calibrations: &'a Arc<Calibrations>,
}

impl Trial<'_> {
    /// Makes thresholds with these parameters and lets COIN ask by them.
    async fn by_gate(
        &self,
        variant: Variant,
        gate: Gate,
        progress: &mut (dyn Progress + Send),
    ) -> Result<Vec<Scored>, ExperimentError> {
        let scoring = default_scoring(self.model.name());
        let how = HomeScoring {
            history: History::Whole,
            withheld: BTreeSet::new(),
            scoring,
            parameters: variant.parameters,
            concurrency: self.settings.concurrency,
        };
        let scored = score_homes(&self.calibrated_on, &how, self.model, || progress.step()).await?;
        let provenance = Provenance {
            model: self.model.name().to_owned(),
            episodes: scored.iter().map(|home| home.name.clone()).collect(),
            history: History::Whole,
            withheld: BTreeSet::new(),
            scoring,
        };
        let samples: Vec<_> = scored.into_iter().flat_map(|home| home.samples).collect();
        let score = NonconformityScore::AllOwners;
        let thresholds = Thresholds::from(&calibrate(provenance, &samples, self.settings.levels, score)?);
        self.asked(variant, gate, thresholds, progress).await
    }

    /// COIN that asks about everything, the least sure first: the whole curve, past where a gate would stop.
    async fn asked_on(&self, progress: &mut (dyn Progress + Send)) -> Result<Vec<Scored>, ExperimentError> {
        self.asked(without(None), Gate::Always, Thresholds::Uncalibrated, progress).await
    }

    async fn asked(
        &self,
        variant: Variant,
        gate: Gate,
        thresholds: Thresholds,
        progress: &mut (dyn Progress + Send),
    ) -> Result<Vec<Scored>, ExperimentError> {
        let scoring = default_scoring(self.model.name());
        let (concurrency, seed) = (self.settings.concurrency, self.settings.seed);
        let jobs = self.homes.iter().map(|home| {
            let (home, model) = (Arc::clone(home), Arc::clone(self.model));
            let settings = AgentSettings {
                gate,
                thresholds,
                risk: self.settings.levels.risk,
                share: ShareThresholds::default(),
                max_questions: home.loaded.episode.objects.len(),
                reinference: Reinference::AnsweredContext,
                choice: variant.choice,
                answers_per_pass: 1,
            };
            let course = Course::new(settings, BTreeSet::new(), scoring, concurrency)
                .with_parameters(variant.parameters);
            async move {
                let outcome = methods::carried_out(&home, model.as_ref(), course, home.person(seed)).await;
                scored(outcome, &home)
            }
        });
        parallel::in_order(jobs.collect::<Vec<_>>(), || progress.step()).await
    }

    async fn by_the_papers_gate(
        &self,
        progress: &mut (dyn Progress + Send),
    ) -> Result<Vec<Scored>, ExperimentError> {
        let (concurrency, seed) = (self.settings.concurrency, self.settings.seed);
        let jobs = self.homes.iter().map(|home| {
            let (home, model, calibrations) =
                (Arc::clone(home), Arc::clone(self.model), Arc::clone(self.calibrations));
            async move {
                let outcome =
                    methods::run(Method::CoinPaper, &home, model.as_ref(), &calibrations, concurrency, seed)
                        .await;
                scored(outcome, &home)
            }
        });
        parallel::in_order(jobs.collect::<Vec<_>>(), || progress.step()).await
    }
}

fn scored(
    outcome: Result<MethodOutcome, crate::run::RunError>,
    home: &JudgedHome,
) -> Result<Scored, ExperimentError> {
    match outcome {
        Ok(outcome) => Ok(summary::score(&outcome, 0, home)),
        Err(source) => {
            Err(ExperimentError::Episode { episode: home.folder.clone(), source: Box::new(source) })
        }
    }
}

#[cfg(test)]
mod tests {
    use coin_schemas::experiment::Spread;

    use super::*;

    #[test]
    fn every_term_is_left_out_by_itself() {
        let whole = without(None);
        assert_eq!(whole.parameters, EvidenceParameters::default());
        let variants: Vec<_> = TERMS.iter().map(|&term| without(Some(term))).collect();
        for (place, variant) in variants.iter().enumerate() {
            assert_ne!(*variant, whole);
            assert!(!variants[..place].contains(variant));
        }
    }

    #[test]
    fn the_table_says_what_a_term_saves() {
        let spread = |mean| Spread { mean, sd: 0.5 };
        let row = |left_out, questions| TermResult {
            left_out,
            at_once: spread(0.95),
            in_the_end: spread(0.99),
            questions: spread(questions),
        };
        let kind = KindResults {
            protocol: "week".to_owned(),
            households: 12,
            calibrated_on: 30,
            things: 400,
            terms: vec![row(None, 3.0), row(Some(Term::Looks), 4.25), row(Some(Term::Place), 2.75)],
            asked_on: Vec::new(),
            paper: Vec::new(),
            oracle: Vec::new(),
        };
        let table = super::super::tables::of_terms(&kind);
        let shown: Vec<Vec<&str>> =
            table.rows.iter().map(|row| row.iter().map(|cell| cell.text.as_str()).collect()).collect();
        assert_eq!(
            shown,
            [
                ["nothing: the whole model", "0.950", "0.990 ± 0.500", "3.0 ± 0.5", "–"],
                ["looks", "0.950", "0.990 ± 0.500", "4.2 ± 0.5", "+1.2"],
                ["place", "0.950", "0.990 ± 0.500", "2.8 ± 0.5", "-0.2"],
            ]
        );
    }
}
