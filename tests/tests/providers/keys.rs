//! Keys go to the server and nowhere else.

use coin_host::model::provider::{Provider, RemoteModel};
use coin_tests::provider::{Script, ScriptedProvider};

use super::{KEY, base_url, first_turn, model, settings};

#[tokio::test]
async fn a_key_is_sent_without_its_surroundings() {
    for (provider, header, value) in [
        (Provider::OpenAi, "authorization", format!("Bearer {KEY}")),
        (Provider::Anthropic, "x-api-key", KEY.to_owned()),
    ] {
        let server = ScriptedProvider::start(Script::default());
        let key = format!(" {KEY}\n");
        let url = base_url(&server, provider);
        let model = RemoteModel::at(provider, "scripted-1", &url, Some(&key), settings()).unwrap();
        first_turn(&model).await.unwrap();
        assert_eq!(server.requests()[0].headers[header], value);
    }
}

#[tokio::test]
async fn a_server_of_ones_own_needs_no_key() {
    let server = ScriptedProvider::start(Script::default());
    let model = RemoteModel::at(Provider::OpenAi, "llama", &server.openai_url(), None, settings()).unwrap();
    first_turn(&model).await.unwrap();
    assert!(!server.requests()[0].headers.contains_key("authorization"));
    server.assert_no_violations();
}

#[tokio::test]
async fn a_server_of_ones_own_that_wants_a_key_says_so() {
    let server = ScriptedProvider::start(Script { key: Some(KEY.to_owned()), ..Script::default() });
    let url = server.openai_url();
    let model = RemoteModel::at(Provider::OpenAi, "llama", &url, None, settings()).unwrap();
    assert_eq!(
        super::unusable(first_turn(&model).await),
        format!("{url} wants a key (401); set OPENAI_API_KEY to one")
    );
}

#[tokio::test]
async fn no_debug_output_shows_the_key() {
    for provider in super::BOTH {
        let server = ScriptedProvider::start(Script::default());
        let model = model(&server, provider);
        for shown in [format!("{model:?}"), format!("{model:#?}")] {
            assert!(!shown.contains(KEY), "{shown}");
            assert!(shown.contains("[key]"), "{shown}");
        }
    }
}
