//! The week plan: when every person is there, and what they do at which time of the day.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::catalogue::Activity;
use super::people::{Housework, Pattern, Person};

/// A minute of the day, from midnight.
pub(super) type Minute = u16;

/// The watch begins at 06:00 …
pub(super) const FIRST_MINUTE: Minute = 6 * 60;
/// … and ends with the minute before 23:00.
pub(super) const LAST_MINUTE: Minute = 23 * 60 - 1;

/// A stretch of a day, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stretch {
    pub(super) from: Minute,
    pub(super) until: Minute,
}

impl Stretch {
    fn minutes(self) -> Minute {
        self.until.saturating_sub(self.from)
    }

    fn overlap(self, other: Self) -> Option<Self> {
        let (from, until) = (self.from.max(other.from), self.until.min(other.until));
        (from < until).then_some(Self { from, until })
    }
}

/// Something that a person does for a while.
#[derive(Debug, Clone, Copy)]
pub(super) struct Occurrence {
    pub(super) activity: Activity,
    pub(super) during: Stretch,
}

/// A day of one person.
#[derive(Debug, Clone, Default)]
pub(super) struct DayPlan {
    /// When the person is there and awake.
    pub(super) present: Vec<Stretch>,
    pub(super) occurrences: Vec<Occurrence>,
}

impl DayPlan {
    /// Adds what fits into the person's presence; less than five minutes are not worth starting.
    fn add(&mut self, activity: Activity, from: Minute, minutes: Minute) {
        let wanted = Stretch { from, until: from.saturating_add(minutes) };
        let fits = self.present.iter().filter_map(|stretch| stretch.overlap(wanted));
        let occurrences: Vec<_> = fits
            .filter(|during| during.minutes() >= 5)
            .map(|during| Occurrence { activity, during })
            .collect();
        self.occurrences.extend(occurrences);
    }
}

/// Whether a day is one of work and school.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DayKind {
    Weekday,
    Weekend,
}

/// What a person keeps to from day to day.
struct Habits {
    wake: Minute,
    bed: Minute,
    leave: Minute,
    back: Minute,
    /// How much later the weekend begins.
    lie_in: Minute,
}

impl Habits {
    fn draw(person: &Person, generator: &mut ChaCha8Rng) -> Self {
        let child = person.is_child();
        let (leave, back) = match person.pattern {
            Pattern::School => (generator.random_range(465..490), generator.random_range(870..970)),
            Pattern::University => (generator.random_range(530..640), generator.random_range(880..1080)),
            Pattern::Desk => (generator.random_range(475..570), generator.random_range(1000..1120)),
            Pattern::OfficeHours | Pattern::Shifts | Pattern::Home => {
                (generator.random_range(455..515), generator.random_range(1035..1130))
            }
        };
        Self {
            wake: if child { generator.random_range(395..430) } else { generator.random_range(365..420) },
            bed: if child { generator.random_range(1240..1300) } else { generator.random_range(1320..1375) },
            leave,
            back,
            lie_in: generator.random_range(20..110),
        }
    }
}

/// Draws the plan of every person for every day: `plans[person][day]`.
pub(super) fn week(people: &[Person], days: &[DayKind], generator: &mut ChaCha8Rng) -> Vec<Vec<DayPlan>> {
    let dinner: Minute = generator.random_range(1090..1180);
    people
        .iter()
        .map(|person| {
            let habits = Habits::draw(person, generator);
            days.iter()
                .map(|&kind| match person.pattern {
                    Pattern::Desk => office_day(&habits, kind, generator),
                    _ => home_day(person, &habits, kind, dinner, generator),
                })
                .collect()
        })
        .collect()
}

/// A time some minutes before or after the usual one.
fn about(usual: Minute, spread: Minute, generator: &mut ChaCha8Rng) -> Minute {
    let shift = generator.random_range(0..=2 * spread);
    (usual + shift).saturating_sub(spread).clamp(FIRST_MINUTE, LAST_MINUTE)
}

/// When the person is out of the house.
fn away(person: &Person, habits: &Habits, kind: DayKind, generator: &mut ChaCha8Rng) -> Option<Stretch> {
    let (works, from, until) = match (person.pattern, kind) {
        (Pattern::OfficeHours | Pattern::School, DayKind::Weekday) => (0.96, habits.leave, habits.back),
        (Pattern::University, DayKind::Weekday) => (0.75, habits.leave, habits.back),
        (Pattern::Shifts, kind) => {
            let early = generator.random_bool(0.5);
            let (from, until) = if early { (400, 870) } else { (800, 1290) };
            (if kind == DayKind::Weekday { 0.75 } else { 0.35 }, from, until)
        }
        (Pattern::Home | Pattern::Desk, DayKind::Weekday) => {
            let from = generator.random_range(560..840);
            (0.6, from, from + generator.random_range(45..130))
        }
        (_, DayKind::Weekend) => {
            let from = generator.random_range(600..930);
            (0.55, from, from + generator.random_range(90..260))
        }
    };
    generator
        .random_bool(works)
        .then(|| Stretch { from: about(from, 8, generator), until: about(until, 25, generator) })
}

fn home_day(
    person: &Person,
    habits: &Habits,
    kind: DayKind,
    dinner: Minute,
    generator: &mut ChaCha8Rng,
) -> DayPlan {
    let lie_in = if kind == DayKind::Weekend { habits.lie_in } else { 0 };
    let awake = Stretch {
        from: about(habits.wake + lie_in, 10, generator),
        until: about(habits.bed + lie_in / 4, 15, generator),
    };
    let mut plan = DayPlan::default();
    let away = away(person, habits, kind, generator);
    match away {
        None => plan.present.push(awake),
        Some(out) => {
            let before = Stretch { from: awake.from.min(out.from), until: out.from };
            let after = Stretch { from: out.until, until: awake.until };
            plan.present.extend([before, after].into_iter().filter(|stretch| stretch.minutes() >= 15));
        }
    }
    let wake = plan.present.first().map_or(awake.from, |stretch| stretch.from);
    plan.add(Activity::Washing, wake, 22);
    plan.add(Activity::Dressing, wake + 12, 22);
    plan.add(Activity::Breakfast, wake + 22, 38);
    if let Some(out) = away {
        plan.add(Activity::ComingAndGoing, out.from.saturating_sub(18), 18);
        plan.add(Activity::ComingAndGoing, out.until, 18);
    }
    plan.add(Activity::Lunch, about(735, 25, generator), 40);
    plan.add(Activity::Dinner, about(dinner, 10, generator), 45);
    housework(person, dinner, &mut plan, generator);
    leisure(person, &mut plan, generator);
    plan.add(Activity::Washing, awake.until.saturating_sub(75), 40);
    plan.add(Activity::Bedtime, awake.until.saturating_sub(35), 35);
    plan
}

fn housework(person: &Person, dinner: Minute, plan: &mut DayPlan, generator: &mut ChaCha8Rng) {
    let share = match person.housework {
        Housework::None => 0.12,
        Housework::Some => 0.45,
        Housework::Most => 0.9,
    };
    let chores = [
        (Activity::Cooking, dinner.saturating_sub(60), 55),
        (Activity::Cooking, 690, 40),
        (Activity::Dishes, dinner + 45, 25),
        (Activity::Dishes, 780, 20),
        (Activity::Cleaning, 580, 60),
        (Activity::Laundry, 640, 50),
        (Activity::Cleaning, 1000, 45),
        (Activity::Laundry, 1180, 40),
    ];
    for (activity, from, minutes) in chores {
        if generator.random_bool(share) {
            plan.add(activity, about(from, 20, generator), minutes);
        }
    }
}

/// Fills the time that is left with hobbies, homework, snacks and, in the evening, television.
fn leisure(person: &Person, plan: &mut DayPlan, generator: &mut ChaCha8Rng) {
    for stretch in plan.present.clone() {
        let mut minute = stretch.from + 45;
        while minute + 20 < stretch.until {
            let length = generator.random_range(25..80);
            let activity = if person.pattern == Pattern::School && generator.random_bool(0.3) {
                Activity::Homework
            } else if generator.random_bool(0.15) {
                Activity::Snack
            } else if minute > 1150 && generator.random_bool(0.4) {
                Activity::Television
            } else {
                person.hobbies.choose(generator).copied().unwrap_or(Activity::Reading)
            };
            plan.add(activity, minute, length);
            minute += length + generator.random_range(0..25);
        }
    }
}

fn office_day(habits: &Habits, kind: DayKind, generator: &mut ChaCha8Rng) -> DayPlan {
    let mut plan = DayPlan::default();
    let comes = if kind == DayKind::Weekday { 0.93 } else { 0.08 };
    if !generator.random_bool(comes) {
        return plan;
    }
    let (from, until) = (about(habits.leave, 20, generator), about(habits.back, 35, generator));
    plan.present.push(Stretch { from, until });
    plan.add(Activity::ComingAndGoing, from, 15);
    plan.add(Activity::Snack, from + 10, 25);
    plan.add(Activity::Meeting, about(600, 30, generator), 50);
    plan.add(Activity::Lunch, about(735, 25, generator), 45);
    plan.add(Activity::Snack, about(900, 40, generator), 20);
    if generator.random_bool(0.5) {
        plan.add(Activity::Meeting, about(850, 40, generator), 60);
    }
    if generator.random_bool(0.4) {
        plan.add(Activity::Parcels, about(940, 60, generator), 40);
    }
    let mut minute = from + 20;
    while minute + 30 < until {
        let length = generator.random_range(40..100);
        plan.add(Activity::DeskWork, minute, length);
        minute += length + generator.random_range(0..30);
    }
    plan.add(Activity::ComingAndGoing, until.saturating_sub(12), 12);
    plan
}
