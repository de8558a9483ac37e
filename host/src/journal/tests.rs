//! What a journal gives back, whatever became of its file.

use std::fs;

use coin_schemas::household::{Background, Score, UserName};
use coin_schemas::report::{AnswerStatus, Estimator, Gate, Reinference, Scoring};
use proptest::prelude::*;
use rstest::rstest;
use tempfile::TempDir;

use super::*;

fn roster() -> Roster {
    let users = ["Bob", "Mary", "Zoë"].map(|name| (UserName::new(name).unwrap(), Background::default()));
    Roster::new(&users.into_iter().collect()).unwrap()
}

fn thing(id: &str) -> ObjectId {
    ObjectId::new(id).unwrap()
}

fn heading() -> JournalHeading {
    JournalHeading {
        version: JOURNAL_VERSION,
        episode: "home".to_owned(),
        now: "2025-01-19T23:00:00".parse().unwrap(),
        users: roster().names().cloned().collect(),
        objects: vec![thing("1"), thing("2")],
        answered: BTreeMap::new(),
        model: "embedded".to_owned(),
        gate: Gate::Risk,
        lambda: Some(0.7),
        risk: None,
        seed: 0,
        reinference: Reinference::default(),
        withheld: Vec::new(),
        scoring: Scoring::default(),
        answers: "terminal".to_owned(),
    }
}

fn inference(values: [f64; 3]) -> Inference {
    let scores = values.map(|value| Score::new(value).unwrap()).to_vec();
    let distribution = OwnerSetDistribution::from_scores(&scores);
    Inference { scores, distribution, related: [thing("2")].into(), ..Inference::default() }
}

fn question(object: &str) -> QuestionReport {
    QuestionReport {
        also: Vec::new(),
        step: 1,
        object_id: thing(object),
        question: "Whose is it?".to_owned(),
        answer: "Zoë's".to_owned(),
        answered_by: None,
        ownership: roster().names().map(|name| (name.clone(), name.as_str() == "Zoë")).collect(),
        status: AnswerStatus::Answered,
        uncertainty_before: 0.5,
        prediction_set_before: roster().names().cloned().collect(),
    }
}

fn begin(db: &Path) -> Journal {
    Journal::open(db, Beginning::Anew, &mut heading(), &roster()).unwrap()
}

fn go_on(db: &Path) -> Result<Journal, JournalError> {
    Journal::open(db, Beginning::WhereItEnded, &mut heading(), &roster())
}

fn db(folder: &TempDir) -> PathBuf {
    folder.path().join("home.db")
}

#[test]
fn a_run_is_told_again_pass_by_pass() {
    let folder = TempDir::new().unwrap();
    let mut journal = begin(&db(&folder));
    journal.inferred(&thing("1"), &inference([0.9, 0.1, 0.2]), &roster()).unwrap();
    journal.answered(&question("1"), false).unwrap();
    journal.inferred(&thing("2"), &inference([0.3, 0.1, 0.2]), &roster()).unwrap();
    drop(journal);
    let mut journal = go_on(&db(&folder)).unwrap();
    assert_eq!(journal.past_inference(&thing("1")), Some(inference([0.9, 0.1, 0.2])));
    assert_eq!(journal.past_inference(&thing("2")), None, "it belongs to the pass after the question");
    let answered = PastQuestion::Answered {
        question: question("1"),
        recorded: Recorded::Surely,
        owner_outside_household: false,
    };
    assert_eq!(journal.past_question(&thing("1"), &[]), Some(answered));
    assert_eq!(journal.past_inference(&thing("2")), Some(inference([0.3, 0.1, 0.2])));
    assert_eq!(journal.past_question(&thing("2"), &[]), None);
}

/// Between the journal and the database a run may end.
#[test]
fn an_answer_that_comes_last_may_not_have_been_recorded() {
    let folder = TempDir::new().unwrap();
    begin(&db(&folder)).answered(&question("1"), false).unwrap();
    let past = go_on(&db(&folder)).unwrap().past_question(&thing("1"), &[]);
    assert!(matches!(past, Some(PastQuestion::Answered { recorded: Recorded::Perhaps, .. })), "{past:?}");
}

#[test]
fn what_was_taken_back_is_not_told_again() {
    let folder = TempDir::new().unwrap();
    let mut journal = begin(&db(&folder));
    journal.inferred(&thing("1"), &inference([0.9, 0.1, 0.2]), &roster()).unwrap();
    journal.answered(&question("1"), false).unwrap();
    journal.inferred(&thing("2"), &inference([0.3, 0.1, 0.2]), &roster()).unwrap();
    journal.undone().unwrap();
    drop(journal);
    let mut journal = go_on(&db(&folder)).unwrap();
    assert_eq!(journal.withdrawn(), [thing("1")], "the database may still know the answer");
    assert!(journal.past_inference(&thing("1")).is_some());
    assert_eq!(journal.past_inference(&thing("2")), None);
    assert_eq!(journal.past_question(&thing("1"), &[]), None);
    journal.answered(&question("1"), false).unwrap();
    drop(journal);
    assert_eq!(go_on(&db(&folder)).unwrap().withdrawn(), [], "it was answered anew");
}

/// A crash may tear the last line at any byte, also within a letter.
#[test]
fn a_torn_line_is_cut_off_wherever_it_is_torn() {
    let folder = TempDir::new().unwrap();
    let mut journal = begin(&db(&folder));
    journal.inferred(&thing("1"), &inference([0.9, 0.1, 0.2]), &roster()).unwrap();
    let whole = fs::read(beside(&db(&folder))).unwrap();
    journal.answered(&question("1"), false).unwrap();
    drop(journal);
    let with_answer = fs::read(beside(&db(&folder))).unwrap();
    let letter = with_answer.iter().rposition(|&byte| byte == "ë".as_bytes()[1]).unwrap();
    for end in [whole.len(), whole.len() + 1, letter, with_answer.len() - 1] {
        fs::write(beside(&db(&folder)), &with_answer[..end]).unwrap();
        assert!(go_on(&db(&folder)).unwrap().past_inference(&thing("1")).is_some(), "{end} bytes");
        assert_eq!(fs::read(beside(&db(&folder))).unwrap(), whole, "{end} bytes");
    }
}

#[test]
fn two_runs_do_not_write_one_journal() {
    let folder = TempDir::new().unwrap();
    let _under_way = begin(&db(&folder));
    let error = go_on(&db(&folder)).unwrap_err().to_string();
    assert!(error.starts_with("another run is under way with this database"), "{error}");
}

#[test]
fn a_damaged_line_is_named() {
    let folder = TempDir::new().unwrap();
    drop(begin(&db(&folder)));
    let mut text = fs::read_to_string(beside(&db(&folder))).unwrap();
    text.push_str("{\"entry\": \"unheard of\"}\n");
    fs::write(beside(&db(&folder)), text).unwrap();
    let error = go_on(&db(&folder)).unwrap_err().to_string();
    assert!(error.contains("home.db.run.jsonl, line 2") && error.contains("--resume"), "{error}");
}

#[rstest]
#[case(|heading: &mut JournalHeading| heading.model = "openai:other".to_owned(), "its model was embedded")]
#[case(|heading: &mut JournalHeading| heading.episode = "another".to_owned(), "its home was \"home\"")]
#[case(|heading: &mut JournalHeading| heading.lambda = None, "gate or calibration")]
#[case(|heading: &mut JournalHeading| heading.seed = 7, "--seed")]
#[case(|heading: &mut JournalHeading| heading.scoring.estimator = Estimator::Fused, "--estimator")]
#[case(|heading: &mut JournalHeading| heading.now = "2025-01-20T23:00:00".parse().unwrap(), "its present was")]
fn another_run_is_not_gone_on_with(#[case] change: fn(&mut JournalHeading), #[case] named: &str) {
    let folder = TempDir::new().unwrap();
    drop(begin(&db(&folder)));
    let mut other = heading();
    change(&mut other);
    let error = Journal::open(&db(&folder), Beginning::WhereItEnded, &mut other, &roster()).unwrap_err();
    assert!(error.to_string().contains(named), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// To the last bit, so that a run that goes on gives the report of one run.
    #[test]
    fn an_inference_comes_back_as_it_was(values in proptest::array::uniform3(0.0..=1.0_f64), fused in any::<bool>()) {
        let folder = TempDir::new().unwrap();
        let mut given = inference(values);
        if fused {
            given.parts = Some(Parts { model: None, evidence: given.scores.clone() });
            given.problem = Some("the model failed".to_owned());
        }
        let mut journal = begin(&db(&folder));
        journal.inferred(&thing("1"), &given, &roster()).unwrap();
        drop(journal);
        prop_assert_eq!(go_on(&db(&folder)).unwrap().past_inference(&thing("1")), Some(given));
    }
}

/// What was to confirm an answer was taken back: the answer stands again, and may have to be recorded again.
#[test]
fn a_confirmation_that_was_taken_back_leaves_the_answer() {
    let folder = TempDir::new().unwrap();
    let mut journal = begin(&db(&folder));
    journal.answered(&question("1"), false).unwrap();
    journal.answered(&question("1"), false).unwrap();
    journal.undone().unwrap();
    drop(journal);
    let mut journal = go_on(&db(&folder)).unwrap();
    assert_eq!(journal.withdrawn(), []);
    let past = journal.past_question(&thing("1"), &[]);
    assert!(matches!(past, Some(PastQuestion::Answered { recorded: Recorded::Perhaps, .. })), "{past:?}");
    assert_eq!(journal.past_question(&thing("1"), &[]), None);
}

#[test]
fn a_question_about_other_things_as_well_is_another() {
    let folder = TempDir::new().unwrap();
    begin(&db(&folder)).answered(&question("1"), false).unwrap();
    assert_eq!(go_on(&db(&folder)).unwrap().past_question(&thing("1"), &[thing("2")]), None);
}
