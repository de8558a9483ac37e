//! Servers that are not there, come back, or are left.

use std::time::Duration;

use coin_host::model::provider::{Provider, ProviderSettings, RemoteModel, RetryPolicy};
use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider, refused_url};
use futures::future::join_all;

use super::{KEY, eventually, first_turn, model, model_with, settings, timed, unanswered, unusable};

#[tokio::test]
async fn a_server_that_was_never_there_is_told_with_the_next_step() {
    for (provider, path) in [(Provider::OpenAi, "/v1"), (Provider::Anthropic, "")] {
        let url = format!("{}{path}", refused_url());
        let model = RemoteModel::at(provider, "llama", &url, Some(KEY), &settings()).unwrap();
        assert_eq!(
            unusable(first_turn(&model).await),
            format!(
                "no model answers at {url}: connection refused; start it, set {}, or run with --model embedded",
                provider.url_variable()
            )
        );
    }
}

#[tokio::test]
async fn a_server_that_speaks_no_tls_is_told() {
    let server = ScriptedProvider::start(Script::default());
    let url = server.openai_url().replace("http://", "https://");
    let model = RemoteModel::at(Provider::OpenAi, "llama", &url, Some(KEY), &settings()).unwrap();
    let reason = unusable(first_turn(&model).await);
    assert!(reason.starts_with(&format!("no model answers at {url}: ")), "{reason}");
    assert!(reason.contains("corrupt message"), "{reason}");
    assert_eq!(server.request_count(), 0);
}

#[tokio::test]
async fn a_server_that_goes_away_leaves_a_call_unanswered() {
    let server = ScriptedProvider::start(Script::default());
    let model = model(&server, Provider::OpenAi);
    first_turn(&model).await.unwrap();
    let url = server.openai_url();
    drop(server);
    assert_eq!(
        unanswered(first_turn(&model).await),
        format!("{url} is out of reach: connection refused (tried 4 times)")
    );
}

#[tokio::test]
async fn a_server_that_fails_again_and_again_is_left_alone_and_tried_once_more_later() {
    let faults = FaultPlan::of(|occasion| (2..=9).contains(&occasion.number).then_some(Fault::Status(500)));
    let server = ScriptedProvider::start(Script { faults, ..Script::default() });
    let retry = RetryPolicy {
        breaker_failures: 8,
        breaker_pause: Duration::from_millis(400),
        base: Duration::from_millis(1),
        ..RetryPolicy::default()
    };
    let model = model_with(&server, Provider::OpenAi, ProviderSettings { retry, ..settings() });
    first_turn(&model).await.unwrap();
    for _ in 0..2 {
        assert!(unanswered(first_turn(&model).await).starts_with("the server answered 500"));
    }
    assert_eq!(server.request_count(), 9);
    let (result, took) = timed(first_turn(&model)).await;
    let reason = unanswered(result);
    assert!(reason.starts_with("not tried: the last 8 attempts failed (500: scripted"), "{reason}");
    assert!(took < Duration::from_millis(200), "{took:?}");
    assert_eq!(server.request_count(), 9, "the server is left alone");
    tokio::time::sleep(Duration::from_millis(450)).await;
    first_turn(&model).await.unwrap();
    assert_eq!(server.request_count(), 10);
}

#[tokio::test]
async fn a_server_that_only_ever_fails_cannot_be_used() {
    let server = ScriptedProvider::start(Script::always(Fault::Status(502)));
    let model = model(&server, Provider::OpenAi);
    for _ in 0..4 {
        let reason = unanswered(first_turn(&model).await);
        assert!(reason.starts_with("the server answered 502"), "{reason}");
    }
    let reason = unusable(first_turn(&model).await);
    assert!(reason.starts_with(&format!("no model answers at {}: 502", server.openai_url())), "{reason}");
    assert_eq!(server.request_count(), 16);
}

#[tokio::test]
async fn calls_go_on_at_the_same_time() {
    let delay = Duration::from_millis(300);
    let server = ScriptedProvider::start(Script { delay, ..Script::default() });
    let model = model(&server, Provider::Anthropic);
    let (replies, took) = timed(join_all((0..8).map(|_| first_turn(&model)))).await;
    assert!(replies.iter().all(Result::is_ok), "{replies:?}");
    assert_eq!((server.most_at_once(), server.request_count()), (8, 8));
    assert!(took < 4 * delay, "{took:?}");
}

#[tokio::test]
async fn a_call_that_is_dropped_leaves_the_server() {
    let server = ScriptedProvider::start(Script::always(Fault::Silence));
    let model = model(&server, Provider::OpenAi);
    let call = first_turn(&model);
    assert!(tokio::time::timeout(Duration::from_millis(300), call).await.is_err());
    assert!(eventually(|| server.under_way() == 0).await, "the connection is still open");
    assert_eq!((server.request_count(), server.abandoned()), (1, 1));
}

#[tokio::test]
async fn a_pause_can_be_left_too() {
    let server = ScriptedProvider::start(Script::always(Fault::Status(503)));
    let retry = RetryPolicy { base: Duration::from_secs(30), ..RetryPolicy::default() };
    let model = model_with(&server, Provider::OpenAi, ProviderSettings { retry, ..settings() });
    assert!(tokio::time::timeout(Duration::from_millis(300), first_turn(&model)).await.is_err());
    assert_eq!(server.request_count(), 1);
}

#[tokio::test]
async fn many_faults_at_random_are_overcome_and_break_no_rule() {
    let faults = vec![Fault::Status(500), Fault::RateLimited(None), Fault::Reset, Fault::Html];
    let server = ScriptedProvider::start(Script {
        faults: FaultPlan::share(0.2, faults),
        seed: 11,
        ..Script::default()
    });
    let mut settings = settings();
    settings.retry.retries = 12;
    settings.retry.breaker_failures = 100;
    for provider in super::BOTH {
        let model = model_with(&server, provider, settings.clone());
        let replies = join_all((0..20).map(|_| first_turn(&model))).await;
        assert!(replies.iter().all(Result::is_ok), "{replies:?}");
    }
    assert_eq!(server.turns(), 40);
    assert!(server.request_count() > 44, "{} requests", server.request_count());
    server.assert_no_violations();
}
