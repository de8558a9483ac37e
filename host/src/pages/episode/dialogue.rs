//! What was asked, what was answered, and what that changed.

use coin_schemas::household::{ObjectId, Owners, Source};
use coin_schemas::report::{AnswerStatus, QuestionReport};
use coin_server::display::{owners_in_words, percent};
use coin_server::pages::plan::Palette;
use maud::{Markup, html};

use super::{Belief, EpisodePage, anchor, name};

pub(super) fn dialogue(input: EpisodePage<'_>, household: &Owners, palette: &Palette<'_>) -> Markup {
    if input.report.questions.is_empty() {
        return html! { p { "Nothing was asked." } };
    }
    html! {
        ol.dialogue {
            @for question in &input.report.questions { (exchange(question, input, household, palette)) }
        }
    }
}

fn exchange(
    question: &QuestionReport,
    input: EpisodePage<'_>,
    household: &Owners,
    palette: &Palette<'_>,
) -> Markup {
    let before =
        question.step.checked_sub(1).and_then(|step| input.history.get(step)?.get(&question.object_id));
    let who = question.answered_by.as_ref().map_or("Answer", |name| name.as_str());
    let changed = changed(question, input);
    html! {
        li data-step=(question.step) {
            p.about { "Q" (question.step) " · " (link(&question.object_id, input)) @for other in &question.also { ", " (link(other, input)) } }
            p.robot { span.who { "COIN" } " " (question.question) }
            @if question.answer.is_empty() { p.person.quiet { "No answer." } }
            @else { p.person { span.who { (who) } " “" (question.answer.trim()) "”" } }
            p.read {
                @match question.status {
                    AnswerStatus::Answered => {
                        @let owners: Owners = question.ownership.iter().filter(|(_, owner)| **owner).map(|(name, _)| name.clone()).collect();
                        (palette.swatch(&owners)) " " strong { (owners_in_words(&owners, household)) }
                        @if let Some(before) = before { (was(before, &owners, household)) }
                    }
                    AnswerStatus::Unresolved => { "Left open." }
                }
                @if !changed.is_empty() {
                    " Changed by it: "
                    @for (place, (object, after)) in changed.iter().enumerate() {
                        @if place > 0 { ", " }
                        (link(object, input)) " (" (owners_in_words(&after.owners, household)) ")"
                    }
                    "."
                }
            }
        }
    }
}

fn was(before: &Belief, owners: &Owners, household: &Owners) -> String {
    if before.owners == *owners {
        format!(", as thought ({} sure)", percent(before.confidence))
    } else {
        format!(" (before: {})", before.in_words(household))
    }
}

/// A link to the thing, by the name that people call it.
fn link(id: &ObjectId, input: EpisodePage<'_>) -> Markup {
    let found = input.episode.objects.iter().enumerate().find(|(_, object)| object.id == *id);
    html! {
        @match found {
            Some((place, object)) => { a href=(format!("#{}", anchor(place))) { (name(object)) } }
            None => { (id) }
        }
    }
}

/// Other things whose inferred owners are not what they were before the answer.
fn changed<'a>(question: &QuestionReport, input: EpisodePage<'a>) -> Vec<(&'a ObjectId, &'a Belief)> {
    let before = question.step.checked_sub(1).and_then(|step| input.history.get(step));
    let (Some(before), Some(after)) = (before, input.history.get(question.step)) else { return Vec::new() };
    after
        .iter()
        .filter(|(object, belief)| {
            !question.is_about(object)
                && belief.source == Source::Inferred
                && before.get(*object).is_some_and(|earlier| earlier.owners != belief.owners)
        })
        .collect()
}
