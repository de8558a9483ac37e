//! Pages to look at: pure functions from results to one HTML file, or one SVG file, that opens from disk. Their frame,
//! their style and the plan of a home are those of the server's own pages ([`coin_server::pages`]), and so are the rules
//! that they keep.

pub mod chart;
pub mod episode;
pub mod experiment;
pub mod table;

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
