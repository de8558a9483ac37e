//! The map as a page. A home of so many things that one plan would be too crowded has a plan for each room, and an
//! overview above them.

use std::collections::BTreeMap;

use coin_schemas::household::Owners;
use coin_schemas::map::{HomeMap, MappedObject};
use maud::{Markup, html};

use super::{Counts, basis, percent, place, said, whose};
use crate::display::count;
use crate::pages::plan::{
    self, MarkState, Palette, PlacedThing, is_crowded, legend, mark_id, overview, plan,
};

const STYLE: &str = include_str!("map.css");

/// What the things that are in no room stand under.
const NO_ROOM: &str = "In no room";

/// The page, whole.
pub(crate) fn page(map: &HomeMap) -> String {
    let palette = Palette::new(map.users.keys());
    let household: Owners = map.users.keys().cloned().collect();
    let placed: Vec<PlacedThing<'_>> =
        map.objects.iter().enumerate().map(|(place, object)| placed(place, object, &household)).collect();
    let things = Things { map, placed: &placed, palette: &palette, household: &household };
    let title = match &map.name {
        Some(name) => format!("Whose is what? {name}"),
        None => "Whose is what?".to_owned(),
    };
    let counts = Counts::of(&map.objects);
    let body = html! {
        main {
            header {
                h1 { (title) }
                p.lead { (counts.in_words()) }
                p.quiet { "As of " (map.as_of.strftime("%Y-%m-%d %H:%M")) ", in the home's own time." }
            }
            section #plan {
                h2 { "Plan" }
                p.quiet {
                    "Every thing at its place, in the colours of its owners; the larger, the more doubt. A mark leads to \
                     the thing's line in the table, and the thing's name there leads back."
                }
                (legend(&map.users, &palette))
                @if is_crowded(&placed) { (things.by_room()) } @else { (things.together()) }
            }
        }
    };
    crate::pages::page(&title, &[plan::STYLE, STYLE], None, &body)
}

/// The id of the line that describes the thing at a place in the map.
fn anchor(place: usize) -> String {
    format!("thing-{place}")
}

fn placed<'a>(place: usize, object: &'a MappedObject, household: &Owners) -> PlacedThing<'a> {
    let said = said(object, household);
    PlacedThing {
        class: object.class.as_str(),
        room: object.room.as_deref(),
        position: object.position,
        link: anchor(place),
        hint: format!("{said} ({})", basis(object)),
        states: vec![MarkState {
            from: 0,
            to: 0,
            owners: &object.owners,
            doubt: 1.0 - object.confidence,
            said,
        }],
        asked: Vec::new(),
    }
}

/// The things of a map and what is drawn of them.
struct Things<'a> {
    map: &'a HomeMap,
    placed: &'a [PlacedThing<'a>],
    palette: &'a Palette<'a>,
    household: &'a Owners,
}

impl Things<'_> {
    /// One plan and one table.
    fn together(&self) -> Markup {
        html! {
            div.drawing { (plan("Plan of the home.", self.placed, self.palette)) }
            h2 { "Things" }
            (self.table("Things", 0, &self.map.objects))
        }
    }

    /// An overview, and a plan and a table for each room. The things of a room follow each other.
    fn by_room(&self) -> Markup {
        let mut first = 0;
        let rooms: Vec<(usize, &[MappedObject])> = self
            .map
            .objects
            .chunk_by(|left, right| left.room == right.room)
            .map(|things| {
                let start = first;
                first += things.len();
                (start, things)
            })
            .collect();
        let link = |number: usize| format!("room-{number}");
        let links: BTreeMap<&str, String> = rooms
            .iter()
            .enumerate()
            .filter_map(|(number, (_, things))| Some((things.first()?.room.as_deref()?, link(number))))
            .collect();
        html! {
            div.drawing { (overview(self.placed, &links, self.palette)) }
            nav aria-label="Rooms" {
                ul {
                    @for (number, (_, things)) in rooms.iter().enumerate() {
                        li { a href=(format!("#{}", link(number))) { (room_name(things)) } " (" (things.len()) ")" }
                    }
                }
            }
            @for (number, &(first, things)) in rooms.iter().enumerate() {
                @let name = room_name(things);
                section.of-room id=(link(number)) {
                    h2 { (name) }
                    p.quiet { (Counts::of(things).in_words()) }
                    div.drawing {
                        (plan(&format!("Plan: {name}."), &self.placed[first..first + things.len()], self.palette))
                    }
                    details open {
                        summary { (count(things.len() as u64, "thing", "things")) }
                        (self.table(name, first, things))
                    }
                }
            }
        }
    }

    fn table(&self, label: &str, first: usize, things: &[MappedObject]) -> Markup {
        html! {
            // A box that scrolls must be reachable by keyboard.
            div.scroll role="region" aria-label=(label) tabindex="0" {
                table.things {
                    thead { tr {
                        th scope="col" { "Thing" } th scope="col" { "Id" } th scope="col" { "Room" }
                        th scope="col" { "Place (m)" } th scope="col" { "Owners" } th scope="col" { "Sure" }
                        th scope="col" { "From" }
                    } }
                    tbody {
                        @for (thing, number) in things.iter().zip(first..) { (self.row(thing, &anchor(number))) }
                    }
                }
            }
        }
    }

    fn row(&self, object: &MappedObject, id: &str) -> Markup {
        html! {
            tr id=(id) {
                th scope="row" { a href=(format!("#{}", mark_id(id))) { (object.class) } }
                td { (object.id) }
                td { (object.room.as_deref().unwrap_or("–")) }
                td { (place(object)) }
                td { (self.palette.swatch(&object.owners)) " " (whose(object, self.household)) }
                td { (percent(object.confidence)) }
                td { (basis(object)) }
            }
        }
    }
}

fn room_name(things: &[MappedObject]) -> &str {
    things.first().and_then(|thing| thing.room.as_deref()).unwrap_or(NO_ROOM)
}
