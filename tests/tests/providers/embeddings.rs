//! Encoders: words go out, directions come back, and what goes wrong is tried again and told as for conversations.

use std::sync::Arc;

use coin_host::model::ModelError;
use coin_host::model::provider::RemoteEncoder;
use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider};

use super::{KEY, settings};

fn encoder(server: &ScriptedProvider) -> RemoteEncoder {
    let name = "openai:clip".parse().unwrap();
    RemoteEncoder::at(name, &server.openai_url(), Some(KEY), &settings()).unwrap()
}

#[tokio::test]
async fn words_become_a_direction() {
    let length_of = |text: &str| vec![text.len() as f64, -0.5];
    let server = ScriptedProvider::start(Script {
        encoder: Arc::new(length_of),
        key: Some(KEY.to_owned()),
        ..Script::default()
    });
    assert_eq!(encoder(&server).embed("red mug").await, Ok(vec![7.0, -0.5]));
    server.assert_no_violations();
}

#[tokio::test]
async fn what_may_pass_is_tried_again() {
    let faults = FaultPlan::first(2, Fault::Status(503));
    let server = ScriptedProvider::start(Script { faults, ..Script::default() });
    assert!(encoder(&server).embed("mug").await.is_ok());
    assert_eq!(server.request_count(), 3);
}

#[tokio::test]
async fn a_refusal_is_told_with_the_way_out() {
    let server = ScriptedProvider::start(Script { model: Some("other".to_owned()), ..Script::default() });
    let Err(ModelError::Unusable { reason }) = encoder(&server).embed("mug").await else { panic!() };
    assert!(reason.starts_with("the model clip is not known at ") && !reason.contains(KEY), "{reason}");
    let server = ScriptedProvider::start(Script::always(Fault::QuotaUsedUp));
    let Err(ModelError::Unusable { reason }) = encoder(&server).embed("mug").await else { panic!() };
    assert!(reason.ends_with("or ask without --encoder"), "{reason}");
}
