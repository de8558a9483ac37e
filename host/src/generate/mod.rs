//! Households of our own making, for calibration, for trials and for the examples.
//!
//! A home is drawn from a seed in the order in which it would come about: people with roles, occupations and
//! hobbies; what they own and share; a week plan for everybody; sessions, in which the paper's Appendix D says
//! who uses a thing and that person's plan says when; what a camera saw of them; the words for it. Things get
//! places in the home and synthetic features that carry some sign of class and owner.
//!
//! [`Protocol`] names the kinds of home, [`RoutineParameters`] is all that tells them apart. [`generate`] is
//! pure: the same protocol and seed give the same episode on every platform. Nothing is read from other data;
//! [`generate_homer`] draws a home that lives by a data set instead.

mod arguments;
mod belongings;
mod catalogue;
mod features;
mod floor_plan;
pub mod homer;
mod paper;
mod parameters;
mod people;
mod plan;
mod random;
mod sessions;
mod sightings;
#[cfg(test)]
mod tests;
mod wording;
mod write;

use std::collections::{BTreeMap, BTreeSet};

use jiff::ToSpan;
use jiff::civil::{Date, DateTime, Weekday, date};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use coin_schemas::episode::{CaptionLine, Episode, EpisodeObject, Truth};
use coin_schemas::household::{Background, ClassLabel, InvalidValue, ObjectId, Position, UserName};
use coin_schemas::tools::display_name;

pub use arguments::{GenerateArguments, HomerArguments, HomesArguments, run, run_homer};
pub use features::Feature;
pub use parameters::{FirstDay, PeopleTemplate, Protocol, RoutineParameters, Structure};
pub use write::{WriteError, write};

use belongings::Belonging;
use floor_plan::{FloorPlan, Placement};
use people::Person;
use plan::DayKind;
use random::{Stream, between, stream};
use sessions::ThingHistory;
use sightings::{FailureReach, Fate, Sighting};

/// Which home to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RoutineSettings {
    /// The seed; unrelated homes under two protocols.
    pub seed: u64,
    /// The kind of home.
    pub protocol: Protocol,
}

/// An episode before it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneratedEpisode {
    /// The home.
    pub episode: Episode,
    /// What was seen, in order of time.
    pub captions: Vec<CaptionLine>,
    /// The synthetic visual features, in the order of the objects.
    pub features: Vec<Feature>,
    /// Who owns what, and how it is used.
    pub truth: Truth,
}

/// What one home keeps to, drawn once from the ranges of its protocol.
struct Habits {
    first_day: Date,
    busyness: f64,
    role_fit: f64,
    cohesion: f64,
    reach: FailureReach,
}

impl Habits {
    fn draw(parameters: &RoutineParameters, generator: &mut ChaCha8Rng) -> Self {
        let drawn_day = date(2025, 1, 1).saturating_add(generator.random_range(0..350).days());
        Self {
            first_day: match parameters.first_day {
                FirstDay::Fixed { year, month, day } => Date::new(year, month, day).unwrap_or(drawn_day),
                FirstDay::Drawn => drawn_day,
            },
            busyness: between(&parameters.busyness, generator),
            role_fit: between(&parameters.role_fit, generator),
            cohesion: between(&parameters.cohesion, generator),
            reach: match generator.random_bool(0.5) {
                true => FailureReach::Session,
                false => FailureReach::Caption,
            },
        }
    }
}

/// Who shares the place in which days, before anything happens there.
struct Household<'a> {
    kind: String,
    seed: u64,
    parameters: &'a RoutineParameters,
    habits: Habits,
    people: Vec<Person>,
    days: Vec<DayKind>,
}

impl<'a> Household<'a> {
    fn draw(settings: &RoutineSettings, parameters: &'a RoutineParameters, routines: Routines) -> Self {
        let kind = routines.kind(settings.protocol);
        let habits = Habits::draw(parameters, &mut stream(&kind, settings.seed, Stream::Habits));
        let people = people::draw(parameters.people, &mut stream(&kind, settings.seed, Stream::People));
        let days = (0..parameters.days).map(|day| day_kind(nth_day(habits.first_day, day.into()))).collect();
        Self { kind, seed: settings.seed, parameters, habits, people, days }
    }

    /// The random numbers of one concern of this home.
    fn random(&self, concern: Stream) -> ChaCha8Rng {
        stream(&self.kind, self.seed, concern)
    }
}

/// What there is in a home and what is done with each thing, in the same order.
struct Life {
    belongings: Vec<Belonging>,
    histories: Vec<ThingHistory>,
}

/// A home with all that happened there, the words and the pictures still missing.
struct Story {
    people: Vec<Person>,
    belongings: Vec<Belonging>,
    placements: Vec<Placement>,
    /// What was done with each thing, and what was seen of it.
    sightings: Vec<Vec<Sighting>>,
    first_day: Date,
}

/// Where the life of a home comes from.
#[derive(Debug, Clone, Copy)]
enum Routines {
    /// Our own catalogue and week plans.
    Own,
    /// Schedules and scripts of the HOMER data set.
    Homer,
}

impl Routines {
    /// The name of the kind of home with these routines.
    fn kind(self, protocol: Protocol) -> String {
        match self {
            Self::Own => protocol.name().to_owned(),
            Self::Homer => format!("homer-{}", protocol.name()),
        }
    }
}

impl Story {
    /// Watches the life of a household and finds its things a place.
    fn of(household: Household<'_>, life: Life) -> Self {
        let (parameters, habits) = (household.parameters, &household.habits);
        let generator = &mut household.random(Stream::Sightings);
        let members = household.people.len();
        let sightings = life
            .histories
            .iter()
            .map(|history| sightings::watch(&history.sessions, members, parameters, habits.reach, generator))
            .collect();

        let generator = &mut household.random(Stream::Floor);
        let floor = FloorPlan::draw(parameters.people, &household.people, generator);
        let placements = life
            .belongings
            .iter()
            .map(|belonging| floor.place(belonging, habits.cohesion, generator))
            .collect();
        Self {
            first_day: habits.first_day,
            people: household.people,
            belongings: life.belongings,
            placements,
            sightings,
        }
    }

    /// Puts what was seen into words, in order of time. A line that is there already is the same sighting.
    fn captions(&self, paraphrased: f64, generator: &mut ChaCha8Rng) -> Vec<CaptionLine> {
        let mut lines: Vec<(DateTime, usize, String)> = Vec::new();
        for (place, (belonging, sightings)) in self.belongings.iter().zip(&self.sightings).enumerate() {
            let display_name = display_name(&class_label(belonging));
            let mut seen: BTreeSet<String> = BTreeSet::new();
            for sighting in sightings {
                let seen_actor = match sighting.fate {
                    Fate::Missed => continue,
                    Fate::Seen => Some(sighting.actor),
                    Fate::TakenFor(other) => Some(other),
                    Fate::Unattributed => None,
                };
                let scene = wording::Scene {
                    people: &self.people,
                    seen: seen_actor,
                    thing: belonging.thing,
                    display_name: &display_name,
                    action: sighting.action,
                };
                let text = match generator.random_bool(paraphrased) {
                    true => scene.paraphrase(generator),
                    false => scene.plain(),
                };
                let minute = i64::from(sighting.minute);
                let time =
                    nth_day(self.first_day, sighting.day).at(0, 0, 0, 0).saturating_add(minute.minutes());
                let caption = wording::caption(time, &text);
                if seen.insert(caption.clone()) {
                    lines.push((time, place, caption));
                }
            }
        }
        lines.sort_by_key(|&(time, place, _)| (time, place));
        lines
            .into_iter()
            .map(|(_, place, caption)| CaptionLine { object_id: object_id(place), caption })
            .collect()
    }

    fn truth(&self) -> Truth {
        let by_id = |place| (object_id(place), &self.belongings[place]);
        let things = || (0..self.belongings.len()).map(by_id);
        let owners = things().map(|(id, belonging)| {
            (id, belonging.owners.iter().map(|&owner| user_name(&self.people[owner])).collect())
        });
        let usage_type = things().map(|(id, belonging)| (id, belonging.usage_type));
        Truth { owners: owners.collect(), usage_type: Some(usage_type.collect()) }
    }

    fn objects(&self) -> Vec<EpisodeObject> {
        self.belongings
            .iter()
            .zip(&self.placements)
            .enumerate()
            .map(|(place, (belonging, placement))| EpisodeObject {
                id: object_id(place),
                class: class_label(belonging),
                position: valid(Position::new(placement.position)),
                room: Some(placement.room.clone()),
            })
            .collect()
    }

    fn users(&self) -> BTreeMap<UserName, Background> {
        self.people
            .iter()
            .map(|person| {
                let background = Background {
                    role: Some(person.role.to_owned()),
                    occupation: Some(person.occupation.to_owned()),
                };
                (user_name(person), background)
            })
            .collect()
    }
}

/// What there is in a home with our own routines, and what happens to it.
fn own_life(household: &Household<'_>) -> Life {
    let Household { parameters, habits, people, days, .. } = household;
    let mut belongings =
        belongings::draw(people, parameters, habits.role_fit, &mut household.random(Stream::Belongings));
    belongings::hand_down(
        &mut belongings,
        parameters.handed_down,
        days.len(),
        &mut household.random(Stream::HandDowns),
    );
    let plans = plan::week(people, days, &mut household.random(Stream::Plans));
    let count = |belonging: &Belonging, generator: &mut ChaCha8Rng| {
        sessions::session_count(belonging.thing, habits.busyness, days.len(), &parameters.sessions, generator)
    };
    let generator = &mut household.random(Stream::Sessions);
    let histories: Vec<ThingHistory> = match parameters.structure {
        Structure::Paper => paper::histories(&belongings, &plans, count, generator),
        Structure::Drawn => belongings
            .iter()
            .map(|belonging| {
                let sessions = count(belonging, generator);
                let lengths = sessions::session_lengths(sessions, generator);
                sessions::live(belonging, &lengths, &plans, generator)
            })
            .collect(),
    };
    Life { belongings, histories }
}

fn own_story(settings: &RoutineSettings, parameters: &RoutineParameters) -> Story {
    let household = Household::draw(settings, parameters, Routines::Own);
    let life = own_life(&household);
    Story::of(household, life)
}

fn homer_story(
    settings: &RoutineSettings,
    parameters: &RoutineParameters,
    data: &homer::HomerData,
) -> Result<Story, homer::HomerError> {
    let household = Household::draw(settings, parameters, Routines::Homer);
    let life = homer::life(data, &household)?;
    Ok(Story::of(household, life))
}

/// Draws a home with our own routines. Equal settings give equal episodes.
pub fn generate(settings: &RoutineSettings) -> GeneratedEpisode {
    let parameters = settings.protocol.parameters();
    told(settings, &parameters, Routines::Own, &own_story(settings, &parameters))
}

/// Draws a home that lives by schedules sampled from HOMER. Equal settings and data give equal episodes.
///
/// # Errors
/// If the protocol is one of a place that HOMER has no data of, or the data are too few for it.
pub fn generate_homer(
    settings: &RoutineSettings,
    data: &homer::HomerData,
) -> Result<GeneratedEpisode, homer::HomerError> {
    if settings.protocol == Protocol::Office {
        return Err(homer::HomerError::NoSuchPlace);
    }
    let parameters = settings.protocol.parameters();
    let story = homer_story(settings, &parameters, data)?;
    Ok(told(settings, &parameters, Routines::Homer, &story))
}

/// Puts a story into words and pictures.
fn told(
    settings: &RoutineSettings,
    parameters: &RoutineParameters,
    routines: Routines,
    story: &Story,
) -> GeneratedEpisode {
    let kind = routines.kind(settings.protocol);
    let random = |concern| stream(&kind, settings.seed, concern);
    let captions = story.captions(parameters.paraphrased, &mut random(Stream::Words));
    let features = features::draw(&story.belongings, &mut random(Stream::Features));
    let last_day = nth_day(story.first_day, usize::from(parameters.days).saturating_sub(1));
    let (maker, licence) = match routines {
        Routines::Own => ("routine generator", ""),
        Routines::Homer => ("HOMER generator", homer::LICENCE_NOTE),
    };
    let episode = Episode {
        name: format!("{kind}-{}", settings.seed),
        description: Some(format!(
            "{} things of {} people over {} days, drawn by the {maker} (protocol {}, seed {}). The \
             visual features are synthetic: they carry a sign of class and owner set and come from no camera.{licence}",
            story.belongings.len(),
            story.people.len(),
            parameters.days,
            settings.protocol.name(),
            settings.seed,
        )),
        users: story.users(),
        objects: story.objects(),
        captions: write::CAPTIONS_FILE.to_owned(),
        embeddings: Some(write::EMBEDDINGS_FILE.to_owned()),
        truth: Some(write::TRUTH_FILE.to_owned()),
        now: last_day.at(23, 0, 0, 0),
        train_until: (usize::from(parameters.days) > TRAINING_DAYS)
            .then(|| nth_day(story.first_day, TRAINING_DAYS).at(0, 0, 0, 0)),
    };
    GeneratedEpisode { episode, captions, features, truth: story.truth() }
}

/// The days of the first part of the history, where it is split in time (the paper's Appendix D).
const TRAINING_DAYS: usize = 3;

fn nth_day(first: Date, day: usize) -> Date {
    first.saturating_add(i64::try_from(day).unwrap_or(i64::MAX).min(10_000).days())
}

fn day_kind(day: Date) -> DayKind {
    match day.weekday() {
        Weekday::Saturday | Weekday::Sunday => DayKind::Weekend,
        _ => DayKind::Weekday,
    }
}

fn object_id(place: usize) -> ObjectId {
    valid(ObjectId::new((place + 1).to_string()))
}

fn user_name(person: &Person) -> UserName {
    valid(UserName::new(person.name))
}

fn class_label(belonging: &Belonging) -> ClassLabel {
    valid(ClassLabel::new(belonging.thing.class))
}

/// Unwraps what is valid by construction: names and classes are constants of this module, ids are numbers, and
/// positions are sums of finite ones.
fn valid<T>(value: Result<T, InvalidValue>) -> T {
    match value {
        Ok(value) => value,
        Err(error) => unreachable!("the generator's own constants are valid: {error}"),
    }
}
