//! A map that is put away and taken up again goes on as if nothing had happened.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::map::tour::{Plan, simulate};

#[test]
fn a_map_goes_on_from_its_state() {
    let plan = Plan { things: 40, rooms: 2, equal_pairs: 6, moved: 0.3, dimension: 32, ..Plan::default() };
    let tour = simulate(&plan, &mut ChaCha8Rng::seed_from_u64(7)).unwrap();
    let parameters = MapParameters { dimension: 32, ..MapParameters::default() };
    let mut whole = SemanticMap::new(MapState::default(), parameters);
    let mut interrupted = whole.clone();
    for view in &tour.views {
        let observed = whole.observe(view);
        interrupted = SemanticMap::new(interrupted.state().clone(), parameters);
        assert_eq!(interrupted.observe(view), observed);
    }
    assert!(!whole.news().history.is_empty());
    assert_eq!(interrupted.state(), whole.state());
    assert_eq!(interrupted.perhaps_moved(), whole.perhaps_moved());
}
