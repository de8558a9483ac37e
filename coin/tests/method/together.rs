//! One question about several alike things.

use coin::agent::{Effect, Event};
use coin_schemas::report::{Gate, Stopped};
use rstest::rstest;

use crate::run::{Run, ask, ask_together, finish, infer, owned_by, unresolved, with_gate};
use crate::support::set;

/// The first one's by four to one; the gate of these tests settles from .8 on.
const RATHER_HIS: &[f64] = &[0.6, 0.1, 0.1];
const SURELY_HIS: &[f64] = &[1.0, 0.0, 0.0];
const SURELY_HERS: &[f64] = &[0.0, 1.0, 0.0];

/// Three pencils in one room and a key; what the agent does once all were judged.
fn three_pencils(third: &[f64]) -> (Run, Vec<Effect>) {
    let mut run = Run::with_alike(with_gate(Gate::Risk), &["1", "2", "3", "key"], &[&["1", "2", "3"]]);
    run.handle(Event::Started);
    let effects = run.pass(&[("1", RATHER_HIS), ("2", RATHER_HIS), ("3", third), ("key", SURELY_HERS)]);
    (run, effects)
}

#[test]
fn a_yes_settles_them_all_with_one_question() {
    let (mut run, effects) = three_pencils(RATHER_HIS);
    assert_eq!(effects.last(), Some(&ask_together(&["1", "2", "3"])));
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["key"])]);
    assert_eq!(run.pass(&[("key", SURELY_HERS)]).last(), Some(&finish(Stopped::Confident)));
    assert_eq!(run.agent.questions(), 1);
    for pencil in ["1", "2", "3"] {
        assert_eq!((run.thing(pencil).owners(), run.thing(pencil).times_asked()), (set(&[0]), 1));
    }
    assert_eq!(run.agent.track_record().wrong, 0);
}

#[test]
fn a_no_leaves_each_to_a_question_of_its_own() {
    let (mut run, _) = three_pencils(RATHER_HIS);
    run.handle(unresolved());
    let all: &[(&str, &[f64])] =
        &[("1", RATHER_HIS), ("2", RATHER_HIS), ("3", RATHER_HIS), ("key", SURELY_HERS)];
    assert_eq!(run.pass(all).last(), Some(&ask("1")));
    assert_eq!(run.thing("1").times_asked(), 0, "nobody has told of it");
    run.handle(owned_by(&[0]));
    assert_eq!(
        run.pass(&all[1..]).last(),
        Some(&ask("2")),
        "the other two are not asked about together again"
    );
}

#[test]
fn who_will_not_say_is_not_asked_about_any_of_them() {
    let (mut run, _) = three_pencils(RATHER_HIS);
    run.handle(Event::Declined);
    let all: &[(&str, &[f64])] =
        &[("1", RATHER_HIS), ("2", RATHER_HIS), ("3", RATHER_HIS), ("key", SURELY_HERS)];
    assert_eq!(run.pass(all).last(), Some(&finish(Stopped::NothingLeftToAsk)));
    assert_eq!(run.agent.questions(), 1);
}

#[rstest]
#[case::the_third_is_known_to_be_his(SURELY_HIS, Some(ask_together(&["1", "2"])))]
#[case::the_third_is_hers(SURELY_HERS, Some(ask("1")))]
fn what_is_not_true_of_all_is_not_asked_of_all(#[case] third: &[f64], #[case] asked: Option<Effect>) {
    let (_, effects) = three_pencils(third);
    assert_eq!(effects.last(), asked.as_ref());
}
