//! The report: from a run's outcome, and the truth where there is one, to what is written down.

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Agent, AgentSettings, ObjectState};
use coin::calibration::Thresholds;
use coin::metrics::{Judged, summarise};
use coin::owners::OwnerSet;
use coin::roster::{Roster, RosterError};
use coin::space::Neighbourhood;
use coin_schemas::calibration::Calibration;
use coin_schemas::episode::{Episode, EpisodeObject, Truth};
use coin_schemas::household::{ObjectId, Score, Source, UsageType};
use coin_schemas::report::{
    AdaptedThreshold, Cost, CurvePoint, ExpectedWrong, Gate, MetricsReport, MetricsSummary, ObjectReport,
    Parameters, Report, Scoring, Withheld,
};
use coin_schemas::tools::{DEFAULT_K, DEFAULT_WINDOW_DAYS};

use crate::driver::{Outcome, Standing};
use crate::journal::named_parts;
use crate::person::PersonKind;

/// What a report says beside the outcome.
#[derive(Debug)]
pub struct Circumstances<'a> {
    /// The episode.
    pub episode: &'a Episode,
    /// The household.
    pub roster: &'a Roster,
    /// The truth, for scoring alone.
    pub truth: Option<&'a Truth>,
    /// The model's name.
    pub model: &'a str,
    /// The seed.
    pub seed: u64,
    /// Every other setting.
    pub parameters: Parameters,
    /// The thresholds that were used.
    pub calibration: Option<&'a Calibration>,
    /// What the run took.
    pub cost: Cost,
}

/// The true owner sets by thing.
type TrueOwners = BTreeMap<ObjectId, OwnerSet>;

/// Puts the report together.
pub fn build(outcome: &Outcome, circumstances: Circumstances<'_>) -> Result<Report, RosterError> {
    let Circumstances { episode, roster, truth, model, seed, parameters, calibration, cost } = circumstances;
    let settings = outcome.agent.settings();
    let objects =
        episode.objects.iter().map(|object| object_report(object, outcome, roster, truth)).collect();
    let true_owners = truth.map(|truth| true_owners(truth, roster)).transpose()?;
    let metrics = metrics(outcome, truth, true_owners.as_ref());
    let curve = true_owners.as_ref().map(|owners| curve(outcome, owners));
    Ok(Report {
        episode: episode.name.clone(),
        model: model.to_owned(),
        gate: settings.gate,
        seed,
        parameters,
        calibration: match settings.thresholds {
            Thresholds::Calibrated { .. } => calibration.cloned(),
            Thresholds::Uncalibrated => None,
        },
        adapted: adapted(&outcome.agent),
        expected_wrong: Some(expected_wrong(&outcome.agent, episode)),
        objects,
        questions: outcome.questions.clone(),
        curve,
        metrics,
        cost,
        stopped: outcome.stopped,
    })
}

fn expected_wrong(agent: &Agent, episode: &Episode) -> ExpectedWrong {
    let mut expected = ExpectedWrong { inferred: 0.0, answered: 0.0 };
    for object in &episode.objects {
        let state = agent.object(&object.id);
        match state.and_then(ObjectState::trust) {
            Some(trust) => expected.answered += 1.0 - trust,
            None => {
                let assessment = state.and_then(ObjectState::assessment);
                expected.inferred += 1.0 - assessment.map_or(0.0, |assessment| assessment.confidence);
            }
        }
    }
    expected
}

fn adapted(agent: &Agent) -> Option<AdaptedThreshold> {
    let adapted = agent.adapted_threshold()?;
    let record = agent.track_record();
    let lambda = adapted.lambda().max(agent.settings().thresholds.lambda());
    Some(AdaptedThreshold {
        lambda: (lambda <= 1.0).then_some(lambda),
        expected_errors: record.expected,
        errors: record.wrong,
        factor: record.factor(),
    })
}

fn object_report(
    object: &EpisodeObject,
    outcome: &Outcome,
    roster: &Roster,
    truth: Option<&Truth>,
) -> ObjectReport {
    let state = outcome.agent.object(&object.id).cloned().unwrap_or_default();
    let truth = truth.and_then(|truth| truth.owners.get(&object.id).cloned());
    let belief = match state.answer() {
        Some(reading) => Belief::answered(reading.owners, roster),
        None => Belief::inferred(&state, roster),
    };
    ObjectReport {
        id: object.id.clone(),
        class: object.class.clone(),
        scores: roster.scores(&belief.scores),
        owners: roster.owners(belief.owners),
        source: belief.source,
        prediction_set: roster.owners(belief.prediction_set),
        uncertainty: belief.uncertainty,
        confidence: belief.confidence,
        shared: belief.shared,
        parts: match belief.source {
            Source::Answer => None,
            Source::Inferred => state.parts().map(|parts| named_parts(parts, roster)),
        },
        problem: state.problem().map(str::to_owned),
        truth,
    }
}

struct Belief {
    scores: Vec<Score>,
    owners: OwnerSet,
    source: Source,
    prediction_set: OwnerSet,
    uncertainty: f64,
    confidence: f64,
    shared: bool,
}

impl Belief {
    /// A person's word leaves no doubt: APPLY-ANSWER makes deterministic scores of it.
    fn answered(owners: OwnerSet, roster: &Roster) -> Self {
        Self {
            scores: roster
                .indices()
                .map(|user| if owners.contains(user) { Score::ONE } else { Score::ZERO })
                .collect(),
            owners,
            source: Source::Answer,
            prediction_set: owners,
            uncertainty: 0.0,
            confidence: 1.0,
            shared: owners.len() > 1,
        }
    }

    /// A thing that the model never scored has no owner and every member as a candidate.
    fn inferred(state: &ObjectState, roster: &Roster) -> Self {
        let assessment = state.assessment();
        Self {
            scores: state.scores().map_or_else(|| vec![Score::ZERO; roster.len()], <[Score]>::to_vec),
            owners: state.owners(),
            source: Source::Inferred,
            prediction_set: assessment.map_or(roster.everyone(), |assessment| assessment.prediction_set),
            uncertainty: assessment.map_or(1.0, |assessment| assessment.uncertainty),
            confidence: assessment.map_or(0.0, |assessment| assessment.confidence),
            shared: assessment.is_some_and(|assessment| assessment.shared),
        }
    }
}

/// The truth as owner sets.
pub fn true_owners(truth: &Truth, roster: &Roster) -> Result<TrueOwners, RosterError> {
    truth.owners.iter().map(|(object, owners)| Ok((object.clone(), roster.owner_set(owners)?))).collect()
}

fn judged<'a>(
    estimates: &'a BTreeMap<ObjectId, Standing>,
    truth: &'a TrueOwners,
) -> impl Iterator<Item = (&'a ObjectId, Judged)> {
    estimates.iter().filter_map(|(object, standing)| {
        truth.get(object).map(|&truth| (object, Judged { estimate: standing.owners, truth }))
    })
}

fn curve(outcome: &Outcome, truth: &TrueOwners) -> Vec<CurvePoint> {
    outcome
        .history
        .iter()
        .enumerate()
        .map(|(step, estimates)| {
            let judged: Vec<Judged> = judged(estimates, truth).map(|(_, judged)| judged).collect();
            let MetricsSummary { subset_accuracy, mean_jaccard, micro_f1, .. } = summarise(&judged);
            CurvePoint { step, subset_accuracy, mean_jaccard, micro_f1 }
        })
        .collect()
}

fn metrics(outcome: &Outcome, truth: Option<&Truth>, true_owners: Option<&TrueOwners>) -> MetricsReport {
    let questions = outcome.questions.len();
    let (Some(truth), Some(true_owners), Some(estimates)) = (truth, true_owners, outcome.history.last())
    else {
        return MetricsReport { overall: None, by_usage_type: None, questions };
    };
    let all: Vec<Judged> = judged(estimates, true_owners).map(|(_, judged)| judged).collect();
    let by_usage_type = truth.usage_type.as_ref().map(|usage_types| {
        let mut groups: BTreeMap<UsageType, Vec<Judged>> = BTreeMap::new();
        for (object, judged) in judged(estimates, true_owners) {
            if let Some(&usage_type) = usage_types.get(object) {
                groups.entry(usage_type).or_default().push(judged);
            }
        }
        groups.into_iter().map(|(usage_type, group)| (usage_type, summarise(&group))).collect()
    });
    MetricsReport { overall: Some(summarise(&all)), by_usage_type, questions }
}

/// The settings that a result depends on.
pub(crate) fn parameters(
    agent: &AgentSettings,
    person: PersonKind,
    withheld: &BTreeSet<Withheld>,
    scoring: Scoring,
) -> Parameters {
    let Neighbourhood { k, sigma, gamma, .. } = Neighbourhood::default();
    Parameters {
        k_near: k,
        k_sim: DEFAULT_K as usize,
        sigma,
        gamma,
        window_days: DEFAULT_WINDOW_DAYS,
        epsilon_min: agent.share.least_score,
        epsilon_in: agent.share.largest_spread,
        epsilon_out: agent.share.least_gap,
        max_questions: agent.max_questions,
        risk: (agent.gate == Gate::Adaptive).then(|| agent.risk.value()),
        reinference: agent.reinference,
        withheld: withheld.clone(),
        scoring,
        answers: person.as_str().to_owned(),
        wrong_answers: None,
    }
}
