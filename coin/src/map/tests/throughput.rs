//! How many detections a minute the map takes in.

use std::time::Instant;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

/// `cargo test -p coin --lib map::tests::throughput -- --ignored --nocapture`
#[test]
#[ignore = "measures; it needs some gigabytes of memory"]
fn a_million_detections_of_full_features() {
    const ROWS: usize = 100;
    const IN_A_ROW: usize = 20;
    const DETECTIONS: usize = 1_000_000;
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let looks: Vec<Vec<f32>> =
        (0..ROWS * IN_A_ROW).map(|_| (0..512).map(|_| generator.random_range(-1.0..1.0)).collect()).collect();
    let mut map = SemanticMap::new(MapState::default(), MapParameters::default());
    let mut seconds = 0.0;
    for number in 0..DETECTIONS / IN_A_ROW {
        let row = number % ROWS;
        let at = clock(number as i64);
        let detections = (0..IN_A_ROW)
            .map(|place| {
                let mut shaken = |metres: f64| metres + generator.random_range(-0.05..0.05);
                let position = [shaken(0.3 * place as f64), shaken(0.5 * row as f64), shaken(0.0)];
                Detection { at, feature: Some(looks[row * IN_A_ROW + place].clone()), ..cup(position) }
            })
            .collect();
        let corner = |x: f64, y: f64, z: f64| Position::new([x, 0.5 * row as f64 + y, z]).unwrap();
        let covered = vec![Region { least: corner(-0.5, -0.4, -1.0), greatest: corner(6.5, 0.4, 1.0) }];
        let seen = View { id: Some(ViewId(number.to_string())), taken_at: at, covered, detections };
        let start = Instant::now();
        map.observe(&seen);
        seconds += start.elapsed().as_secs_f64();
    }
    println!(
        "{DETECTIONS} detections of {} entries in {seconds:.1} s: {:.1} million a minute",
        map.state().entries.len(),
        DETECTIONS as f64 / seconds * 60.0 / 1e6
    );
    assert_eq!(map.state().entries.len(), ROWS * IN_A_ROW);
}
