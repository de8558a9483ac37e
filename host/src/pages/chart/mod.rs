//! Charts as SVG. Each is a file of its own with its own light and dark colours, and the same inside a page. Lines are
//! told apart by dashes and marks as well as by colour.

mod bars;
mod intervals;
mod lines;
mod scale;
mod scatter;
#[cfg(test)]
mod tests;

pub use bars::{Bar, BarChart, BarGroup};
pub use intervals::{Interval, IntervalChart};
pub use lines::{LineChart, Point, Series, Shape};
pub(crate) use scale::tenth_below;
pub use scatter::{Dot, ScatterChart};

use coin_server::pages::{colour, unit};
use maud::{Markup, PreEscaped, html};
use scale::{Scale, ticks};

/// The width of every chart, in its own units.
const WIDTH: f64 = 640.0;

/// The colours in both schemes, for a chart that is opened by itself.
const STYLE: &str = "\
svg.chart{--ink:#1c2430;--muted:#566070;--line:#d9dee5;--c0:#0b62a3;--c1:#c4500a;--c2:#00795a;--c3:#a8447c;\
--c4:#7a6200;--c5:#4a5ac0;--c6:#2f7f8c;--c7:#8a4b2a;--c8:#5b6472;font:13px system-ui,'Segoe UI',sans-serif}\
@media screen and (prefers-color-scheme:dark){svg.chart{--ink:#e6eaf0;--muted:#a2adbb;--line:#343d49;--c0:#5fb4f2;--c1:#ff9a56;\
--c2:#3ecfa2;--c3:#f09bcb;--c4:#e2c44e;--c5:#a3aeff;--c6:#6fd3df;--c7:#d9a07c;--c8:#aab4c1}}\
svg.chart text{fill:var(--ink)}svg.chart .faint{fill:var(--muted)}svg.chart .grid{stroke:var(--line)}\
svg.chart .axis{stroke:var(--muted)}";

/// How a method looks in every chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Look(pub usize);

impl Look {
    /// The colour, as a variable that both schemes set.
    pub(crate) fn colour(self) -> String {
        colour(self.0)
    }

    fn dashes(self) -> &'static str {
        ["none", "7 4", "2 3", "9 3 2 3", "12 4", "4 2", "1 2", "6 2 2 2 2 2", "10 2"][self.0 % 9]
    }

    /// A mark of about eight units around a point.
    fn mark(self, x: f64, y: f64) -> Markup {
        let colour = self.colour();
        let path = |data: String| html! { path d=(data) fill=(colour) {} };
        match self.0 % 5 {
            0 => html! { circle cx=(unit(x)) cy=(unit(y)) r="4.2" fill=(colour) {} },
            1 => html! { rect x=(unit(x - 3.8)) y=(unit(y - 3.8)) width="7.6" height="7.6" fill=(colour) {} },
            2 => path(format!("M{} {}l4.8 8.4h-9.6z", unit(x), unit(y - 5.0))),
            3 => path(format!("M{} {}l5 5-5 5-5-5z", unit(x), unit(y - 5.0))),
            _ => path(format!("M{} {}l4.8 -8.4h-9.6z", unit(x), unit(y + 5.0))),
        }
    }
}

/// A chart's frame: its name and description for whoever does not see it, and its style.
fn frame(title: &str, description: &str, height: f64, content: &Markup) -> Markup {
    html! {
        svg.chart xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {}", unit(height))) role="img"
            aria-label=(format!("{title}. {description}")) {
            title { (title) }
            desc { (description) }
            style { (PreEscaped(STYLE)) }
            (content)
        }
    }
}

/// A name beside a sample of its look, in rows of two.
fn legend(entries: &[(String, Look)], top: f64) -> Markup {
    html! {
        @for (place, (name, look)) in entries.iter().enumerate() {
            @let x = 52.0 + (place % 2) as f64 * 290.0;
            @let y = top + (place / 2) as f64 * 20.0;
            line x1=(unit(x)) x2=(unit(x + 26.0)) y1=(unit(y)) y2=(unit(y)) stroke=(look.colour()) stroke-width="2.4"
                stroke-dasharray=(look.dashes()) {}
            (look.mark(x + 13.0, y))
            text x=(unit(x + 34.0)) y=(unit(y + 4.5)) { (name) }
        }
    }
}

/// The height of a legend with so many entries.
fn legend_height(entries: usize) -> f64 {
    entries.div_ceil(2) as f64 * 20.0
}

/// The area in which values are drawn.
struct Plot {
    x: Scale,
    y: Scale,
}

impl Plot {
    /// Grid, axes, ticks and the names of the axes.
    fn axes(&self, x_label: &str, y_label: &str) -> Markup {
        let (left, right) = (self.x.low_at, self.x.high_at);
        let (bottom, top) = (self.y.low_at, self.y.high_at);
        html! {
            @for (value, text) in ticks(self.y.low, self.y.high) {
                @let y = unit(self.y.at(value));
                line.grid x1=(unit(left)) x2=(unit(right)) y1=(y) y2=(y) {}
                text.faint x=(unit(left - 8.0)) y=(unit(self.y.at(value) + 4.5)) text-anchor="end" { (text) }
            }
            @for (value, text) in ticks(self.x.low, self.x.high) {
                text.faint x=(unit(self.x.at(value))) y=(unit(bottom + 18.0)) text-anchor="middle" { (text) }
            }
            line.axis x1=(unit(left)) x2=(unit(right)) y1=(unit(bottom)) y2=(unit(bottom)) {}
            text.faint x=(unit((left + right) / 2.0)) y=(unit(bottom + 38.0)) text-anchor="middle" { (x_label) }
            text.faint x=(unit(left - 40.0)) y=(unit(top - 12.0)) { (y_label) }
        }
    }
}
