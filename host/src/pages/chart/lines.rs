//! Curves with their spread, and steps.

use std::fmt::Write;

use coin_server::pages::unit;
use maud::{Markup, html};

use super::{Look, Plot, Scale, WIDTH, frame, legend, legend_height};

/// A point of a curve and how far runs spread about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The value on the horizontal axis.
    pub x: f64,
    /// The value on the vertical axis.
    pub y: f64,
    /// The standard deviation; 0 draws no band.
    pub spread: f64,
}

/// How a series goes from point to point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Straight.
    Line,
    /// Level until the next point, as a survival curve.
    Steps,
    /// One value over the whole width.
    Level,
}

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What it shows.
    pub name: String,
    /// How it looks.
    pub look: Look,
    /// How it goes.
    pub shape: Shape,
    /// Its points, from left to right.
    pub points: Vec<Point>,
    /// Places with a small upright stroke, where runs were censored.
    pub strokes: Vec<(f64, f64)>,
}

/// Curves over one pair of axes. The vertical axis ends at 1.
#[derive(Debug, Clone, PartialEq)]
pub struct LineChart {
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
    /// The curves; the first is drawn last, above the others.
    pub series: Vec<Series>,
}

impl LineChart {
    /// The chart as SVG.
    pub fn svg(&self) -> Markup {
        let bottom = 320.0;
        let last =
            self.series.iter().flat_map(|series| &series.points).map(|point| point.x).fold(1.0, f64::max);
        let plot = Plot {
            x: Scale { low: 0.0, high: last, low_at: 52.0, high_at: WIDTH - 16.0 },
            y: Scale { low: self.lowest, high: 1.0, low_at: bottom, high_at: 34.0 },
        };
        let entries: Vec<(String, Look)> =
            self.series.iter().map(|series| (series.name.clone(), series.look)).collect();
        let height = bottom + 66.0 + legend_height(entries.len());
        frame(
            &self.title,
            &self.description,
            height,
            &html! {
                (plot.axes(&self.x_label, &self.y_label))
                @for series in self.series.iter().rev() { (band(series, &plot)) }
                @for series in self.series.iter().rev() { (curve(series, &plot)) }
                (legend(&entries, bottom + 64.0))
            },
        )
    }
}

fn band(series: &Series, plot: &Plot) -> Markup {
    if series.points.iter().all(|point| point.spread == 0.0) || series.shape != Shape::Line {
        return html! {};
    }
    let edge = |point: &Point, sign: f64| {
        format!("{} {}", unit(plot.x.at(point.x)), unit(plot.y.at(point.y + sign * point.spread)))
    };
    let upper = series.points.iter().map(|point| edge(point, 1.0));
    let lower = series.points.iter().rev().map(|point| edge(point, -1.0));
    let outline: Vec<String> = upper.chain(lower).collect();
    html! { path d=(format!("M{}z", outline.join("L"))) fill=(series.look.colour()) opacity="0.14" {} }
}

fn curve(series: &Series, plot: &Plot) -> Markup {
    let colour = series.look.colour();
    let mut data = String::new();
    let mut before = None;
    for point in &series.points {
        let (x, y) = (unit(plot.x.at(point.x)), unit(plot.y.at(point.y)));
        // Writing to a string cannot fail.
        let _ = match (series.shape, before.replace(y.clone())) {
            (Shape::Level, _) => write!(data, "M{} {y}H{}", unit(plot.x.low_at), unit(plot.x.high_at)),
            (_, None) => write!(data, "M{x} {y}"),
            (Shape::Line, Some(_)) => write!(data, "L{x} {y}"),
            (Shape::Steps, Some(_)) => write!(data, "H{x}V{y}"),
        };
    }
    let ends = series.points.first().into_iter().chain(series.points.last());
    html! {
        @if !data.is_empty() {
            path d=(data) fill="none" stroke=(colour) stroke-width="2.2" stroke-linejoin="round"
                stroke-dasharray=(series.look.dashes()) {}
        }
        @if series.shape != Shape::Level {
            @for point in ends { (series.look.mark(plot.x.at(point.x), plot.y.at(point.y))) }
        }
        @for &(x, y) in &series.strokes {
            @let (x, y) = (plot.x.at(x), plot.y.at(y));
            line x1=(unit(x)) x2=(unit(x)) y1=(unit(y - 6.0)) y2=(unit(y + 6.0)) stroke=(colour) stroke-width="1.6" {}
        }
    }
}
