//! What is tried again, when, and what is said when it is given up.

use std::time::Duration;

use coin_host::model::provider::{Provider, ProviderSettings, RetryPolicy};
use coin_tests::provider::{Fault, FaultPlan, RetryAfter, Script, ScriptedProvider};
use rstest::rstest;

use super::{first_turn, model, model_with, settings, timed, unanswered, unusable};

fn failing_first(count: usize, fault: Fault) -> ScriptedProvider {
    ScriptedProvider::start(Script { faults: FaultPlan::first(count, fault), ..Script::default() })
}

#[rstest]
#[tokio::test]
async fn what_may_pass_is_tried_again(
    #[values(Provider::OpenAi, Provider::Anthropic)] provider: Provider,
    #[values(
        Fault::Status(408),
        Fault::Status(409),
        Fault::Status(425),
        Fault::Status(500),
        Fault::Status(503),
        Fault::Status(529),
        Fault::RateLimited(None),
        Fault::Reset,
        Fault::Html,
        Fault::OtherJson
    )]
    fault: Fault,
) {
    let server = failing_first(3, fault);
    let reply = first_turn(&model(&server, provider)).await.unwrap();
    assert_eq!(reply.tool_calls.len(), 3);
    assert_eq!((server.request_count(), server.turns()), (4, 1));
    let bodies: Vec<_> = server.requests().into_iter().map(|request| request.body).collect();
    assert!(bodies.iter().all(|body| *body == bodies[0]), "the same is asked every time");
    server.assert_no_violations();
}

#[rstest]
#[case(Fault::Status(500), "the server answered 500: scripted (your key is [key]) (tried 4 times)")]
#[case(
    Fault::RateLimited(None),
    "the server answered 429: too many requests (your key is [key]) (tried 4 times)"
)]
#[case(
    Fault::Html,
    "the answer is not JSON: <!DOCTYPE html> <title>Sign in</title><p>Hello [key] (tried 4 times)"
)]
#[case(Fault::Reset, "the answer broke off: connection reset (tried 4 times)")]
#[tokio::test]
async fn what_does_not_pass_is_given_up_in_words(#[case] fault: Fault, #[case] words: &str) {
    for provider in super::BOTH {
        let server = ScriptedProvider::start(Script::always(fault));
        assert_eq!(unanswered(first_turn(&model(&server, provider)).await), words);
        assert_eq!(server.request_count(), 4);
    }
}

#[tokio::test]
async fn json_that_is_no_answer_is_quoted() {
    for (provider, missing) in [(Provider::OpenAi, "no choices"), (Provider::Anthropic, "no content")] {
        let server = ScriptedProvider::start(Script::always(Fault::OtherJson));
        assert_eq!(
            unanswered(first_turn(&model(&server, provider)).await),
            format!(r#"the answer has {missing}: {{"status":"ok","you":"[key]"}} (tried 4 times)"#)
        );
    }
}

#[rstest]
#[case(RetryAfter::Seconds(1), 950..2500)]
#[case(RetryAfter::Milliseconds(300), 290..900)]
// A date knows no fractions of a second: this is one to two seconds away.
#[case(RetryAfter::Date(Duration::from_secs(2)), 950..3000)]
#[case(RetryAfter::Seconds(0), 0..500)]
#[tokio::test]
async fn the_pause_that_is_asked_for_is_made(
    #[case] wait: RetryAfter,
    #[case] milliseconds: std::ops::Range<u128>,
) {
    let server = failing_first(1, Fault::RateLimited(Some(wait)));
    // Without the header the pause would be far too short or too long.
    let base = if wait == RetryAfter::Seconds(0) { 5000 } else { 1 };
    let retry = RetryPolicy { base: Duration::from_millis(base), ..RetryPolicy::default() };
    let model = model_with(&server, Provider::OpenAi, ProviderSettings { retry, ..settings() });
    first_turn(&model).await.unwrap();
    let requests = server.requests();
    let pause = requests[1].at.duration_since(requests[0].at).as_millis();
    assert!(milliseconds.contains(&pause), "{pause} ms");
}

#[rstest]
#[case(RetryAfter::Seconds(61))]
#[case(RetryAfter::Milliseconds(61_000))]
#[case(RetryAfter::Date(Duration::from_secs(63)))]
#[tokio::test]
async fn a_pause_that_is_too_long_is_not_made(#[case] wait: RetryAfter) {
    let server = ScriptedProvider::start(Script::always(Fault::RateLimited(Some(wait))));
    let (result, took) = timed(first_turn(&model(&server, Provider::Anthropic))).await;
    let reason = unanswered(result);
    assert!(reason.contains("wants to be left alone for 6"), "{reason}");
    assert!(reason.contains("longer than the 60 s that are waited for at most"), "{reason}");
    assert_eq!(server.request_count(), 1);
    assert!(took < Duration::from_secs(1), "{took:?}");
}

#[tokio::test]
async fn a_quota_that_is_used_up_is_not_waited_for() {
    for provider in super::BOTH {
        let server = ScriptedProvider::start(Script::always(Fault::QuotaUsedUp));
        let reason = unusable(first_turn(&model(&server, provider)).await);
        assert!(reason.starts_with("the quota is used up (4"), "{reason}");
        assert!(reason.contains(provider.key_variable()), "{reason}");
        assert_eq!(server.request_count(), 1);
    }
}

#[rstest]
#[case(Fault::EndlessBody)]
#[case(Fault::Silence)]
#[tokio::test]
async fn an_answer_that_does_not_come_to_its_end_is_given_up(#[case] fault: Fault) {
    let server = ScriptedProvider::start(Script::always(fault));
    let mut settings = settings();
    settings.timeout = Duration::from_millis(250);
    settings.retry.retries = 1;
    let (result, took) = timed(first_turn(&model_with(&server, Provider::OpenAi, settings))).await;
    assert_eq!(unanswered(result), "no whole answer came within 0.25 s (tried 2 times)");
    assert_eq!(server.request_count(), 2);
    assert!(took < Duration::from_secs(3), "{took:?}");
}

#[tokio::test]
async fn a_slow_answer_is_waited_for() {
    let server = ScriptedProvider::start(Script { delay: Duration::from_millis(300), ..Script::default() });
    let (result, took) = timed(first_turn(&model(&server, Provider::Anthropic))).await;
    result.unwrap();
    assert!(took >= Duration::from_millis(300), "{took:?}");
    assert_eq!(server.request_count(), 1);
}
