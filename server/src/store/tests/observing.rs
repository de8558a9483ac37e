//! What a robot sees, as it is kept.

use coin::captions::{Action, Observation};
use coin::map::detection::{Detection, Region, View, ViewId};
use coin::map::entry::SightingId;
use coin::map::tour::{Plan, simulate};
use coin_schemas::episode::FEATURE_DIMENSIONS;
use coin_schemas::household::{ClassLabel, ObjectId, Position};
use jiff::civil::{DateTime, date};
use jiff::{SignedDuration, ToSpan};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::store::semantic_map::Revised;
use crate::test_home;

fn on_day(day: i64) -> DateTime {
    date(2025, 2, 1).at(9, 0, 0, 0).saturating_add(day.days())
}

/// A cup of one of two looks.
fn cup(place: [f64; 3], look: usize) -> Detection {
    let mut feature = vec![0.0; FEATURE_DIMENSIONS];
    feature[100 + look] = 1.0;
    Detection {
        class: ClassLabel::new("cup").unwrap(),
        position: place,
        radius: 0.05,
        at: on_day(0),
        feature: Some(feature),
    }
}

fn view(name: &str, day: i64, detections: Vec<Detection>) -> ViewInRooms {
    let detections: Vec<Detection> =
        detections.into_iter().map(|detection| Detection { at: on_day(day), ..detection }).collect();
    let rooms = vec![None; detections.len()];
    let id = Some(ViewId(name.to_owned()));
    ViewInRooms { view: View { id, taken_at: on_day(day), covered: vec![], detections }, rooms }
}

fn covering(mut view: ViewInRooms, least: [f64; 3], greatest: [f64; 3]) -> ViewInRooms {
    let corner = |metres| Position::new(metres).unwrap();
    view.view.covered.push(Region { least: corner(least), greatest: corner(greatest) });
    view
}

/// The ids of the things that the detections of one view are of.
fn observe(store: &Store, view: ViewInRooms) -> Vec<String> {
    let observations = store.observe(&[view]).unwrap();
    let ids = observations.detections.into_iter().flatten().map(|observed| match observed {
        Observed::Taken { object, .. } | Observed::Repeated { object } => object.to_string(),
        Observed::Refused(refusal) => refusal.to_string(),
    });
    ids.collect()
}

fn object(store: &Store, id: &str) -> Option<StoredObject> {
    store.read(|reader| reader.object(id)).unwrap()
}

#[expect(clippy::redundant_closure_for_method_calls, reason = "the method's path is not general enough")]
fn ids(store: &Store) -> Vec<String> {
    let objects = store.read(|reader| reader.objects()).unwrap();
    objects.into_iter().map(|object| object.id.to_string()).collect()
}

/// A cup that was seen here twice, is gone from here in three views, and was seen twice elsewhere.
fn a_cup_that_moves(store: &Store) -> (Vec<String>, Observations) {
    let here = [1.0, 1.0, 0.8];
    let there = [4.0, 1.0, 0.8];
    let empty = |name: &str, day| covering(view(name, day, vec![]), [0.0, 0.0, 0.0], [2.0, 2.0, 2.0]);
    let first = observe(store, view("a", 1, vec![cup(here, 0)]));
    observe(store, view("b", 2, vec![cup(here, 0)]));
    for (name, day) in [("c", 3), ("d", 4), ("e", 5)] {
        observe(store, empty(name, day));
    }
    observe(store, view("f", 6, vec![cup(there, 0)]));
    let last = store.observe(&[view("g", 7, vec![cup(there, 0)])]).unwrap();
    (first, last)
}

#[test]
fn what_is_kept_in_memory_is_what_the_database_says() {
    let plan =
        Plan { things: 30, rooms: 2, equal_pairs: 4, moved: 0.3, views_per_day: 12, ..Plan::default() };
    let tour = simulate(&plan, &mut ChaCha8Rng::seed_from_u64(5)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    // Another process takes in every third view, so that what is kept is out of date then.
    let stores = [(); 2].map(|()| Store::open(&path, Access::ReadWrite).unwrap());
    let mut in_memory = coin::map::SemanticMap::new(
        coin::map::MapState { entries_so_far: 1, sightings_so_far: 1, ..Default::default() },
        coin::map::parameters::MapParameters::default(),
    );
    let mut moves = 0;
    for (number, view) in tour.views.iter().enumerate() {
        let rooms = vec![None; view.detections.len()];
        let store = &stores[usize::from(number % 3 == 2)];
        moves += store.observe(&[ViewInRooms { view: view.clone(), rooms }]).unwrap().moved.len();
        in_memory.observe(view);
        in_memory.news();
    }
    let Revised { revision, map } = stores[usize::from((tour.views.len() - 1) % 3 == 2)].map.take().unwrap();
    assert!(moves > 0, "no thing was moved, so that little is shown");
    // Not assert_eq!, which would print thousands of numbers.
    assert!(map.state() == in_memory.state());
    let read = stores[0]
        .write(|writer| {
            assert_eq!(writer.map_revision()?, revision);
            writer.semantic_map(None)
        })
        .unwrap();
    assert!(read.state() == map.state());
    assert_eq!(read.perhaps_moved(), map.perhaps_moved());
}

#[test]
fn a_thing_that_was_moved_keeps_its_id_its_owner_and_its_past() {
    let store = Store::open_in_memory().unwrap();
    add_bob(&store);
    let here = [1.0, 1.0, 0.8];
    let thing = observe(&store, view("a", 1, vec![cup(here, 0)])).remove(0);
    observe(&store, view("b", 2, vec![cup(here, 0)]));
    for (name, day) in [("c", 3), ("d", 4), ("e", 5)] {
        let empty = covering(view(name, day, vec![]), [0.0, 0.0, 0.0], [2.0, 2.0, 2.0]);
        observe(&store, empty);
    }
    let mut elsewhere = view("f", 6, vec![cup([4.0, 1.0, 0.8], 0)]);
    elsewhere.rooms = vec![Some("kitchen".to_owned())];
    let newcomer = observe(&store, elsewhere).remove(0);
    assert_ne!(newcomer, thing);
    // Something is seen to be done with it under its passing id, before it is known which thing it is.
    store
        .write(|writer| {
            let household = writer.household()?.unwrap();
            for (id, caption) in [(&thing, "Bob takes the cup"), (&newcomer, "Bob uses the cup")] {
                let observation = Observation { at: on_day(6), actor: None, action: Action::Take };
                let object = writer.object_key(id)?.unwrap();
                writer.record_usage(&household, &[UsageRecord { object, observation, caption }])?;
            }
            Ok::<_, StoreError>(())
        })
        .unwrap();
    let last = store.observe(&[view("g", 7, vec![cup([4.02, 1.0, 0.8], 0)])]).unwrap();
    let moved = &last.moved[0];
    assert_eq!(moved.object.as_str(), thing);
    assert_eq!((moved.from, moved.at), (here, on_day(6)));
    assert!((moved.to[0] - 4.01).abs() < 1e-9, "{moved:?}");
    assert_eq!(ids(&store), [thing.as_str()]);
    let found = object(&store, &newcomer).unwrap();
    assert_eq!(found.id.as_str(), thing, "the passing id still names it");
    assert_eq!(found.room.as_deref(), Some("kitchen"));
    store
        .read(|reader| {
            let household = reader.household()?.unwrap();
            let log = reader.usage(&household, found.key, i64::MIN, i64::MAX)?;
            assert_eq!(log.events.len(), 2, "both events are its own");
            assert_eq!(reader.sighting_count(found.key)?, 4);
            let places = reader.former_places(found.key)?;
            assert_eq!(places, [FormerPlace { position: here, until: on_day(6) }]);
            let changes = reader.changes(found.key)?;
            assert_eq!(
                changes,
                [ObjectChange { kind: ChangeKind::Moved, other: newcomer.clone(), at: on_day(6) }]
            );
            Ok::<_, StoreError>(())
        })
        .unwrap();
}

#[test]
fn a_thing_is_recognised_whoever_saw_it_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    let (first, last) = a_cup_that_moves(&Store::open(&path, Access::ReadWrite).unwrap());
    assert_eq!(last.moved[0].object.as_str(), first[0]);
    let again = Store::open(&path, Access::ReadWrite).unwrap();
    assert_eq!(observe(&again, view("h", 8, vec![cup([4.0, 1.0, 0.8], 0)])), first);
}

#[test]
fn the_same_view_again_changes_nothing() {
    let store = Store::open_in_memory().unwrap();
    let both = || view("a", 1, vec![cup([1.0, 1.0, 0.8], 0), cup([1.3, 1.0, 0.8], 0)]);
    let first = observe(&store, both());
    let before = object(&store, &first[0]);
    let again = store.observe(&[both()]).unwrap().detections.remove(0);
    let repeated = |id: &String| Observed::Repeated { object: ObjectId::new(id.as_str()).unwrap() };
    assert_eq!(again, first.iter().map(repeated).collect::<Vec<_>>());
    assert_eq!(object(&store, &first[0]), before);
    // Without a view, it is the moment that tells.
    let alone = || {
        let mut alone = view("", 2, vec![cup([1.0, 1.0, 0.8], 0)]);
        alone.view.id = None;
        alone
    };
    observe(&store, alone());
    let again = store.observe(&[alone()]).unwrap().detections.remove(0);
    assert_eq!(again, [repeated(&first[0])]);
}

#[test]
fn a_detection_of_a_recorded_thing_leaves_its_class_and_its_recording_alone() {
    let store = test_home::store();
    let episode = test_home::episode();
    let seen = Detection {
        class: ClassLabel::new("mug").unwrap(),
        feature: episode.features.as_ref().map(|features| features[2].to_vec()),
        ..cup([0.02, 0.41, 0.0], 0)
    };
    assert_eq!(observe(&store, view("a", 1, vec![seen])), ["cup-a"]);
    let object = object(&store, "cup-a").unwrap();
    assert_eq!(object.class.as_str(), "coffee cup");
    assert_ne!(object.position.metres(), [0.0, 0.4, 0.0]);
    assert_eq!(store.import(&episode).unwrap().usage.recorded, 0, "it is the same recording still");
    assert_eq!(object, self::object(&store, "cup-a").unwrap());
}

#[test]
fn what_is_detected_before_an_import_is_another_home() {
    let store = Store::open_in_memory().unwrap();
    observe(&store, view("a", 1, vec![cup([1.0, 1.0, 0.8], 0)]));
    let refusal = store.import(&test_home::episode()).unwrap_err();
    assert!(matches!(refusal, StoreError::OtherHome { .. }), "{refusal}");
}

#[test]
fn a_wrong_join_is_undone() {
    let store = Store::open_in_memory().unwrap();
    let (blue, red) = ([1.0, 1.0, 0.8], [1.1, 1.0, 0.8]);
    let thing = observe(&store, view("a", 1, vec![cup(blue, 0)])).remove(0);
    for (name, place) in [("b", red), ("c", blue), ("d", red)] {
        assert_eq!(observe(&store, view(name, 1, vec![cup(place, 0)])), [thing.as_str()]);
    }
    let key = object(&store, &thing).unwrap().key;
    let sightings = store.read(|reader| reader.latest_sightings(key, 10)).unwrap();
    let wrong = |(number, sighting): &(SightingId, coin::map::detection::Sighting)| {
        (sighting.position.metres() == red).then_some(*number)
    };
    let wrong = sightings.iter().filter_map(wrong).collect();
    let other = store.split(key, &wrong).unwrap();
    assert_eq!(object(&store, &thing).unwrap().position.metres(), blue);
    let other_object = object(&store, other.as_str()).unwrap();
    assert_eq!(other_object.position.metres(), red);
    let changes = store.read(|reader| reader.changes(key)).unwrap();
    assert_eq!((changes[0].kind, changes[0].other.as_str()), (ChangeKind::Split, other.as_str()));
    // From then on each detection joins its own, also after all is read again.
    store.map.take();
    let both = observe(&store, view("e", 2, vec![cup(red, 0), cup(blue, 0)]));
    assert_eq!(both, [other.to_string(), thing.clone()]);
    assert_eq!(store.read(|reader| reader.sighting_count(other_object.key)).unwrap(), 3);
    let nothing = store.split(key, &std::collections::BTreeSet::new()).unwrap_err();
    assert!(nothing.to_string().contains("both parts"), "{nothing}");
}

#[test]
fn what_fails_leaves_no_map_that_nobody_wrote_down() {
    let store = Store::open_in_memory().unwrap();
    let thing = observe(&store, view("a", 1, vec![cup([1.0, 1.0, 0.8], 0)]));
    let call = Call::default();
    call.interrupt();
    let late = view("b", 2, vec![cup([9.0, 1.0, 0.8], 1)]);
    assert!(store.during(&call).observe(&[late]).is_err());
    assert_eq!(ids(&store), thing);
    observe(&store, view("c", 3, vec![cup([9.0, 1.0, 0.8], 1)]));
    assert_eq!(ids(&store), ["thing-1", "thing-2"]);
}

#[test]
fn times_are_kept_to_the_millisecond() {
    use crate::store::semantic_map::{milliseconds, moment};
    for time in ["2025-01-19T19:00:00.123", "1969-12-31T23:59:59.999", "0001-01-01T00:00:00"] {
        let time: DateTime = time.parse().unwrap();
        assert_eq!(moment(milliseconds(time)).unwrap(), time);
    }
    let epoch = date(1970, 1, 1).at(0, 0, 0, 0);
    assert_eq!(milliseconds(epoch.saturating_add(SignedDuration::from_millis(-1))), -1);
}
