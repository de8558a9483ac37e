//! What a report says, in words: of one thing, whose it is, how sure that is and why; of the run, what it took, why it
//! ended and what may be relied on. The terminal and the page say the same.

mod facts;
pub(crate) mod guarantee;

use coin_schemas::household::{Owners, Scores, Source, UserName};
use coin_schemas::report::{AnswerStatus, Gate, ObjectReport, QuestionReport, Report};
use coin_server::display::{names, owners_in_words, percent, plain_text};

pub(crate) use facts::facts;

/// How many people besides the owners are named as plausible; more are counted.
const OTHERS_NAMED: usize = 3;

/// Whether the truth is known and the owner set is another one.
pub(crate) fn is_wrong(object: &ObjectReport) -> bool {
    object.truth.as_ref().is_some_and(|truth| *truth != object.owners)
}

/// Whether nothing is known of the thing, because nothing could score it and no person said anything.
fn is_unknown(object: &ObjectReport) -> bool {
    object.source == Source::Inferred && object.confidence == 0.0
}

/// The owners in words.
pub(crate) fn whose(object: &ObjectReport, household: &Owners) -> String {
    if is_unknown(object) { "unknown".to_owned() } else { owners_in_words(&object.owners, household) }
}

/// The probability of the owner set.
pub(crate) fn how_sure(object: &ObjectReport) -> String {
    if is_unknown(object) { "–".to_owned() } else { percent(object.confidence) }
}

/// What the conclusion rests on, and what is left open.
pub(crate) fn why(report: &Report, object: &ObjectReport) -> String {
    let questions: Vec<&QuestionReport> =
        report.questions.iter().filter(|question| question.is_about(&object.id)).collect();
    let mut reasons: Vec<String> = Vec::new();
    match object.source {
        Source::Answer => {
            let answered = |question: &&&QuestionReport| question.status == AnswerStatus::Answered;
            reasons.push(match questions.iter().rev().find(answered) {
                Some(question) => {
                    format!("Q{}: “{}”", question.step, plain_text(question.answer.trim()))
                }
                None => "answered".to_owned(),
            });
        }
        Source::Inferred => {
            if !is_unknown(object) {
                reasons.push(if object.shared { "inferred, shared" } else { "inferred" }.to_owned());
            }
            reasons.extend(other_common_sense(object));
            reasons.extend(object.problem.as_ref().map(|problem| plain_text(problem).into_owned()));
            reasons.extend(questions.last().map(|question| format!("Q{} left it open", question.step)));
            reasons.extend(not_excluded(report, object));
            if is_unsettled(report, object) {
                reasons.push("not settled".to_owned());
            }
        }
    }
    reasons.join("; ")
}

/// What the language model's common sense would say, where the evidence says somebody else.
fn other_common_sense(object: &ObjectReport) -> Option<String> {
    let parts = object.parts.as_ref()?;
    let (by_model, by_evidence) = (likeliest(parts.model.as_ref()?)?, likeliest(&parts.evidence)?);
    (by_model != by_evidence).then(|| format!("common sense says {}", plain_text(by_model.as_str())))
}

/// The member with the highest score; nobody where two share it.
fn likeliest(scores: &Scores) -> Option<&UserName> {
    let highest = scores.values().map(|score| score.value()).fold(f64::NEG_INFINITY, f64::max);
    let mut with_it = scores.iter().filter(|(_, score)| score.value() == highest);
    let first = with_it.next()?.0;
    with_it.next().is_none().then_some(first)
}

/// Who else is plausible. A threshold that excludes nobody says nothing of any one thing.
fn not_excluded(report: &Report, object: &ObjectReport) -> Option<String> {
    let calibration = report.calibration.as_ref()?;
    if calibration.q_alpha >= 1.0 || is_unknown(object) {
        return None;
    }
    let others: Vec<_> = object.prediction_set.difference(&object.owners).collect();
    match others.len() {
        0 => None,
        many if many > OTHERS_NAMED => Some(format!("{many} others not excluded")),
        _ => Some(format!("{} not excluded", names(others))),
    }
}

/// Whether the gate would have asked about the thing, had it been able to. Of the gate over owner sets the report
/// does not hold enough to tell.
fn is_unsettled(report: &Report, object: &ObjectReport) -> bool {
    if object.source == Source::Answer {
        return false;
    }
    let doubted = match (report.gate, &report.calibration) {
        (Gate::Never, _) => return false,
        (Gate::Always, _) => true,
        (_, None) => object.confidence < coin::calibration::UNCALIBRATED_CONFIDENCE,
        (Gate::Risk, Some(calibration)) => object.confidence < calibration.lambda,
        (Gate::Adaptive, Some(_)) => {
            let adapted = report.adapted.as_ref().and_then(|adapted| adapted.lambda);
            adapted.is_none_or(|lambda| object.confidence < lambda)
        }
        (Gate::Paper, Some(calibration)) => object.uncertainty > calibration.q_cp,
        (Gate::Set, Some(_)) => false,
    };
    doubted || is_unknown(object)
}
