//! Laws of whole runs: worlds drawn at random, in which models change their minds and fail, and people know, do not
//! know, decline and leave.

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Agent, AgentSettings, Effect, Event, Inference, QuestionChoice, Reinference};
use coin::calibration::Thresholds;
use coin::gate::MOST_TIMES_ASKED;
use coin::gate::wants_to_ask;
use coin::owners::OwnerSetDistribution;
use coin_schemas::household::{ObjectId, Score};
use coin_schemas::report::{Gate, Stopped};
use proptest::prelude::*;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::run::{CALIBRATED, answered, owned_by_a_stranger, the_papers, unresolved};
use crate::support::{id, set};

/// How the model and the people behave, and in which order results come back.
#[derive(Debug, Clone)]
struct World {
    settings: AgentSettings,
    things: usize,
    /// Decides what is said; the same seed says the same.
    seed: u64,
    /// Decides nothing but the order of results.
    order: u64,
}

/// Everything that happened in a run.
#[derive(Debug, PartialEq)]
struct Trace {
    effects: Vec<Vec<Effect>>,
    passes: usize,
    asked: BTreeMap<ObjectId, u32>,
    stopped: Stopped,
    agent: Agent,
}

impl World {
    fn objects(&self) -> Vec<ObjectId> {
        (0..self.things).map(|thing| id(&(thing * 3).to_string())).collect()
    }

    /// Every three things are of a kind, in worlds of an even seed.
    fn alike(&self) -> Vec<Vec<ObjectId>> {
        match self.seed.is_multiple_of(2) {
            true => self.objects().chunks(3).map(<[ObjectId]>::to_vec).collect(),
            false => Vec::new(),
        }
    }

    /// A generator that depends on the seed, the thing and the moment, and on nothing else.
    fn generator(&self, object: &ObjectId, moment: usize) -> ChaCha8Rng {
        let thing: u64 = object.as_str().parse().unwrap();
        ChaCha8Rng::seed_from_u64(self.seed.wrapping_mul(1_000_003) ^ (thing << 32) ^ moment as u64)
    }

    fn result(&self, object: &ObjectId, pass: usize) -> Event {
        let mut generator = self.generator(object, pass);
        if generator.random_range(0..8) == 0 {
            return Event::InferenceFailed { object: object.clone(), reason: "no luck".to_owned() };
        }
        let scores: Vec<Score> = (0..3)
            .map(|_| Score::new(f64::from(generator.random_range(0..=10_u32)) / 10.0).unwrap())
            .collect();
        let mut related: BTreeSet<ObjectId> = self.objects().into_iter().collect();
        related.retain(|other| other != object && generator.random_range(0..3) == 0);
        let distribution = OwnerSetDistribution::from_scores(&scores);
        Event::Inferred {
            object: object.clone(),
            inference: Inference { scores, distribution, related, ..Inference::default() },
        }
    }

    fn reply(&self, object: &ObjectId, question: usize) -> Event {
        match self.generator(object, 1_000_000 + question).random_range(0..12) {
            0..=2 => unresolved(),
            3 | 4 => Event::Declined,
            5 => owned_by_a_stranger(),
            6 if self.seed.is_multiple_of(4) => Event::NobodyLeft,
            _ => answered(coin::dialogue::Reading { owners: set(&[question % 3]), outside_household: false }),
        }
    }

    /// Drives the agent to its end. Panics where a law of every single step is broken.
    fn run(&self) -> Trace {
        let mut agent = Agent::new(self.settings.clone(), self.objects()).asking_together(self.alike());
        let mut shuffle = ChaCha8Rng::seed_from_u64(self.order);
        let mut queue = vec![Event::Started];
        let (mut all, mut passes, mut questions) = (Vec::new(), 0, 0);
        let mut asked: BTreeMap<ObjectId, u32> = BTreeMap::new();
        let mut closed: BTreeSet<ObjectId> = BTreeSet::new();
        let mut chosen: Option<ObjectId> = None;
        let mut together: BTreeSet<ObjectId> = BTreeSet::new();
        loop {
            assert!(!queue.is_empty(), "the agent waits for nothing");
            assert_misplaced_events_are_refused(&agent, &queue, self.objects().first());
            let event = queue.remove(0);
            let effects = agent.handle(event).unwrap();
            for effect in &effects {
                match effect {
                    Effect::Infer { objects } => {
                        assert!(
                            objects.iter().all(|object| agent.object(object).unwrap().answer().is_none())
                        );
                        queue = objects.iter().map(|object| self.result(object, passes)).collect();
                        queue.shuffle(&mut shuffle);
                        passes += 1;
                    }
                    Effect::Record { objects } => {
                        assert!(
                            objects.iter().all(|object| agent.object(object).unwrap().scores().is_some())
                        );
                    }
                    Effect::Weigh { objects } => {
                        assert_eq!(self.settings.choice, QuestionChoice::MostInformative);
                        assert!(objects.len() > 1 && objects.iter().all(|object| !closed.contains(object)));
                        let left =
                            |object| self.generator(object, 2_000_000 + questions).random_range(0.0..1.0);
                        let doubt_left: Vec<f64> = objects.iter().map(left).collect();
                        let least = doubt_left.iter().copied().fold(f64::INFINITY, f64::min);
                        chosen =
                            doubt_left.iter().position(|&left| left == least).map(|at| objects[at].clone());
                        queue = vec![Event::Weighed { doubt_left }];
                    }
                    Effect::AskTogether { objects } => {
                        assert!(objects.len() > 1);
                        assert!(chosen.take().is_none_or(|chosen| chosen == objects[0]));
                        let owners: BTreeSet<_> =
                            objects.iter().map(|object| agent.object(object).unwrap().owners()).collect();
                        assert_eq!(owners.len(), 1, "one question is about the same people's things");
                        for object in objects {
                            assert!(!closed.contains(object) && !asked.contains_key(object));
                            assert!(
                                together.insert(object.clone()),
                                "{object} was asked about with others before"
                            );
                        }
                        let reply = self.reply(&objects[0], questions);
                        questions += 1;
                        if reply != unresolved() {
                            objects.iter().for_each(|object| *asked.entry(object.clone()).or_default() += 1);
                        }
                        if matches!(reply, Event::Declined) || reply == owned_by_a_stranger() {
                            closed.extend(objects.iter().cloned());
                        }
                        queue = vec![reply];
                    }
                    Effect::Ask { object } => {
                        assert!(
                            chosen.take().is_none_or(|chosen| chosen == *object),
                            "another left less doubt"
                        );
                        assert!(!closed.contains(object), "{object} was declined or a stranger's");
                        let thing = agent.object(object).unwrap();
                        if let Some(trust) = thing.trust() {
                            assert!(trust < 1.0, "{object} was answered, and nothing speaks against it");
                            assert_ne!(
                                self.settings.gate,
                                Gate::Paper,
                                "the paper takes answers as they are"
                            );
                        }
                        let reply = self.reply(object, questions);
                        questions += 1;
                        *asked.entry(object.clone()).or_default() += 1;
                        if matches!(reply, Event::Declined) || reply == owned_by_a_stranger() {
                            closed.insert(object.clone());
                        }
                        queue = vec![reply];
                    }
                    Effect::Finish { stopped } => {
                        let stopped = *stopped;
                        assert_misplaced_events_are_refused(&agent, &[], self.objects().first());
                        all.push(effects);
                        return Trace { effects: all, passes, asked, stopped, agent };
                    }
                }
            }
            all.push(effects);
        }
    }
}

/// Of all events only those belong that the agent waits for; any other changes nothing.
fn assert_misplaced_events_are_refused(agent: &Agent, awaited: &[Event], object: Option<&ObjectId>) {
    let waits_for_a_reply = matches!(awaited, [Event::Answered { .. } | Event::Declined | Event::NobodyLeft]);
    let mut misplaced = vec![];
    if awaited != [Event::Started] {
        misplaced.push(Event::Started);
    }
    if !waits_for_a_reply {
        misplaced.extend([unresolved(), owned_by_a_stranger(), Event::Declined, Event::NobodyLeft]);
    }
    misplaced.push(Event::Weighed { doubt_left: vec![0.5; 100] });
    let is_awaited = |object: &ObjectId| {
        awaited.iter().any(|event| match event {
            Event::Inferred { object: other, .. } | Event::InferenceFailed { object: other, .. } => {
                other == object
            }
            _ => false,
        })
    };
    let unknown = id("unknown");
    for object in [object, Some(&unknown)].into_iter().flatten().filter(|object| !is_awaited(object)) {
        misplaced.push(Event::InferenceFailed { object: object.clone(), reason: "late".to_owned() });
    }
    for event in misplaced {
        let mut tried = agent.clone();
        assert!(tried.handle(event).is_err());
        assert_eq!(&tried, agent);
    }
}

fn any_world() -> impl Strategy<Value = World> {
    let gate = prop_oneof![
        Just(Gate::Risk),
        Just(Gate::Adaptive),
        Just(Gate::Set),
        Just(Gate::Paper),
        Just(Gate::Always),
        Just(Gate::Never)
    ];
    let reinference = prop_oneof![Just(Reinference::AnsweredContext), Just(Reinference::EveryUnasked)];
    let thresholds = prop_oneof![3 => Just(CALIBRATED), 1 => Just(Thresholds::Uncalibrated)];
    let max_questions = prop_oneof![2 => Just(usize::MAX), 1 => 0..6_usize];
    let choice = prop_oneof![Just(QuestionChoice::LeastSure), Just(QuestionChoice::MostInformative)];
    let passes = (reinference, choice, 1..4_usize);
    (gate, passes, thresholds, max_questions, 0..8_usize, any::<u64>(), any::<u64>()).prop_map(
        |(gate, (reinference, choice, answers_per_pass), thresholds, max_questions, things, seed, order)| {
            World {
                settings: AgentSettings {
                    gate,
                    reinference,
                    choice,
                    answers_per_pass,
                    thresholds,
                    max_questions,
                    ..the_papers()
                },
                things,
                seed,
                order,
            }
        },
    )
}

/// The unanswered things that the gate wants to ask about.
fn unsettled<'a>(world: &'a World, agent: &'a Agent) -> impl Iterator<Item = ObjectId> + 'a {
    let AgentSettings { gate, thresholds, .. } = &world.settings;
    world.objects().into_iter().filter(move |object| {
        let thing = agent.object(object).unwrap();
        let adapted = agent.adapted_threshold();
        let wanted = thing.assessment().map_or(*gate != Gate::Never, |thought| {
            wants_to_ask(*gate, thresholds, thought)
                || adapted.is_some_and(|adapted| !adapted.settles(thought.confidence))
        });
        thing.answer().is_none() && wanted
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Every thing is asked about at most twice, and every question leads to at most one pass.
    #[test]
    fn every_run_ends_within_the_bound(world in any_world()) {
        let trace = world.run();
        let most = MOST_TIMES_ASKED as usize * world.things;
        prop_assert!(trace.passes <= most + 1);
        prop_assert!(trace.asked.values().all(|&times| times <= MOST_TIMES_ASKED));
        prop_assert!(trace.agent.questions() <= world.settings.max_questions);
        for (object, times) in &trace.asked {
            let counted = trace.agent.object(object).unwrap().times_asked();
            prop_assert!(counted == *times || trace.stopped == Stopped::NothingLeftToAsk && counted + 1 == *times);
        }
    }

    #[test]
    fn a_run_says_truly_why_it_ended(world in any_world()) {
        let trace = world.run();
        let open: Vec<ObjectId> = unsettled(&world, &trace.agent).collect();
        match trace.stopped {
            Stopped::Confident => prop_assert_eq!(open, []),
            Stopped::MaxQuestions => prop_assert_eq!(trace.agent.questions(), world.settings.max_questions),
            // Somebody may leave who was asked to confirm an answer.
            Stopped::NothingLeftToAsk => {
                prop_assert!(!open.is_empty() || trace.agent.unsettled().next().is_some());
            }
            Stopped::Budget | Stopped::Interrupted => prop_assert!(false, "nobody ended the run"),
        }
    }

    /// What was said last stands, however it was doubted.
    #[test]
    fn nobody_is_contradicted(world in any_world()) {
        let trace = world.run();
        for object in world.objects() {
            let thing = trace.agent.object(&object).unwrap();
            if let Some(reading) = thing.answer() {
                prop_assert_eq!(thing.owners(), reading.owners);
                prop_assert!(thing.trust().is_some_and(|trust| (0.0..=1.0).contains(&trust)));
            }
        }
    }

    #[test]
    fn the_order_of_results_does_not_matter(world in any_world(), order in any::<u64>()) {
        let other = World { order, ..world.clone() };
        let (here, there) = (world.run(), other.run());
        prop_assert_eq!(here.effects, there.effects);
        prop_assert_eq!(here.agent, there.agent);
    }

    #[test]
    fn the_same_events_have_the_same_effects(world in any_world()) {
        prop_assert_eq!(world.run(), world.run());
    }

    /// The second pass is the last in which both ways have seen the same.
    #[test]
    fn an_answer_infers_some_of_the_unasked_again(world in any_world()) {
        let passes = |reinference| -> Vec<BTreeSet<ObjectId>> {
            let settings = AgentSettings { reinference, max_questions: 2, ..world.settings.clone() };
            let trace = World { settings, ..world.clone() }.run();
            let inferred = trace.effects.into_iter().flatten().filter_map(|effect| match effect {
                Effect::Infer { objects } => Some(objects.into_iter().collect()),
                _ => None,
            });
            inferred.collect()
        };
        let (changed, every) = (passes(Reinference::AnsweredContext), passes(Reinference::EveryUnasked));
        prop_assert_eq!(changed.first(), every.first());
        prop_assert!(changed.len() <= every.len());
        for (some, all) in changed.iter().zip(&every) {
            prop_assert!(some.is_subset(all));
        }
    }
}
