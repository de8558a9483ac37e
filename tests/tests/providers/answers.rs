//! Whole conversations, in both providers' forms.

use coin_host::model::provider::Provider;
use coin_host::model::{ChatModel, ChatRequest, Ending, Message, ReplyFormat, TokenUsage};
use coin_tests::provider::{Fault, Script, ScriptedProvider};
use rstest::rstest;
use serde_json::{Value, json};

use super::{answered, first_turn, last_turn, model, opening, turn};

#[rstest]
#[tokio::test]
async fn tools_are_called_together_and_their_answers_lead_to_scores(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
) {
    let server = ScriptedProvider::start(Script::default());
    let model = model(&server, provider);
    let calls = first_turn(&model).await.unwrap();
    let called: Vec<&str> = calls.tool_calls.iter().map(|call| call.tool.as_str()).collect();
    assert_eq!(called, ["get_usage_summary", "nearby_objects", "similar_objects"]);
    let scores = turn(&model, &answered(opening(), &calls)).await.unwrap();
    assert_eq!((&scores.tool_calls, &scores.ending), (&Vec::new(), &Ending::Finished));
    let said: Value = serde_json::from_str(&scores.text.unwrap()).unwrap();
    let people: Vec<&String> = said["ownership_distribution"].as_object().unwrap().keys().collect();
    assert_eq!(people, ["Alice", "Bob", "Carol"]);
    assert!(said["ownership_distribution"]["Bob"].as_f64().unwrap() > 0.5, "{said}");
    assert_eq!(said.get("owner_sets"), None, "no language model tells its owner sets");
    assert_eq!((server.request_count(), server.turns()), (2, 2));
    server.assert_no_violations();
}

#[rstest]
#[tokio::test]
async fn a_correction_is_understood(#[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider) {
    let server = ScriptedProvider::start(Script::default());
    let model = model(&server, provider);
    let calls = first_turn(&model).await.unwrap();
    let mut conversation = answered(opening(), &calls);
    // An empty answer, a wrong one, and what was said to them.
    for text in ["", "It is Bob's."] {
        conversation.push(Message::Assistant { text: Some(text.to_owned()), tool_calls: Vec::new() });
        conversation.push(Message::System { text: "Answer again with JSON only.".to_owned() });
    }
    let scores = turn(&model, &conversation).await.unwrap();
    assert!(scores.text.unwrap().contains("ownership_distribution"));
    server.assert_no_violations();
}

#[rstest]
#[tokio::test]
async fn an_error_of_a_tool_is_told(#[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider) {
    let server = ScriptedProvider::start(Script::default());
    let model = model(&server, provider);
    let calls = first_turn(&model).await.unwrap();
    let mut conversation = answered(opening(), &calls);
    if let Some(Message::Tool { text, is_error, .. }) = conversation.last_mut() {
        (*text, *is_error) = ("there is no such thing".to_owned(), true);
    }
    // The evidence model asks again for what was answered with an error only if it is not told that it was.
    let scores = turn(&model, &conversation).await.unwrap();
    assert!(scores.text.unwrap().contains("ownership_distribution"));
    server.assert_no_violations();
    let body = server.requests()[1].body.to_string();
    assert_eq!(body.contains("is_error"), provider == Provider::Anthropic);
}

#[rstest]
#[tokio::test]
async fn plain_words_are_asked_for_without_a_form_and_without_tools(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
) {
    let server = ScriptedProvider::start(Script::default());
    let mut task = super::task();
    task["task"] = json!("ask_question");
    task["scores"] = json!({"Alice": 0.4, "Bob": 0.5, "Carol": 0.1});
    task.as_object_mut().unwrap().shift_remove("as_of");
    let conversation =
        [Message::System { text: "Word a question.".to_owned() }, Message::User { text: task.to_string() }];
    let request = ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text };
    let question = model(&server, provider).complete(&request).await.unwrap().text.unwrap();
    assert!(question.ends_with('?') && question.contains("Bob"), "{question}");
    server.assert_no_violations();
    let body = &server.requests()[0].body;
    assert_eq!((body.get("tools"), body.get("response_format")), (None, None));
}

#[rstest]
#[tokio::test]
async fn what_a_turn_takes_is_reported(#[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider) {
    let server = ScriptedProvider::start(Script::default());
    let usage = last_turn(&model(&server, provider)).await.unwrap().usage;
    assert_eq!(usage, server.requests()[0].usage);
    assert_ne!(usage, TokenUsage::default());
}

#[tokio::test]
async fn the_seed_and_the_form_are_sent_to_openai_alone() {
    let server = ScriptedProvider::start(Script::default());
    for provider in super::BOTH {
        first_turn(&model(&server, provider)).await.unwrap();
    }
    let [openai, anthropic] = server.requests().try_into().unwrap();
    assert_eq!(openai.body["seed"], 7);
    assert_eq!(openai.body["response_format"]["json_schema"]["strict"], true);
    assert_eq!((anthropic.body.get("seed"), anthropic.body.get("output_config")), (None, None));
    for request in [openai, anthropic] {
        assert_eq!(request.body["temperature"], 0.2);
        assert_eq!(request.body["tools"].as_array().unwrap().len(), 3);
    }
}

#[rstest]
#[case(Fault::CutShort, Ending::CutShort)]
#[case(Fault::Refusal, Ending::Refused { reason: "I can't help with judging people.".to_owned() })]
#[case(Fault::Empty, Ending::Finished)]
#[tokio::test]
async fn how_a_turn_ends_is_told(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
    #[case] fault: Fault,
    #[case] ending: Ending,
) {
    let server = ScriptedProvider::start(Script::always(fault));
    let reply = last_turn(&model(&server, provider)).await.unwrap();
    assert_eq!(reply.ending, ending);
    assert_eq!(reply.text.is_some(), fault == Fault::CutShort);
    assert_eq!(server.request_count(), 1, "what a model says is not the transport's to judge");
}
