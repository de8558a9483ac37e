//! Points with names, and paths between some of them.

use coin_server::pages::unit;
use maud::{Markup, html};

use super::lines::Series;
use super::{Look, Plot, Scale, WIDTH, frame, legend, legend_height};

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct Dot {
    /// Its name.
    pub name: String,
    /// How it looks.
    pub look: Look,
    /// The value on the horizontal axis.
    pub x: f64,
    /// The value on the vertical axis.
    pub y: f64,
}

/// Points and paths over one pair of axes. The vertical axis ends at 1.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterChart {
    /// What it shows, in a few words.
    pub title: String,
    /// What it shows, in a sentence, for whoever does not see it.
    pub description: String,
    /// The name of the horizontal axis.
    pub x_label: String,
    /// The name of the vertical axis.
    pub y_label: String,
    /// Where the vertical axis begins.
    pub lowest: f64,
    /// The points.
    pub dots: Vec<Dot>,
    /// The paths.
    pub paths: Vec<Series>,
}

impl ScatterChart {
    /// The chart as SVG. Names stand in the legend, where they cannot cover each other.
    pub fn svg(&self) -> Markup {
        let bottom = 320.0;
        let points = self.paths.iter().flat_map(|path| &path.points).map(|point| point.x);
        let last = self.dots.iter().map(|dot| dot.x).chain(points).fold(1.0, f64::max);
        let plot = Plot {
            x: Scale { low: 0.0, high: last * 1.04, low_at: 52.0, high_at: WIDTH - 16.0 },
            y: Scale { low: self.lowest, high: 1.0, low_at: bottom, high_at: 34.0 },
        };
        let paths = self.paths.iter().map(|path| (path.name.clone(), path.look));
        let entries: Vec<(String, Look)> =
            self.dots.iter().map(|dot| (dot.name.clone(), dot.look)).chain(paths).collect();
        frame(
            &self.title,
            &self.description,
            bottom + 66.0 + legend_height(entries.len()),
            &html! {
                (plot.axes(&self.x_label, &self.y_label))
                @for path in &self.paths {
                    @let corners: Vec<String> = path.points.iter()
                        .map(|point| format!("{} {}", unit(plot.x.at(point.x)), unit(plot.y.at(point.y))))
                        .collect();
                    @if !corners.is_empty() {
                        path d=(format!("M{}", corners.join("L"))) fill="none" stroke=(path.look.colour())
                            stroke-width="1.8" stroke-dasharray=(path.look.dashes()) {}
                    }
                }
                @for dot in &self.dots { (dot.look.mark(plot.x.at(dot.x), plot.y.at(dot.y))) }
                (legend(&entries, bottom + 64.0))
            },
        )
    }
}
