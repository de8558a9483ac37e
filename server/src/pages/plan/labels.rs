//! The names beside the marks, where there is room for them.

use super::layout::{Layout, Spot};

/// The width of a letter in the name of a thing and in the name of a room, about.
const LETTER: f64 = 5.7;
const LETTER_OF_ROOM: f64 = 6.6;

/// The height of a line of text above and below its baseline.
const ABOVE: f64 = 9.0;
const BELOW: f64 = 3.0;

/// The longest name that is written out, in characters.
const LONGEST: usize = 24;

/// A rectangle on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    /// The square around a mark.
    pub(super) fn around(spot: Spot, radius: f64) -> Self {
        Self { left: spot.x - radius, top: spot.y - radius, right: spot.x + radius, bottom: spot.y + radius }
    }

    /// The line of the name of a room that begins here.
    pub(super) fn of_room_name(start: Spot, name: &str) -> Self {
        Self {
            left: start.x,
            top: start.y - ABOVE,
            right: start.x + room_name_width(name),
            bottom: start.y + BELOW,
        }
    }

    /// Whether another one lies within this one.
    pub(super) fn contains(&self, other: &Self) -> bool {
        self.left <= other.left
            && other.right <= self.right
            && self.top <= other.top
            && other.bottom <= self.bottom
    }

    /// The least one that holds both.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    /// With so much room on every side.
    pub(super) fn padded(self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}

/// How wide the name of a room is, about.
pub(super) fn room_name_width(name: &str) -> f64 {
    LETTER_OF_ROOM * letters(name)
}

/// A name, written beside its mark.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    /// Where its baseline begins, is in the middle or ends, as the anchor says.
    pub(super) at: Spot,
    /// `start`, `middle` or `end`, as in SVG.
    pub(super) anchor: &'static str,
    /// The name, shortened where it is long.
    pub(super) text: String,
    /// What it covers.
    pub(super) area: Area,
}

/// A mark that wants its name beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Nameless<'a> {
    pub(super) at: Spot,
    pub(super) radius: f64,
    pub(super) name: &'a str,
    /// The place of its room in the list of rooms.
    pub(super) room: Option<usize>,
}

/// Names for marks, those of the largest first, where they cover neither a mark nor what is `taken` nor each other. Of
/// the sides of a mark the best is one within its own room, then one in no other room, and at last any. Where everything
/// is taken there is none.
pub(super) fn labels(
    marks: &[Nameless<'_>],
    rooms: &[Area],
    layout: &Layout,
    mut taken: Vec<Area>,
) -> Vec<Option<Label>> {
    taken.extend(marks.iter().map(|mark| Area::around(mark.at, mark.radius)));
    let mut by_size: Vec<usize> = (0..marks.len()).collect();
    by_size.sort_by(|&one, &other| marks[other].radius.total_cmp(&marks[one].radius));
    let mut placed = vec![None; marks.len()];
    for place in by_size {
        let mark = marks[place];
        let free = sides(mark).into_iter().filter(|label| {
            layout.sheet().contains(&label.area) && !taken.iter().any(|area| area.meets(&label.area))
        });
        let label = free.min_by_key(|label| {
            let own = mark.room.and_then(|room| rooms.get(room));
            let in_another = rooms
                .iter()
                .enumerate()
                .any(|(room, area)| mark.room != Some(room) && area.meets(&label.area));
            match own.is_some_and(|room| room.contains(&label.area)) {
                true => 0,
                false if !in_another => 1,
                false => 2,
            }
        });
        taken.extend(label.as_ref().map(|label| label.area));
        placed[place] = label;
    }
    placed
}

/// The places beside a mark in which its name may stand.
fn sides(mark: Nameless<'_>) -> [Label; 4] {
    let Nameless { at: spot, radius, name, .. } = mark;
    let text = shortened(name, LONGEST);
    let width = LETTER * letters(&text);
    let (right, left) = (spot.x + radius + 3.0, spot.x - radius - 3.0);
    [
        ("start", right, spot.y + 3.5, right),
        ("end", left, spot.y + 3.5, left - width),
        ("middle", spot.x, spot.y + radius + 10.5, spot.x - width / 2.0),
        ("middle", spot.x, spot.y - radius - 4.5, spot.x - width / 2.0),
    ]
    .map(|(anchor, x, y, start)| Label {
        at: Spot { x, y },
        anchor,
        text: text.clone(),
        area: Area { left: start, top: y - ABOVE, right: start + width, bottom: y + BELOW },
    })
}

/// A text of at most so many characters; what is cut off is shown by an ellipsis.
pub(super) fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// How many Latin letters a text is as wide as.
fn letters(text: &str) -> f64 {
    // From here on come the scripts whose characters fill a square.
    text.chars().map(|character| if character >= '\u{2e80}' { 1.9 } else { 1.0 }).sum()
}
