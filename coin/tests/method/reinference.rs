//! Which things are inferred again when only an answer calls for it.

use coin::agent::{AgentSettings, Effect, Event, Reinference};
use coin_schemas::report::Stopped;

use crate::run::{
    Run, SURE, ask, failed, finish, infer, inferred, inferred_seeing, owned_by, owned_by_a_stranger, record,
    the_papers, unresolved,
};

const DOUBTFUL: &[f64] = &[0.6, 0.6];
const MORE_DOUBTFUL: &[f64] = &[0.4, 0.4];

fn answered_context() -> AgentSettings {
    AgentSettings { reinference: Reinference::AnsweredContext, ..the_papers() }
}

/// A run after its first pass. Every thing has its scores and the things it can see.
fn started(things: &[(&str, &[f64], &[&str])]) -> (Run, Vec<Effect>) {
    let objects: Vec<&str> = things.iter().map(|&(object, ..)| object).collect();
    let mut run = Run::new(answered_context(), &objects);
    run.handle(Event::Started);
    let effects = things
        .iter()
        .map(|&(object, scores, related)| run.handle(inferred_seeing(object, scores, related)))
        .last()
        .unwrap();
    (run, effects)
}

#[test]
fn an_answer_reaches_the_things_that_can_see_it() {
    let (mut run, _) = started(&[
        ("1", MORE_DOUBTFUL, &[]),
        ("2", DOUBTFUL, &["1"]),
        ("3", DOUBTFUL, &["2"]),
        ("4", SURE, &["1", "3"]),
    ]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2", "4"])]);
}

#[test]
fn an_answer_that_nothing_can_see_costs_no_inference() {
    let (mut run, _) = started(&[("1", MORE_DOUBTFUL, &[]), ("2", DOUBTFUL, &["3"]), ("3", DOUBTFUL, &[])]);
    assert_eq!(run.handle(owned_by(&[0])), [ask("2")]);
}

#[test]
fn an_unresolved_or_declined_question_changes_nothing_known() {
    for reply in [unresolved(), Event::Declined] {
        let (mut run, _) = started(&[("1", MORE_DOUBTFUL, &[]), ("2", DOUBTFUL, &["1"])]);
        assert_eq!(run.handle(reply), [ask("2")]);
    }
}

#[test]
fn a_stranger_as_the_owner_is_news_too() {
    let (mut run, _) = started(&[("1", MORE_DOUBTFUL, &[]), ("2", DOUBTFUL, &["1"])]);
    assert_eq!(run.handle(owned_by_a_stranger()), [infer(&["2"])]);
}

/// 3 is known by inference from the first pass on, and what it is known for changes: neither is news to 2.
#[test]
fn what_a_model_concluded_is_no_news() {
    let (mut run, _) = started(&[
        ("1", MORE_DOUBTFUL, &[]),
        ("2", DOUBTFUL, &["3"]),
        ("3", SURE, &["1"]),
        ("4", MORE_DOUBTFUL, &[]),
    ]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["3"])]);
    let changed = run.handle(inferred_seeing("3", &[0.0, 1.0], &["1"]));
    assert_eq!(changed, [record(&["3"]), ask("4")]);
    assert_eq!(run.handle(unresolved()), [ask("2")]);
}

#[test]
fn an_answered_thing_is_never_inferred_again() {
    let (mut run, _) = started(&[("1", MORE_DOUBTFUL, &["2"]), ("2", DOUBTFUL, &["1"])]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2"])]);
    run.handle(inferred_seeing("2", DOUBTFUL, &["1"]));
    assert_eq!(run.handle(owned_by(&[0])), [finish(Stopped::Confident)]);
}

/// The belief that is kept still knows what it could see.
#[test]
fn a_failure_in_a_later_pass_leaves_a_thing_open_to_news() {
    let (mut run, _) =
        started(&[("1", MORE_DOUBTFUL, &[]), ("2", MORE_DOUBTFUL, &[]), ("3", DOUBTFUL, &["1", "2"])]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["3"])]);
    assert_eq!(run.handle(failed("3")), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["3"])]);
}

#[test]
fn a_failure_in_the_first_pass_leaves_a_thing_to_the_questions() {
    let mut run = Run::new(answered_context(), &["1", "2"]);
    run.handle(Event::Started);
    run.handle(failed("1"));
    assert_eq!(run.handle(inferred("2", MORE_DOUBTFUL)), [record(&["2"]), ask("1")]);
    assert_eq!(run.handle(unresolved()), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[0])), [ask("1")]);
}

#[test]
fn the_limit_still_comes_before_another_pass() {
    let settings = AgentSettings { max_questions: 1, ..answered_context() };
    let mut run = Run::new(settings, &["1", "2"]);
    run.handle(Event::Started);
    run.handle(inferred_seeing("1", MORE_DOUBTFUL, &["2"]));
    run.handle(inferred_seeing("2", DOUBTFUL, &["1"]));
    assert_eq!(run.handle(owned_by(&[0])), [finish(Stopped::MaxQuestions)]);
}

/// Two answers are taken together; the third is the last and is taken into account before the run ends.
#[test]
fn answers_may_be_taken_together() {
    let settings = AgentSettings { answers_per_pass: 2, ..the_papers() };
    let doubtful: Vec<(&str, &[f64])> = ["1", "2", "3", "4"].map(|object| (object, DOUBTFUL)).into();
    let (mut run, effects) = Run::after_first_pass(settings, &doubtful);
    assert_eq!(effects.last(), Some(&ask("1")));
    assert_eq!(run.handle(owned_by(&[0])), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["3", "4"])]);
    run.handle(inferred("3", MORE_DOUBTFUL));
    run.handle(inferred("4", SURE));
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["4"])]);
    assert_eq!(run.handle(inferred("4", SURE)), [finish(Stopped::Confident)]);
}
