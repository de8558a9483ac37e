//! Laws of repetition, by a clock that does not wait.

use std::cell::RefCell;
use std::time::{Duration, SystemTime};

use reqwest::header::{HeaderMap, HeaderName, HeaderValue};
use rstest::rstest;
use tokio::time::Instant;

use super::super::failure::{Failure, Quota};
use super::super::retry::{RetryPolicy, persist, retry_after};
use super::{status, wait};

/// Fails in these ways one after the other, and then succeeds. Returns the outcome and when attempts were made.
async fn attempts(
    policy: &RetryPolicy,
    failures: &[Failure],
) -> (Result<usize, (Failure, usize)>, Vec<Duration>) {
    let start = Instant::now();
    let times = RefCell::new(Vec::new());
    let outcome = persist(policy, || async {
        times.borrow_mut().push(start.elapsed());
        let made = times.borrow().len();
        failures.get(made - 1).cloned().map_or(Ok(made), Err)
    })
    .await;
    (outcome.map_err(|given_up| (given_up.failure, given_up.attempts)), times.into_inner())
}

#[tokio::test(start_paused = true)]
async fn pauses_double_and_are_lengthened_by_chance() {
    let busy = vec![status(503, ""); 4];
    for _ in 0..20 {
        let (outcome, times) = attempts(&RetryPolicy::default(), &busy).await;
        assert_eq!(outcome, Err((busy[0].clone(), 4)));
        for (place, pair) in times.windows(2).enumerate() {
            let pause = pair[1] - pair[0];
            let least = Duration::from_millis(500) * 2_u32.pow(u32::try_from(place).unwrap());
            // The clock of the tests counts whole milliseconds.
            let most = 2 * least + Duration::from_millis(1);
            assert!((least..=most).contains(&pause), "pause {place} is {pause:?}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn the_servers_own_pause_is_made_instead() {
    let (outcome, times) = attempts(&RetryPolicy::default(), &[wait(60), wait(0), wait(7)]).await;
    assert_eq!(outcome, Ok(4));
    assert_eq!(times, [0, 60, 60, 67].map(Duration::from_secs));
    let (outcome, times) = attempts(&RetryPolicy::default(), &[wait(61)]).await;
    assert_eq!((outcome, times.len()), (Err((wait(61), 1)), 1));
}

#[rstest]
#[case(status(400, ""), 1)]
#[case(status(401, ""), 1)]
#[case(status(404, ""), 1)]
#[case(status(413, ""), 1)]
#[case(status(307, ""), 1)]
#[case(status(408, ""), 4)]
#[case(status(409, ""), 4)]
#[case(status(425, ""), 4)]
#[case(status(429, ""), 4)]
#[case(status(500, ""), 4)]
#[case(status(529, ""), 4)]
#[case(Failure::NoResponse("connection refused".to_owned()), 4)]
#[case(Failure::BrokenOff("connection reset".to_owned()), 4)]
#[case(Failure::TimedOut(Duration::from_secs(120)), 4)]
#[case(Failure::garbled("no JSON", "<html>"), 4)]
#[case(Failure::NotTried { failures: 8, last: String::new(), wait: Duration::ZERO }, 1)]
#[tokio::test(start_paused = true)]
async fn only_what_may_pass_is_tried_again(#[case] failure: Failure, #[case] tries: usize) {
    let (outcome, times) = attempts(&RetryPolicy::default(), &vec![failure.clone(); 9]).await;
    assert_eq!((outcome, times.len()), (Err((failure, tries)), tries));
}

#[rstest]
#[case(429, r#"{"error": {"message": "Pay.", "type": "insufficient_quota", "code": "insufficient_quota"}}"#)]
#[case(429, r#"[{"error": {"message": "Pay.", "code": "insufficient_quota"}}]"#)]
#[case(400, r#"{"type": "error", "error": {"type": "invalid_request_error", "message": "Your credit balance is too low."}}"#)]
#[case(402, "")]
fn a_quota_that_is_used_up_is_known(#[case] code: u16, #[case] body: &str) {
    let failure = status(code, body);
    assert!(!failure.may_pass());
    assert!(matches!(failure, Failure::Status(refusal) if refusal.quota == Quota::UsedUp));
}

#[rstest]
#[case(&[("retry-after", "7")], Some(7_000))]
#[case(&[("retry-after", "0.25")], Some(250))]
#[case(&[("retry-after", "-3")], Some(0))]
#[case(&[("retry-after-ms", "1500"), ("retry-after", "7")], Some(1_500))]
#[case(&[("retry-after-ms", "soon"), ("retry-after", "7")], Some(7_000))]
#[case(&[("retry-after", "Fri, 13 Feb 2009 23:31:40 GMT")], Some(10_000))]
#[case(&[("retry-after", "Fri, 13 Feb 2009 23:31:20 GMT")], Some(0))]
#[case(&[("retry-after", "soon")], None)]
#[case(&[("retry-after", "nan")], None)]
#[case(&[("retry-after", "1e300")], Some(u128::MAX))]
#[case(&[], None)]
fn the_pause_is_read(#[case] headers: &[(&'static str, &'static str)], #[case] milliseconds: Option<u128>) {
    let now = SystemTime::UNIX_EPOCH + Duration::from_secs(1_234_567_890);
    let headers = HeaderMap::from_iter(
        headers.iter().map(|&(name, value)| (HeaderName::from_static(name), HeaderValue::from_static(value))),
    );
    let expected =
        milliseconds.map(|number| u64::try_from(number).map_or(Duration::MAX, Duration::from_millis));
    assert_eq!(retry_after(&headers, now), expected);
}
