//! Parameters that a server refuses are left out.

use coin_host::model::provider::Provider;
use coin_tests::provider::{Fault, FaultPlan, Manner, Script, ScriptedProvider};
use rstest::rstest;
use serde_json::Value;

use super::{first_turn, model, unanswered};

fn refusing(refuses: &[&'static str], manner: Manner) -> ScriptedProvider {
    ScriptedProvider::start(Script { refuses: refuses.to_vec(), manner, ..Script::default() })
}

fn statuses(server: &ScriptedProvider) -> Vec<u16> {
    server.requests().iter().map(|request| request.status.unwrap()).collect()
}

fn last_body(server: &ScriptedProvider) -> Value {
    server.requests().pop().unwrap().body
}

#[rstest]
#[case(Provider::OpenAi, "temperature")]
#[case(Provider::OpenAi, "seed")]
#[case(Provider::OpenAi, "response_format")]
#[case(Provider::Anthropic, "temperature")]
#[tokio::test]
async fn a_refused_parameter_is_left_out_for_the_rest_of_the_run(
    #[case] provider: Provider,
    #[case] parameter: &'static str,
) {
    let server = refusing(&[parameter], Manner::Named);
    let model = model(&server, provider);
    first_turn(&model).await.unwrap();
    let refused = statuses(&server).len() - 1;
    assert_eq!(statuses(&server)[..refused], vec![400; refused]);
    first_turn(&model).await.unwrap();
    assert_eq!(statuses(&server).len(), refused + 2, "the second call knows it");
    assert_eq!(last_body(&server).get(parameter), None);
    server.assert_no_violations();
}

#[tokio::test]
async fn the_older_name_of_the_length_is_tried_before_none() {
    let server = refusing(&["max_completion_tokens"], Manner::Named);
    first_turn(&model(&server, Provider::OpenAi)).await.unwrap();
    assert_eq!(last_body(&server)["max_tokens"], 8192);
    let server = refusing(&["max_completion_tokens", "max_tokens"], Manner::Named);
    first_turn(&model(&server, Provider::OpenAi)).await.unwrap();
    assert_eq!(statuses(&server), [400, 400, 200]);
    assert_eq!(last_body(&server).get("max_tokens"), None);
}

#[rstest]
#[tokio::test]
async fn a_form_that_is_not_known_becomes_a_plainer_one(
    #[values(Manner::Named, Manner::Unnamed)] manner: Manner,
) {
    let server = refusing(&["json_schema"], manner);
    let own = model(&server, Provider::OpenAi);
    first_turn(&own).await.unwrap();
    assert_eq!(last_body(&server)["response_format"]["type"], "json_object");
    let server = refusing(&["json_schema", "json_object"], manner);
    first_turn(&model(&server, Provider::OpenAi)).await.unwrap();
    assert_eq!(statuses(&server), [400, 400, 200]);
    assert_eq!(last_body(&server).get("response_format"), None);
    server.assert_no_violations();
}

#[tokio::test]
async fn a_form_that_was_accepted_is_kept_when_a_request_is_refused_without_a_word() {
    let faults = FaultPlan::script(vec![None, Some(Fault::Status(400))]);
    let server = ScriptedProvider::start(Script { faults, ..Script::default() });
    let model = model(&server, Provider::OpenAi);
    first_turn(&model).await.unwrap();
    assert!(unanswered(first_turn(&model).await).starts_with("the server answered 400"));
    first_turn(&model).await.unwrap();
    assert_eq!(last_body(&server)["response_format"]["type"], "json_schema");
}

#[tokio::test]
async fn a_guess_that_did_not_help_is_not_kept() {
    let faults = FaultPlan::first(3, Fault::Status(400));
    let server = ScriptedProvider::start(Script { faults, ..Script::default() });
    let model = model(&server, Provider::OpenAi);
    assert!(unanswered(first_turn(&model).await).starts_with("the server answered 400"));
    assert_eq!(statuses(&server), [400; 3], "with a schema, as any object, without a form");
    first_turn(&model).await.unwrap();
    assert_eq!(last_body(&server)["response_format"]["type"], "json_schema");
}

#[tokio::test]
async fn all_that_is_refused_at_once_is_found() {
    let refuses = ["temperature", "seed", "max_completion_tokens", "max_tokens", "response_format"];
    let server = refusing(&refuses, Manner::Named);
    let model = model(&server, Provider::OpenAi);
    first_turn(&model).await.unwrap();
    assert_eq!(server.turns(), 1);
    let body = last_body(&server);
    assert!(refuses.iter().all(|name| body.get(name).is_none()), "{body}");
    server.assert_no_violations();
}

#[tokio::test]
async fn calls_that_learn_it_at_the_same_time_all_go_on() {
    let server = refusing(&["temperature"], Manner::Named);
    let model = model(&server, Provider::Anthropic);
    let replies = futures::future::join_all((0..8).map(|_| first_turn(&model))).await;
    assert!(replies.iter().all(Result::is_ok), "{replies:?}");
    server.assert_no_violations();
}
