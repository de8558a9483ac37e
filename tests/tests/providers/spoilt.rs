//! What a model gets wrong reaches the caller as it was said.

use coin_host::model::provider::Provider;
use coin_host::model::{ChatReply, ToolArguments};
use coin_tests::provider::{Fault, Script, ScriptedProvider};
use rstest::rstest;
use serde_json::Value;

use super::{answered, first_turn, last_turn, model, opening, turn};

async fn said(provider: Provider, fault: Fault) -> String {
    let server = ScriptedProvider::start(Script::always(fault));
    let reply = last_turn(&model(&server, provider)).await.unwrap();
    let requests = server.requests();
    assert_eq!((requests.len(), requests[0].fault), (1, Some(fault)));
    server.assert_no_violations();
    reply.text.unwrap()
}

#[rstest]
#[case(Fault::CodeFences, "```json\n{")]
#[case(Fault::Prose, "Here is what I think:")]
#[case(Fault::TrailingCommas, ",}")]
#[case(Fault::InventedPeople, "\"Zebediah\"")]
#[case(Fault::ScoresAsText, "\"Alice\":\"0.")]
#[case(Fault::ScoresAsPercentages, "%\"")]
#[case(Fault::ScoresAboveOne, "\"Alice\":1.")]
#[case(Fault::ScoresNotNumbers, "\"Alice\":NaN")]
#[case(Fault::ScoresAllEqual, "\"Alice\":0.5,\"Bob\":0.5,\"Carol\":0.5")]
#[tokio::test]
async fn wrong_words_are_handed_on(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
    #[case] fault: Fault,
    #[case] holds: &str,
) {
    let said = said(provider, fault).await;
    assert!(said.contains(holds), "{said}");
}

#[tokio::test]
async fn people_can_be_missing() {
    let said: Value = serde_json::from_str(&said(Provider::OpenAi, Fault::MissingPeople).await).unwrap();
    assert_eq!(said["ownership_distribution"].as_object().unwrap().len(), 2);
}

/// A turn with a wrong call, and the next request, which shows it to the model again.
async fn wrong_calls(provider: Provider, fault: Fault) -> (ChatReply, Value) {
    let server = ScriptedProvider::start(Script::always(fault));
    let model = model(&server, provider);
    let calls = first_turn(&model).await.unwrap();
    turn(&model, &answered(opening(), &calls)).await.unwrap();
    server.assert_no_violations();
    (calls, server.requests().pop().unwrap().body)
}

#[rstest]
#[tokio::test]
async fn malformed_arguments_are_shown_to_the_model_again(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
) {
    let (calls, next) = wrong_calls(provider, Fault::MalformedArguments).await;
    let ToolArguments::Malformed(text) = &calls.tool_calls[0].arguments else {
        panic!("these are no arguments: {calls:?}");
    };
    let echoed = match provider {
        Provider::OpenAi => next.pointer("/messages/2/tool_calls/0/function/arguments"),
        Provider::Anthropic => next.pointer("/messages/1/content/0/input/malformed_arguments"),
    };
    assert_eq!(echoed.unwrap(), text);
}

#[rstest]
#[tokio::test]
async fn wrong_names_and_arguments_are_handed_on(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
) {
    let (calls, _) = wrong_calls(provider, Fault::UnknownTool).await;
    assert_eq!(calls.tool_calls[0].tool, "find_owner");
    let (calls, _) = wrong_calls(provider, Fault::WrongArguments).await;
    assert_eq!(calls.tool_calls[0].arguments.to_text(), r#"{"objectId":42}"#);
}

#[rstest]
#[tokio::test]
async fn a_call_that_is_made_again_and_again_has_another_id_every_time(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
) {
    let server = ScriptedProvider::start(Script::always(Fault::SameCallAgain));
    let model = model(&server, provider);
    let mut conversation = opening();
    for _ in 0..5 {
        let reply = turn(&model, &conversation).await.unwrap();
        assert_eq!(reply.tool_calls.len(), 1);
        conversation = answered(conversation, &reply);
    }
    server.assert_no_violations();
}
