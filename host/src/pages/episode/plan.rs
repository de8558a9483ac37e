//! The plan of a home: the things at their places, coloured by owner, sized by doubt.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use coin_schemas::episode::EpisodeObject;
use coin_schemas::household::{Owners, UserName};
use maud::{Markup, html};

use super::Belief;
use crate::pages::chart::{Look, unit};

/// The width of the plan and the most height that it takes, in its own units.
const WIDTH: f64 = 720.0;
const MOST_HEIGHT: f64 = 620.0;
const LEAST_HEIGHT: f64 = 260.0;

/// Room around the things for marks and the names of rooms.
const MARGIN: f64 = 46.0;

/// The radius of a mark where there is no doubt, and where there is nothing but.
const SMALLEST: f64 = 9.5;
const LARGEST: f64 = 21.0;

/// The least distance between the rims of two marks.
const GAP: f64 = 2.0;

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
    pub(super) height: f64,
    /// The places of the things.
    pub(super) places: Vec<Spot>,
    /// Where their marks are: at the place, or beside it where another mark would cover it.
    pub(super) marks: Vec<Spot>,
}

/// Draws positions in metres to one scale, north up, and moves marks of the given radii off each other.
pub(super) fn layout(positions: &[[f64; 3]], radii: &[f64]) -> Layout {
    let bounds = |axis: usize| {
        let values = positions.iter().map(|position| position[axis]);
        let (low, high) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high { (0.0, 0.0) } else { (low, high) }
    };
    let ((west, east), (south, north)) = (bounds(0), bounds(1));
    let (across, along) = ((east - west).max(LEAST_SPAN), (north - south).max(LEAST_SPAN));
    let scale = ((WIDTH - 2.0 * MARGIN) / across).min((MOST_HEIGHT - 2.0 * MARGIN) / along);
    let height = (along * scale + 2.0 * MARGIN).clamp(LEAST_HEIGHT, MOST_HEIGHT);
    let (middle_x, middle_y) = (west / 2.0 + east / 2.0, south / 2.0 + north / 2.0);
    let places: Vec<Spot> = positions
        .iter()
        .map(|[x, y, _]| Spot {
            x: WIDTH / 2.0 + (x - middle_x) * scale,
            y: height / 2.0 - (y - middle_y) * scale,
        })
        .collect();
    let marks = moved_apart(&places, radii, height);
    Layout { height, places, marks }
}

/// Pushes overlapping marks off each other, half of the way each, until none overlap or [`MOVES`] rounds are over.
fn moved_apart(places: &[Spot], radii: &[f64], height: f64) -> Vec<Spot> {
    let mut marks = places.to_vec();
    for _ in 0..MOVES {
        let mut moved = false;
        for one in 0..marks.len() {
            for other in one + 1..marks.len() {
                let (dx, dy) = (marks[other].x - marks[one].x, marks[other].y - marks[one].y);
                let distance = dx.hypot(dy);
                let wanted = radii[one] + radii[other] + GAP;
                if distance >= wanted - 1e-6 {
                    continue;
                }
                // Marks at the very same place go apart in directions of their own.
                let angle = if distance > 1e-9 { dy.atan2(dx) } else { (other as f64) * 2.4 };
                let step = (wanted - distance) / 2.0;
                marks[one] = within(marks[one], -step, angle, radii[one], height);
                marks[other] = within(marks[other], step, angle, radii[other], height);
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    marks
}

fn within(spot: Spot, step: f64, angle: f64, radius: f64, height: f64) -> Spot {
    let edge = radius + 1.0;
    Spot {
        x: (spot.x + step * angle.cos()).clamp(edge, WIDTH - edge),
        y: (spot.y + step * angle.sin()).clamp(edge, height - edge),
    }
}

/// The looks of the members of the household.
pub(super) struct Palette<'a> {
    looks: BTreeMap<&'a UserName, (Look, String)>,
}

impl<'a> Palette<'a> {
    /// Gives every member a colour and the shortest beginning of the name that is nobody else's.
    pub(super) fn new(members: impl Iterator<Item = &'a UserName>) -> Self {
        let members: Vec<&UserName> = members.collect();
        let look = |(place, &name): (usize, &&'a UserName)| {
            let others: Vec<&UserName> = members.iter().copied().filter(|other| *other != name).collect();
            (name, (Look(place), initials(name, &others)))
        };
        Self { looks: members.iter().enumerate().map(look).collect() }
    }

    fn colour(&self, name: &UserName) -> String {
        self.looks.get(name).map_or("var(--muted)".to_owned(), |(look, _)| look.colour())
    }

    /// What stands in a mark: whose it is, for whoever does not tell colours apart.
    fn letters(&self, owners: &Owners) -> String {
        match owners.len() {
            0 => "–".to_owned(),
            many if many > 2 && many == self.looks.len() => "all".to_owned(),
            1 | 2 => owners.iter().filter_map(|name| self.looks.get(name)).map(|(_, text)| &**text).collect(),
            many => many.to_string(),
        }
    }

    /// A mark: a disc in the owner's colour, in as many sectors as there are owners; an empty one where somebody
    /// outside the household is the owner.
    pub(super) fn mark(&self, at: Spot, radius: f64, owners: &Owners) -> Markup {
        let share = TAU / owners.len().max(1) as f64;
        let rim = |turn: f64| (unit(at.x + radius * turn.sin()), unit(at.y - radius * turn.cos()));
        html! {
            @if owners.len() < 2 {
                @let colour = owners.first().map_or("var(--panel)".to_owned(), |name| self.colour(name));
                circle.rim cx=(unit(at.x)) cy=(unit(at.y)) r=(unit(radius)) fill=(colour) {}
            } @else {
                @for (place, name) in owners.iter().enumerate() {
                    @let (from, to) = (rim(share * place as f64), rim(share * (place + 1) as f64));
                    path fill=(self.colour(name)) d=(format!(
                        "M{} {}L{} {}A{radius:.1} {radius:.1} 0 0 1 {} {}z",
                        unit(at.x), unit(at.y), from.0, from.1, to.0, to.1
                    )) {}
                }
                circle.rim cx=(unit(at.x)) cy=(unit(at.y)) r=(unit(radius)) fill="none" {}
            }
            @let letters = self.letters(owners);
            text.letters.outside[owners.is_empty()] x=(unit(at.x)) y=(unit(at.y + 3.6)) text-anchor="middle" aria-hidden="true" {
                (letters)
            }
        }
    }

    /// A mark by itself, for a legend or a line of text.
    pub(super) fn swatch(&self, owners: &Owners) -> Markup {
        html! {
            svg.swatch viewBox="0 0 24 24" width="20" height="20" aria-hidden="true" {
                (self.mark(Spot { x: 12.0, y: 12.0 }, 11.0, owners))
            }
        }
    }
}

/// The shortest beginning of a name, of at most three letters, with which no other name begins.
fn initials(name: &UserName, others: &[&UserName]) -> String {
    let beginning = |name: &UserName, letters: usize| name.as_str().chars().take(letters).collect::<String>();
    (1..=2)
        .map(|letters| beginning(name, letters))
        .find(|text| others.iter().all(|other| beginning(other, text.chars().count()) != *text))
        .unwrap_or_else(|| beginning(name, 3))
}

/// One state of a mark and the questions over which it lasts.
pub(super) struct MarkState<'a> {
    /// Its first and its last step.
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) belief: &'a Belief,
    /// It in words.
    pub(super) said: String,
}

/// A thing on the plan.
pub(super) struct PlacedThing<'a> {
    pub(super) object: &'a EpisodeObject,
    /// Where it is described.
    pub(super) link: String,
    /// The states of its mark, in the order of time; the last one is drawn.
    pub(super) states: Vec<MarkState<'a>>,
    /// After which questions about it the plan shows it as asked.
    pub(super) asked: Vec<usize>,
    /// The evidence in a few words, for a pointer where no script runs.
    pub(super) hint: String,
}

/// The plan as SVG; every mark is a link to what is known of its thing.
pub(super) fn plan(things: &[PlacedThing<'_>], palette: &Palette<'_>) -> Markup {
    let positions: Vec<[f64; 3]> = things.iter().map(|thing| thing.object.position.metres()).collect();
    let radii: Vec<f64> = things
        .iter()
        .map(|thing| thing.states.iter().map(|state| radius(state.belief.doubt())).fold(SMALLEST, f64::max))
        .collect();
    let layout = layout(&positions, &radii);
    html! {
        svg.plan xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {}", unit(layout.height)))
            role="group" aria-label="Plan of the home. Every thing is a link to what is known of it." {
            (rooms(things, &layout))
            @for (place, mark) in layout.places.iter().zip(&layout.marks) {
                @if (place.x - mark.x).hypot(place.y - mark.y) > 1.0 {
                    line.stem x1=(unit(place.x)) y1=(unit(place.y)) x2=(unit(mark.x)) y2=(unit(mark.y)) {}
                    circle.foot cx=(unit(place.x)) cy=(unit(place.y)) r="1.6" {}
                }
            }
            @for (thing, &mark) in things.iter().zip(&layout.marks) { (linked(thing, mark, palette)) }
        }
    }
}

fn linked(thing: &PlacedThing<'_>, mark: Spot, palette: &Palette<'_>) -> Markup {
    let last = thing.states.len().saturating_sub(1);
    let name = name_and_room(thing.object);
    let said = thing.states.last().map_or("", |state| state.said.as_str());
    html! {
        a.thing href=(format!("#{}", thing.link)) aria-label=(format!("{name}: {said}")) data-name=(name) {
            title { (name) ": " (thing.hint) }
            @for &step in &thing.asked {
                circle.asked.past data-from=(step) data-to=(step) cx=(unit(mark.x)) cy=(unit(mark.y))
                    r=(unit(LARGEST + 4.0)) fill="none" {}
            }
            @for (place, state) in thing.states.iter().enumerate() {
                g.past[place != last] data-from=(state.from) data-to=(state.to) data-said=(state.said) {
                    (palette.mark(mark, radius(state.belief.doubt()), &state.belief.owners))
                }
            }
        }
    }
}

/// `marker, study`.
pub(super) fn name_and_room(object: &EpisodeObject) -> String {
    match &object.room {
        Some(room) => format!("{}, {room}", object.class),
        None => object.class.to_string(),
    }
}

/// The width of a letter in the name of a room, about.
const LETTER: f64 = 6.6;

/// The outline of every room: a box around the things that are in it, wide enough for its name.
fn rooms(things: &[PlacedThing<'_>], layout: &Layout) -> Markup {
    let mut boxes: BTreeMap<&str, [f64; 4]> = BTreeMap::new();
    for (place, thing) in things.iter().enumerate() {
        let Some(room) = thing.object.room.as_deref() else { continue };
        let bounds =
            boxes.entry(room).or_insert([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);
        for spot in [layout.places[place], layout.marks[place]] {
            *bounds = [
                bounds[0].min(spot.x - SMALLEST - 8.0),
                bounds[1].min(spot.y - SMALLEST - 24.0),
                bounds[2].max(spot.x + SMALLEST + 8.0),
                bounds[3].max(spot.y + SMALLEST + 8.0),
            ];
        }
    }
    for (name, bounds) in &mut boxes {
        let wanted = LETTER * name.chars().count() as f64 + 16.0;
        let missing = (wanted - (bounds[2] - bounds[0])).max(0.0) / 2.0;
        *bounds = [
            (bounds[0] - missing).max(1.0),
            bounds[1].max(1.0),
            (bounds[2] + missing).min(WIDTH - 1.0),
            bounds[3].min(layout.height - 1.0),
        ];
    }
    html! {
        @for [left, top, right, bottom] in boxes.values() {
            rect.room x=(unit(*left)) y=(unit(*top)) width=(unit((right - left).max(0.0)))
                height=(unit((bottom - top).max(0.0))) rx="8" {}
        }
        @for (name, [left, top, ..]) in &boxes {
            text.room-name x=(unit(left + 8.0)) y=(unit(top + 15.0)) aria-hidden="true" { (name) }
        }
    }
}

/// How to read the sizes.
pub(super) fn sizes() -> Markup {
    let doubts = [(0.0, "sure"), (0.5, "half sure"), (1.0, "no idea")];
    html! {
        @for (doubt, name) in doubts {
            li {
                svg.swatch viewBox="0 0 44 44" width="32" height="32" aria-hidden="true" {
                    circle.rim cx="22" cy="22" r=(unit(radius(doubt))) fill="none" {}
                }
                (name)
            }
        }
    }
}
