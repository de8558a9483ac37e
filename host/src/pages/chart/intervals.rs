//! Measured shares with their intervals, beside what was promised.

use coin_server::pages::unit;
use maud::{Markup, html};

use super::{Look, Scale, WIDTH, frame, ticks};

/// A measured share.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// What was measured.
    pub name: String,
    /// The share.
    pub share: f64,
    /// The lower end of its interval.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// What was promised.
    pub promised: f64,
}

/// Intervals one below the other.
#[derive(Debug, Clone, PartialEq)]
pub struct IntervalChart {
    /// What it shows, in a few words.
    pub title: String,
    /// What it shows, in a sentence, for whoever does not see it.
    pub description: String,
    /// The name of the axis.
    pub label: String,
    /// The rows, from above.
    pub rows: Vec<Interval>,
}

const ROW: f64 = 46.0;

impl IntervalChart {
    /// The chart as SVG. The axis spans what is shown.
    pub fn svg(&self) -> Markup {
        let ends = self.rows.iter().flat_map(|row| [row.low, row.high, row.promised]);
        let (low, high) =
            ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| (low.min(end), high.max(end)));
        let margin = ((high - low) * 0.08).max(0.001);
        let bottom = 20.0 + self.rows.len() as f64 * ROW;
        let scale = Scale {
            low: (low - margin).max(0.0),
            high: (high + margin).min(1.0),
            low_at: 16.0,
            high_at: WIDTH - 24.0,
        };
        let look = Look(0);
        frame(
            &self.title,
            &self.description,
            bottom + 46.0,
            &html! {
                @for (value, text) in ticks(scale.low, scale.high) {
                    @let x = unit(scale.at(value));
                    line.grid x1=(x) x2=(x) y1="10" y2=(unit(bottom)) {}
                    text.faint x=(x) y=(unit(bottom + 18.0)) text-anchor="middle" { (text) }
                }
                text.faint x=(unit(WIDTH / 2.0)) y=(unit(bottom + 38.0)) text-anchor="middle" { (self.label) }
                @for (place, row) in self.rows.iter().enumerate() {
                    @let top = 20.0 + place as f64 * ROW;
                    @let y = top + 28.0;
                    @let promised = scale.at(row.promised);
                    text x="16" y=(unit(top + 12.0)) { (row.name) }
                    line x1=(unit(scale.at(row.low))) x2=(unit(scale.at(row.high))) y1=(unit(y)) y2=(unit(y))
                        stroke=(look.colour()) stroke-width="3" {}
                    (look.mark(scale.at(row.share), y))
                    line x1=(unit(promised)) x2=(unit(promised)) y1=(unit(y - 10.0)) y2=(unit(y + 10.0))
                        stroke="var(--c1)" stroke-width="2.4" {}
                }
            },
        )
    }
}
