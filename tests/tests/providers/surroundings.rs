//! The scripted provider itself: it finds what is wrong, and it does what its script says.

use coin_host::model::provider::Provider;
use coin_host::model::{ChatReply, Message};
use coin_tests::provider::{Script, ScriptedProvider, Turn};
use std::sync::Arc;

use super::{first_turn, model, turn};

#[tokio::test]
async fn a_wrong_request_is_found() {
    for provider in super::BOTH {
        let server = ScriptedProvider::start(Script::default());
        let mut conversation = super::opening();
        conversation.push(Message::Tool {
            call_id: "call_never_made".to_owned(),
            tool: "nearby_objects".to_owned(),
            text: "{}".to_owned(),
            is_error: false,
        });
        let _ = turn(&model(&server, provider), &conversation).await;
        let violations = server.violations();
        assert!(violations.iter().any(|found| found.contains("call_never_made")), "{violations:?}");
    }
}

#[tokio::test]
async fn a_brain_can_be_a_closure() {
    let brain = |turn: &Turn| ChatReply::words(format!("{} tools", turn.tools.len()));
    let server = ScriptedProvider::start(Script { brain: Arc::new(brain), ..Script::default() });
    let reply = first_turn(&model(&server, Provider::Anthropic)).await.unwrap();
    assert_eq!(reply.text.unwrap(), "3 tools");
}
