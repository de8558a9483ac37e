//! Algorithm 1 of the paper, line by line, with the paper's gate and every unasked thing inferred again.

use coin::agent::{AgentSettings, Event, Known, KnownSource};
use coin::owners::OwnerSet;
use coin_schemas::report::Stopped;
use rstest::rstest;

use crate::run::{Run, SURE, ask, finish, infer, owned_by, record, the_papers};
use crate::support::{id, scores, set};

#[test]
fn line_01_takes_every_object_once() {
    let mut run = Run::new(the_papers(), &["2", "1", "2"]);
    assert_eq!(run.handle(Event::Started), [infer(&["1", "2"])]);
}

#[test]
fn line_02_starts_without_a_belief_and_without_a_question() {
    let run = Run::new(the_papers(), &["1"]);
    assert_eq!(run.agent.questions(), 0);
    let thing = run.thing("1");
    assert_eq!((thing.scores(), thing.assessment(), thing.answer()), (None, None, None));
    assert_eq!((thing.owners(), thing.known(), thing.times_asked()), (OwnerSet::EMPTY, None, 0));
    assert_eq!(run.agent.object(&id("2")), None);
}

#[test]
fn line_03_goes_round_until_a_break() {
    let (mut run, effects) =
        Run::after_first_pass(the_papers(), &[("1", &[0.6, 0.6]), ("2", &[0.7, 0.0]), ("3", SURE)]);
    assert_eq!(effects, [record(&["1", "2", "3"]), ask("1")]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2", "3"])]);
    // What is believed as before is not stored again.
    assert_eq!(run.pass(&[("2", &[0.7, 0.0]), ("3", SURE)]), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[1])), [infer(&["3"])]);
    assert_eq!(run.pass(&[("3", SURE)]), [finish(Stopped::Confident)]);
    assert_eq!(run.agent.questions(), 2);
}

/// BUILD-KNOWN takes answers, and inferences whose owner set has a probability of at least .9.
#[test]
fn line_04_builds_the_known_from_answers_and_sure_inferences() {
    let (mut run, _) = Run::after_first_pass(
        the_papers(),
        &[("asked", &[0.4, 0.4]), ("sure", &[0.0, 0.95]), ("at", &[1.0, 0.1]), ("below", &[1.0, 0.11])],
    );
    assert_eq!(run.thing("asked").known(), None);
    run.handle(owned_by(&[0, 1]));
    let known = |object| run.thing(object).known();
    let inferred = |owners| Some(Known { owners, source: KnownSource::Inferred });
    assert_eq!(known("asked"), Some(Known { owners: set(&[0, 1]), source: KnownSource::Answered }));
    assert_eq!(known("sure"), inferred(set(&[1])));
    assert_eq!(known("at"), inferred(set(&[0])));
    assert_eq!(known("below"), None);
}

#[test]
fn line_05_infers_every_object_that_nobody_was_asked_about() {
    let mut run = Run::new(the_papers(), &["10", "9", "cup", "2"]);
    assert_eq!(run.handle(Event::Started), [infer(&["2", "9", "10", "cup"])]);
    let effects = run.pass(&[("cup", SURE), ("9", &[0.6, 0.0]), ("10", SURE), ("2", SURE)]);
    assert_eq!(
        effects,
        [record(&["2", "9", "10", "cup"]), ask("9")],
        "in the order of ids, however they came in"
    );
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2", "10", "cup"])], "sure ones too");
}

/// Gathering the context of line 6 is the driver's part: the agent waits until every result is there.
#[test]
fn line_06_and_07_wait_for_the_scores_of_the_whole_pass() {
    let mut run = Run::new(the_papers(), &["1", "2"]);
    run.handle(Event::Started);
    assert_eq!(run.handle(crate::run::inferred("2", &[0.6, 0.0])), []);
    assert_eq!(run.thing("2").scores(), None, "the state of the last pass holds until this one is complete");
    assert_eq!(run.handle(crate::run::inferred("1", SURE)), [record(&["1", "2"]), ask("2")]);
}

#[rstest]
#[case::one_owner(&[0.9, 0.3, 0.2], &[0], false)]
#[case::two_share(&[0.9, 0.1, 0.85], &[0, 2], true)]
#[case::no_clear_gap(&[0.9, 0.7, 0.85], &[0], false)]
fn line_08_detects_shared_owners(#[case] scores: &[f64], #[case] owners: &[usize], #[case] shared: bool) {
    let (run, _) = Run::after_first_pass(the_papers(), &[("1", scores)]);
    assert_eq!(run.thing("1").owners(), set(owners));
    assert_eq!(run.thing("1").assessment().map(|thought| thought.shared), Some(shared));
}

#[test]
fn line_09_replaces_the_belief_of_the_last_pass_and_has_it_stored() {
    let (mut run, _) = Run::after_first_pass(the_papers(), &[("1", &[0.6, 0.6]), ("2", &[0.7, 0.0])]);
    assert_eq!(run.thing("2").scores(), Some(scores(&[0.7, 0.0]).as_slice()));
    run.handle(owned_by(&[1]));
    assert_eq!(run.pass(&[("2", &[0.0, 1.0])])[0], record(&["2"]));
    assert_eq!(run.thing("2").scores(), Some(scores(&[0.0, 1.0]).as_slice()));
    assert_eq!(run.thing("2").owners(), set(&[1]));
}

/// Γ = {u : s_u ≥ 1 − q_α} with q_α = .5, and cp_s = 1 − its mean score.
#[rstest]
#[case::at_the_threshold(&[0.5, 0.49], &[0], 0.5)]
#[case::both(&[0.75, 0.5], &[0, 1], 0.375)]
#[case::nobody(&[0.49, 0.25], &[], 1.0)]
fn line_11_and_12_make_the_prediction_set_and_its_uncertainty(
    #[case] scores: &[f64],
    #[case] gamma: &[usize],
    #[case] uncertainty: f64,
) {
    let (run, _) = Run::after_first_pass(the_papers(), &[("1", scores)]);
    let thought = run.thing("1").assessment().unwrap();
    assert_eq!(thought.prediction_set, set(gamma));
    assert!((thought.uncertainty - uncertainty).abs() < 1e-15);
}

#[test]
fn line_13_and_14_break_when_every_uncertainty_is_within_the_threshold() {
    let (_, effects) = Run::after_first_pass(the_papers(), &[("1", SURE), ("2", &[0.0, 0.9])]);
    assert_eq!(effects, [record(&["1", "2"]), finish(Stopped::Confident)]);
}

#[test]
fn line_13_goes_on_for_a_single_object_beyond_the_threshold() {
    let (_, effects) = Run::after_first_pass(the_papers(), &[("1", SURE), ("2", &[0.0, 0.89])]);
    assert_eq!(effects, [record(&["1", "2"]), ask("2")]);
}

/// An asked object has no cp_s any more: the last answer ends the run.
#[test]
fn line_13_looks_at_unasked_objects_alone() {
    let (mut run, _) = Run::after_first_pass(the_papers(), &[("1", &[0.4, 0.4])]);
    assert_eq!(run.handle(owned_by(&[1])), [finish(Stopped::Confident)]);
}

/// The largest cp_s; where equal, the larger Γ; where that is equal too, the lower id, numbers by value.
#[rstest]
#[case::largest_uncertainty(&[("1", [0.7, 0.0]), ("2", [0.6, 0.0]), ("3", [0.8, 0.0])], "2")]
#[case::an_empty_prediction_set(&[("1", [0.5, 0.5]), ("2", [0.4, 0.4])], "2")]
#[case::larger_prediction_set(&[("1", [0.75, 0.0]), ("2", [0.75, 0.75])], "2")]
#[case::lower_number(&[("10", [0.75, 0.0]), ("9", [0.0, 0.75])], "9")]
#[case::number_before_text(&[("cup", [0.75, 0.0]), ("9", [0.75, 0.0])], "9")]
#[case::lower_text(&[("cup", [0.75, 0.0]), ("bag", [0.75, 0.0])], "bag")]
fn line_16_takes_the_most_uncertain_object(#[case] things: &[(&str, [f64; 2])], #[case] first: &str) {
    let things: Vec<(&str, &[f64])> =
        things.iter().map(|(object, scores)| (*object, scores.as_slice())).collect();
    let (_, effects) = Run::after_first_pass(the_papers(), &things);
    assert_eq!(effects.last(), Some(&ask(first)));
}

#[test]
fn line_17_asks_one_question_at_a_time() {
    let (mut run, effects) = Run::after_first_pass(the_papers(), &[("1", &[0.6, 0.0]), ("2", &[0.6, 0.0])]);
    assert_eq!(effects, [record(&["1", "2"]), ask("1")]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2"])], "not the second question yet");
}

#[test]
fn line_18_and_19_take_the_answer_for_the_truth() {
    let (mut run, _) = Run::after_first_pass(the_papers(), &[("1", &[0.6, 0.0, 0.0]), ("2", SURE_OF_THREE)]);
    run.handle(owned_by(&[1, 2]));
    let thing = run.thing("1");
    assert_eq!(thing.owners(), set(&[1, 2]), "whatever the scores say");
    assert_eq!(thing.answer().map(|reading| reading.owners), Some(set(&[1, 2])));
    assert_eq!(thing.times_asked(), 1);
}

const SURE_OF_THREE: &[f64] = &[0.0, 1.0, 0.0];

#[test]
fn line_20_counts_the_question() {
    let (mut run, _) = Run::after_first_pass(the_papers(), &[("1", &[0.6, 0.0])]);
    assert_eq!(run.agent.questions(), 0, "asked, not yet answered");
    run.handle(owned_by(&[0]));
    assert_eq!(run.agent.questions(), 1);
}

#[test]
fn line_21_and_22_break_at_the_limit_without_another_pass() {
    let settings = AgentSettings { max_questions: 1, ..the_papers() };
    let (mut run, _) = Run::after_first_pass(settings, &[("1", &[0.6, 0.0]), ("2", &[0.7, 0.0])]);
    assert_eq!(run.handle(owned_by(&[1])), [finish(Stopped::MaxQuestions)]);
    assert_eq!(run.thing("1").owners(), set(&[1]), "the last answer counts");
}

/// Line 13 comes before line 21 in the next round, line 21 before line 13 in this one.
#[test]
fn line_22_comes_before_the_gate() {
    let settings = AgentSettings { max_questions: 1, ..the_papers() };
    let (mut run, _) = Run::after_first_pass(settings, &[("1", &[0.6, 0.0]), ("2", SURE)]);
    assert_eq!(run.handle(owned_by(&[0])), [finish(Stopped::MaxQuestions)]);
}

#[test]
fn line_24_goes_round_below_the_limit() {
    let settings = AgentSettings { max_questions: 2, ..the_papers() };
    let (mut run, _) = Run::after_first_pass(settings, &[("1", &[0.6, 0.0]), ("2", &[0.7, 0.0])]);
    assert_eq!(run.handle(owned_by(&[0])), [infer(&["2"])]);
    assert_eq!(run.pass(&[("2", &[0.7, 0.0])]), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[0])), [finish(Stopped::MaxQuestions)]);
}

#[test]
fn no_objects_leave_nothing_to_do() {
    assert_eq!(Run::new(the_papers(), &[]).handle(Event::Started), [finish(Stopped::Confident)]);
}

/// A belief that moves too little to be told on the way is stored when the run ends.
#[test]
fn what_moved_a_little_is_stored_in_the_end() {
    let settings = AgentSettings { max_questions: 1, ..the_papers() };
    let (mut run, _) = Run::after_first_pass(settings.clone(), &[("1", &[0.6, 0.0]), ("2", &[0.95, 0.0])]);
    assert_eq!(run.handle(owned_by(&[0])), [finish(Stopped::MaxQuestions)]);
    let settings = AgentSettings { max_questions: 2, ..settings };
    let (mut run, _) =
        Run::after_first_pass(settings, &[("1", &[0.6, 0.0]), ("2", &[0.7, 0.0]), ("3", SURE)]);
    run.handle(owned_by(&[0]));
    assert_eq!(run.pass(&[("2", &[0.701, 0.0]), ("3", SURE)]), [ask("2")]);
    assert_eq!(run.handle(owned_by(&[0])), [record(&["2"]), finish(Stopped::MaxQuestions)]);
}
