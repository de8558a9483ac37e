//! What was recorded is said again, and nothing else.

use std::collections::BTreeSet;

use coin_schemas::household::ObjectId;
use coin_schemas::model::Task;
use coin_schemas::report::Scoring;
use futures::future::join_all;
use proptest::prelude::*;
use rstest::rstest;
use serde_json::json;

use super::*;
use crate::client::ServerAddress;
use crate::home::Home;
use crate::model::embedded::EmbeddedModel;
use crate::steps::Steps;

#[tokio::test]
async fn the_first_asking_gets_the_first_outcome_and_so_on() {
    let (_folder, path) = file();
    let recorder = Recorder::create(Echo::failing(1), &path).unwrap();
    let mut said = Vec::new();
    for question in ["one", "two", "one", "one"] {
        said.push((question, ask(&recorder, question).await));
    }
    let replay = Replay::open(&path).unwrap();
    assert_eq!(replay.name(), "echo");
    for (question, outcome) in &said {
        assert_eq!(ask(&replay, question).await, *outcome);
    }
    assert_eq!(ask(&replay, "one").await, said[3].1, "the last outcome is given from then on");
    assert_eq!(ask(&replay, "two").await, said[1].1);
}

#[tokio::test]
async fn what_came_from_memory_comes_from_memory_again() {
    let (folder, path) = file();
    let cache = Arc::new(Cache::open(Echo::new(), folder.path().join("kept.jsonl")).unwrap());
    let recorder = Recorder::create(cache, &path).unwrap();
    let said = [ask(&recorder, "one").await, ask(&recorder, "one").await];
    assert_eq!(said[1].as_ref().unwrap().origin, Origin::Memory);
    let replay = Replay::open(&path).unwrap();
    assert_eq!([ask(&replay, "one").await, ask(&replay, "one").await], said);
}

/// A whole step of the agent with its tool calls, over the real server.
#[tokio::test]
async fn a_step_plays_back_as_it_was() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes/three-things");
    let home =
        Home::open(crate::home::load(&folder).await.unwrap(), None, &ServerAddress::InProcess).await.unwrap();
    let infer = async |model: &dyn ChatModel, id: &str| {
        let steps = Steps::new(model, &home.server, &home.roster, &BTreeSet::new(), Scoring::default());
        let task = Task::InferOwnership {
            household: home.roster.users(),
            as_of: home.episode.now,
            object: home.things[&ObjectId::new(id).unwrap()].clone(),
            context: None,
        };
        let step = steps.infer(&task).await;
        (step.called, step.outcome.map_err(|error| error.to_string()), steps.cost())
    };
    let (_folder, path) = file();
    let recorder = Recorder::create(Arc::new(EmbeddedModel::default()), &path).unwrap();
    let said = infer(&recorder, "3").await;
    assert!(said.1.is_ok());
    let replay = Replay::open(&path).unwrap();
    assert_eq!(infer(&replay, "3").await, said);
    insta::assert_snapshot!(told(&infer(&replay, "1").await.1.unwrap_err(), &path), @r#"the tape tape.jsonl holds no reply to this request, infer_ownership of thing 1 (kettle): the episode, the settings or the program differ from those of the recording; use the same ones, or record anew with --record FILE"#);
}

#[tokio::test]
async fn a_request_that_is_not_on_the_tape_is_described() {
    let (_folder, path) = file();
    recorded(&path, &["one"]).await;
    let replay = Replay::open(&path).unwrap();
    let thing = json!({"id": "7", "class": "mug", "position": [0.0, 0.0, 0.0]});
    let household = json!({"Bob": {}});
    let questions = [
        json!({"task": "ask_question", "household": household, "object": thing, "scores": {"Bob": 0.5}})
            .to_string(),
        json!({"task": "read_answer", "household": household, "question": "Whose?", "answer": "My \"own\""})
            .to_string(),
        json!({"task": "judge_sharing", "classes": ["mug", "sofa"]}).to_string(),
        format!("something else {}", "and so on ".repeat(100)),
    ];
    let mut subjects = Vec::new();
    for question in &questions {
        let ModelError::Unusable { reason } = ask(&replay, question).await.unwrap_err() else { panic!() };
        subjects
            .push(told(&reason, &path).replace("the tape tape.jsonl holds no reply to this request, ", ""));
    }
    insta::assert_snapshot!(subjects.join("\n"), @r#"
    ask_question about thing 7 (mug): the episode, the settings or the program differ from those of the recording; use the same ones, or record anew with --record FILE
    read_answer "My \"own\"": the episode, the settings or the program differ from those of the recording; use the same ones, or record anew with --record FILE
    judge_sharing of 2 classes: the episode, the settings or the program differ from those of the recording; use the same ones, or record anew with --record FILE
    something else and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and so on and …: the episode, the settings or the program differ from those of the recording; use the same ones, or record anew with --record FILE
    "#);
}

#[tokio::test]
async fn what_is_no_tape_is_refused() {
    let (folder, path) = file();
    recorded(&path, &["one", "two"]).await;
    let whole = std::fs::read_to_string(&path).unwrap();
    let refused = |text: &str| {
        std::fs::write(&path, text).unwrap();
        told(&Replay::open(&path).unwrap_err(), &path)
    };
    insta::assert_snapshot!(refused(""), @r#"tape.jsonl is no tape: its first line is not {"tape_version": …, "model": …}; name a file that --record wrote"#);
    let other = refused("");
    for text in ["hello\n", "{\"event\": \"run_started\"}\n", "[1]\n", &whole[..30], "\u{0}\n", "\n"] {
        assert_eq!(refused(text), other);
    }
    insta::assert_snapshot!(refused("{\"tape_version\":2,\"reel\":\"big\"}\n"), @r#"tape.jsonl is a tape of version 2, and this program reads version 1; record anew with --record FILE"#);
    let second = whole.lines().nth(1).unwrap();
    insta::assert_snapshot!(refused(&whole.replace(second, &second[..second.len() - 1])), @r#"tape.jsonl:2: this is no exchange with a model: EOF while parsing an object at line 1 column 310; delete the line, or record anew"#);
    insta::assert_snapshot!(refused(&whole.replacen("\"fingerprint\":\"", "\"fingerprint\":\"x", 1)), @r#"tape.jsonl:2: this is no exchange with a model: a fingerprint has 64 digits from 0 to 9 and a to f, and "x2beaaf533cb2f00dda3ca7f385834f112f149d49ff59460651a7c3220f7b311f" has not at line 1 column 82; delete the line, or record anew"#);
    insta::assert_snapshot!(refused(&format!("{whole}{{}}\n")), @r#"tape.jsonl:4: this is no exchange with a model: missing field `fingerprint` at line 1 column 2; delete the line, or record anew"#);
    insta::assert_snapshot!(told(&Replay::open(folder.path()).unwrap_err(), folder.path()), @r#"tape.jsonl is a folder; name a file for the tape"#);
    insta::assert_snapshot!(told(&Replay::open(folder.path().join("none")).unwrap_err(), folder.path()), @r#"the tape tape.jsonl/none cannot be opened: No such file or directory (os error 2); name another file"#);
    std::fs::write(&path, whole.replace('\n', "\n\n").into_bytes()).unwrap();
    assert!(Replay::open(&path).is_ok(), "white lines hold nothing");
}

/// A crash may tear the last line at any byte; all that is whole is played back.
#[tokio::test]
async fn a_torn_last_line_is_passed_over() {
    let (_folder, path) = file();
    recorded(&path, &["one", "zwölf"]).await;
    let whole = std::fs::read(&path).unwrap();
    let last = whole[..whole.len() - 1].iter().rposition(|byte| *byte == b'\n').unwrap() + 1;
    for end in last..whole.len() {
        std::fs::write(&path, &whole[..end]).unwrap();
        let replay = Replay::open(&path).unwrap();
        assert_eq!(words(&replay, "one").await, "one 1");
        // Without its line break alone the line is whole.
        assert_eq!(ask(&replay, "zwölf").await.is_ok(), end == whole.len() - 1, "cut at byte {end}");
    }
}

#[rstest]
#[case::one_thread(1)]
#[case::four_threads(4)]
fn the_order_of_different_requests_makes_no_difference(#[case] threads: usize) {
    let runtime =
        tokio::runtime::Builder::new_multi_thread().worker_threads(threads).enable_time().build().unwrap();
    proptest!(ProptestConfig::with_cases(64), |(
        (asked, again) in prop::collection::vec(0_usize..5, 1..30)
            .prop_flat_map(|asked| (Just(asked.clone()), Just(asked).prop_shuffle()))
    )| {
        runtime.block_on(async {
            let (_folder, path) = file();
            let recorder = Recorder::create(Echo::new(), &path).unwrap();
            join_all(asked.iter().map(|number| ask_owned(&recorder, *number))).await;
            let said = by_question(&lines(&path).1);
            let replay = Replay::open(&path).unwrap();
            let answers = join_all(again.iter().map(|number| ask_owned(&replay, *number))).await;
            let mut heard: Vec<Vec<String>> = vec![Vec::new(); 5];
            for (number, answer) in again.iter().zip(answers) {
                heard[*number].push(answer);
            }
            // Each reply is given once, to its own question.
            assert_eq!(heard.iter().map(|heard| sorted(heard)).collect::<Vec<_>>(), said);
        });
    });
}

async fn ask_owned(model: &dyn ChatModel, number: usize) -> String {
    words(model, &"?".repeat(number + 1)).await
}

fn by_question(exchanges: &[Exchange]) -> Vec<Vec<String>> {
    let mut said = vec![Vec::new(); 5];
    for exchange in exchanges {
        let Outcome::Reply(ChatReply { text: Some(text), .. }) = &exchange.outcome else { panic!() };
        said[text.matches('?').count() - 1].push(text.clone());
    }
    said.iter().map(|said| sorted(said)).collect()
}

fn sorted(texts: &[String]) -> Vec<String> {
    let mut texts = texts.to_vec();
    texts.sort();
    texts
}
