//! Long calls: progress and giving up.

use super::*;

/// Captions of so many seconds of one day.
fn captions(count: u32) -> Value {
    (0..count)
        .map(|second| {
            let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
            let caption = format!("2025-01-10 {hour:02}:{minute:02}:{second:02} Bob takes the Marker");
            json!({"object_id": "1", "caption": caption})
        })
        .collect()
}

#[tokio::test]
async fn a_long_call_tells_its_progress_to_a_client_that_wants_to_know() {
    let mut client = Client::initialized().await;
    let arguments = json!({"captions": captions(20_000)});
    let call = json!({"name": "record_usage", "arguments": arguments, "_meta": {"progressToken": "import"}});
    let answer = client.request("tools/call", call).await;
    assert_eq!(answer["result"]["structuredContent"]["recorded"], 20_000);
    let notes = std::mem::take(&mut client.notes);
    assert!(!notes.is_empty());
    let mut before = -1.0;
    for note in notes {
        assert_eq!(note["method"], "notifications/progress");
        assert_eq!(note["params"]["progressToken"], "import");
        assert_eq!(note["params"]["total"], 100.0);
        let progress = note["params"]["progress"].as_f64().unwrap();
        assert!(progress > before && progress < 100.0, "{progress} after {before}");
        assert!(note["params"]["message"].as_str().unwrap().contains(" of 20000 captions "), "{note}");
        before = progress;
    }
}

#[tokio::test]
async fn a_client_that_does_not_ask_hears_nothing_of_progress() {
    let mut client = Client::initialized().await;
    let answer = client.call("record_usage", json!({"captions": captions(2_000)})).await;
    assert_eq!(answer["result"]["structuredContent"]["recorded"], 2_000);
    assert_eq!(client.notes, Vec::<Value>::new());
}

#[tokio::test]
async fn a_call_that_its_client_gives_up_ends_and_is_not_answered() {
    let mut client = Client::initialized().await;
    client
        .send(json!({"jsonrpc": "2.0", "id": 77, "method": "tools/call", "params": {"name": "endless", "_meta": {"progressToken": 5}}}))
        .await;
    let first = client.next_message().await;
    assert_eq!(first["method"], "notifications/progress", "{first}");
    client
        .send(json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 77}}))
        .await;
    let ended = async {
        while !GIVEN_UP.load(Ordering::SeqCst) {
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
    };
    tokio::time::timeout(Duration::from_secs(10), ended).await.expect("the call goes on");
    let after = client.call("list_users", json!({})).await;
    assert_eq!(after["result"]["isError"], false);
}
