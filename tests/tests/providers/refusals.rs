//! What no repetition mends: keys, models, requests.

use std::time::Duration;

use coin_host::model::provider::Provider;
use coin_tests::provider::{Fault, Script, ScriptedProvider};
use rstest::rstest;

use super::{first_turn, last_turn, model, timed, unanswered, unusable};

#[rstest]
#[case(Provider::OpenAi, "the key in OPENAI_API_KEY was refused (401); set it to a valid key")]
#[case(Provider::Anthropic, "the key in ANTHROPIC_API_KEY was refused (401); set it to a valid key")]
#[tokio::test]
async fn a_wrong_key_is_told_within_a_second(#[case] provider: Provider, #[case] words: &str) {
    let script = Script { key: Some("another key".to_owned()), ..Script::default() };
    let server = ScriptedProvider::start(script);
    let (result, took) = timed(first_turn(&model(&server, provider))).await;
    assert_eq!(unusable(result), words);
    assert!(took < Duration::from_secs(1), "{took:?}");
    assert_eq!(server.request_count(), 1);
}

#[tokio::test]
async fn the_right_key_is_let_in() {
    for provider in super::BOTH {
        let server =
            ScriptedProvider::start(Script { key: Some(super::KEY.to_owned()), ..Script::default() });
        first_turn(&model(&server, provider)).await.unwrap();
    }
}

#[tokio::test]
async fn a_key_that_may_not_is_told() {
    let server = ScriptedProvider::start(Script::always(Fault::Status(403)));
    assert_eq!(
        unusable(first_turn(&model(&server, Provider::OpenAi)).await),
        "the key in OPENAI_API_KEY was refused (403: scripted (your key is [key])); set it to a key that may use \
         the model scripted-1"
    );
}

#[tokio::test]
async fn an_unknown_model_is_told() {
    let server = ScriptedProvider::start(Script { model: Some("another".to_owned()), ..Script::default() });
    let url = server.openai_url();
    assert_eq!(
        unusable(first_turn(&model(&server, Provider::OpenAi)).await),
        format!(
            "the model scripted-1 is not known at {url} (404: there is no such model (your key is [key])); choose \
             one that is there, or set OPENAI_BASE_URL to where it is"
        )
    );
    assert_eq!(server.request_count(), 1);
}

#[tokio::test]
async fn a_redirect_is_not_followed() {
    for provider in super::BOTH {
        let server = ScriptedProvider::start(Script::always(Fault::Redirect));
        let reason = unusable(first_turn(&model(&server, provider)).await);
        assert!(reason.contains("sends requests elsewhere (307)"), "{reason}");
        assert!(reason.contains(provider.url_variable()), "{reason}");
        assert_eq!(server.request_count(), 1, "the key went to another place");
    }
}

#[rstest]
#[case(Provider::Anthropic, 400)]
#[case(Provider::Anthropic, 413)]
#[case(Provider::OpenAi, 413)]
#[tokio::test]
async fn a_refused_request_is_not_repeated(#[case] provider: Provider, #[case] status: u16) {
    let server = ScriptedProvider::start(Script::always(Fault::Status(status)));
    assert_eq!(
        unanswered(last_turn(&model(&server, provider)).await),
        format!("the server answered {status}: scripted (your key is [key])")
    );
    assert_eq!(server.request_count(), 1);
}
