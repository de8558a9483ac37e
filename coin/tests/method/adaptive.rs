//! What the adaptive gate keeps in homes that err more often than they seem to, by simulation.

use coin::conformal::Level;
use coin::gate::{AdaptedThreshold, Held, TrackRecord};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const HOMES: usize = 500;
const THINGS: usize = 34;
const RISK: f64 = 0.012;

/// λ̂ of a calibration on homes that err as often as they seem to.
const LAMBDA: f64 = 0.88;

/// What came of asking, as shares of all things.
#[derive(Debug, Clone, Copy, Default)]
struct Outcome {
    wrong: f64,
    asked: f64,
}

/// Homes whose things are wrong so many times as often as is claimed, and whether the threshold follows the answers.
fn simulated(factor: f64, follows: impl Fn(&[f64], TrackRecord, f64) -> bool) -> Outcome {
    let mut generator = ChaCha8Rng::seed_from_u64(5);
    let mut all = Outcome::default();
    for _ in 0..HOMES {
        let mut doubts: Vec<f64> =
            (0..THINGS).map(|_| generator.random_range(0.0..0.95_f64).powi(8)).collect();
        doubts.sort_by(|left, right| right.total_cmp(left));
        let wrong: Vec<bool> =
            doubts.iter().map(|doubt| generator.random_bool((factor * doubt).min(1.0))).collect();
        let mut record = TrackRecord::default();
        let mut asked = 0;
        while asked < THINGS
            && (1.0 - doubts[asked] < LAMBDA || follows(&doubts[asked..], record, 1.0 - doubts[asked]))
        {
            record.add(1.0 - doubts[asked], !wrong[asked]);
            asked += 1;
        }
        all.asked += asked as f64;
        all.wrong += wrong[asked..].iter().filter(|&&wrong| wrong).count() as f64;
    }
    let things = (HOMES * THINGS) as f64;
    Outcome { wrong: all.wrong / things, asked: all.asked / things }
}

fn by_answers(left: &[f64], record: TrackRecord, confidence: f64) -> bool {
    let held = left.iter().map(|doubt| Held::Inferred { confidence: 1.0 - doubt });
    !AdaptedThreshold::new(held, THINGS, Level::new(RISK).unwrap(), record).settles(confidence)
}

#[test]
fn the_answers_keep_the_risk_where_a_fixed_threshold_does_not() {
    let compared =
        [1.0, 2.0, 3.0].map(|factor| (simulated(factor, |_, _, _| false), simulated(factor, by_answers)));
    let [(fixed, adapted), (fixed_at_two, adapted_at_two), (fixed_at_three, adapted_at_three)] = compared;
    assert!(fixed.wrong <= RISK && adapted.wrong <= RISK, "{compared:?}");
    assert!(fixed_at_two.wrong > 1.6 * RISK && adapted_at_two.wrong <= 1.15 * RISK, "{compared:?}");
    assert!(fixed_at_three.wrong > 2.5 * RISK && adapted_at_three.wrong <= 1.25 * RISK, "{compared:?}");
    assert!(
        adapted.asked < adapted_at_two.asked && adapted_at_two.asked < adapted_at_three.asked,
        "{compared:?}"
    );
    // Where nothing is amiss the answers cost few questions more.
    assert!(adapted.asked <= fixed.asked + 0.05, "{compared:?}");
}
