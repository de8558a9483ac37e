//! That the tour is what it says it is, and that its judge finds what is wrong.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::similarity::{cosine, normalise};

fn tour(plan: &Plan, seed: u64) -> Tour {
    simulate(plan, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

/// The truth itself as entries.
fn perfect(tour: &Tour) -> Vec<Vec<Option<usize>>> {
    tour.truth.clone()
}

#[test]
fn the_default_tour_is_as_its_documentation_says() {
    let plan = Plan::default();
    let tour = tour(&plan, 1);
    assert_eq!(tour.things.len(), 200);
    assert_eq!(tour.views.len(), 250);
    assert_eq!(tour.things.iter().filter(|thing| thing.twin.is_some()).count(), 40);
    let moved = tour.things.iter().filter(|thing| thing.moved()).count();
    assert!((10..=30).contains(&moved), "{moved} moved");
    let seen = tour.truth.iter().flatten().filter(|truth| truth.is_some()).count() as f64 / 200.0;
    assert!((24.0..30.0).contains(&seen), "30 views of each, a tenth missed, gives {seen}");
    let invented = tour.truth.iter().flatten().filter(|truth| truth.is_none()).count();
    assert!((60..180).contains(&invented), "{invented} of some 6000");
}

#[test]
fn noise_is_that_of_the_plan() {
    let plan = Plan { noise: [0.05, 0.05], invented: 0.0, ..Plan::default() };
    let tour = tour(&plan, 2);
    let mut squares = 0.0;
    let mut count = 0.0;
    for (number, (view, truth)) in tour.views.iter().zip(&tour.truth).enumerate() {
        let day = usize::from(number >= tour.first_day);
        for (detection, thing) in view.detections.iter().zip(truth) {
            let place = tour.things[thing.unwrap()].places[day];
            squares += (0..3).map(|axis| (detection.position[axis] - place[axis]).powi(2)).sum::<f64>();
            count += 3.0;
        }
    }
    let deviation = f64::sqrt(squares / count);
    assert!((deviation - 0.05).abs() < 0.001, "{deviation}");
}

#[test]
fn twins_look_the_same_and_belong_to_two_people() {
    let tour = tour(&Plan::default(), 3);
    let mut generator = ChaCha8Rng::seed_from_u64(4);
    let mut look = |thing: usize| normalise(&tour.things[thing].feature(&mut generator)).unwrap();
    for (number, thing) in tour.things.iter().enumerate() {
        let Some(twin) = thing.twin else { continue };
        assert_ne!(thing.owner, tour.things[twin].owner);
        assert_eq!(tour.things[twin].twin, Some(number));
        assert!((cosine(&look(number), &look(twin)) - 0.9).abs() < 0.08);
        let other = (0..200)
            .find(|&other| other != number && other != twin && tour.things[other].class == thing.class)
            .unwrap();
        assert!((cosine(&look(number), &look(other)) - 0.7).abs() < 0.15);
    }
}

#[test]
fn the_truth_scores_one_but_for_what_does_not_exist() {
    let tour = tour(&Plan::default(), 5);
    let scores = judge(&tour, &perfect(&tour));
    assert_eq!(scores.identities.f1(), 1.0);
    assert_eq!((scores.kept, &scores.merged, &scores.swapped), (scores.moved, &vec![], &vec![]));
}

#[test]
fn a_merged_pair_and_a_lost_id_are_found() {
    let tour = tour(&Plan::default(), 6);
    let moved = (0..200).find(|&thing| tour.things[thing].moved()).unwrap();
    let twin = (0..200).find(|&thing| tour.things[thing].twin.is_some()).unwrap();
    let mut entries = perfect(&tour);
    for (number, view) in entries.iter_mut().enumerate() {
        for entry in view {
            if *entry == Some(moved) && number >= tour.first_day {
                *entry = Some(1000);
            } else if *entry == Some(twin) {
                *entry = tour.things[twin].twin;
            }
        }
    }
    let scores = judge(&tour, &entries);
    assert_eq!(scores.kept + 1, scores.moved);
    assert_eq!(scores.merged, [(twin, tour.things[twin].twin.unwrap())]);
    assert!(scores.identities.f1() < 1.0);
}
