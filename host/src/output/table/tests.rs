//! The texts are committed as snapshots; look at them when they change.

use std::collections::BTreeMap;

use coin_schemas::calibration::{Calibration, History, NonconformityScore};
use coin_schemas::household::{
    ClassLabel, ObjectId, Owners, OwnershipBoolean, Score, Scores, Source, UsageType, UserName,
};
use coin_schemas::report::{
    AnswerStatus, Cost, Gate, MetricsReport, MetricsSummary, ObjectReport, Parameters, QuestionReport,
    Scoring, Stopped,
};
use proptest::prelude::*;
use rstest::rstest;

use super::*;
use crate::output::Colour;
use crate::output::conclusions::guarantee;

const FAMILY: [(&str, &str, &str); 3] = [
    ("Bob", "father", "office worker"),
    ("Mary", "mother", "homemaker"),
    ("Tom", "son", "elementary school student"),
];

fn users(people: &[(&str, &str, &str)]) -> Users {
    let known = |text: &str| (!text.is_empty()).then(|| text.to_owned());
    people
        .iter()
        .map(|(name, role, occupation)| {
            let background = Background { role: known(role), occupation: known(occupation) };
            (UserName::new(*name).unwrap(), background)
        })
        .collect()
}

fn owners(names: &str) -> Owners {
    names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
}

fn inferred(id: &str, class: &str, names: &str, confidence: f64) -> ObjectReport {
    ObjectReport {
        id: ObjectId::new(id).unwrap(),
        class: ClassLabel::new(class).unwrap(),
        scores: Scores::new(),
        owners: owners(names),
        source: Source::Inferred,
        prediction_set: owners(names),
        uncertainty: 1.0 - confidence,
        confidence,
        shared: owners(names).len() > 1,
        parts: None,
        problem: None,
        truth: Some(owners(names)),
    }
}

fn answered(id: &str, class: &str, names: &str) -> ObjectReport {
    ObjectReport { source: Source::Answer, uncertainty: 0.0, ..inferred(id, class, names, 1.0) }
}

fn question(step: usize, id: &str, answer: &str, status: AnswerStatus) -> QuestionReport {
    QuestionReport {
        also: Vec::new(),
        step,
        object_id: ObjectId::new(id).unwrap(),
        question: "Whose is it?".to_owned(),
        answer: answer.to_owned(),
        answered_by: None,
        ownership: OwnershipBoolean::new(),
        status,
        uncertainty_before: 0.4,
        prediction_set_before: owners("Bob Tom"),
    }
}

fn metrics(objects: usize, share: f64) -> MetricsSummary {
    MetricsSummary {
        objects,
        subset_accuracy: share,
        mean_jaccard: (share + 1.0) / 2.0,
        micro_precision: share,
        micro_recall: 1.0,
        micro_f1: (share + 1.0) / 2.0,
    }
}

fn calibration() -> Calibration {
    Calibration {
        version: 1,
        episodes: Vec::new(),
        history: Default::default(),
        withheld: Default::default(),
        scoring: Scoring::default(),
        model: "embedded".to_owned(),
        alpha: 0.2,
        alpha_cp: 0.05,
        risk: 0.012,
        score: NonconformityScore::AllOwners,
        samples: 1020,
        households: 30,
        q_alpha: 0.63,
        q_cp: 0.02,
        q_set: 0.41,
        lambda: 0.7132,
        created_with: "coin 0.1.0".to_owned(),
    }
}

/// A run over a family's things in which everything went well but one inference.
fn report() -> Report {
    let mut cup = inferred("12", "cup", "Bob", 0.74);
    cup.prediction_set = owners("Bob Mary");
    cup.truth = Some(owners("Mary"));
    let objects = vec![
        inferred("1", "plate", "Tom", 0.9971),
        answered("2", "drinking glass", "Mary"),
        inferred("3", "remote control", "Bob Mary Tom", 0.94),
        answered("7", "toothpaste", "Bob Mary"),
        cup,
        inferred("13", "marker", "Bob", 1.0),
    ];
    Report {
        episode: "small-house".to_owned(),
        model: "embedded".to_owned(),
        gate: Gate::Risk,
        seed: 1,
        parameters: Parameters {
            reinference: Default::default(),
            withheld: Default::default(),
            scoring: Scoring::default(),
            k_near: 5,
            k_sim: 5,
            sigma: 0.5,
            gamma: 1.0,
            window_days: 365,
            epsilon_min: 0.8,
            epsilon_in: 0.08,
            epsilon_out: 0.2,
            max_questions: 20,
            answers: "simulated".to_owned(),
            risk: None,
            wrong_answers: None,
        },
        calibration: Some(calibration()),
        adapted: None,
        expected_wrong: None,
        objects,
        questions: vec![
            question(1, "2", "Mary's — the others only borrow it.", AnswerStatus::Answered),
            question(2, "7", "Bob and I share it.", AnswerStatus::Answered),
        ],
        curve: Some(Vec::new()),
        metrics: MetricsReport {
            overall: Some(metrics(6, 5.0 / 6.0)),
            by_usage_type: Some(BTreeMap::from([
                (UsageType::SingleUser, metrics(2, 1.0)),
                (UsageType::TemporarySharing, metrics(2, 0.5)),
                (UsageType::MultiUserSharing, metrics(2, 1.0)),
            ])),
            questions: 2,
        },
        cost: Cost {
            remembered_replies: 0,
            model_calls: 21,
            tool_calls: 24,
            prompt_tokens: 0,
            completion_tokens: 0,
            seconds: 0.3141,
        },
        stopped: Stopped::Confident,
    }
}

fn without_truth() -> Report {
    let mut report = report();
    report.curve = None;
    report.metrics.overall = None;
    report.metrics.by_usage_type = None;
    for object in &mut report.objects {
        object.truth = None;
    }
    report
}

/// A language model without a calibration, of which a call failed and whose questions ran out.
fn with_problems() -> Report {
    let mut report = without_truth();
    let mut failed = inferred("14", "scissors", "", 0.0);
    failed.truth = None;
    failed.problem = Some("the model answered three times without any scores: “I cannot say”".to_owned());
    let mut open = inferred("15", "eraser", "Tom", 0.52);
    open.truth = None;
    let mut outside = answered("16", "umbrella", "");
    outside.truth = None;
    report.objects.extend([failed, open, outside]);
    report.model = "openai:gpt-5-mini".to_owned();
    report.calibration = None;
    report.questions.extend([
        question(3, "15", "I don't know whose that is.", AnswerStatus::Unresolved),
        question(4, "16", "It isn't ours; it belongs to a neighbour.", AnswerStatus::Answered),
    ]);
    report.metrics.questions = 4;
    report.parameters.max_questions = 4;
    report.parameters.answers = "terminal".to_owned();
    report.stopped = Stopped::MaxQuestions;
    report.cost = Cost {
        remembered_replies: 0,
        model_calls: 642,
        tool_calls: 1204,
        prompt_tokens: 498_113,
        completion_tokens: 13_593,
        seconds: 625.8,
    };
    report
}

fn with_members(people: &[(&str, &str, &str)]) -> (Report, Users) {
    let mut report = without_truth();
    let all: Vec<&str> = people.iter().map(|(name, _, _)| *name).collect();
    report.objects = vec![
        inferred("desk-1", "standing desk with a drawer", all[0], 0.88),
        inferred("desk-2", "kettle", &all.join(" "), 0.97),
        inferred("desk-3", "whiteboard marker", &all[1..].join(" "), 0.81),
    ];
    for object in &mut report.objects {
        object.truth = None;
    }
    report.objects[0].prediction_set = owners(&all.join(" "));
    report.questions = Vec::new();
    report.metrics.questions = 0;
    (report, users(people))
}

const COUPLE: [(&str, &str, &str); 2] = [("Ann", "", "nurse"), ("Li", "", "")];

const OFFICE: [(&str, &str, &str); 8] = [
    ("Alexandra", "head of the laboratory", "professor of computational linguistics"),
    ("Bo", "assistant", "engineer"),
    ("Chandra", "guest", "mathematician"),
    ("Dmitri", "student", ""),
    ("Eun-ji", "student", ""),
    ("Fatoumata", "student", ""),
    ("Gwendolyn", "office", "secretary"),
    ("Hironobu", "", "engineer"),
];

fn plain(width: u16) -> Style {
    Style { width, colour: Colour::Never }
}

#[rstest]
fn snapshots(#[values(80, 120)] width: u16) {
    let family = users(&FAMILY);
    let (couple, of_two) = with_members(&COUPLE);
    let (office, of_eight) = with_members(&OFFICE);
    let cases = [
        ("with_truth", report(), &family),
        ("without_truth", without_truth(), &family),
        ("with_problems", with_problems(), &family),
        ("two_members", couple, &of_two),
        ("eight_members", office, &of_eight),
    ];
    for (name, report, users) in cases {
        insta::assert_snapshot!(format!("{name}_{width}"), render(&report, users, plain(width)));
    }
}

#[rstest]
#[case(Gate::Risk)]
#[case(Gate::Set)]
#[case(Gate::Paper)]
#[case(Gate::Always)]
#[case(Gate::Never)]
fn guarantees(#[case] gate: Gate) {
    let mut report = report();
    report.gate = gate;
    insta::assert_snapshot!(format!("guarantee_{gate:?}"), guarantee::guarantee(&report));
}

#[test]
fn a_risk_that_no_threshold_keeps_is_said() {
    let mut report = report();
    report.calibration = Some(Calibration { lambda: 2.0, samples: 10, households: 1, ..calibration() });
    insta::assert_snapshot!(guarantee::guarantee(&report), @"no threshold keeps wrong owner sets at 1.2 %, so everything was up for a question (calibrated on 10 things of 1 other home).");
}

#[test]
fn nothing_follows_from_no_data() {
    let mut report = report();
    report.calibration = Some(Calibration { samples: 0, households: 0, ..calibration() });
    insta::assert_snapshot!(
        guarantee::guarantee(&report),
        @"none: the calibration was made from no data. Make one with host calibrate."
    );
}

#[rstest]
#[case::of_another_model(|report: &mut Report| report.model = "gpt-4o".to_owned(), "another model")]
#[case::scored_otherwise(
    |report: &mut Report| report.parameters.scoring.batch = 8,
    "scores of another kind"
)]
#[case::told_less(
    |report: &mut Report| report.parameters.withheld = [coin_schemas::report::Withheld::Usage].into(),
    "told more or less"
)]
#[case::from_the_first_days(
    |report: &mut Report| report.calibration.as_mut().unwrap().history = History::TrainingDays,
    "first days"
)]
#[case::from_this_home(
    |report: &mut Report| report.calibration.as_mut().unwrap().episodes.push("small-house".to_owned()),
    "a home of this name"
)]
fn thresholds_of_something_else_promise_nothing(#[case] change: fn(&mut Report), #[case] reason: &str) {
    let mut report = report();
    change(&mut report);
    let said = guarantee::guarantee(&report);
    assert!(said.starts_with("none: ") && said.contains(reason), "{said}");
}

#[test]
fn a_guarantee_ends_where_the_questions_did() {
    let mut report = report();
    report.gate = Gate::Set;
    report.stopped = Stopped::NothingLeftToAsk;
    let promise = guarantee::guarantee(&report);
    assert!(
        promise.ends_with(" It does not cover what was still up for a question in the end."),
        "{promise}"
    );
}

#[test]
fn only_seconds_differ_between_equal_runs() {
    let family = users(&FAMILY);
    let (mut slow, quick) = (report(), report());
    slow.cost.seconds = 9.5;
    let differing: Vec<(String, String)> = render(&quick, &family, plain(80))
        .lines()
        .zip(render(&slow, &family, plain(80)).lines())
        .filter(|(left, right)| left != right)
        .map(|(left, right)| (left.to_owned(), right.to_owned()))
        .collect();
    let line = |seconds: &str| format!("  effort     21 model calls, 24 tool calls, {seconds} s");
    assert_eq!(differing, [(line("0.31"), line("9.50"))]);
}

#[test]
fn colour_changes_no_character() {
    let family = users(&FAMILY);
    let colourful = render(&report(), &family, Style { width: 100, colour: Colour::Always });
    assert!(colourful.contains("\u{1b}[31m✗\u{1b}[0m Mary"), "{colourful}");
    assert_eq!(console::strip_ansi_codes(&colourful), render(&report(), &family, plain(100)));
}

#[test]
fn what_comes_from_outside_cannot_command_the_terminal() {
    let mut report = with_problems();
    report.episode = "\u{1b}]0;title\u{7}".to_owned();
    report.model = "\u{9b}31m".to_owned();
    report.questions[0].answer = "Mary's\u{1b}[2J\nBob's".to_owned();
    report.objects[6].problem = Some("\u{1b}[1A\r".to_owned());
    let text = render(&report, &users(&FAMILY), plain(80));
    assert!(text.chars().all(|character| character == '\n' || !character.is_control()), "{text}");
}

proptest! {
    #[test]
    fn every_line_fits(
        width in 40u16..=120,
        classes in proptest::collection::vec("[a-z ]{0,20}[a-z]{1,60}", 0..8),
        answer in "([A-Za-z']{1,30} ){1,30}",
        scored in 0.0..=1.0f64,
    ) {
        let mut report = report();
        for (class, object) in classes.iter().zip(&mut report.objects) {
            object.class = ClassLabel::new(class.as_str()).unwrap();
            object.confidence = Score::new(scored).unwrap().value();
        }
        report.questions[0].answer = answer;
        let text = render(&report, &users(&FAMILY), plain(width));
        for line in text.lines() {
            prop_assert!(line.chars().count() <= usize::from(width), "{width}: {line:?}");
            prop_assert_eq!(line.trim_end(), line);
        }
    }
}
