//! Where everything of a plan is drawn.

use std::collections::BTreeMap;

use super::labels::Area;

/// The width of a sheet that is not crowded, and the most and the least height that it takes, in its own units.
const WIDTH: f64 = 720.0;
const MOST_HEIGHT: f64 = 620.0;
const LEAST_HEIGHT: f64 = 260.0;

/// Room around the things for marks and the names of rooms.
const MARGIN: f64 = 46.0;

/// The radius of a mark where there is no doubt, and where there is nothing but.
pub(super) const SMALLEST: f64 = 9.5;
pub(super) const LARGEST: f64 = 21.0;

/// The least distance between the rims of two marks.
const GAP: f64 = 2.0;

/// The share of a sheet that marks may cover. With more of them the sheet gets larger.
const MOST_COVERED: f64 = 0.3;

/// How often marks that cover each other are moved apart. A crowd that needs more stays a little crowded.
const MOVES: usize = 200;

/// A home with nothing in it but one thing is drawn as if it were this large, in metres.
const LEAST_SPAN: f64 = 2.0;

/// The radius of a mark: its area grows with the doubt, 0…1.
pub(super) fn radius(doubt: f64) -> f64 {
    let doubt = if doubt.is_finite() { doubt.clamp(0.0, 1.0) } else { 1.0 };
    (SMALLEST.powi(2) + doubt * (LARGEST.powi(2) - SMALLEST.powi(2))).sqrt()
}

/// A point of the plan, in its own units, the vertical axis downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    pub(super) x: f64,
    pub(super) y: f64,
}

/// Where everything is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub(super) width: f64,
    pub(super) height: f64,
    /// The places of the things.
    pub(super) places: Vec<Spot>,
    /// Where their marks are: at the place, or beside it where another mark would cover it.
    pub(super) marks: Vec<Spot>,
}

/// Draws positions in metres to one scale, north up, on a sheet that is large enough for marks of the given radii, and
/// moves the marks off each other.
pub(super) fn layout(positions: &[[f64; 3]], radii: &[f64]) -> Layout {
    let mut drawn = at_their_places(positions, magnification(radii));
    drawn.marks = moved_apart(&drawn, radii);
    drawn
}

/// How much larger than usual, in length, a sheet must be for marks of these radii.
pub(super) fn magnification(radii: &[f64]) -> f64 {
    let covered: f64 = radii.iter().map(|radius| std::f64::consts::PI * (radius + GAP / 2.0).powi(2)).sum();
    (covered / (MOST_COVERED * WIDTH * MOST_HEIGHT)).sqrt().max(1.0)
}

/// Draws positions in metres to one scale, north up, every mark at its place whatever it covers.
pub(super) fn at_their_places(positions: &[[f64; 3]], magnification: f64) -> Layout {
    let bounds = |axis: usize| {
        let values = positions.iter().map(|position| position[axis]);
        let (low, high) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high { (0.0, 0.0) } else { (low, high) }
    };
    let ((west, east), (south, north)) = (bounds(0), bounds(1));
    let (across, along) = ((east - west).max(LEAST_SPAN), (north - south).max(LEAST_SPAN));
    let (width, most_height) = (WIDTH * magnification, MOST_HEIGHT * magnification);
    let scale = ((width - 2.0 * MARGIN) / across).min((most_height - 2.0 * MARGIN) / along);
    let height = (along * scale + 2.0 * MARGIN).clamp(LEAST_HEIGHT * magnification, most_height);
    let (middle_x, middle_y) = (west / 2.0 + east / 2.0, south / 2.0 + north / 2.0);
    let places: Vec<Spot> = positions
        .iter()
        .map(|[x, y, _]| Spot {
            x: width / 2.0 + (x - middle_x) * scale,
            y: height / 2.0 - (y - middle_y) * scale,
        })
        .collect();
    Layout { width, height, marks: places.clone(), places }
}

/// Pushes overlapping marks off each other, half of the way each, until none overlap or [`MOVES`] rounds are over.
fn moved_apart(drawn: &Layout, radii: &[f64]) -> Vec<Spot> {
    let mut marks = drawn.places.clone();
    let reach = 2.0 * radii.iter().fold(SMALLEST, |most, &radius| most.max(radius)) + GAP;
    for _ in 0..MOVES {
        let neighbours = Cells::new(&marks, reach);
        let mut moved = false;
        for one in 0..marks.len() {
            for other in neighbours.later_ones_near(one) {
                let (dx, dy) = (marks[other].x - marks[one].x, marks[other].y - marks[one].y);
                let distance = dx.hypot(dy);
                let wanted = radii[one] + radii[other] + GAP;
                if distance >= wanted - 1e-6 {
                    continue;
                }
                // Marks at the very same place go apart in directions of their own.
                let angle = if distance > 1e-9 { dy.atan2(dx) } else { (other as f64) * 2.4 };
                let step = (wanted - distance) / 2.0;
                marks[one] = drawn.within(marks[one], -step, angle, radii[one]);
                marks[other] = drawn.within(marks[other], step, angle, radii[other]);
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    marks
}

impl Layout {
    /// All of it.
    pub(super) fn sheet(&self) -> Area {
        Area { left: 0.0, top: 0.0, right: self.width, bottom: self.height }
    }

    /// A step from a spot that does not lead off the sheet.
    fn within(&self, spot: Spot, step: f64, angle: f64, radius: f64) -> Spot {
        let edge = radius + 1.0;
        Spot {
            x: (spot.x + step * angle.cos()).clamp(edge, self.width - edge),
            y: (spot.y + step * angle.sin()).clamp(edge, self.height - edge),
        }
    }
}

/// Marks by the square of the sheet that they are in, so that a thousand of them need not be compared with each other.
struct Cells {
    of_mark: Vec<(i64, i64)>,
    marks: BTreeMap<(i64, i64), Vec<usize>>,
}

impl Cells {
    fn new(marks: &[Spot], side: f64) -> Self {
        let of_mark: Vec<(i64, i64)> = marks
            .iter()
            .map(|spot| ((spot.x / side).floor() as i64, (spot.y / side).floor() as i64))
            .collect();
        let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (mark, &cell) in of_mark.iter().enumerate() {
            cells.entry(cell).or_default().push(mark);
        }
        Self { of_mark, marks: cells }
    }

    /// The marks that may touch this one and come after it, in their order.
    fn later_ones_near(&self, mark: usize) -> Vec<usize> {
        let (column, row) = self.of_mark[mark];
        let columns = column.saturating_sub(1)..=column.saturating_add(1);
        let cells = columns
            .flat_map(|column| (row.saturating_sub(1)..=row.saturating_add(1)).map(move |row| (column, row)));
        let near = cells.filter_map(|cell| self.marks.get(&cell)).flatten();
        let mut near: Vec<usize> = near.copied().filter(|&other| other > mark).collect();
        near.sort_unstable();
        near
    }
}
