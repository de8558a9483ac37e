//! Where things are: rooms on one floor, and in every room the spots of its people and the common ones.

use coin_schemas::household::UsageType;
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::belongings::Belonging;
use super::catalogue::{Handling, Kept};
use super::parameters::PeopleTemplate;
use super::people::{Bedroom, Person};
use super::random::normal;

/// How far a thing lies from its spot: the standard deviation on the floor, in metres.
const SPREAD: f64 = 0.18;
/// How much its height varies, in metres.
const HEIGHT_SPREAD: f64 = 0.04;
/// The share of the carried things in somebody's spots that have wandered to that person's desk or bed.
const WANDERED: f64 = 0.4;
/// The share of the carried things of several owners that one of them keeps. Were there none, a person's own spot
/// would give away that its things have one owner.
const WITH_ONE_OF_THE_OWNERS: f64 = 0.25;
/// The share of the lent things that would be in their owner's spot and are in a borrower's.
const WITH_A_BORROWER: f64 = 0.15;
/// The common spots of a room: tables, shelves, sills.
const COMMON_SPOTS: usize = 2;
/// Nothing lies closer to a wall, in metres.
const MARGIN: f64 = 0.2;

/// A rectangular room: its name, its corner nearest the origin, its size in metres.
#[derive(Debug, Clone, PartialEq)]
struct Room {
    name: String,
    corner: [f64; 2],
    size: [f64; 2],
    common: Vec<[f64; 2]>,
}

impl Room {
    fn point(&self, generator: &mut ChaCha8Rng) -> [f64; 2] {
        [0, 1].map(|axis| {
            self.corner[axis] + generator.random_range(2.0 * MARGIN..self.size[axis] - 2.0 * MARGIN)
        })
    }

    fn clamp(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            point[axis].clamp(self.corner[axis] + MARGIN, self.corner[axis] + self.size[axis] - MARGIN)
        })
    }
}

/// A thing's place: metres, and the room's name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placement {
    pub(super) position: [f64; 3],
    pub(super) room: String,
}

/// The rooms, and the spot of every person for every way of keeping things.
pub(super) struct FloorPlan {
    rooms: Vec<Room>,
    /// For every way of keeping things, the room in which everybody's things are kept so.
    common_rooms: [usize; Kept::ALL.len()],
    /// For every person and way of keeping things, the room and the spot.
    spots: Vec<[(usize, [f64; 2]); Kept::ALL.len()]>,
}

impl FloorPlan {
    /// Lays out the rooms and gives everybody their spots.
    pub(super) fn draw(template: PeopleTemplate, people: &[Person], generator: &mut ChaCha8Rng) -> Self {
        let (mut rooms, room_of): (_, fn(Option<usize>, Kept) -> usize) = match template {
            PeopleTemplate::Office { .. } => (office_rooms(), office_room),
            _ => (home_rooms(people), home_room),
        };
        for room in &mut rooms {
            room.common = (0..COMMON_SPOTS).map(|_| room.point(generator)).collect();
        }
        let spots = people
            .iter()
            .enumerate()
            .map(|(place, person)| {
                let own_bedroom = (person.bedroom == Bedroom::Own)
                    .then(|| people[..place].iter().filter(|other| other.bedroom == Bedroom::Own).count());
                Kept::ALL.map(|kept| {
                    let room = room_of(own_bedroom, kept);
                    (room, rooms[room].point(generator))
                })
            })
            .collect();
        let common_rooms = Kept::ALL.map(|kept| room_of(None, kept));
        Self { rooms, common_rooms, spots }
    }

    /// Puts a thing somewhere: in the spot for such things of the person who keeps it, or, where nobody does, on a
    /// common spot of the room where such things are kept. Two in five of the carried things that somebody keeps
    /// have wandered to that person's desk or bed; what is not carried stays in its room.
    pub(super) fn place(
        &self,
        belonging: &Belonging,
        cohesion: f64,
        generator: &mut ChaCha8Rng,
    ) -> Placement {
        let kept = belonging.thing.kept;
        let (room, spot) = match keeper(belonging, cohesion, generator) {
            Some(person) => {
                let wandered = is_carried(belonging) && generator.random_bool(WANDERED);
                let kept = match (wandered, generator.random_bool(0.5)) {
                    (false, _) => kept,
                    (true, false) => Kept::Desk,
                    (true, true) => Kept::Bedside,
                };
                self.spots[person][kept as usize]
            }
            None => {
                let room = self.common_rooms[kept as usize];
                (room, self.rooms[room].common[generator.random_range(0..COMMON_SPOTS)])
            }
        };
        let room = &self.rooms[room];
        let [x, y] = room.clamp(spot.map(|metres| metres + SPREAD * normal(generator)));
        let z = (belonging.thing.height + HEIGHT_SPREAD * normal(generator)).max(0.02);
        Placement { position: [x, y, z].map(rounded), room: room.name.clone() }
    }
}

fn is_carried(belonging: &Belonging) -> bool {
    belonging.thing.handling == Handling::Carried
}

/// In whose spots a thing is. Of one owner's, that person with the probability `cohesion`, though some of what is
/// lent is still with a borrower; of several owners', at times one of them.
fn keeper(belonging: &Belonging, cohesion: f64, generator: &mut ChaCha8Rng) -> Option<usize> {
    let is_lent = is_carried(belonging) && belonging.usage_type == UsageType::TemporarySharing;
    match belonging.owners.as_slice() {
        [owner] if generator.random_bool(cohesion) => match belonging.others.choose(generator) {
            Some(&borrower) if is_lent && generator.random_bool(WITH_A_BORROWER) => Some(borrower),
            _ => Some(*owner),
        },
        [_] => None,
        owners if is_carried(belonging) && generator.random_bool(WITH_ONE_OF_THE_OWNERS) => {
            owners.choose(generator).copied()
        }
        _ => None,
    }
}

/// Positions are given to a tenth of a millimetre.
fn rounded(metres: f64) -> f64 {
    (metres * 10_000.0).round() / 10_000.0
}

fn room(name: impl Into<String>, corner: [f64; 2], size: [f64; 2]) -> Room {
    Room { name: name.into(), corner, size, common: Vec::new() }
}

/// Kitchen, living room and study on one side of the hallway; bathroom and bedrooms on the other.
fn home_rooms(people: &[Person]) -> Vec<Room> {
    let mut rooms = vec![
        room("kitchen", [0.0, 0.0], [4.0, 4.5]),
        room("living room", [4.0, 0.0], [5.5, 4.5]),
        room("study", [9.5, 0.0], [3.5, 4.5]),
        room("hallway", [0.0, 4.5], [13.0, 1.6]),
        room("bathroom", [0.0, 6.1], [3.0, 3.9]),
    ];
    let own_rooms = people.iter().filter(|person| person.bedroom == Bedroom::Own).count();
    for number in 0..=own_rooms {
        let corner = [3.0 + 3.4 * number as f64, 6.1];
        rooms.push(room(format!("bedroom {}", number + 1), corner, [3.4, 3.9]));
    }
    rooms
}

const STUDY: usize = 2;
const FIRST_BEDROOM: usize = 5;

/// The room for a way of keeping things, `own_bedroom` counting the bedrooms that are one person's.
fn home_room(own_bedroom: Option<usize>, kept: Kept) -> usize {
    let bedroom = own_bedroom.map_or(FIRST_BEDROOM, |number| FIRST_BEDROOM + 1 + number);
    match kept {
        Kept::Cupboard => 0,
        Kept::Seat => 1,
        Kept::Hook => 3,
        Kept::BathroomShelf => 4,
        Kept::Bedside => bedroom,
        // Those who sleep in the shared bedroom have their desks in the study.
        Kept::Desk if bedroom == FIRST_BEDROOM => STUDY,
        Kept::Desk => bedroom,
    }
}

fn office_rooms() -> Vec<Room> {
    vec![
        room("kitchenette", [0.0, 0.0], [3.5, 4.0]),
        room("meeting room", [3.5, 0.0], [5.0, 4.0]),
        room("entrance", [8.5, 0.0], [3.5, 4.0]),
        room("storage room", [12.0, 0.0], [3.0, 4.0]),
        room("open office", [0.0, 4.0], [12.0, 7.0]),
    ]
}

fn office_room(_own_bedroom: Option<usize>, kept: Kept) -> usize {
    match kept {
        Kept::Cupboard => 0,
        Kept::Seat => 1,
        Kept::Hook => 2,
        Kept::BathroomShelf => 3,
        Kept::Desk | Kept::Bedside => 4,
    }
}
