//! Laws of the circuit breaker, by a clock that does not wait.

use std::time::Duration;

use proptest::prelude::*;
use rstest::rstest;

use super::super::breaker::{Breaker, History};
use super::super::failure::Failure;
use super::status;

const PAUSE: Duration = Duration::from_secs(30);

fn breaker() -> Breaker {
    Breaker::new(8, PAUSE)
}

fn fail(breaker: &Breaker, times: usize) {
    for _ in 0..times {
        breaker.permit().unwrap().settle(Some(&status(500, "broken")));
    }
}

#[tokio::test(start_paused = true)]
async fn eight_failures_in_a_row_open_it_for_half_a_minute() {
    let breaker = breaker();
    fail(&breaker, 7);
    breaker.permit().unwrap().settle(None);
    fail(&breaker, 8);
    tokio::time::advance(Duration::from_secs(12)).await;
    assert_eq!(
        breaker.permit().unwrap_err(),
        Failure::NotTried { failures: 8, last: "500: broken".to_owned(), wait: Duration::from_secs(18) }
    );
    tokio::time::advance(Duration::from_secs(18)).await;
    assert!(breaker.permit().is_ok());
}

#[tokio::test(start_paused = true)]
async fn one_trial_at_a_time_is_let_through() {
    let breaker = breaker();
    fail(&breaker, 8);
    tokio::time::advance(PAUSE).await;
    let trial = breaker.permit().unwrap();
    assert!(breaker.permit().is_err());
    trial.settle(Some(&status(500, "")));
    assert!(breaker.permit().is_err(), "a trial that fails opens it anew");
    tokio::time::advance(PAUSE).await;
    breaker.permit().unwrap().settle(None);
    fail(&breaker, 7);
    assert!(breaker.permit().is_ok(), "a trial that succeeds closes it and begins a new count");
}

#[tokio::test(start_paused = true)]
async fn a_trial_that_is_left_makes_room_for_the_next() {
    let breaker = breaker();
    fail(&breaker, 8);
    tokio::time::advance(PAUSE).await;
    drop(breaker.permit().unwrap());
    assert!(breaker.permit().is_ok());
}

#[tokio::test(start_paused = true)]
async fn an_answer_that_was_under_way_closes_it() {
    let breaker = breaker();
    let slow = breaker.permit().unwrap();
    fail(&breaker, 8);
    assert!(breaker.permit().is_err());
    slow.settle(None);
    assert!(breaker.permit().is_ok());
}

#[rstest]
#[case(status(500, ""), false, History::NeverAnswered)]
#[case(status(529, ""), false, History::NeverAnswered)]
#[case(Failure::NoResponse(String::new()), false, History::NeverAnswered)]
#[case(Failure::BrokenOff(String::new()), false, History::NeverAnswered)]
#[case(Failure::TimedOut(PAUSE), false, History::NeverAnswered)]
#[case(Failure::garbled("", ""), true, History::NeverAnswered)]
#[case(status(429, ""), true, History::Answered)]
#[case(status(401, ""), true, History::Answered)]
#[tokio::test(start_paused = true)]
async fn only_a_server_that_is_broken_or_gone_counts(
    #[case] failure: Failure,
    #[case] stays_closed: bool,
    #[case] history: History,
) {
    let breaker = breaker();
    for _ in 0..8 {
        breaker.permit().unwrap().settle(Some(&failure));
    }
    assert_eq!(breaker.permit().is_ok(), stays_closed);
    assert_eq!(breaker.history(), history);
}

proptest! {
    /// While nothing is waited for, the breaker is open exactly if the last eight attempts have failed.
    #[test]
    fn it_counts_what_comes_in_a_row(outcomes in prop::collection::vec(prop::bool::weighted(0.15), 0..60)) {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        runtime.block_on(async {
            let breaker = breaker();
            let mut in_a_row = 0;
            for succeeds in outcomes {
                let Ok(permit) = breaker.permit() else { break };
                let failure = status(503, "");
                permit.settle((!succeeds).then_some(&failure));
                in_a_row = if succeeds { 0 } else { in_a_row + 1 };
                prop_assert_eq!(breaker.permit().is_err(), in_a_row >= 8);
            }
            Ok(())
        })?;
    }
}
