//! What is known of one thing: whose it is, how sure that is, and from what it follows.

use coin_schemas::episode::EpisodeObject;
use coin_schemas::household::{Owners, Scores, Source, UserName};
use coin_schemas::report::{ObjectReport, Report};
use coin_schemas::tools::{KnownOwnership, UsageSummary};
use coin_server::display::{count, owners_in_words, percent};
use coin_server::pages::plan::Palette;
use maud::{Markup, html};

use super::{anchor, name};
use crate::evidence::Evidence;
use crate::output::conclusions::{how_sure, is_wrong, whose, why};

/// A thing and all that is said of it.
pub(super) struct Thing<'a> {
    pub(super) place: usize,
    pub(super) object: &'a EpisodeObject,
    pub(super) of_report: &'a ObjectReport,
    pub(super) report: &'a Report,
    pub(super) evidence: Option<&'a Evidence>,
    pub(super) household: &'a Owners,
    pub(super) palette: &'a Palette<'a>,
}

/// The evidence in a few words: `Bob in 12 sessions, Mary in 1`.
pub(super) fn hint(evidence: &Evidence) -> String {
    let each: Vec<String> = evidence
        .usage
        .user_summary
        .iter()
        .map(|user| format!("{} in {}", user.user_id, count(user.sessions, "session", "sessions")))
        .collect();
    if each.is_empty() { "nobody was seen to use it".to_owned() } else { each.join(", ") }
}

/// A line with the conclusion, which opens to the evidence.
pub(super) fn thing(thing: &Thing<'_>) -> Markup {
    let Thing { place, object, of_report, report, household, palette, .. } = *thing;
    html! {
        details.thing {
            summary {
                span.name { (name(object)) }
                span.owners { (palette.swatch(&of_report.owners)) (whose(of_report, household)) }
                span.sure { (how_sure(of_report)) }
                span.why { (why(report, of_report)) }
                @if is_wrong(of_report) {
                    span.wrong { "✗ in truth: " (of_report.truth.as_ref().map_or(String::new(), |truth| owners_in_words(truth, household))) }
                }
            }
            article id=(anchor(place)) {
                h3 { (name(object)) }
                p.verdict {
                    (palette.swatch(&of_report.owners)) " " strong { (whose(of_report, household)) }
                    ", " (how_sure(of_report)) " sure: " (why(report, of_report)) "."
                    @if let Some(truth) = &of_report.truth {
                        @if is_wrong(of_report) { " ✗ In truth: " (owners_in_words(truth, household)) "." }
                        @else { " ✓ Right." }
                    }
                }
                (scores(of_report, palette))
                @if let Some(evidence) = thing.evidence {
                    (usage(&evidence.usage))
                    (related("Lies near", evidence.nearby.iter().map(|near| {
                        (near.name.as_str(), format!("{:.1} m", near.distance), near.known_ownership.as_ref())
                    }), household))
                    (related("Looks like", evidence.similar.iter().map(|like| {
                        (like.name.as_str(), format!("{:.2}", like.similarity), like.known_ownership.as_ref())
                    }), household))
                }
            }
        }
    }
}

fn scores(of_report: &ObjectReport, palette: &Palette<'_>) -> Markup {
    html! {
        table.scores {
            caption { "Score of each" }
            @if of_report.parts.is_some() {
                thead { tr {
                    th scope="col" { "Who" } th scope="col" {} th scope="col" { "Together" }
                    th scope="col" { "Common sense" } th scope="col" { "Evidence" }
                } }
            }
            tbody {
                @for (name, score) in &of_report.scores {
                    @let owner = Owners::from([name.clone()]);
                    tr {
                        th scope="row" { (palette.swatch(&owner)) (name) }
                        td { meter min="0" max="1" value=(format!("{:.3}", score.value())) {} }
                        td { (percent(score.value())) }
                        @if let Some(parts) = &of_report.parts {
                            td { (part(parts.model.as_ref(), name)) }
                            td { (part(Some(&parts.evidence), name)) }
                        }
                    }
                }
            }
        }
    }
}

/// What one part of a fused score says of a member.
fn part(scores: Option<&Scores>, name: &UserName) -> String {
    scores.and_then(|scores| scores.get(name)).map_or_else(|| "–".to_owned(), |score| percent(score.value()))
}

fn usage(usage: &UsageSummary) -> Markup {
    html! {
        @if usage.user_summary.is_empty() { p.quiet { "Nobody was seen to use it." } }
        @else {
            table.usage {
                caption { "Who used it" }
                thead { tr { th scope="col" { "Who" } th scope="col" { "Sessions" } th scope="col" { "Captions" } th scope="col" { "Last" } } }
                tbody {
                    @for user in &usage.user_summary {
                        tr {
                            th scope="row" { (user.user_id) }
                            td { (user.sessions) }
                            td { (user.total_events) }
                            td { (format!("{:.1} days ago", user.last_used_days_ago)) }
                        }
                    }
                }
            }
            ul.captions aria-label="Lately seen" {
                @for caption in usage.user_summary.iter().filter_map(|user| user.example_events.last()) { li { (caption) } }
            }
        }
        @if usage.unattributed_events > 0 {
            p.quiet { (count(usage.unattributed_events, "caption names", "captions name")) " nobody of the household." }
        }
    }
}

fn related<'a>(
    title: &str,
    things: impl Iterator<Item = (&'a str, String, Option<&'a KnownOwnership>)>,
    household: &Owners,
) -> Markup {
    let each: Vec<String> = things
        .map(|(name, how, known)| match known {
            Some(known) => {
                let source = match known.source {
                    Source::Answer => "answered",
                    Source::Inferred => "inferred",
                };
                format!("{name} ({how}; {}, {source})", owners_in_words(&known.owners, household))
            }
            None => format!("{name} ({how})"),
        })
        .collect();
    html! { @if !each.is_empty() { p { strong { (title) ": " } (each.join(", ")) "." } } }
}
