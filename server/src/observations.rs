//! From observations, as a robot hands them in, to the views that the map takes in, and back to what became of them.

use std::collections::HashMap;
use std::sync::LazyLock;

use coin::map::detection::{Detection, Refusal, Region, View, ViewId};
use coin_schemas::household::{ClassLabel, MAX_NAME_BYTES, Position};
use coin_schemas::tools::{
    MovedObject, Observation, ObserveObjectsResult, PerhapsMoved, RejectedObservation, SeenObject, SeenView,
};
use jiff::civil::DateTime;
use jiff::{ToSpan, Zoned};
use rmcp::model::JsonObject;
use serde_json::Value;

use crate::scene::four_decimals;
use crate::store::{Observed, Store, StoreError, ViewInRooms};
use crate::tools::{argument_schema, quoted, read_item};

/// How far a robot's clock may be ahead of ours, in minutes.
const LEEWAY: i64 = 5;

static OBSERVATION: LazyLock<JsonObject> = LazyLock::new(argument_schema::<Observation>);

/// Observations that are taken in together.
pub(crate) struct Batch {
    /// When the batch was begun, by the clock of this computer.
    now: DateTime,
    views: Vec<IndexedView>,
    by_name: HashMap<String, usize>,
    rejected: Vec<RejectedObservation>,
}

/// A view, and where in the call each of its detections stood.
struct IndexedView {
    view: ViewInRooms,
    indexes: Vec<u64>,
}

impl Batch {
    /// A batch with nothing in it.
    pub(crate) fn new() -> Self {
        Self {
            now: Zoned::now().datetime(),
            views: Vec::new(),
            by_name: HashMap::new(),
            rejected: Vec::new(),
        }
    }

    /// How many observations there are, those that were rejected included.
    pub(crate) fn len(&self) -> usize {
        self.views.iter().map(|view| view.indexes.len()).sum::<usize>() + self.rejected.len()
    }

    /// Adds an observation that was not read yet.
    pub(crate) fn add_value(&mut self, index: u64, observation: &Value) {
        match read_item(&OBSERVATION, observation) {
            Ok(observation) => self.add(index, observation),
            Err(reason) => self.reject(index, reason),
        }
    }

    /// Adds an observation.
    pub(crate) fn add(&mut self, index: u64, observation: Observation) {
        match self.detection(observation) {
            Ok((detection, view, room)) => {
                let place = self.view_of(view, detection.at);
                let IndexedView { view, indexes } = &mut self.views[place];
                view.view.detections.push(detection);
                view.rooms.push(room);
                indexes.push(index);
            }
            Err(reason) => self.reject(index, reason),
        }
    }

    /// Notes that an observation was refused.
    pub(crate) fn reject(&mut self, index: u64, reason: String) {
        self.rejected.push(RejectedObservation { index, reason });
    }

    /// Adds what a view had in sight.
    ///
    /// # Errors
    /// What is wrong with it, with the field.
    pub(crate) fn add_view(&mut self, seen: &SeenView) -> Result<(), String> {
        let name = name("view", &seen.view)?;
        let corner = |field: &str, metres: [f64; 3]| {
            Position::new(metres).map_err(|source| format!("{field}: {source}"))
        };
        let region =
            Region { least: corner("least", seen.least)?, greatest: corner("greatest", seen.greatest)? };
        if (0..3).any(|axis| seen.least[axis] > seen.greatest[axis]) {
            return Err(format!("least: {:?} is beyond greatest, {:?}", seen.least, seen.greatest));
        }
        let taken_at = seen.seen_at.as_deref().map(|text| self.time(text)).transpose()?;
        let place = match (self.by_name.get(name), taken_at) {
            (Some(place), _) => *place,
            (None, Some(at)) => self.view_of(Some(name.to_owned()), at),
            (None, None) => {
                return Err(format!(
                    "seen_at: it is missing, and no observation is of the view {}",
                    quoted(name)
                ));
            }
        };
        let view = &mut self.views[place].view.view;
        view.taken_at = taken_at.map_or(view.taken_at, |at| at.max(view.taken_at));
        view.covered.push(region);
        Ok(())
    }

    /// Has the map take everything in.
    ///
    /// # Errors
    /// Failures of the database; then nothing was taken in.
    pub(crate) fn observe(mut self, store: &Store) -> Result<ObserveObjectsResult, StoreError> {
        // What was seen first is taken in first, because what is missing or was moved is told by the order of time.
        self.views.sort_by_key(|view| view.view.view.taken_at);
        let (views, indexes): (Vec<ViewInRooms>, Vec<Vec<u64>>) =
            self.views.into_iter().map(|view| (view.view, view.indexes)).unzip();
        let observations = store.observe(&views)?;
        let mut rejected = self.rejected;
        let mut results = Vec::new();
        let outcomes = observations.detections.into_iter().zip(indexes);
        for (observed, index) in outcomes.flat_map(|(observed, indexes)| observed.into_iter().zip(indexes)) {
            match observed {
                Observed::Taken { object, is_new, divergence, views } => results.push(SeenObject {
                    index,
                    object_id: object,
                    new: is_new,
                    divergence: divergence.map(four_decimals),
                    views: views as u64,
                }),
                Observed::Refused(refusal) => {
                    rejected.push(RejectedObservation { index, reason: reason(&refusal) });
                }
                Observed::Repeated { object } => rejected.push(RejectedObservation {
                    index,
                    reason: format!("it was taken in before, as a sighting of {:?}", object.as_str()),
                }),
            }
        }
        results.sort_by_key(|seen| seen.index);
        rejected.sort_by_key(|rejected| rejected.index);
        let moved = observations.moved.into_iter().map(|moved| {
            Ok(MovedObject {
                object_id: moved.object,
                from: rounded(moved.from)?,
                to: rounded(moved.to)?,
                at: moved.at,
            })
        });
        let perhaps = observations.perhaps_moved.into_iter();
        Ok(ObserveObjectsResult {
            results,
            rejected,
            moved: moved.collect::<Result<_, StoreError>>()?,
            perhaps_moved: perhaps
                .map(|perhaps| PerhapsMoved { object_id: perhaps.object, candidates: perhaps.candidates })
                .collect(),
        })
    }

    fn detection(
        &self,
        observation: Observation,
    ) -> Result<(Detection, Option<String>, Option<String>), String> {
        let Observation { class, position, radius, embedding, seen_at, view, room } = observation;
        let class = ClassLabel::new(class.trim()).map_err(|source| format!("class: {source}"))?;
        let view = view.map(|view| name("view", &view).map(str::to_owned)).transpose()?;
        let room = room.map(|room| name("room", &room).map(str::to_owned)).transpose()?;
        let at = self.time(&seen_at)?;
        Ok((Detection { class, position, radius, at, feature: embedding }, view, room))
    }

    fn time(&self, text: &str) -> Result<DateTime, String> {
        let at: DateTime = text.trim().parse().map_err(|_| {
            format!(
                "seen_at: {} is no local time that exists; give one without a time zone, such as 2025-01-19T19:00:00",
                quoted(text)
            )
        })?;
        if at > self.now.saturating_add(LEEWAY.minutes()) {
            let now = self.now.strftime("%Y-%m-%dT%H:%M:%S");
            return Err(format!("seen_at: {at} is in the future; here it is {now}"));
        }
        // The database keeps milliseconds.
        let milliseconds = at.subsec_nanosecond() / 1_000_000;
        at.with()
            .subsec_nanosecond(milliseconds * 1_000_000)
            .build()
            .map_err(|source| format!("seen_at: {source}"))
    }

    /// The view of this name, or one of its own for what is of no view.
    fn view_of(&mut self, name: Option<String>, at: DateTime) -> usize {
        if let Some(&place) = name.as_deref().and_then(|name| self.by_name.get(name)) {
            let view = &mut self.views[place].view.view;
            view.taken_at = view.taken_at.max(at);
            return place;
        }
        let place = self.views.len();
        if let Some(name) = &name {
            self.by_name.insert(name.clone(), place);
        }
        let view = View { id: name.map(ViewId), taken_at: at, covered: Vec::new(), detections: Vec::new() };
        self.views.push(IndexedView { view: ViewInRooms { view, rooms: Vec::new() }, indexes: Vec::new() });
        place
    }
}

/// A name that people can read and that fits into a line.
fn name<'a>(field: &str, given: &'a str) -> Result<&'a str, String> {
    let trimmed = given.trim();
    if trimmed.is_empty() {
        Err(format!("{field}: it is empty; leave it out where there is none"))
    } else if trimmed.len() > MAX_NAME_BYTES {
        Err(format!("{field}: it has {} bytes; at most {MAX_NAME_BYTES} are allowed", trimmed.len()))
    } else if trimmed.contains(char::is_control) {
        Err(format!("{field}: it holds a control character"))
    } else {
        Ok(trimmed)
    }
}

/// What is wrong with a detection, with the field as the robot knows it.
fn reason(refusal: &Refusal) -> String {
    let field = match refusal {
        Refusal::Position { .. } => "position",
        Refusal::Radius { .. } => "radius",
        Refusal::Dimension { .. } | Refusal::Feature => "embedding",
        Refusal::Future { .. } => "seen_at",
    };
    format!("{field}: {refusal}")
}

fn rounded(metres: [f64; 3]) -> Result<Position, StoreError> {
    Ok(Position::new(metres.map(four_decimals))?)
}
