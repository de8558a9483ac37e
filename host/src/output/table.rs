//! The final text of a run: who lives there, whose every thing is, and how good and how dear that was.
//!
//! It says only what the report holds, and it is the same for the same report.

mod figures;
mod guarantee;
#[cfg(test)]
mod tests;

use std::borrow::Cow;

use coin_schemas::household::{Background, Owners, Source, Users};
use coin_schemas::report::{AnswerStatus, Gate, ObjectReport, QuestionReport, Report};
use comfy_table::{Cell, CellAlignment, TableComponent};

use super::layout::{columns, labelled, names, owners_in_words, percent};
use super::{Style, plain_text};

/// The mark of an owner set that is not the true one.
const WRONG: &str = "✗";

/// How many people besides the owners are named as plausible; more are counted.
const OTHERS_NAMED: usize = 3;

/// The whole text, every line of which ends in a line break and fits the width.
pub fn render(report: &Report, users: &Users, style: Style) -> String {
    let sections = [
        household(report, users, style),
        things(report, &users.keys().cloned().collect(), style),
        figures::accuracy(report, style),
        figures::summary(report, style),
    ];
    let sections: Vec<String> = sections.into_iter().filter(|section| !section.is_empty()).collect();
    sections.join("\n")
}

fn household(report: &Report, users: &Users, style: Style) -> String {
    let people: Vec<(Cow<'_, str>, String)> = users
        .iter()
        .map(|(name, background)| (plain_text(name.as_str()), background_in_words(background)))
        .collect();
    let rows: Vec<(&str, String)> =
        people.iter().map(|(name, background)| (name.as_ref(), background.clone())).collect();
    let longest = people.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default();
    let label_width = u16::try_from(longest).unwrap_or(u16::MAX).clamp(1, style.width / 3);
    let title = style.heading(plain_text(&report.episode));
    format!("{title}\n{}", labelled(&rows, 2, label_width, style.width))
}

fn background_in_words(background: &Background) -> String {
    let parts = [&background.role, &background.occupation];
    let parts: Vec<Cow<'_, str>> = parts.into_iter().flatten().map(|part| plain_text(part)).collect();
    parts.join(", ")
}

fn things(report: &Report, household: &Owners, style: Style) -> String {
    let any_wrong = report.objects.iter().any(is_wrong);
    let mut table = columns(style.width);
    table.set_style(TableComponent::HeaderLines, '─');
    let mut header = vec!["id", "thing", "whose", "sure", "why"];
    if any_wrong {
        header.push("in truth");
    }
    table.set_header(header);
    for object in &report.objects {
        let mut row = vec![
            Cell::new(plain_text(object.id.as_str())),
            Cell::new(plain_text(object.class.as_str())),
            Cell::new(whose(object, household)),
            Cell::new(how_sure(object)).set_alignment(CellAlignment::Right),
            Cell::new(why(report, object)),
        ];
        if let (true, Some(truth)) = (any_wrong, &object.truth) {
            let text = format!("{WRONG} {}", owners_in_words(truth, household));
            row.push(Cell::new(if is_wrong(object) { text } else { String::new() }));
        }
        table.add_row(row);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    if let Some(ids) = table.column_mut(0) {
        ids.set_padding((2, 2));
        if report.objects.iter().all(|object| object.id.as_str().bytes().all(|byte| byte.is_ascii_digit())) {
            ids.set_cell_alignment(CellAlignment::Right);
        }
    }
    let mut text = String::new();
    for (place, line) in table.lines().enumerate() {
        let line = line.trim_end();
        let line = match place {
            0 => style.heading(line),
            1 => format!("  {}", style.aside(line.chars().skip(2).collect::<String>())),
            _ => line.replace(WRONG, &style.alarm(WRONG)),
        };
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// Whether the truth is known and the owner set is another one.
fn is_wrong(object: &ObjectReport) -> bool {
    object.truth.as_ref().is_some_and(|truth| *truth != object.owners)
}

/// Whether nothing is known of the thing, because the model failed and no person said anything.
fn is_unknown(object: &ObjectReport) -> bool {
    object.source == Source::Inferred && object.problem.is_some()
}

fn whose(object: &ObjectReport, household: &Owners) -> String {
    if is_unknown(object) { "unknown".to_owned() } else { owners_in_words(&object.owners, household) }
}

fn how_sure(object: &ObjectReport) -> String {
    if is_unknown(object) { "–".to_owned() } else { percent(object.confidence) }
}

fn why(report: &Report, object: &ObjectReport) -> String {
    let questions: Vec<&QuestionReport> =
        report.questions.iter().filter(|question| question.object_id == object.id).collect();
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
            match &object.problem {
                Some(problem) => reasons.push(format!("the model failed: {}", plain_text(problem))),
                None => reasons.push(if object.shared { "inferred, shared" } else { "inferred" }.to_owned()),
            }
            reasons.extend(questions.last().map(|question| format!("Q{} left it open", question.step)));
            reasons.extend(not_excluded(report, object));
            if is_unsettled(report, object) {
                reasons.push("not settled".to_owned());
            }
        }
    }
    reasons.join("; ")
}

/// Who else is plausible. A threshold that excludes nobody says nothing of any one thing.
fn not_excluded(report: &Report, object: &ObjectReport) -> Option<String> {
    let calibration = report.calibration.as_ref()?;
    if calibration.q_alpha >= 1.0 || object.problem.is_some() {
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
        (Gate::Paper, Some(calibration)) => object.uncertainty > calibration.q_cp,
        (Gate::Set, Some(_)) => false,
    };
    doubted || object.problem.is_some()
}
