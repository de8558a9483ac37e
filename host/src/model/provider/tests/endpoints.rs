//! Keys and base URLs, as they stand in the environment.

use std::collections::BTreeMap;

use rstest::rstest;

use super::super::endpoint::{Endpoint, Service};
use super::super::{Provider, ProviderSettings, RemoteModel};
use crate::model::{ChatModel, ModelError};

fn endpoint(provider: Provider, variables: &[(&str, &str)]) -> Result<Endpoint, String> {
    let variables: BTreeMap<&str, &str> = variables.iter().copied().collect();
    Endpoint::from_variables(Service::Conversation(provider), |name| {
        Ok(variables.get(name).map(|&value| value.to_owned()))
    })
    .map_err(|error| match error {
        ModelError::Unusable { reason } => reason,
        other => panic!("{other:?}"),
    })
}

#[rstest]
#[case(Provider::OpenAi, "https://api.openai.com/v1", "https://api.openai.com/v1/chat/completions")]
#[case(Provider::OpenAi, "http://127.0.0.1:11434/v1/", "http://127.0.0.1:11434/v1/chat/completions")]
#[case(Provider::OpenAi, " http://[::1]:8080 ", "http://[::1]:8080/chat/completions")]
#[case(Provider::OpenAi, " ", "https://api.openai.com/v1/chat/completions")]
#[case(Provider::Anthropic, "", "https://api.anthropic.com/v1/messages")]
#[case(Provider::Anthropic, "https://gate.example/claude/", "https://gate.example/claude/v1/messages")]
#[case(Provider::Anthropic, "https://api.anthropic.com/v1", "https://api.anthropic.com/v1/messages")]
fn requests_are_posted_below_the_base_url(#[case] provider: Provider, #[case] base: &str, #[case] url: &str) {
    let variables = [(provider.url_variable(), base), (provider.key_variable(), "k")];
    assert_eq!(endpoint(provider, &variables).unwrap().url.as_str(), url);
}

#[test]
fn a_missing_key_is_told() {
    insta::assert_snapshot!(endpoint(Provider::OpenAi, &[]).unwrap_err(), @"there is no key for OpenAI; set OPENAI_API_KEY to one, set OPENAI_BASE_URL to a server that needs none, or run with --model embedded");
    insta::assert_snapshot!(endpoint(Provider::Anthropic, &[("ANTHROPIC_API_KEY", " \n")]).unwrap_err(), @"there is no key for Anthropic; set ANTHROPIC_API_KEY to one, or run with --model embedded");
    let elsewhere = [("ANTHROPIC_BASE_URL", "http://localhost:1")];
    assert!(endpoint(Provider::Anthropic, &elsewhere).is_err());
}

#[test]
fn only_a_server_of_ones_own_needs_no_key() {
    assert!(endpoint(Provider::OpenAi, &[("OPENAI_BASE_URL", "http://localhost:11434/v1")]).is_ok());
    assert!(endpoint(Provider::OpenAi, &[("OPENAI_BASE_URL", "https://api.openai.com/v1/")]).is_err());
}

#[rstest]
#[case("secret\nsecond")]
#[case("secret\u{7f}")]
#[case("secrét")]
fn a_key_that_fits_no_header_is_told_without_it(#[case] key: &str) {
    let reason = endpoint(Provider::OpenAi, &[("OPENAI_API_KEY", key)]).unwrap_err();
    assert!(reason.contains("OPENAI_API_KEY") && !reason.contains("secr"), "{reason}");
}

#[rstest]
#[case("localhost:11434/v1", "localhost:11434/v1")]
#[case("api", "api")]
#[case("ftp://host/v1", "ftp://host/v1")]
#[case("https://ann:secret@host/v1", "https://host/v1")]
#[case("https://ann:secret@host:port/v1", "https://host:port/v1")]
#[case("ann:secret@host/v1", "host/v1")]
#[case("https://host/v1?key=secret", "https://host/v1")]
#[case("https://host/v1#secret", "https://host/v1")]
#[case("http://", "http://")]
fn a_malformed_url_is_told_without_its_secrets(#[case] given: &str, #[case] shown: &str) {
    let variables = [("OPENAI_BASE_URL", given), ("OPENAI_API_KEY", "k")];
    let reason = endpoint(Provider::OpenAi, &variables).unwrap_err();
    assert!(reason.starts_with(&format!("OPENAI_BASE_URL is {shown:?}, which ")), "{reason}");
    assert!(reason.ends_with("such as https://api.openai.com/v1"), "{reason}");
    assert!(!reason.contains("secret"), "{reason}");
}

#[rstest]
#[case("http://127.0.0.2:1/v1", true)]
#[case("http://[::1]:1/v1", true)]
#[case("http://localhost/v1", true)]
#[case("http://model.localhost/v1", true)]
#[case("http://localhost.example/v1", false)]
#[case("http://192.168.0.7/v1", false)]
#[case("http://127.example/v1", false)]
fn this_machine_is_known(#[case] base: &str, #[case] is_here: bool) {
    assert_eq!(
        Endpoint::new(Service::Conversation(Provider::OpenAi), base, Some("k")).unwrap().is_loopback(),
        is_here
    );
}

#[test]
fn the_key_is_shown_nowhere() {
    let endpoint =
        Endpoint::new(Service::Conversation(Provider::OpenAi), "http://127.0.0.1:1/v1", Some("sk-secret"))
            .unwrap();
    let header = endpoint.key.as_ref().unwrap().header("Bearer ").unwrap();
    assert!(header.is_sensitive());
    assert!(!format!("{endpoint:?} {header:?}").contains("sk-secret"));
    assert_eq!(endpoint.without_key("a sk-secret b sk-secret"), "a [key] b [key]");
}

#[test]
fn a_model_is_named_after_its_provider() {
    let settings = ProviderSettings::default();
    let model = RemoteModel::at(Provider::Anthropic, "claude-x", "http://127.0.0.1:1", Some("k"), &settings);
    assert_eq!(model.unwrap().name(), "anthropic:claude-x");
}
