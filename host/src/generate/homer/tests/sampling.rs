//! Days of a persona: what is drawn how often, and what can follow what.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rstest::rstest;

use super::{both, made_up};
use crate::generate::homer::data::{HomerData, Persona, SLOTS};
use crate::generate::homer::sampler::{
    BLOCKED_HOURS, COMING_HOME, DaySampler, Habits, LEAVING_HOME, Occurrence, Second, day,
};
use crate::generate::homer::schedule::{self, habits};
use crate::generate::homer::script::Verb;

const SIX: Second = 6 * 60 * 60;
const HOUR: Second = 60 * 60;

fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Whether so many hits are what a probability gives: within four and a half standard deviations of the binomial
/// distribution, which a right sampler leaves once in 150,000 checks.
fn assert_is_the_share(hits: usize, draws: usize, share: f64, what: &str) {
    let (expected, deviation) = (draws as f64 * share, (draws as f64 * share * (1.0 - share)).sqrt());
    let off = (hits as f64 - expected).abs();
    assert!(off <= 4.5 * deviation + 1e-6, "{what}: {hits} of {draws}, where {expected:.1} are expected");
}

/// So many days of a persona with one habit.
fn days<'a>(
    persona: &'a Persona,
    habits: &Habits<'a>,
    count: usize,
    generator: &mut ChaCha8Rng,
) -> Vec<Vec<Occurrence<'a>>> {
    (0..count).map(|_| day(persona, habits, generator).unwrap()).collect()
}

/// The shares of the hours, over the sum of the busiest hour's; computed here from the numbers themselves.
fn shares(persona: &Persona) -> BTreeMap<&str, [f64; SLOTS]> {
    let at_home: BTreeMap<&str, [f64; SLOTS]> = persona
        .hours
        .iter()
        .filter(|(activity, _)| *activity != "come_home")
        .map(|(activity, hours)| (activity.as_str(), *hours))
        .collect();
    let mut busiest = 0.0_f64;
    for hour in 0..SLOTS {
        busiest = busiest.max(at_home.values().map(|hours| hours[hour]).sum());
    }
    at_home.into_iter().map(|(activity, hours)| (activity, hours.map(|share| share / busiest))).collect()
}

#[test]
fn an_hours_draws_have_the_proportions_of_its_histogram() {
    const DRAWS: usize = 2000;
    both("histograms", |data| {
        let generator = &mut random(1);
        for persona in &data.personas {
            let shares = shares(persona);
            let fresh = DaySampler::new(persona);
            for hour in 0..SLOTS {
                let mut drawn: BTreeMap<Option<&str>, usize> = BTreeMap::new();
                for _ in 0..DRAWS {
                    let activity = fresh.clone().draw(hour, generator);
                    *drawn.entry(activity).or_default() += 1;
                }
                let mut idle = 1.0;
                for (activity, hours) in &shares {
                    let hits = drawn.get(&Some(*activity)).copied().unwrap_or(0);
                    assert_is_the_share(hits, DRAWS, hours[hour], &format!("{activity} at {hour}"));
                    idle -= hours[hour];
                }
                let hits = drawn.get(&None).copied().unwrap_or(0);
                assert_is_the_share(hits, DRAWS, idle.max(0.0), &format!("nothing at {hour}"));
            }
        }
    });
}

#[test]
fn days_begin_in_the_proportions_of_the_first_hour() {
    const DAYS: usize = 800;
    both("beginnings of days", |data| {
        let generator = &mut random(2);
        for persona in &data.personas {
            let habits = habits(data, persona, generator);
            let mut first: BTreeMap<&str, usize> = BTreeMap::new();
            for day in days(persona, &habits, DAYS, generator) {
                if let Some(occurrence) = day.first().filter(|occurrence| occurrence.from == SIX) {
                    *first.entry(occurrence.activity).or_default() += 1;
                }
            }
            for (activity, hours) in shares(persona) {
                // A day on which the persona goes out may be sampled again, so that its beginning is no plain draw.
                if !persona.hours.contains_key(LEAVING_HOME) {
                    let hits = first.get(activity).copied().unwrap_or(0);
                    assert_is_the_share(hits, DAYS, hours[0], activity);
                }
            }
        }
    });
}

#[test]
fn nobody_does_anything_at_home_while_out_and_everybody_is_home_at_midnight() {
    both("days out", |data| {
        let generator = &mut random(3);
        let mut outings = 0;
        for persona in &data.personas {
            let habits = habits(data, persona, generator);
            for day in days(persona, &habits, 150, generator) {
                let mut out = false;
                for occurrence in &day {
                    assert_eq!(out, occurrence.activity == COMING_HOME, "{day:?}");
                    out = occurrence.activity == LEAVING_HOME;
                    outings += usize::from(out);
                }
                assert!(!out, "{day:?}");
            }
        }
        assert!(outings > 100, "{outings} outings");
    });
}

#[test]
fn one_thing_at_a_time_and_none_again_within_three_hours() {
    both("blocks", |data| {
        let generator = &mut random(4);
        let mut again = 0;
        for persona in &data.personas {
            let habits = habits(data, persona, generator);
            for day in days(persona, &habits, 150, generator) {
                let mut ended: BTreeMap<&str, Second> = BTreeMap::new();
                for pair in day.windows(2) {
                    assert!(pair[0].until <= pair[1].from, "{day:?}");
                }
                for occurrence in day {
                    let slot = |second: Second| ((second - SIX) / HOUR) as usize;
                    if let Some(before) = ended.insert(occurrence.activity, occurrence.until) {
                        assert!(slot(occurrence.from) >= slot(before) + BLOCKED_HOURS, "{occurrence:?}");
                        again += 1;
                    }
                }
            }
        }
        assert!(again > 100, "{again} repetitions");
    });
}

#[test]
fn an_activity_takes_as_long_as_its_script_may() {
    both("durations", |data| {
        let generator = &mut random(5);
        for persona in &data.personas {
            let habits = habits(data, persona, generator);
            for occurrence in days(persona, &habits, 100, generator).into_iter().flatten() {
                let script = habits[occurrence.activity];
                let took = occurrence.until - occurrence.from;
                assert!((script.shortest()..=script.longest()).contains(&took), "{occurrence:?}: {took} s");
                assert!((SIX..24 * HOUR).contains(&occurrence.from), "{occurrence:?}");
                let begins: Vec<Second> = script.beginnings(took).map(|(begins, _)| begins).collect();
                assert!(begins[0] == 0 && begins.is_sorted() && *begins.last().unwrap() < took, "{begins:?}");
            }
        }
    });
}

#[rstest]
#[case::shortest(15 * 60 + 40, [0, 20, 15 * 60 + 20])]
#[case::half_way(37 * 60 + 30 + 60, [0, 30, 37 * 60 + 60])]
#[case::longest(60 * 60 + 80, [0, 40, 60 * 60 + 40])]
fn steps_share_the_time_by_their_ranges(#[case] whole: Second, #[case] expected: [Second; 3]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("meal.txt");
    std::fs::write(&path, "[WALK] <table> (1)\n[SIT] <chair> (2)\n[STANDUP]\n").unwrap();
    let script = crate::generate::homer::script::read(&path).unwrap();
    assert_eq!((script.shortest(), script.longest()), (15 * 60 + 40, 60 * 60 + 80));
    let begins: Vec<(Second, Verb)> =
        script.beginnings(whole).map(|(begins, step)| (begins, step.verb)).collect();
    let verbs = [Verb::Walk, Verb::Sit, Verb::StandUp];
    assert_eq!(begins, expected.into_iter().zip(verbs).collect::<Vec<_>>());
}

/// Which of the made-up classes somebody living alone uses in six weeks.
fn classes(data: &HomerData, seed: u64) -> Vec<String> {
    schedule::sample(data, 1, 42, &mut random(seed)).unwrap().into_keys().collect()
}

#[test]
fn one_member_follows_one_script_for_each_activity() {
    let mut read = BTreeMap::from([("radio", 0), ("mug", 0)]);
    for seed in 1..=30 {
        let used = classes(made_up::data(), seed);
        let uses = |class: &str| used.iter().any(|used| used == class);
        assert!(!(uses("radio") && uses("mug")), "the two ways of reading, seed {seed}: {used:?}");
        assert!(!(uses("coat") && uses("keys")), "the two ways of going out, seed {seed}: {used:?}");
        for (class, count) in &mut read {
            *count += usize::from(uses(class));
        }
    }
    assert!(read.values().all(|&count| count > 0), "{read:?}");
}

#[test]
fn what_is_taken_out_comes_home_again() {
    both("coming home", |data| {
        for persona in &data.personas {
            for seed in 1..=10 {
                let habits = habits(data, persona, &mut random(seed));
                let name = |activity: &str| habits.get(activity).map(|script| &script.name);
                assert_eq!(name(LEAVING_HOME), name(COMING_HOME), "{}", persona.name);
            }
        }
    });
}
