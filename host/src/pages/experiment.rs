//! The page and the figures of an experiment.

mod figures;
#[cfg(test)]
mod tests;

use coin_schemas::experiment::{ExperimentResults, Guarantee, Method, MethodResults};
use coin_server::pages::page;
use maud::{Markup, PreEscaped, html};

pub use figures::{Figure, figures};

use super::table::Table;

/// How a method is called in tables and figures.
pub fn method_name(method: Method) -> &'static str {
    match method {
        Method::Coin => "COIN (default gate)",
        Method::CoinPaper => "COIN (the paper's gate)",
        Method::Actowl => "ActOwL",
        Method::NlmapLlm => "NLMap + model",
        Method::LastUser => "Last-User (Tan et al.)",
        Method::Frequency => "Frequency (Wu et al.)",
        Method::NoQuestions => "COIN without questions",
        Method::NoBackground => "COIN without background",
        Method::NoUsage => "COIN without usage",
    }
}

/// `index.html`: everything on one page.
pub fn index(results: &ExperimentResults, tables: &[Table], figures: &[Figure]) -> String {
    let episodes = results.episodes.join(", ");
    let runs =
        if results.trials == 1 { "one trial".to_owned() } else { format!("{} trials", results.trials) };
    let body = html! {
        main {
            header {
                h1 { "Whose is this? The experiment" }
                p.lead { (headline(results)) }
                p.quiet {
                    "Episodes: " (episodes) ". " (runs) " of each method, seed " (results.seed) ", model "
                    code { (results.model) } ". " (guarantee(results))
                }
                (key_figures(results))
                nav aria-label="On this page" {
                    ul {
                        li { a href="#figures" { "Figures" } }
                        li { a href="#tables" { "Tables" } }
                        li { a href="#how" { "How it was made" } }
                    }
                }
            }
            section #figures {
                h2 { "Figures" }
                div.pair {
                    @for figure in figures {
                        figure {
                            // The figure is markup of this program, whose texts were escaped when it was made.
                            (PreEscaped(&figure.svg))
                            figcaption { strong { (figure.title) ". " } (figure.caption) }
                        }
                    }
                }
            }
            section #tables {
                h2 { "Tables" }
                @for table in tables { (table.to_html()) }
            }
            section #how { (how(results)) }
        }
    };
    page("Whose is this? The experiment", &[], None, &body)
}

fn headline(results: &ExperimentResults) -> String {
    let ours = results.methods.get(&Method::Coin);
    let papers = results.methods.get(&Method::CoinPaper);
    let said = |of: &MethodResults| {
        format!(
            "{:.3} of the things right with {:.1} questions",
            of.overall.subset_accuracy.mean, of.questions.mean
        )
    };
    match (ours, papers) {
        (Some(ours), Some(papers)) => format!(
            "COIN gets {}; the paper's gate, with the same model, {}. The paper itself reports 0.988 with 28.4.",
            said(ours),
            said(papers)
        ),
        (Some(ours), None) => format!("COIN gets {}.", said(ours)),
        _ => "The methods side by side.".to_owned(),
    }
}

fn guarantee(results: &ExperimentResults) -> String {
    match &results.calibration {
        Some(calibration) => format!(
            "Thresholds from {} things of {} other homes: at most {:.1} % of the things are settled without a question \
             and wrong, as long as a home is like those.",
            calibration.samples,
            calibration.households,
            100.0 * calibration.risk
        ),
        None => "There is no calibration for this model, so no guarantee holds.".to_owned(),
    }
}

fn key_figures(results: &ExperimentResults) -> Markup {
    let coin = results.methods.get(&Method::Coin);
    let papers = results.methods.get(&Method::CoinPaper);
    let wrong = results.coverage.iter().find(|row| row.guarantee == Guarantee::WrongInTheEnd);
    html! {
        dl.key {
            @if let Some(coin) = coin {
                div { dt { "right in the end" } dd { (format!("{:.3}", coin.overall.subset_accuracy.mean))
                    small { "Subset Accuracy of COIN" } } }
                div { dt { "questions" } dd { (format!("{:.1}", coin.questions.mean))
                    @if let Some(papers) = papers { small { (format!("{:.1} with the paper's gate", papers.questions.mean)) } } } }
            }
            @if let (Some(coin), Some(papers)) = (coin, papers) {
                @if papers.tokens.mean > 0.0 {
                    div { dt { "tokens" } dd { (format!("{:.0} %", 100.0 * coin.tokens.mean / papers.tokens.mean))
                        small { "of what the paper's scheme takes" } } }
                }
            }
            @if let Some(wrong) = wrong {
                div { dt { "wrong in unseen homes" } dd { (format!("{:.2} %", 100.0 * wrong.share))
                    small { (format!("aimed at: at most {:.1} %, over {} homes", 100.0 * wrong.promised, wrong.households)) } } }
            }
        }
    }
}

fn how(results: &ExperimentResults) -> Markup {
    html! {
        h2 { "How it was made" }
        p {
            "Every run imports the episode into a database of its own, starts the tool server on it and lets the model \
             work through the server's tools; people are simulated from the episode's truth, which nothing else sees. A \
             trial changes the words in which people answer and the chance in ActOwL's sampling. The embedded model is \
             deterministic, so that methods without either do not differ from trial to trial; the paper's figures come \
             from GPT-4o at temperature 0.2, which does."
        }
        p {
            "A run that stops asking counts with its last value in the curves. Runs that never reach a Subset Accuracy of "
            (format!("{:.2}", results.target_accuracy)) " are censored in the Kaplan–Meier curve."
        }
        p { "Written by " code { (results.created_with) } "; all figures are in " code { "results.json" } "." }
    }
}
