//! What the paper does not tell: people who do not know, will not say or are not there, models that fail, gates
//! beside the paper's, and events out of place.

use coin::agent::{AgentSettings, Event, Known, KnownSource, UnexpectedEvent};
use coin::calibration::Thresholds;
use coin::owners::OwnerSet;
use coin_schemas::report::{Gate, Stopped};
use rstest::rstest;

use crate::run::{
    Run, SURE, ask, failed, finish, infer, inferred, owned_by, owned_by_a_stranger, record, the_papers,
    unresolved, with_gate,
};
use crate::support::{id, set};

const DOUBTFUL: &[f64] = &[0.6, 0.6];

/// Two things of which nothing is sure; the first is asked about.
fn two_doubtful(settings: AgentSettings) -> Run {
    let (run, effects) = Run::after_first_pass(settings, &[("1", DOUBTFUL), ("2", DOUBTFUL)]);
    assert_eq!(effects.last(), Some(&ask("1")));
    run
}

mod answers {
    use super::*;

    #[test]
    fn an_unresolved_one_comes_again_after_the_other_things_and_once_only() {
        let mut run = two_doubtful(the_papers());
        let both: &[(&str, &[f64])] = &[("1", &[0.4, 0.4]), ("2", DOUBTFUL)];
        assert_eq!(run.handle(unresolved()), [infer(&["1", "2"])]);
        assert_eq!(run.pass(both).last(), Some(&ask("2")), "though 1 is more uncertain");
        run.handle(unresolved());
        assert_eq!(run.pass(both).last(), Some(&ask("1")));
        run.handle(unresolved());
        assert_eq!(run.pass(both).last(), Some(&ask("2")));
        run.handle(unresolved());
        assert_eq!(run.pass(both).last(), Some(&finish(Stopped::NothingLeftToAsk)));
        assert_eq!(run.agent.questions(), 4);
        assert_eq!((run.thing("1").times_asked(), run.thing("1").answer()), (2, None));
    }

    #[test]
    fn the_second_one_settles_what_the_first_left_open() {
        let mut run = two_doubtful(the_papers());
        run.handle(unresolved());
        run.pass(&[("1", DOUBTFUL), ("2", SURE)]);
        assert_eq!(run.handle(owned_by(&[1])), [infer(&["2"])]);
        assert_eq!(run.pass(&[("2", SURE)]).last(), Some(&finish(Stopped::Confident)));
        assert_eq!(run.thing("1").owners(), set(&[1]));
    }

    #[test]
    fn a_thing_of_a_stranger_is_settled_and_known_as_such() {
        let mut run = two_doubtful(the_papers());
        assert_eq!(run.handle(owned_by_a_stranger()), [infer(&["2"])]);
        assert_eq!(run.thing("1").owners(), OwnerSet::EMPTY);
        let known = Known { owners: OwnerSet::EMPTY, source: KnownSource::Answered };
        assert_eq!(run.thing("1").known(), Some(known));
    }

    #[test]
    fn a_declined_question_is_counted_and_never_put_again() {
        let mut run = two_doubtful(the_papers());
        assert_eq!(run.handle(Event::Declined), [infer(&["1", "2"])]);
        assert_eq!(run.agent.questions(), 1);
        assert_eq!(run.pass(&[("1", &[0.4, 0.4]), ("2", DOUBTFUL)]).last(), Some(&ask("2")));
        run.handle(owned_by(&[0]));
        assert_eq!(run.pass(&[("1", &[0.4, 0.4])]).last(), Some(&finish(Stopped::NothingLeftToAsk)));
        assert_eq!(run.thing("1").times_asked(), 1);
    }

    #[test]
    fn with_nobody_left_the_run_is_over_and_no_question_counted() {
        let mut run = two_doubtful(the_papers());
        assert_eq!(run.handle(Event::NobodyLeft), [finish(Stopped::NothingLeftToAsk)]);
        assert_eq!(run.agent.questions(), 0);
        assert_eq!(run.thing("1").times_asked(), 0);
    }

    #[rstest]
    fn every_kind_uses_up_the_limit(#[values(unresolved(), Event::Declined, owned_by(&[0]))] reply: Event) {
        let mut run = two_doubtful(AgentSettings { max_questions: 1, ..the_papers() });
        assert_eq!(run.handle(reply), [finish(Stopped::MaxQuestions)]);
    }

    #[rstest]
    #[case::something_to_ask(DOUBTFUL, Stopped::MaxQuestions)]
    #[case::nothing_to_ask(SURE, Stopped::Confident)]
    fn a_limit_of_zero_asks_nothing(#[case] scores: &[f64], #[case] stopped: Stopped) {
        let settings = AgentSettings { max_questions: 0, ..the_papers() };
        let (_, effects) = Run::after_first_pass(settings, &[("1", scores)]);
        assert_eq!(effects, [record(&["1"]), finish(stopped)]);
    }
}

mod failures {
    use super::*;

    /// Nothing is believed of the first: it is asked about before anything that is only uncertain.
    #[test]
    fn in_the_first_pass_leave_a_thing_to_the_questions() {
        let mut run = Run::new(the_papers(), &["1", "2"]);
        run.handle(Event::Started);
        run.handle(inferred("1", &[0.4, 0.4]));
        assert_eq!(run.handle(failed("2")), [record(&["1"]), ask("2")]);
        assert_eq!(run.thing("2").problem(), Some("the model is out of reach"));
        assert_eq!((run.thing("2").owners(), run.thing("2").known()), (OwnerSet::EMPTY, None));
    }

    #[test]
    fn of_every_thing_store_nothing_and_go_by_id() {
        let mut run = Run::new(the_papers(), &["10", "9"]);
        run.handle(Event::Started);
        run.handle(failed("9"));
        assert_eq!(run.handle(failed("10")), [ask("9")]);
    }

    #[test]
    fn in_a_later_pass_keep_the_belief() {
        let mut run = two_doubtful(the_papers());
        run.handle(owned_by(&[0]));
        let before = run.thing("2").clone();
        assert_eq!(run.handle(failed("2")), [ask("2")], "no belief is new, so nothing is stored");
        assert_eq!(run.thing("2").scores(), before.scores());
        assert_eq!(run.thing("2").assessment(), before.assessment());
        assert_eq!(run.thing("2").problem(), Some("the model is out of reach"));
    }

    #[test]
    fn are_forgotten_after_a_success() {
        let mut run = Run::new(the_papers(), &["1", "2"]);
        run.handle(Event::Started);
        run.handle(failed("1"));
        assert_eq!(run.handle(inferred("2", DOUBTFUL)).last(), Some(&ask("1")));
        run.handle(unresolved());
        run.pass(&[("1", SURE), ("2", DOUBTFUL)]);
        assert_eq!(run.thing("1").problem(), None);
        assert_eq!(run.thing("1").owners(), set(&[0]));
    }

    #[rstest]
    #[case(Gate::Risk, ask("1"))]
    #[case(Gate::Set, ask("1"))]
    #[case(Gate::Paper, ask("1"))]
    #[case(Gate::Always, ask("1"))]
    #[case(Gate::Never, finish(Stopped::Confident))]
    fn leave_every_gate_but_one_a_question(#[case] gate: Gate, #[case] expected: coin::agent::Effect) {
        for thresholds in [crate::run::CALIBRATED, Thresholds::Uncalibrated] {
            let mut run = Run::new(AgentSettings { thresholds, ..with_gate(gate) }, &["1"]);
            run.handle(Event::Started);
            assert_eq!(run.handle(failed("1")), std::slice::from_ref(&expected));
        }
    }
}

mod gates {
    use super::*;

    /// cp_s is .1, .2 and .29. conf is 1, 1 and .55, because scores of 0 leave one owner set alone; ties go by id.
    const THREE: &[(&str, &[f64])] = &[("sure", &[0.9, 0.0]), ("at", &[0.8, 0.0]), ("two", &[0.72, 0.7])];

    fn asked(settings: AgentSettings, things: &[(&str, &[f64])]) -> Vec<String> {
        let (mut run, mut effects) = Run::after_first_pass(settings, things);
        let mut order = Vec::new();
        while let Some(coin::agent::Effect::Ask { object }) = effects.last() {
            order.push(object.to_string());
            effects = run.handle(owned_by(&[0]));
            let open: Vec<(&str, &[f64])> = things
                .iter()
                .filter(|&&(thing, _)| !order.iter().any(|asked| asked == thing))
                .copied()
                .collect();
            if !open.is_empty() {
                effects = run.pass(&open);
            }
        }
        order
    }

    #[rstest]
    #[case::risk(Gate::Risk, &["two"])]
    #[case::paper(Gate::Paper, &["two", "at"])]
    #[case::always(Gate::Always, &["two", "at", "sure"])]
    #[case::never(Gate::Never, &[])]
    fn ask_what_they_say(#[case] gate: Gate, #[case] expected: &[&str]) {
        assert_eq!(asked(with_gate(gate), THREE), expected);
    }

    /// q_set = .5: owner sets of at least .5. The third has none, the fourth one and the fifth two.
    #[test]
    fn over_sets_ask_where_not_exactly_one_is_left() {
        let things: &[(&str, &[f64])] =
            &[("none", &[0.6, 0.7]), ("one", &[0.9, 0.2]), ("two", &[1.0, 0.5]), ("sure", &[1.0, 0.0])];
        assert_eq!(asked(with_gate(Gate::Set), things), ["none", "two"]);
    }

    #[rstest]
    fn without_calibration_ask_below_a_fixed_confidence(#[values(Gate::Risk, Gate::Set)] gate: Gate) {
        let settings = AgentSettings { thresholds: Thresholds::Uncalibrated, ..with_gate(gate) };
        let things: &[(&str, &[f64])] =
            &[("below", &[0.94, 0.94]), ("above", &[0.98, 0.98]), ("low", &[0.5, 0.5])];
        assert_eq!(asked(settings, things), ["low", "below"]);
    }

    /// The paper's gate decides by DETECT-SHARE, the others by the most probable set.
    #[rstest]
    #[case(Gate::Paper, &[0])]
    #[case(Gate::Risk, &[0, 1])]
    #[case(Gate::Set, &[0, 1])]
    #[case(Gate::Always, &[0, 1])]
    #[case(Gate::Never, &[0, 1])]
    fn differ_in_the_owner_set(#[case] gate: Gate, #[case] owners: &[usize]) {
        let (run, _) = Run::after_first_pass(with_gate(gate), &[("1", &[0.9, 0.7])]);
        assert_eq!(run.thing("1").owners(), set(owners));
    }
}

mod out_of_place {
    use super::*;

    fn assert_refused(run: &Run, event: Event, expected: &UnexpectedEvent, text: &str) {
        let mut tried = run.clone();
        let refused = tried.agent.handle(event).unwrap_err();
        assert_eq!(&refused, expected);
        assert_eq!(refused.to_string(), text);
        assert_eq!(tried.agent, run.agent, "a refused event changes nothing");
    }

    fn assert_not_inferring(run: &Run, object: &str) {
        let expected = UnexpectedEvent::NotInferring { object: id(object) };
        let text = format!("no inference of thing {object} is under way");
        assert_refused(run, inferred(object, SURE), &expected, &text);
        assert_refused(run, failed(object), &expected, &text);
    }

    fn assert_not_asking(run: &Run) {
        for reply in [owned_by(&[0]), unresolved(), Event::Declined, Event::NobodyLeft] {
            assert_refused(run, reply, &UnexpectedEvent::NotAsking, "no question is open");
        }
    }

    fn assert_started(run: &Run) {
        let text = "the run has already started";
        assert_refused(run, Event::Started, &UnexpectedEvent::AlreadyStarted, text);
    }

    #[test]
    fn before_the_start() {
        let run = Run::new(the_papers(), &["1"]);
        assert_not_inferring(&run, "1");
        assert_not_asking(&run);
    }

    #[test]
    fn while_a_pass_is_under_way() {
        let mut run = Run::new(the_papers(), &["1", "2"]);
        run.handle(Event::Started);
        run.handle(inferred("1", SURE));
        assert_started(&run);
        assert_not_inferring(&run, "1");
        assert_not_inferring(&run, "a-stranger");
        assert_not_asking(&run);
    }

    #[test]
    fn while_a_question_is_open() {
        let run = two_doubtful(the_papers());
        assert_started(&run);
        assert_not_inferring(&run, "2");
    }

    #[test]
    fn for_a_thing_that_was_answered() {
        let mut run = two_doubtful(the_papers());
        run.handle(owned_by(&[0]));
        assert_not_inferring(&run, "1");
    }

    #[test]
    fn after_the_end() {
        let (run, effects) = Run::after_first_pass(the_papers(), &[("1", SURE)]);
        assert_eq!(effects.last(), Some(&finish(Stopped::Confident)));
        assert_started(&run);
        assert_not_inferring(&run, "1");
        assert_not_asking(&run);
    }
}

mod an_end_from_outside {
    use super::*;

    #[test]
    fn keeps_what_a_pass_has_brought_so_far() {
        let mut run = Run::new(the_papers(), &["1", "2"]);
        run.handle(Event::Started);
        run.handle(inferred("2", SURE));
        assert_eq!(run.handle(ended()), [record(&["2"]), finish(Stopped::Interrupted)]);
        assert_eq!(run.thing("2").owners(), set(&[0]));
        assert_eq!(run.thing("1").scores(), None);
    }

    #[test]
    fn leaves_an_open_question_open() {
        let mut run = two_doubtful(the_papers());
        assert_eq!(run.handle(ended()), [finish(Stopped::Interrupted)]);
        assert_eq!((run.agent.questions(), run.thing("1").times_asked()), (0, 0));
    }

    #[test]
    fn is_nothing_to_a_run_that_is_over() {
        let mut run = two_doubtful(the_papers());
        run.handle(ended());
        assert_eq!(run.handle(ended()), []);
    }

    fn ended() -> Event {
        Event::Ended { stopped: Stopped::Interrupted }
    }
}
