//! The home that is measured.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use coin_schemas::episode::{EpisodeObject, FEATURE_DIMENSIONS};
use coin_schemas::household::{Background, ClassLabel, ObjectId, Position, UserName};
use coin_server::store::{Access, Store, StoreError, Writer};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::Plan;

/// A large building, in metres: a million things are forty in a cubic metre.
const BUILDING: [f64; 3] = [100.0, 100.0, 2.5];

/// So many things are stored in one transaction.
const BATCH: usize = 100_000;

/// What the class and the look have of a feature's squared length, as in `coin::map::tour`: two views of things that look
/// the same have a cosine of 0.9, and things of one class one of 0.7. The rest is the view's.
const CLASS_SHARE: f32 = 0.7;
const LOOK_SHARE: f32 = 0.2;

type Direction = [f32; FEATURE_DIMENSIONS];

/// Puts a home into a database, and its features and positions into files beside it: rows of 32 and of 64 bits.
pub(crate) fn build(plan: &Plan, database: &Path) {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let file =
        |name| BufWriter::new(File::create(plan.folder.join(name)).expect("the folder can be written to"));
    let mut files = [file("features.f32"), file("positions.f64")];
    let store = Store::open(database, Access::ReadWrite).expect("the database can be made");
    let bob = UserName::new("Bob").expect("a name");
    store.write(|writer| writer.put_user(&bob, &Background::default())).expect("somebody moves in");
    let classes: Vec<Direction> = (0..plan.classes).map(|_| direction(&mut generator)).collect();
    let mut look = (0, direction(&mut generator));
    for first in (0..plan.things).step_by(BATCH) {
        let add = |writer: &Writer<'_>| {
            for number in first..plan.things.min(first + BATCH) {
                // Two things in four look the same.
                if number % 4 != 1 {
                    look = (generator.random_range(0..plan.classes), direction(&mut generator));
                }
                let feature = seen(&classes[look.0], &look.1, &direction(&mut generator));
                let metres = BUILDING.map(|length| generator.random_range(0.0..length));
                files[0].write_all(&feature.map(f32::to_le_bytes).concat()).expect("the disk has room");
                files[1].write_all(&metres.map(f64::to_le_bytes).concat()).expect("the disk has room");
                let key = writer.add_object(&thing(number, look.0, metres))?;
                writer.put_feature(key, &feature)?;
            }
            Ok::<_, StoreError>(())
        };
        store.write(add).expect("the things are stored");
        eprintln!("{} things are there", plan.things.min(first + BATCH));
    }
}

fn thing(number: usize, class: usize, metres: [f64; 3]) -> EpisodeObject {
    EpisodeObject {
        id: ObjectId::new(number.to_string()).expect("a number is an id"),
        class: ClassLabel::new(format!("class {class}")).expect("a class"),
        position: Position::new(metres).expect("a position"),
        room: None,
    }
}

/// A random direction, of length about 1 in many dimensions.
fn direction(generator: &mut ChaCha8Rng) -> Direction {
    let greatest = (3.0 / FEATURE_DIMENSIONS as f32).sqrt();
    std::array::from_fn(|_| greatest * (2.0 * generator.random::<f32>() - 1.0))
}

fn seen(class: &Direction, look: &Direction, view: &Direction) -> Direction {
    let shares = [CLASS_SHARE, LOOK_SHARE, 1.0 - CLASS_SHARE - LOOK_SHARE].map(f32::sqrt);
    let feature: Direction = std::array::from_fn(|place| {
        shares[0] * class[place] + shares[1] * look[place] + shares[2] * view[place]
    });
    let length = feature.iter().map(|component| component * component).sum::<f32>().sqrt();
    feature.map(|component| component / length)
}
