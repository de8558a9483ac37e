//! The plan of a home: the things at their places, coloured by owner, sized by doubt, named where there is room.
//!
//! A mark is a link to the element that describes its thing. What is believed may change in the course of time; then a
//! mark has several states, and a script may choose which one is seen.

mod labels;
mod layout;
mod palette;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use coin_schemas::household::{Background, Owners, Position, UserName, Users};
use maud::{Markup, html};

use super::unit;
use labels::{Area, Label, Nameless, labels, room_name_width, shortened};
use layout::{LARGEST, Layout, SMALLEST, Spot, at_their_places, layout, magnification, radius};
pub use palette::Palette;

/// The style of plans, legends and swatches.
pub const STYLE: &str = include_str!("plan.css");

/// From here on a sheet is so large that its letters get too small for a screen or a page.
const CROWDED: f64 = 1.5;

/// How much smaller than on a plan the marks of an overview are.
const OVERVIEW: f64 = 0.22;

/// The longest name of a room that is written out, in characters.
const LONGEST_ROOM_NAME: usize = 60;

/// One state of a mark and the moments over which it lasts.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkState<'a> {
    /// Its first moment.
    pub from: usize,
    /// Its last moment.
    pub to: usize,
    /// Who is held to own the thing.
    pub owners: &'a Owners,
    /// How much room there is for another answer, 0…1.
    pub doubt: f64,
    /// It in words.
    pub said: String,
}

/// A thing on the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedThing<'a> {
    /// What it is.
    pub class: &'a str,
    /// The room that it is in.
    pub room: Option<&'a str>,
    /// Where it is.
    pub position: Position,
    /// The id of the element that describes it. The mark's own is [`mark_id`] of it.
    pub link: String,
    /// The states of its mark, in the order of time; the last one is drawn.
    pub states: Vec<MarkState<'a>>,
    /// The moments at which it is shown as asked about.
    pub asked: Vec<usize>,
    /// More in a few words, for a pointer.
    pub hint: String,
}

impl PlacedThing<'_> {
    /// The radius of the largest of its states.
    fn radius(&self) -> f64 {
        self.states.iter().map(|state| radius(state.doubt)).fold(SMALLEST, f64::max)
    }
}

/// `marker, study`.
pub fn name_and_room(class: &str, room: Option<&str>) -> String {
    match room {
        Some(room) => format!("{class}, {room}"),
        None => class.to_owned(),
    }
}

/// The id of the mark of a thing that is described by the element of this id.
pub fn mark_id(link: &str) -> String {
    format!("{link}-mark")
}

/// Whether one plan of all these things would be too crowded to read.
pub fn is_crowded(things: &[PlacedThing<'_>]) -> bool {
    let radii: Vec<f64> = things.iter().map(PlacedThing::radius).collect();
    magnification(&radii) > CROWDED
}

/// The plan as SVG; every mark is a link to what is known of its thing. `title` is for whoever does not see it.
pub fn plan(title: &str, things: &[PlacedThing<'_>], palette: &Palette<'_>) -> Markup {
    let positions: Vec<[f64; 3]> = things.iter().map(|thing| thing.position.metres()).collect();
    let radii: Vec<f64> = things.iter().map(PlacedThing::radius).collect();
    let layout = layout(&positions, &radii);
    let mut rooms = rooms(things, &layout);
    let labels = named(things, &layout, &radii, &rooms);
    widen(&mut rooms, things, &labels, &layout);
    html! {
        svg.plan xmlns="http://www.w3.org/2000/svg" viewBox=(sheet(&layout)) role="group"
            aria-label=(format!("{title} Every thing is a link to what is known of it.")) {
            @for room in &rooms { (room.outline()) }
            @for room in &rooms { (room.name()) }
            @for (place, mark) in layout.places.iter().zip(&layout.marks) {
                @if (place.x - mark.x).hypot(place.y - mark.y) > 1.0 {
                    line.stem x1=(unit(place.x)) y1=(unit(place.y)) x2=(unit(mark.x)) y2=(unit(mark.y)) {}
                    circle.foot cx=(unit(place.x)) cy=(unit(place.y)) r="1.6" {}
                }
            }
            @for (thing, (&mark, label)) in things.iter().zip(layout.marks.iter().zip(&labels)) {
                (linked(thing, mark, label.as_ref(), palette))
            }
        }
    }
}

/// The names of things, where there is room for them.
fn named(
    things: &[PlacedThing<'_>],
    layout: &Layout,
    radii: &[f64],
    rooms: &[Room<'_>],
) -> Vec<Option<Label>> {
    let marks: Vec<Nameless<'_>> = things
        .iter()
        .zip(layout.marks.iter().zip(radii))
        .map(|(thing, (&at, &radius))| {
            let room = rooms.iter().position(|room| Some(room.room) == thing.room);
            Nameless { at, radius, name: thing.class, room }
        })
        .collect();
    let bounds: Vec<Area> = rooms.iter().map(|room| room.bounds).collect();
    labels(&marks, &bounds, layout, rooms.iter().map(Room::name_area).collect())
}

/// Widens rooms to the names of their things, except into other rooms.
fn widen(rooms: &mut [Room<'_>], things: &[PlacedThing<'_>], labels: &[Option<Label>], layout: &Layout) {
    for place in 0..rooms.len() {
        let room = rooms[place].room;
        let of_room = things.iter().zip(labels).filter(|(thing, _)| thing.room == Some(room));
        for area in of_room.filter_map(|(_, label)| Some(label.as_ref()?.area.padded(4.0))) {
            let wider = rooms[place].bounds.with(area);
            let free = layout.sheet().contains(&wider)
                && rooms.iter().enumerate().all(|(other, room)| other == place || !room.bounds.meets(&wider));
            if free {
                rooms[place].bounds = wider;
            }
        }
    }
}

/// A plan on which no mark is a link and none is moved, for a home of so many things that each room has a plan of its own.
/// `links` says where that is.
pub fn overview(things: &[PlacedThing<'_>], links: &BTreeMap<&str, String>, palette: &Palette<'_>) -> Markup {
    let positions: Vec<[f64; 3]> = things.iter().map(|thing| thing.position.metres()).collect();
    let layout = at_their_places(&positions, 1.0);
    let rooms = rooms(things, &layout);
    html! {
        svg.plan.overview xmlns="http://www.w3.org/2000/svg" viewBox=(sheet(&layout)) role="group"
            aria-label="Plan of the whole home. Every room is a link to its own plan." {
            @for room in &rooms { (room.outline()) }
            @for (thing, &place) in things.iter().zip(&layout.places) {
                @if let Some(state) = thing.states.last() {
                    (palette.disc(place, OVERVIEW * radius(state.doubt), state.owners))
                }
            }
            @for room in &rooms {
                @match links.get(room.room) {
                    Some(link) => { a href=(format!("#{link}")) aria-label=(room.room) { (room.name()) } }
                    None => { (room.name()) }
                }
            }
        }
    }
}

fn sheet(layout: &Layout) -> String {
    format!("0 0 {} {}", unit(layout.width), unit(layout.height))
}

fn linked(thing: &PlacedThing<'_>, mark: Spot, label: Option<&Label>, palette: &Palette<'_>) -> Markup {
    let last = thing.states.len().saturating_sub(1);
    let name = name_and_room(thing.class, thing.room);
    let said = thing.states.last().map_or("", |state| state.said.as_str());
    // What never changes needs no account of when it was so.
    let changes = thing.states.iter().any(|state| state.to > 0);
    html! {
        a.thing href=(format!("#{}", thing.link)) id=(mark_id(&thing.link)) aria-label=(format!("{name}: {said}"))
            data-name=[changes.then_some(&name)] {
            title { (name) ": " (thing.hint) }
            @for &step in &thing.asked {
                circle.asked.past data-from=(step) data-to=(step) cx=(unit(mark.x)) cy=(unit(mark.y))
                    r=(unit(LARGEST + 4.0)) fill="none" {}
            }
            @for (place, state) in thing.states.iter().enumerate() {
                @let drawn = palette.mark(mark, radius(state.doubt), state.owners);
                @if changes {
                    g.past[place != last] data-from=(state.from) data-to=(state.to) data-said=(state.said) { (drawn) }
                } @else { (drawn) }
            }
            @if let Some(label) = label {
                text.name x=(unit(label.at.x)) y=(unit(label.at.y)) text-anchor=(label.anchor) aria-hidden="true" {
                    (label.text)
                }
            }
        }
    }
}

/// The outline of a room: a box around the things that are in it, wide enough for its name.
struct Room<'a> {
    room: &'a str,
    shown_name: String,
    name_start: Spot,
    bounds: Area,
}

impl Room<'_> {
    fn outline(&self) -> Markup {
        let Area { left, top, right, bottom } = self.bounds;
        html! {
            rect.room x=(unit(left)) y=(unit(top)) width=(unit((right - left).max(0.0)))
                height=(unit((bottom - top).max(0.0))) rx="8" {}
        }
    }

    fn name_area(&self) -> Area {
        Area::of_room_name(self.name_start, &self.shown_name)
    }

    fn name(&self) -> Markup {
        let Spot { x, y } = self.name_start;
        html! { text.room-name x=(unit(x)) y=(unit(y)) aria-hidden="true" { (self.shown_name) } }
    }
}

/// The rooms, by name.
fn rooms<'a>(things: &[PlacedThing<'a>], layout: &Layout) -> Vec<Room<'a>> {
    let mut boxes: BTreeMap<&'a str, Area> = BTreeMap::new();
    for (place, thing) in things.iter().enumerate() {
        let Some(room) = thing.room else { continue };
        for spot in [layout.places[place], layout.marks[place]] {
            let around = Area::around(spot, SMALLEST + 8.0);
            // The name stands above the things.
            let around = Area { top: around.top - 16.0, ..around };
            let bounds = boxes.entry(room).or_insert(around);
            *bounds = bounds.with(around);
        }
    }
    boxes
        .into_iter()
        .map(|(room, Area { left, top, right, bottom })| {
            let shown_name = shortened(room, LONGEST_ROOM_NAME);
            let missing = (room_name_width(&shown_name) + 16.0 - (right - left)).max(0.0) / 2.0;
            let bounds = Area {
                left: (left - missing).max(1.0),
                top: top.max(1.0),
                right: (right + missing).min(layout.width - 1.0),
                bottom: bottom.min(layout.height - 1.0),
            };
            let name_start = Spot { x: bounds.left + 8.0, y: bounds.top + 15.0 };
            Room { room, shown_name, name_start, bounds }
        })
        .collect()
}

/// Who lives there and in which colour, and how to read the sizes.
pub fn legend(users: &Users, palette: &Palette<'_>) -> Markup {
    let member = |name: &UserName| Owners::from([name.clone()]);
    let doubts = [(0.0, "sure"), (0.5, "half sure"), (1.0, "no idea")];
    html! {
        ul.legend aria-label="Who lives here, and how to read the marks" {
            @for (name, background) in users { li { (palette.swatch(&member(name))) (name) (in_brackets(background)) } }
            @if users.len() > 1 {
                li { (palette.swatch(&users.keys().take(2).cloned().collect())) "shared" }
            }
            li { (palette.swatch(&Owners::new())) "somebody outside" }
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
}

fn in_brackets(background: &Background) -> String {
    let parts: Vec<&str> =
        [&background.role, &background.occupation].into_iter().flatten().map(String::as_str).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join(", ")) }
}
