//! What the pages of both programs share: the frame and the style of a page, and the plan of a home. Pure functions from
//! data to one HTML file that opens from disk.
//!
//! Everything is written by templates that escape what they are given, so that a name or a caption stays text. A page
//! asks the network for nothing and says so in its content security policy. It follows the reader's light or dark
//! scheme, is printed as on white paper, and is readable without colour, without a mouse and without its script.

pub mod plan;

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The style of every page: quiet type, one column, tables that scroll in their own box.
const STYLE: &str = include_str!("style.css");

/// How many colours the style has for people and methods.
const COLOURS: usize = 9;

/// A page from its parts. The styles and the script are constants of the program.
pub fn page(title: &str, styles: &[&'static str], script: Option<&'static str>, body: &Markup) -> String {
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
                style { (PreEscaped(STYLE)) @for style in styles { (PreEscaped(style)) } }
            }
            body {
                (body)
                @if let Some(script) = script { script { (PreEscaped(script)) } }
            }
        }
    }
    .into_string()
}

/// A coordinate as it is written; what is not finite would break the file.
pub fn unit(value: f64) -> String {
    let finite = if value.is_finite() { value } else { 0.0 };
    format!("{:.1}", finite + 0.0)
}

/// The colour of whoever is at a place in a list, as a variable that both schemes set.
pub fn colour(place: usize) -> String {
    format!("var(--c{})", place % COLOURS)
}
