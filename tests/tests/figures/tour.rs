//! A robot's tour through a simulated home, over the pipe: every view is a call of `observe_objects`.
//!
//! The tour and what is true of it come from `coin::map::tour`, and so does the judge. The map itself is judged on many
//! tours in `coin`; this one shows that nothing is lost between the robot and the database, a server that ends at night
//! included: the things are those that a map in memory finds.

use std::collections::BTreeMap;

use coin::map::detection::View;
use coin::map::entry::{EntryId, SightingId};
use coin::map::parameters::MapParameters;
use coin::map::tour::{Plan, Tour, TourScores, judge, simulate};
use coin::map::{MapState, Outcome, SemanticMap};
use coin_tests::{EpisodeBuilder, Era, Home, ServerProcess, is_slow_run};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

const OWNERS: [&str; 4] = ["Ann", "Ben", "Cleo", "Dan"];

/// The seed of the tour. The map was tuned on others.
const SEED: u64 = 1001;

fn call(view: &View) -> Value {
    let name = view.id.as_ref().map(|id| id.0.as_str());
    let observations: Vec<Value> = view
        .detections
        .iter()
        .map(|seen| {
            json!({
                "class": seen.class, "position": seen.position, "radius": seen.radius, "embedding": seen.feature,
                "seen_at": seen.at, "view": name,
            })
        })
        .collect();
    let views: Vec<Value> = view
        .covered
        .iter()
        .map(|region| {
            let (least, greatest) = (region.least.metres(), region.greatest.metres());
            json!({"view": name, "seen_at": view.taken_at, "least": least, "greatest": greatest})
        })
        .collect();
    json!({"observations": observations, "views": views})
}

/// Shows the views to the server, and tells of which thing each detection was said to be.
fn observe(server: &mut ServerProcess, views: &[View], moved: &mut usize) -> Vec<Vec<Option<String>>> {
    let seen_in = |view: &View| {
        let result = server.ok("observe_objects", call(view));
        assert_eq!(result["rejected"], json!([]), "{:?}", view.id);
        *moved += result["moved"].as_array().map_or(0, Vec::len);
        let seen = result["results"].as_array().unwrap().iter();
        seen.map(|seen| seen["object_id"].as_str().map(str::to_owned)).collect()
    };
    views.iter().map(seen_in).collect()
}

/// The id under which each thing was seen most often in some views.
fn main_ids<E: Ord + Clone>(
    things: usize,
    truth: &[Vec<Option<usize>>],
    ids: &[Vec<Option<E>>],
) -> Vec<Option<E>> {
    let mut counts: Vec<BTreeMap<&E, usize>> = vec![BTreeMap::new(); things];
    for (thing, id) in truth.iter().flatten().zip(ids.iter().flatten()) {
        if let (Some(thing), Some(id)) = (thing, id) {
            *counts[*thing].entry(id).or_default() += 1;
        }
    }
    let most = |of_thing: &BTreeMap<&E, usize>| {
        of_thing.iter().max_by_key(|(_, count)| **count).map(|(id, _)| (*id).clone())
    };
    counts.iter().map(most).collect()
}

/// How a map in memory does on the tour.
fn scores_in_memory(tour: &Tour) -> TourScores {
    let mut map = SemanticMap::new(MapState::default(), MapParameters::default());
    let outcomes: Vec<Vec<Outcome>> = tour.views.iter().map(|view| map.observe(view).outcomes).collect();
    let entries = map.state().entries.values();
    let holders: BTreeMap<SightingId, EntryId> =
        entries.flat_map(|entry| entry.sightings.keys().map(|&sighting| (sighting, entry.id))).collect();
    let holder = |outcome: &Outcome| match outcome {
        Outcome::Joined { sighting, .. } | Outcome::New { sighting, .. } => holders.get(sighting).copied(),
        Outcome::Refused(_) | Outcome::Repeated { .. } => None,
    };
    let held: Vec<Vec<_>> = outcomes.iter().map(|of_view| of_view.iter().map(holder).collect()).collect();
    judge(tour, &held)
}

#[test]
fn a_tour_through_the_server_keeps_ids_and_owners() {
    if !is_slow_run("tour") {
        return;
    }
    let tour = simulate(&Plan::default(), &mut ChaCha8Rng::seed_from_u64(SEED)).unwrap();
    let people: BTreeMap<&str, Value> = OWNERS.iter().map(|&name| (name, json!({}))).collect();
    let home = Home::of(&EpisodeBuilder::new().with("/users", json!(people)));
    let mut moved = 0;

    let mut server = home.server_of(Era::Legacy);
    let mut ids = observe(&mut server, &tour.views[..tour.first_day], &mut moved);
    let first_ids = main_ids(tour.things.len(), &tour.truth, &ids);
    for (thing, id) in tour.things.iter().zip(&first_ids) {
        if let Some(id) = id {
            let answer = json!({
                "object_id": id, "question": "Whose is this?", "answer": "I know whose.",
                "ownership": {OWNERS[thing.owner]: true},
            });
            server.ok("record_answer", answer);
        }
    }
    server.finish();

    let mut server = home.server_of(Era::Modern);
    let last_ids = observe(&mut server, &tour.views[tour.first_day..], &mut moved);
    ids.extend(last_ids.iter().cloned());
    // What was learned later is known of the earlier detections as well: former ids name the thing.
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let mut present = |id: &String| {
        let known = names.entry(id.clone()).or_insert_with(|| {
            let whose = server.ok("nearby_objects", json!({"object_id": id}));
            whose["object"]["id"].as_str().unwrap().to_owned()
        });
        known.clone()
    };
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let mut number = |id: &String| {
        let next = numbers.len();
        *numbers.entry(present(id)).or_insert(next)
    };
    let ids: Vec<Vec<Option<usize>>> =
        ids.iter().map(|of_view| of_view.iter().map(|id| id.as_ref().map(&mut number)).collect()).collect();
    let scores = judge(&tour, &ids);
    let last_ids = main_ids(tour.things.len(), &tour.truth[tour.first_day..], &last_ids);
    let moved_things = tour.things.iter().zip(&last_ids).filter(|(thing, _)| thing.moved());
    let mut owners_kept = 0;
    for (thing, id) in moved_things.filter_map(|(thing, id)| Some((thing, id.as_ref()?))) {
        let whose = server.ok("whose_is", json!({"object_id": id}));
        owners_kept += usize::from(whose["owners"] == json!([OWNERS[thing.owner]]));
    }
    println!(
        "{} detections, {} things: IDF1 {:.3}; {} of {} moved things kept their id and {owners_kept} their owner, \
         {moved} moves told; {} pairs merged, {} swapped",
        ids.iter().map(Vec::len).sum::<usize>(),
        tour.things.len(),
        scores.identities.f1(),
        scores.kept,
        scores.moved,
        scores.merged.len(),
        scores.swapped.len(),
    );
    assert_eq!(scores, scores_in_memory(&tour));
    assert!(scores.identities.f1() >= 0.97);
    assert!(scores.merged.is_empty() && scores.swapped.is_empty(), "{scores:?}");
    assert!(scores.kept as f64 >= 0.8 * scores.moved as f64, "{scores:?}");
    assert!(owners_kept >= scores.kept, "{owners_kept} of {scores:?}");
}
