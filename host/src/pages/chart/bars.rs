//! Groups of bars with the spread of each.

use coin_server::pages::unit;
use maud::{Markup, html};

use super::{Look, Plot, Scale, WIDTH, frame};

/// A bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// What it stands for.
    pub name: String,
    /// How it looks.
    pub look: Look,
    /// Its length.
    pub value: f64,
    /// The standard deviation; 0 draws no whisker.
    pub spread: f64,
    /// What is written at its end.
    pub label: String,
}

/// Bars that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct BarGroup {
    /// What they have in common.
    pub name: String,
    /// The bars, from above.
    pub bars: Vec<Bar>,
}

/// Lying bars, so that their names can be read.
#[derive(Debug, Clone, PartialEq)]
pub struct BarChart {
    /// What it shows, in a few words.
    pub title: String,
    /// What it shows, in a sentence, for whoever does not see it.
    pub description: String,
    /// The name of the axis.
    pub label: String,
    /// Where the axis ends.
    pub highest: f64,
    /// The groups, from above.
    pub groups: Vec<BarGroup>,
}

const BAR: f64 = 22.0;
const HEAD: f64 = 34.0;

impl BarChart {
    /// The chart as SVG.
    pub fn svg(&self) -> Markup {
        let heights: Vec<f64> =
            self.groups.iter().map(|group| HEAD + group.bars.len() as f64 * BAR).collect();
        let bottom = 14.0 + heights.iter().sum::<f64>();
        let plot = Plot {
            x: Scale { low: 0.0, high: self.highest, low_at: 178.0, high_at: WIDTH - 74.0 },
            y: Scale { low: 0.0, high: 0.0, low_at: bottom, high_at: 14.0 },
        };
        let mut top = 14.0;
        frame(
            &self.title,
            &self.description,
            bottom + 46.0,
            &html! {
                @for (value, text) in super::ticks(0.0, self.highest) {
                    @let x = unit(plot.x.at(value));
                    line.grid x1=(x) x2=(x) y1="20" y2=(unit(bottom)) {}
                    text.faint x=(x) y=(unit(bottom + 18.0)) text-anchor="middle" { (text) }
                }
                text.faint x=(unit((plot.x.low_at + plot.x.high_at) / 2.0)) y=(unit(bottom + 38.0)) text-anchor="middle" {
                    (self.label)
                }
                @for (group, height) in self.groups.iter().zip(heights) {
                    text x="4" y=(unit(top + HEAD - 10.0)) font-weight="600" { (group.name) }
                    @for (place, bar) in group.bars.iter().enumerate() {
                        (drawn(bar, top + HEAD + place as f64 * BAR, &plot))
                    }
                    ({ top += height; html! {} })
                }
            },
        )
    }
}

fn drawn(bar: &Bar, top: f64, plot: &Plot) -> Markup {
    let (start, end) = (plot.x.low_at, plot.x.at(bar.value));
    let middle = top + BAR / 2.0;
    let (low, high) = (plot.x.at(bar.value - bar.spread), plot.x.at(bar.value + bar.spread));
    let label_at = if bar.spread > 0.0 { end.max(high) } else { end };
    html! {
        text.faint x=(unit(start - 8.0)) y=(unit(middle + 4.5)) text-anchor="end" { (bar.name) }
        rect x=(unit(start)) y=(unit(top + 3.0)) width=(unit((end - start).max(1.0))) height=(unit(BAR - 6.0)) rx="2"
            fill=(bar.look.colour()) {}
        @if bar.spread > 0.0 {
            line.axis x1=(unit(low)) x2=(unit(high)) y1=(unit(middle)) y2=(unit(middle)) stroke-width="1.6" {}
        }
        text x=(unit(label_at + 6.0)) y=(unit(middle + 4.5)) { (bar.label) }
    }
}
