//! Pages to look at: pure functions from results to one HTML file, or one SVG file, that opens from disk.
//!
//! Everything is written by templates that escape what they are given, so that a name or a caption stays text. A page
//! asks the network for nothing and says so in its content security policy. It follows the reader's light or dark
//! scheme and is readable without colour, without a mouse and without its script.

pub mod chart;
pub mod episode;
pub mod experiment;
pub mod table;

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The style of every page: quiet type, one column, tables that scroll in their own box.
const STYLE: &str = include_str!("style.css");

/// A page from its parts. `style` and `script` are constants of this program.
pub(crate) fn page(title: &str, style: &'static str, script: Option<&'static str>, body: &Markup) -> String {
    let policy = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; \
                  base-uri 'none'; form-action 'none'";
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta http-equiv="Content-Security-Policy" content=(policy);
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(style)) }
            }
            body {
                (body)
                @if let Some(script) = script { script { (PreEscaped(script)) } }
            }
        }
    }
    .into_string()
}

/// A number with its thousands apart.
pub(crate) fn thousands(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let (whole, rest) =
        text.split_once('.').map_or((text.as_str(), None), |(whole, rest)| (whole, Some(rest)));
    let mut grouped = String::new();
    for (place, digit) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    match rest {
        Some(rest) => format!("{grouped}.{rest}"),
        None => grouped,
    }
}
