//! The map on simulated tours. Seeds from 1000 on judge; whatever was chosen was chosen on seeds below.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::map::entry::{EntryId, SightingId};
use crate::map::parameters::MapParameters;
use crate::map::tour::{Plan, Tour, TourScores, judge, simulate};
use crate::map::{MapState, Outcome, SemanticMap};

fn tour(plan: &Plan, seed: u64) -> Tour {
    simulate(plan, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

/// The entry in which each detection is in the end.
fn entries(map: &SemanticMap, outcomes: &[Vec<Outcome>]) -> Vec<Vec<Option<EntryId>>> {
    let holders: BTreeMap<SightingId, EntryId> = map
        .state()
        .entries
        .values()
        .flat_map(|entry| entry.sightings.keys().map(|&sighting| (sighting, entry.id)))
        .collect();
    let holder = |outcome: &Outcome| match outcome {
        Outcome::Joined { sighting, .. } | Outcome::New { sighting, .. } => holders.get(sighting).copied(),
        Outcome::Refused(_) | Outcome::Repeated { .. } => None,
    };
    outcomes.iter().map(|of_view| of_view.iter().map(holder).collect()).collect()
}

fn run(tour: &Tour) -> (SemanticMap, TourScores) {
    let mut map = SemanticMap::new(MapState::default(), MapParameters::default());
    let outcomes: Vec<Vec<Outcome>> = tour.views.iter().map(|view| map.observe(view).outcomes).collect();
    let scores = judge(tour, &entries(&map, &outcomes));
    (map, scores)
}

fn report(name: &str, seeds: std::ops::Range<u64>, plan: &Plan) {
    for seed in seeds {
        let tour = tour(plan, seed);
        let (map, scores) = run(&tour);
        println!(
            "{name} seed {seed}: IDF1 {:.4} {:?} entries {} (twice or more {}) kept {}/{} merged {:?} undecided {}",
            scores.identities.f1(),
            scores.identities,
            map.state().entries.len(),
            map.state().entries.values().filter(|entry| entry.views() > 1).count(),
            scores.kept,
            scores.moved,
            scores.merged,
            map.perhaps_moved().len(),
        );
    }
}

#[test]
#[ignore = "prints the development tours"]
fn development() {
    report("default", 1..5, &Plan::default());
}

#[test]
#[ignore = "diagnosis"]
fn diagnosis() {
    for seed in 2..8 {
        let tour = tour(&Plan::default(), seed);
        let mut map = SemanticMap::new(MapState::default(), MapParameters::default());
        let outcomes: Vec<Vec<Outcome>> = tour.views.iter().map(|view| map.observe(view).outcomes).collect();
        let entries = entries(&map, &outcomes);
        for (number, thing) in tour.things.iter().enumerate().filter(|(_, thing)| thing.moved()) {
            let mut count = [BTreeMap::new(), BTreeMap::new()];
            for (view, (truth, entries)) in tour.truth.iter().zip(&entries).enumerate() {
                for (truth, entry) in truth.iter().zip(entries) {
                    if *truth == Some(number) {
                        *count[usize::from(view >= tour.first_day)].entry(entry.unwrap().0).or_insert(0) += 1;
                    }
                }
            }
            let best = |c: &BTreeMap<u64, i32>| c.iter().max_by_key(|(_, n)| **n).map(|(e, _)| *e);
            if best(&count[0]) != best(&count[1]) {
                println!(
                    "seed {seed} thing {number} {:?} twin {:?} places {:?} {count:?}",
                    thing.class,
                    thing.twin.map(|t| (t, tour.things[t].moved(), tour.things[t].places)),
                    thing.places
                );
                for id in count.iter().flat_map(|c| c.keys()) {
                    let e = &map.state().entries.get(&EntryId(*id));
                    if let Some(e) = e {
                        println!(
                            "   {id} views {} absences {} {} .. {} at {:?} moves {:?} {:?}",
                            e.views(),
                            e.absences,
                            e.first_seen,
                            e.last_seen,
                            e.place.position,
                            e.moves,
                            e.classes
                        );
                    }
                }
            }
        }
    }
}
