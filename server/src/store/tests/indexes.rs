//! What the indexes find is what looking at everything finds.

use coin::similarity::{most_similar, normalise};
use coin::space::{Neighbourhood, neighbours};
use coin_schemas::episode::{EpisodeObject, FEATURE_DIMENSIONS};
use coin_schemas::household::{ClassLabel, ObjectId, Position};
use proptest::prelude::*;

use super::super::looks::Alike;
use super::*;

fn thing(id: usize, metres: [f64; 3]) -> EpisodeObject {
    EpisodeObject {
        id: ObjectId::new(id.to_string()).unwrap(),
        class: ClassLabel::new("marker").unwrap(),
        position: Position::new(metres).unwrap(),
        room: None,
    }
}

/// A home with a thing at each of these places.
fn furnished(places: &[[f64; 3]]) -> Store {
    let store = Store::open_in_memory().unwrap();
    let furnish = |writer: &Writer<'_>| {
        places
            .iter()
            .enumerate()
            .try_for_each(|(id, metres)| writer.add_object(&thing(id, *metres)).map(drop))
    };
    store.write(furnish).unwrap();
    store
}

/// Coordinates that often coincide, and some that numbers of 32 bits do not hold.
fn any_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => (-4..5_i32).prop_map(|steps| f64::from(steps) * 0.1),
        4 => -3.0..3.0_f64,
        1 => 16_777_216.0..16_777_220.0_f64,
        1 => prop_oneof![Just(1e30), Just(-1e300), Just(1e-300), Just(1e308)],
    ]
}

fn any_reach() -> impl Strategy<Value = Neighbourhood> {
    let sigma = prop_oneof![Just(0.5), 0.001..10.0_f64];
    let gamma = prop_oneof![Just(1.0), Just(0.0), 0.0..3.0_f64];
    let min_weight = prop_oneof![Just(0.01), Just(0.0), Just(1.0), 0.0..1.0_f64, Just(1e-320)];
    (0..30_usize, sigma, gamma, min_weight).prop_map(|(k, sigma, gamma, min_weight)| Neighbourhood {
        k,
        sigma,
        gamma,
        min_weight,
    })
}

/// The neighbours of a thing among some, as ids and distances.
fn near(target: &StoredObject, objects: &[StoredObject], reach: &Neighbourhood) -> Vec<(ObjectId, f64)> {
    let others = objects.iter().filter(|other| other.key != target.key);
    let found = neighbours(target.position, others.map(|other| (other.id.clone(), other.position)), reach);
    found.into_iter().map(|near| (near.item, near.distance)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn neighbours_are_those_of_all_things(
        places in proptest::collection::vec([any_coordinate(), any_coordinate(), any_coordinate()], 1..80),
        moved in proptest::collection::vec((any::<prop::sample::Index>(), any_coordinate()), 0..10),
        reaches in proptest::collection::vec(any_reach(), 1..8),
    ) {
        let store = furnished(&places);
        let move_things = |writer: &Writer<'_>| {
            for (which, x) in &moved {
                let id = which.index(places.len()).to_string();
                writer.connection.execute("UPDATE objects SET x = ?2 WHERE id = ?1", (&id, x))?;
            }
            writer.connection.execute("DELETE FROM objects WHERE id = '7'", ())?;
            Ok::<_, StoreError>(())
        };
        store.write(move_things).unwrap();
        let pairs = store.read::<_, StoreError>(|reader| {
            let objects = reader.objects()?;
            let mut pairs = Vec::new();
            for target in objects.iter().take(5) {
                for reach in &reaches {
                    let around = reader.around(target, reach)?;
                    pairs.push((near(target, &around, reach), near(target, &objects, reach)));
                }
            }
            Ok(pairs)
        });
        for (found, expected) in pairs.unwrap() {
            prop_assert_eq!(found, expected);
        }
    }
}

/// A step in the life of a home's features.
#[derive(Debug, Clone)]
enum Step {
    Put { object: usize, direction: u8, through: usize },
    Forget { object: usize, through: usize },
    TakeBack { object: usize, direction: u8, through: usize },
    Index { through: usize },
    Enter { through: usize },
    Look { object: usize, k: usize, through: usize },
}

const THINGS: usize = 12;

fn any_step() -> impl Strategy<Value = Step> {
    let step = (0..THINGS, any::<u8>(), 0..2_usize, 1..THINGS, 0..10_u8);
    step.prop_map(|(object, direction, through, k, kind)| match kind {
        0..3 => Step::Put { object, direction, through },
        3 => Step::Forget { object, through },
        4 => Step::TakeBack { object, direction, through },
        5 => Step::Index { through },
        6 => Step::Enter { through },
        _ => Step::Look { object, k, through },
    })
}

/// A feature; few are possible, so that some things look the same.
fn feature(direction: u8) -> [f32; FEATURE_DIMENSIONS] {
    let mut feature = [0.0; FEATURE_DIMENSIONS];
    feature[usize::from(direction % 4)] = 2.0;
    feature[usize::from(direction / 4 % 8)] += f32::from(direction / 64);
    feature
}

fn put(writer: &Writer<'_>, object: usize, direction: u8) -> Result<(), StoreError> {
    let key = writer.object_key(&object.to_string())?.unwrap();
    writer.put_feature(key, &feature(direction))
}

fn forget(writer: &Writer<'_>, object: usize) -> Result<(), StoreError> {
    let key = writer.object_key(&object.to_string())?.unwrap();
    writer.connection.execute("DELETE FROM features WHERE object_key = ?1", [key.0])?;
    Ok(())
}

type Similarities = Option<Vec<(ObjectId, f64)>>;

/// What looks like a thing, as the kept looks tell it and as all features tell it.
fn looked_at(reader: &Reader<'_>, object: usize, k: usize) -> Result<[Similarities; 2], StoreError> {
    let key = reader.object_key(&object.to_string())?.unwrap();
    let ranked = |target: &[f32], others: &[(ObjectId, Vec<f32>)]| {
        let others = others.iter().map(|(id, look)| (id.clone(), look.as_slice()));
        let alike = most_similar(target, others, k).into_iter();
        alike.map(|similar| (similar.item, similar.similarity)).collect()
    };
    let found = match reader.alike(key, k)? {
        Alike::NeverSeen => None,
        Alike::Found { look, others } => {
            let others: Vec<_> = others.into_iter().map(|other| (other.object.id, other.look)).collect();
            Some(ranked(&look, &others))
        }
    };
    let features = reader.features()?;
    let mut others = Vec::new();
    for other in reader.objects()?.iter().filter(|other| other.key != key) {
        let look = features.get(&other.key).and_then(|feature| normalise(feature));
        others.extend(look.map(|look| (other.id.clone(), look)));
    }
    let target = features.get(&key).and_then(|feature| normalise(feature));
    Ok([found, target.map(|target| ranked(&target, &others))])
}

#[expect(clippy::redundant_closure_for_method_calls, reason = "the method's path is not general enough")]
fn perform(stores: &[Store; 2], steps: &[Step]) {
    for step in steps {
        match *step {
            Step::Put { object, direction, through } => {
                stores[through].write(|writer| put(writer, object, direction)).unwrap();
            }
            Step::Forget { object, through } => {
                stores[through].write(|writer| forget(writer, object)).unwrap();
            }
            Step::TakeBack { object, direction, through } => {
                let taken_back: Result<(), StoreError> = stores[through].write(|writer| {
                    put(writer, object, direction)?;
                    // Who writes sees what was written, and nobody else ever does.
                    let [found, expected] = looked_at(writer, object, THINGS)?;
                    assert_eq!(found, expected);
                    Err(StoreError::Interrupted)
                });
                taken_back.unwrap_err();
            }
            // So few things are all in the lists that a search goes through, so that nothing is missed.
            Step::Index { through } => {
                stores[through].make_index(9).unwrap();
            }
            Step::Enter { through } => {
                stores[through].change(|writer| writer.enter_changes()).unwrap();
            }
            Step::Look { object, k, through } => {
                let [found, expected] = stores[through].read(|reader| looked_at(reader, object, k)).unwrap();
                assert_eq!(found, expected);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn look_alikes_are_those_of_all_features_for_whoever_looks_whenever(
        before in proptest::collection::vec(any_step(), 0..20),
        meanwhile in proptest::collection::vec(any_step(), 0..20),
        after in proptest::collection::vec(any_step(), 0..10),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("home.db");
        // Each store keeps looks of its own, as two processes do.
        let stores = [(); 2].map(|()| Store::open(&path, Access::ReadWrite).unwrap());
        stores[0]
            .write(|writer| (0..THINGS).try_for_each(|id| writer.add_object(&thing(id, [0.0; 3])).map(drop)))
            .unwrap();
        perform(&stores, &before);
        stores[0]
            .read::<_, StoreError>(|reader| {
                // From here on, this transaction sees the home as it is now.
                reader.objects()?;
                perform(&stores, &meanwhile);
                for object in 0..THINGS {
                    let [found, expected] = looked_at(reader, object, 5)?;
                    assert_eq!(found, expected);
                }
                Ok(())
            })
            .unwrap();
        perform(&stores, &after);
    }
}
