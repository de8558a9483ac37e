//! Wrong joins undone.

use std::collections::BTreeMap;

use super::*;
use crate::map::{Change, SplitError};

/// Two cups that were never in one view, too close to be told apart.
fn joined_wrongly() -> SemanticMap {
    let mut map = map();
    for minute in 0..6 {
        map.observe(&view(minute, vec![cup([if minute % 2 == 0 { 0.0 } else { 0.2 }, 0.0, 0.0])]));
    }
    assert_eq!(all_ids(&map), [0]);
    map
}

#[test]
fn a_wrong_join_is_undone_and_remembered() {
    let mut map = joined_wrongly();
    let out = sightings(&[1, 3, 5]);
    assert_eq!(map.split(EntryId(0), &out, &BTreeMap::new()), Ok(EntryId(1)));
    let (left, taken) = (entry(&map, 0), entry(&map, 1));
    assert_eq!(left.place.position, [0.0; 3]);
    assert!((taken.place.position[0] - 0.2).abs() < 1e-12);
    assert_eq!((left.views(), left.first_seen, left.last_seen), (3, clock(0), clock(4)));
    assert_eq!((taken.views(), taken.first_seen, taken.last_seen), (3, clock(1), clock(5)));
    assert_eq!(taken.sightings.keys().copied().collect::<BTreeSet<_>>(), out);
    assert_eq!(map.news().history, [Change::Split { entry: EntryId(0), into: EntryId(1), sightings: out }]);
    assert_eq!(map.state().views[&ViewId("at 1".into())], BTreeSet::from([EntryId(1)]));
    let outcomes = map.observe(&view(6, vec![cup([0.19, 0.0, 0.0]), cup([0.01, 0.0, 0.0])])).outcomes;
    assert_eq!(ids(&outcomes), [Some(1), Some(0)], "from now on they are two");
}

#[test]
fn what_cannot_be_split_is_left_as_it_is() {
    let mut map = joined_wrongly();
    let before = map.clone();
    let (entry, nothing, all) = (EntryId(0), sightings(&[]), sightings(&[0, 1, 2, 3, 4, 5]));
    assert_eq!(
        map.split(EntryId(7), &all, &BTreeMap::new()),
        Err(SplitError::UnknownEntry { entry: EntryId(7) })
    );
    assert_eq!(
        map.split(entry, &sightings(&[0, 9]), &BTreeMap::new()),
        Err(SplitError::UnknownSighting { entry, sighting: SightingId(9) })
    );
    assert_eq!(map.split(entry, &nothing, &BTreeMap::new()), Err(SplitError::EmptyPart { entry }));
    assert_eq!(map.split(entry, &all, &BTreeMap::new()), Err(SplitError::EmptyPart { entry }));
    assert_eq!(map, before);
}

/// Somebody bought a second red cup and threw the first away. It is no move, and must not become one again.
#[test]
fn a_wrong_move_is_undone_for_good() {
    let mut map = map();
    let red = (0..6).map(|number| (SightingId(number), RED.to_vec())).collect();
    for minute in 0..6 {
        map.observe(&covering(view(minute, vec![red_cup(if minute < 3 { 0.0 } else { 4.0 })]), -9.0, 9.0));
    }
    assert_eq!(all_ids(&map), [0]);
    assert_eq!(map.split(EntryId(0), &sightings(&[3, 4, 5]), &red), Ok(EntryId(2)));
    for minute in 6..12 {
        map.observe(&covering(view(minute, vec![red_cup(4.0)]), -9.0, 9.0));
    }
    assert_eq!(all_ids(&map), [0, 2]);
    assert_eq!((entry(&map, 0).place.position, entry(&map, 0).moves.as_slice()), ([0.0; 3], [].as_slice()));
    assert_eq!((entry(&map, 2).place.position, entry(&map, 2).views()), ([4.0, 0.0, 0.0], 9));
}
