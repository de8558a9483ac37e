//! Ways of making scores, with models that say what a test has them say, against the real server.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;

use async_trait::async_trait;
use coin::owners::OwnerSet;
use coin::roster::UserIndex;
use coin_schemas::household::Score;
use coin_schemas::report::{ContextSource, Scoring};
use coin_schemas::tools::{WhoseIs, WhoseIsResult};
use serde_json::json;

use super::*;
use crate::client::ServerAddress;
use crate::home::Home;
use crate::model::{ChatModel, ChatReply, ChatRequest, Message};

/// Gives everything to Tom, in the form that is asked for.
#[derive(Default)]
struct ForTom {
    tasks: Mutex<Vec<Task>>,
    fails_on: Option<&'static str>,
    leaves_out: Option<&'static str>,
}

#[async_trait]
impl ChatModel for ForTom {
    fn name(&self) -> &str {
        "for-tom"
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        let Some(Message::User { text }) = request.conversation.get(1) else { panic!("no task") };
        let task: Task = serde_json::from_str(text).unwrap();
        let mut scores = json!({"Bob": 0.1, "Mary": 0.1, "Tom": 0.9});
        if let (Some(name), Some(scores)) = (self.leaves_out, scores.as_object_mut()) {
            scores.shift_remove(name);
        }
        let (ids, reply) = match &task {
            Task::InferOwnership { object, .. } => {
                (vec![object.id.clone()], json!({"ownership_distribution": scores}))
            }
            Task::InferSeveral { things, .. } => {
                let ids: Vec<ObjectId> = things.iter().map(|thing| thing.object.id.clone()).collect();
                let all: serde_json::Map<String, serde_json::Value> =
                    ids.iter().map(|id| (id.to_string(), scores.clone())).collect();
                (ids, json!({"ownership_distributions": all}))
            }
            other => panic!("{other:?}"),
        };
        self.tasks.lock().unwrap().push(task);
        match self.fails_on {
            Some(thing) if ids.iter().any(|id| id.as_str() == thing) => {
                Err(ModelError::Unanswered { reason: "503 Service Unavailable".to_owned() })
            }
            _ => Ok(ChatReply::words(reply.to_string())),
        }
    }
}

async fn home() -> Home {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes/three-things");
    let loaded = crate::home::load(&folder).await.unwrap();
    Home::open(loaded, None, &ServerAddress::InProcess).await.unwrap()
}

fn scoring(estimator: Estimator, context: ContextSource, batch: usize) -> Scoring {
    Scoring { estimator, context, batch }
}

/// Runs passes over all things; between them `2` is answered to be Tom's.
async fn passes(
    model: &ForTom,
    scoring: Scoring,
    reinference: Reinference,
    count: usize,
) -> Vec<Vec<Estimate>> {
    let home = home().await;
    let withheld = BTreeSet::new();
    let steps = Steps::new(model, &home.server, &home.roster, &withheld, scoring);
    let estimation = Estimation::new(
        &steps,
        &home.things,
        withheld.clone(),
        home.episode.now,
        reinference,
        EvidenceParameters::default(),
    )
    .unwrap();
    let things: Vec<&TaskObject> = home.things.values().collect();
    let mut results = Vec::new();
    let mut answers = Answers::new();
    for pass in 0..count {
        let mut estimates = Vec::new();
        for batch in things.chunks(estimation.batch()) {
            estimates.extend(estimation.infer(batch, &answers).await);
        }
        results.push(estimates);
        if pass == 0 {
            let answer =
                json!({"object_id": "2", "question": "?", "answer": "Tom's", "ownership": {"Tom": true}});
            let serde_json::Value::Object(answer) = answer else { panic!() };
            assert!(!home.server.call_raw("record_answer", answer).await.unwrap().is_error);
            let tom = UserIndex::new(2).map(OwnerSet::single).unwrap();
            answers.insert(ObjectId::new("2").unwrap(), tom);
        }
    }
    results
}

fn inference(estimate: &Estimate) -> &Inference {
    estimate.outcome.as_ref().unwrap()
}

fn asked(model: &ForTom) -> usize {
    model.tasks.lock().unwrap().len()
}

/// The host judges the home as the server does that it is connected to.
#[tokio::test]
async fn the_evidence_model_alone_asks_no_model_and_says_what_the_server_says() {
    let model = ForTom::default();
    let estimates =
        passes(&model, scoring(Estimator::Evidence, ContextSource::Tools, 1), Reinference::default(), 1)
            .await;
    assert_eq!(asked(&model), 0);
    let home = home().await;
    for (estimate, thing) in estimates[0].iter().zip(home.things.values()) {
        let whose: WhoseIsResult = home
            .server
            .call("whose_is", &WhoseIs { object_id: thing.id.to_string(), as_of: None })
            .await
            .unwrap();
        let evidence = inference(estimate);
        assert_eq!(evidence.problem, None);
        assert_eq!(home.roster.scores(&evidence.scores), whose.scores);
    }
}

/// p(S) ∝ ((1 − w)·π(S) + w·e(S)) · p(c|S): the parts are there, and the whole is drawn to what the model says.
#[tokio::test]
async fn fused_scores_are_one_posterior_of_both_parts() {
    let model = ForTom::default();
    let fused = scoring(Estimator::Fused, ContextSource::Given, 1);
    let estimates = passes(&model, fused, Reinference::default(), 1).await;
    for estimate in &estimates[0] {
        let inference = inference(estimate);
        let parts = inference.parts.as_ref().unwrap();
        let tom = |scores: &[Score]| scores[2].value();
        assert_eq!(parts.model.as_deref().map(tom), Some(0.9));
        let (whole, evidence) = (tom(&inference.scores), tom(&parts.evidence));
        assert!(evidence < whole, "{evidence} {whole}");
        assert_eq!(inference.scores, inference.distribution.marginals(3));
    }
    // The model is told of the place, and of nothing that the evidence model weighs.
    let tasks = model.tasks.lock().unwrap();
    for task in tasks.iter() {
        let Task::InferOwnership { context: Some(context), .. } = task else { panic!("{task:?}") };
        assert_eq!((&context.usage, context.similar_objects.len()), (&None, 0));
        assert!(context.nearby_objects.iter().all(|neighbour| neighbour.known_ownership.is_none()));
    }
}

#[rstest::rstest]
#[case::common_sense_does_not_change_with_an_answer(Estimator::Fused, ContextSource::Given, 1, 3)]
#[case::nor_where_it_is_asked_with_tools(Estimator::Fused, ContextSource::Tools, 1, 3)]
#[case::several_in_one_call(Estimator::Fused, ContextSource::Given, 2, 2)]
// After the answer `3`, which lies near `2`, is asked about again; `2` itself sees its own neighbours as before.
#[case::what_lies_near_the_answered_thing(Estimator::Model, ContextSource::Given, 1, 4)]
#[case::the_rest_of_a_batch_is_left_out(Estimator::Model, ContextSource::Given, 3, 2)]
#[tokio::test]
async fn a_thing_whose_context_did_not_change_is_not_asked_about_again(
    #[case] estimator: Estimator,
    #[case] context: ContextSource,
    #[case] batch: usize,
    #[case] calls: usize,
) {
    let model = ForTom::default();
    let results = passes(&model, scoring(estimator, context, batch), Reinference::default(), 3).await;
    assert_eq!(asked(&model), calls);
    for (second, third) in results[1].iter().zip(&results[2]) {
        assert_eq!(inference(second), inference(third));
    }
}

/// So that the price of the paper's scheme can be told.
#[tokio::test]
async fn the_papers_scheme_asks_about_everything_every_time() {
    let model = ForTom::default();
    let given = scoring(Estimator::Model, ContextSource::Given, 1);
    passes(&model, given, Reinference::EveryUnasked, 3).await;
    assert_eq!(asked(&model), 9);
}

#[tokio::test]
async fn an_answer_reaches_fused_scores_through_the_evidence() {
    let model = ForTom::default();
    let fused = scoring(Estimator::Fused, ContextSource::Given, 1);
    let results = passes(&model, fused, Reinference::default(), 2).await;
    let parts = |pass: usize| inference(&results[pass][2]).parts.clone().unwrap();
    assert_eq!(parts(0).model, parts(1).model);
    assert_ne!(parts(1).evidence, parts(0).evidence);
}

#[rstest::rstest]
#[case(Estimator::Fused, 1)]
#[case(Estimator::Model, 1)]
#[case(Estimator::Fused, 3)]
#[tokio::test]
async fn where_the_model_fails_the_evidence_speaks_and_says_so(
    #[case] estimator: Estimator,
    #[case] batch: usize,
) {
    let model = ForTom { fails_on: Some("2"), ..ForTom::default() };
    let results =
        passes(&model, scoring(estimator, ContextSource::Given, batch), Reinference::default(), 1).await;
    let evidence =
        passes(&model, scoring(Estimator::Evidence, ContextSource::Tools, 1), Reinference::default(), 1)
            .await;
    let failed = inference(&results[0][1]);
    assert_eq!(failed.scores, inference(&evidence[0][1]).scores);
    assert_eq!(
        failed.problem.as_deref(),
        Some(
            "the model failed: the model did not answer: 503 Service Unavailable; judged by the evidence alone"
        )
    );
    // A conversation about several things fails for all of them.
    let others = [0, 2].map(|place| inference(&results[0][place]).problem.is_some());
    assert_eq!(others, [batch > 1; 2]);
}

/// The 0 that a missing score counts as goes on weighing, and so the note of it stays.
#[tokio::test]
async fn the_note_of_a_missing_score_stays_as_long_as_it_counts() {
    let model = ForTom { leaves_out: Some("Mary"), ..ForTom::default() };
    let results =
        passes(&model, scoring(Estimator::Fused, ContextSource::Given, 1), Reinference::default(), 2).await;
    for estimate in results.iter().flatten() {
        let note = inference(estimate).problem.as_deref();
        assert_eq!(note, Some("the model gave no score for Mary, which counts as 0"));
    }
}
