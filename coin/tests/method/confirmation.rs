//! Answers that may be wrong: which are asked about again, and how answers move the threshold of the adaptive gate.

use coin::agent::AgentSettings;
use coin::conformal::Level;
use coin::evidence::DOUBTFUL;
use coin_schemas::report::{Gate, Stopped};
use rstest::rstest;

use crate::run::{Run, ask, finish, infer, owned_by, owned_by_a_stranger, unresolved, with_gate};
use crate::support::set;

/// The first one's by two to one, perhaps also the second one's, hardly the third one's.
const RATHER_HIS: &[f64] = &[0.5, 0.2, 0.001];

/// Nobody in particular.
const OPEN: &[f64] = &[0.5, 0.5, 0.5];

/// The answer that the first of two things is whose nobody would have thought.
fn surprised(gate: Gate) -> (Run, Vec<coin::agent::Effect>) {
    let (mut run, effects) =
        Run::after_first_pass(with_gate(gate), &[("1", RATHER_HIS), ("2", &[1.0, 0.0, 0.0])]);
    assert_eq!(effects.last(), Some(&ask("1")));
    let effects = run.handle(owned_by(&[2]));
    (run, effects)
}

#[test]
fn an_answer_that_everything_speaks_against_is_asked_to_be_confirmed() {
    let (mut run, effects) = surprised(Gate::Risk);
    assert_eq!(effects, [infer(&["2"])]);
    assert!(run.thing("1").trust().unwrap() < DOUBTFUL);
    assert_eq!(run.thing("1").owners(), set(&[2]), "until then it stands");
    assert_eq!(run.pass(&[("2", &[1.0, 0.0, 0.0])]).last(), Some(&ask("1")));
}

#[rstest]
#[case::said_again(owned_by(&[2]), &[2])]
#[case::taken_back(owned_by(&[0]), &[0])]
#[case::not_understood(unresolved(), &[2])]
#[case::declined(coin::agent::Event::Declined, &[2])]
fn what_is_said_then_stands(#[case] reply: coin::agent::Event, #[case] owners: &[usize]) {
    let (mut run, _) = surprised(Gate::Risk);
    run.pass(&[("2", &[1.0, 0.0, 0.0])]);
    assert_eq!(run.handle(reply), [infer(&["2"])]);
    assert_eq!(run.pass(&[("2", &[1.0, 0.0, 0.0])]).last(), Some(&finish(Stopped::Confident)));
    assert_eq!(run.thing("1").owners(), set(owners));
    assert_eq!(run.agent.questions(), 2);
}

#[test]
fn an_answer_that_was_likely_is_taken_as_it_is() {
    let (mut run, _) = Run::after_first_pass(with_gate(Gate::Risk), &[("1", OPEN), ("2", &[1.0, 0.0, 0.0])]);
    run.handle(owned_by(&[0, 1]));
    assert!(run.thing("1").trust().unwrap() > 0.8);
    assert_eq!(run.pass(&[("2", &[1.0, 0.0, 0.0])]).last(), Some(&finish(Stopped::Confident)));
}

#[test]
fn nothing_is_known_of_strangers_to_doubt_their_things() {
    let (mut run, _) = Run::after_first_pass(with_gate(Gate::Risk), &[("1", RATHER_HIS)]);
    assert_eq!(run.handle(owned_by_a_stranger()), [finish(Stopped::Confident)]);
    assert_eq!(run.thing("1").trust(), Some(1.0));
}

#[test]
fn the_papers_gate_takes_every_answer_as_it_is() {
    let (mut run, effects) = Run::after_first_pass(with_gate(Gate::Paper), &[("1", RATHER_HIS)]);
    assert_eq!(effects.last(), Some(&ask("1")));
    assert_eq!(run.handle(owned_by(&[2])), [finish(Stopped::Confident)]);
}

mod adaptive {
    use super::*;

    /// Nine of ten things are as sure as this; the risk gate settles them from .8 on.
    const SETTLED_BY_RISK: &[f64] = &[0.95, 0.01, 0.01];

    fn settings(risk: f64) -> AgentSettings {
        AgentSettings { risk: Level::new(risk).unwrap(), ..with_gate(Gate::Adaptive) }
    }

    /// How many questions a home of ten things takes, the first three of which are in doubt, where a person answers so.
    fn questions(risk: f64, answers: impl Fn(&str) -> coin::agent::Event) -> usize {
        let names: Vec<String> = (0..10).map(|thing| thing.to_string()).collect();
        let scores = |name: &str| if name < "3" { RATHER_HIS } else { SETTLED_BY_RISK };
        let things: Vec<(&str, &[f64])> = names.iter().map(|name| (name.as_str(), scores(name))).collect();
        let (mut run, mut effects) = Run::after_first_pass(settings(risk), &things);
        loop {
            match effects.last() {
                Some(coin::agent::Effect::Ask { object }) => effects = run.handle(answers(object.as_str())),
                Some(coin::agent::Effect::Infer { objects }) => {
                    let again: Vec<(&str, &[f64])> =
                        objects.iter().map(|object| (object.as_str(), scores(object.as_str()))).collect();
                    effects = run.pass(&again);
                }
                _ => return run.agent.questions(),
            }
        }
    }

    #[test]
    fn errors_make_it_ask_about_what_it_had_settled() {
        let right = questions(0.02, |_| owned_by(&[0]));
        let wrong = questions(0.02, |thing| owned_by(if thing < "3" { &[0, 1] } else { &[0] }));
        assert_eq!(right, 3);
        assert!(wrong > 3, "{wrong}");
    }

    #[test]
    fn it_asks_no_less_than_the_risk_gate_and_the_more_the_less_may_be_wrong() {
        let [loose, middle, strict] = [0.2, 0.005, 0.0005].map(|risk| questions(risk, |_| owned_by(&[0])));
        assert_eq!(loose, 3);
        assert!(loose < middle && middle < strict, "{loose} {middle} {strict}");
    }
}
