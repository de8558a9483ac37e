//! The map: what it promises, on small homes made by hand, and how it does on simulated tours.

mod association;
mod fusion;
mod judged;
mod moving;
mod remembering;
mod splitting;
mod throughput;

use std::collections::BTreeSet;

use coin_schemas::household::{ClassLabel, Position};
use jiff::SignedDuration;
use jiff::civil::{DateTime, date};

use super::detection::{Detection, Region, View, ViewId};
use super::entry::{Entry, EntryId, SightingId};
use super::parameters::MapParameters;
use super::{MapState, Outcome, SemanticMap};

const CUP: f64 = 0.045;

/// A map of features with four numbers, so that a test can write them down.
fn map() -> SemanticMap {
    SemanticMap::new(MapState::default(), MapParameters { dimension: 4, ..MapParameters::default() })
}

fn clock(minutes: i64) -> DateTime {
    date(2025, 3, 1).at(9, 0, 0, 0).checked_add(SignedDuration::from_mins(minutes)).unwrap()
}

fn class(name: &str) -> ClassLabel {
    ClassLabel::new(name).unwrap()
}

/// A cup of unknown look, seen at the beginning.
fn cup(position: [f64; 3]) -> Detection {
    Detection { class: class("cup"), position, radius: CUP, at: clock(0), feature: None }
}

fn looking(detection: Detection, feature: [f32; 4]) -> Detection {
    Detection { feature: Some(feature.to_vec()), ..detection }
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 0.0];
const BLUE: [f32; 4] = [0.6, 0.8, 0.0, 0.0];

fn red_cup(x: f64) -> Detection {
    looking(cup([x, 0.0, 0.0]), RED)
}

/// A view of that minute, which covers nothing but what it shows.
fn view(minute: i64, detections: Vec<Detection>) -> View {
    let detections =
        detections.into_iter().map(|detection| Detection { at: clock(minute), ..detection }).collect();
    View { id: Some(ViewId(format!("at {minute}"))), taken_at: clock(minute), covered: vec![], detections }
}

/// A view that covers everything from one x to another.
fn covering(view: View, from: f64, to: f64) -> View {
    let corner = |x: f64, other: f64| Position::new([x, other, other]).unwrap();
    View { covered: vec![Region { least: corner(from, -2.0), greatest: corner(to, 2.0) }], ..view }
}

fn ids(outcomes: &[Outcome]) -> Vec<Option<u64>> {
    outcomes.iter().map(|outcome| outcome.entry().map(|id| id.0)).collect()
}

fn entry(map: &SemanticMap, id: u64) -> &Entry {
    &map.state().entries[&EntryId(id)]
}

fn all_ids(map: &SemanticMap) -> Vec<u64> {
    map.state().entries.keys().map(|id| id.0).collect()
}

fn sightings(numbers: &[u64]) -> BTreeSet<SightingId> {
    numbers.iter().copied().map(SightingId).collect()
}
