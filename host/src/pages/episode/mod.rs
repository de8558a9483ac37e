//! The page of one episode: the plan of the home, the dialogue, the accuracy by question, and what is known of
//! every thing.
//!
//! Everything that the page can show stands in its markup. The script only chooses what is visible: it puts the
//! evidence beside the plan for whatever is pointed at, and goes back through the questions.

mod dialogue;
mod things;

use std::collections::BTreeMap;

use coin_schemas::episode::{Episode, EpisodeObject};
use coin_schemas::household::{ObjectId, Owners, Source};
use coin_schemas::report::{AnswerStatus, Report};
use coin_server::display::{belief_in_words, owners_in_words, percent};
use coin_server::pages::page;
use coin_server::pages::plan::{self, MarkState, Palette, PlacedThing, name_and_room, plan};
use maud::{Markup, html};

use super::chart::{LineChart, Look, Point, Series, Shape, tenth_below};
use crate::evidence::Evidence;
use crate::output::conclusions::{facts, is_wrong};

const STYLE: &str = include_str!("episode.css");
const SCRIPT: &str = include_str!("episode.js");

/// What is believed of a thing at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Belief {
    /// Its owners; empty where somebody outside the household owns it, or nothing is known.
    pub owners: Owners,
    /// The probability of this owner set; 1 where a person said so.
    pub confidence: f64,
    /// Whether a person said so.
    pub source: Source,
}

impl Belief {
    /// How much room there is for another answer, 0…1.
    fn doubt(&self) -> f64 {
        1.0 - self.confidence
    }

    /// `Bob, 96 % sure`.
    fn in_words(&self, household: &Owners) -> String {
        belief_in_words(&owners_in_words(&self.owners, household), self.confidence, self.source)
    }
}

/// What the page is made from.
#[derive(Debug, Clone, Copy)]
pub struct EpisodePage<'a> {
    /// The home; it holds no truth.
    pub episode: &'a Episode,
    /// What came of the run; the truth in it is there because the run was judged.
    pub report: &'a Report,
    /// What was believed before the first question and after each one.
    pub history: &'a [BTreeMap<ObjectId, Belief>],
    /// What the server tells of every thing.
    pub evidence: &'a BTreeMap<ObjectId, Evidence>,
}

/// The page, whole.
pub fn episode(input: EpisodePage<'_>) -> String {
    let EpisodePage { episode, report, history, evidence } = input;
    let palette = Palette::new(episode.users.keys());
    let household: Owners = episode.users.keys().cloned().collect();
    let placed = placed(input, &household);
    let questions = report.questions.len();
    let body = html! {
        main {
            header {
                h1 { "Whose is this? " (episode.name) }
                p.lead { (lead(report)) }
                @if let Some(description) = &episode.description { p.quiet { (description) } }
                (key_figures(report))
                nav aria-label="On this page" {
                    ul {
                        li { a href="#plan" { "Plan" } }
                        li { a href="#dialogue" { "Dialogue" } }
                        li { a href="#accuracy" { "By question" } }
                        li { a href="#things" { "Things" } }
                        li { a href="#run" { "The run" } }
                    }
                }
            }
            section #plan {
                h2 { "Plan" }
                p.quiet {
                    "Every thing at its place, in the colours of its owners; the larger, the more doubt. Point at one, or \
                     go through them with the tab key, to see why. A ring is around what was asked about last."
                }
                (plan::legend(&episode.users, &palette))
                @if questions > 0 {
                    p.replay hidden {
                        label for="step" { "Questions asked so far" }
                        input #step type="range" min="0" max=(questions) value=(questions);
                        output for="step" { (questions) " of " (questions) }
                    }
                }
                div.beside {
                    div.drawing { (plan("Plan of the home.", &placed, &palette)) }
                    aside #evidence hidden tabindex="-1" aria-label="What is known of the thing" {}
                }
            }
            section #dialogue {
                h2 { "Dialogue" }
                (dialogue::dialogue(input, &household, &palette))
            }
            section #accuracy {
                h2 { "By question" }
                (by_question(report, history))
            }
            section #things {
                h2 { "Things" }
                @for (place, object) in episode.objects.iter().enumerate() {
                    @if let Some(of_report) = report.objects.iter().find(|found| found.id == object.id) {
                        (things::thing(&things::Thing {
                            place,
                            object,
                            of_report,
                            report,
                            evidence: evidence.get(&object.id),
                            household: &household,
                            palette: &palette,
                        }))
                    }
                }
            }
            section #run {
                h2 { "The run" }
                dl.facts { @for (label, text) in facts(report) { dt { (label) } dd { (text) } } }
            }
        }
    };
    page(&format!("Whose is this? {}", episode.name), &[plan::STYLE, STYLE], Some(SCRIPT), &body)
}

/// What the page calls a thing.
fn name(object: &EpisodeObject) -> String {
    name_and_room(object.class.as_str(), object.room.as_deref())
}

/// The id of the element that describes the thing at a place in the episode.
fn anchor(place: usize) -> String {
    format!("thing-{place}")
}

fn lead(report: &Report) -> String {
    let things = report.objects.len();
    let asked = report.questions.len();
    let questions = match asked {
        0 => "without a question".to_owned(),
        1 => "with one question".to_owned(),
        many => format!("with {many} questions"),
    };
    let answered = report.objects.iter().filter(|object| object.source == Source::Answer).count();
    let judged = report.objects.iter().filter(|object| object.truth.is_some()).count();
    let wrong = report.objects.iter().filter(|object| is_wrong(object)).count();
    match judged {
        0 => format!(
            "COIN says whose {things} things are, {questions}: {answered} by answer, {} by inference.",
            things - answered
        ),
        _ => format!("COIN is right about {} of {judged} things, {questions}.", judged - wrong),
    }
}

fn key_figures(report: &Report) -> Markup {
    let curve = report.curve.as_deref().unwrap_or_default();
    let answered = report.questions.iter().filter(|asked| asked.status == AnswerStatus::Answered).count();
    html! {
        dl.key {
            @if let Some(first) = curve.first() {
                div { dt { "right at once" } dd { (format!("{:.3}", first.subset_accuracy))
                    small { "Subset Accuracy before any question" } } }
            }
            @if let Some(last) = curve.last() {
                div { dt { "right in the end" } dd { (format!("{:.3}", last.subset_accuracy))
                    small { (format!("Jaccard {:.3}, F1 {:.3}", last.mean_jaccard, last.micro_f1)) } } }
            }
            div { dt { "questions" } dd { (report.questions.len())
                small { (answered) " settled something; " (report.objects.len()) " things" } } }
            @if let (Some(calibration), coin_schemas::report::Gate::Risk) = (&report.calibration, report.gate) {
                @if calibration.lambda <= 1.0 {
                    div { dt { "sure enough" } dd { (percent(calibration.lambda))
                        small { "from here on nobody is asked" } } }
                }
            }
        }
    }
}

/// Every thing with the states of its mark.
fn placed<'a>(input: EpisodePage<'a>, household: &Owners) -> Vec<PlacedThing<'a>> {
    let EpisodePage { episode, report, history, evidence } = input;
    let of_thing = |(place, object): (usize, &'a EpisodeObject)| {
        let mut states: Vec<MarkState<'a>> = Vec::new();
        let mut held: Option<&Belief> = None;
        for (step, beliefs) in history.iter().enumerate() {
            let Some(belief) = beliefs.get(&object.id) else { continue };
            match states.last_mut() {
                Some(last) if held == Some(belief) => last.to = step,
                _ => states.push(MarkState {
                    from: step,
                    to: step,
                    owners: &belief.owners,
                    doubt: belief.doubt(),
                    said: belief.in_words(household),
                }),
            }
            held = Some(belief);
        }
        let asked = report.questions.iter().filter(|asked| asked.is_about(&object.id));
        PlacedThing {
            class: object.class.as_str(),
            room: object.room.as_deref(),
            position: object.position,
            link: anchor(place),
            hint: evidence.get(&object.id).map_or(String::new(), things::hint),
            states,
            asked: asked.map(|asked| asked.step).collect(),
        }
    };
    episode.objects.iter().enumerate().map(of_thing).collect()
}

/// Accuracy after each question; where nobody knows the truth, how sure COIN is.
fn by_question(report: &Report, history: &[BTreeMap<ObjectId, Belief>]) -> Markup {
    let series = |name: &str, look, values: Vec<f64>| Series {
        name: name.to_owned(),
        look: Look(look),
        shape: if values.len() == 1 { Shape::Level } else { Shape::Line },
        points: values
            .into_iter()
            .enumerate()
            .map(|(step, y)| Point { x: step as f64, y, spread: 0.0 })
            .collect(),
        strokes: Vec::new(),
    };
    let (title, label, drawn) = match &report.curve {
        Some(curve) => (
            "Accuracy by question",
            "share",
            vec![
                series("Subset Accuracy", 0, curve.iter().map(|point| point.subset_accuracy).collect()),
                series("Mean Jaccard", 1, curve.iter().map(|point| point.mean_jaccard).collect()),
                series("Micro F1", 2, curve.iter().map(|point| point.micro_f1).collect()),
            ],
        ),
        None => {
            let mean = |beliefs: &BTreeMap<ObjectId, Belief>| {
                let sum: f64 = beliefs.values().map(|belief| belief.confidence).sum();
                sum / beliefs.len().max(1) as f64
            };
            let sureness = history.iter().map(mean).collect();
            ("Confidence by question", "mean confidence", vec![series("mean confidence", 0, sureness)])
        }
    };
    let drawn_values = drawn.iter().flat_map(|series| &series.points).map(|point| point.y);
    let chart = LineChart {
        title: title.to_owned(),
        description: series_in_words(&drawn),
        x_label: "questions asked".to_owned(),
        y_label: label.to_owned(),
        lowest: tenth_below(drawn_values),
        series: drawn,
    };
    html! { figure { (chart.svg()) figcaption { (title) ". Before the first question and after each one." } } }
}

fn series_in_words(series: &[Series]) -> String {
    let each = series.iter().map(|series| {
        let values: Vec<String> = series.points.iter().map(|point| format!("{:.3}", point.y)).collect();
        format!("{}: {}", series.name, values.join(", "))
    });
    format!("{}.", each.collect::<Vec<_>>().join("; "))
}
