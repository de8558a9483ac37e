//! A reply that was paid for is kept, whatever happens.

use std::io::Write;

use futures::future::join_all;
use rstest::rstest;

use super::*;

fn remembered(text: &str) -> ChatReply {
    ChatReply { origin: Origin::Memory, ..ChatReply::words(text) }
}

#[tokio::test]
async fn a_reply_is_given_again_at_no_cost() {
    let (_folder, path) = file();
    let echo = Echo::new();
    let cache = Cache::open(echo.clone(), &path).unwrap();
    let first = ask(&cache, "one").await.unwrap();
    assert_eq!((first.origin, first.usage), (Origin::Model, USAGE));
    assert_eq!(ask(&cache, "one").await.unwrap(), remembered("one 1"));
    drop(cache);
    let reopened = Cache::open(echo.clone(), &path).unwrap();
    assert_eq!(ask(&reopened, "one").await.unwrap(), remembered("one 1"));
    assert_eq!(words(&reopened, "two").await, "two 2");
    assert_eq!(echo.calls(), 2);
    let (header, exchanges) = lines(&path);
    assert_eq!((header.model.as_str(), exchanges.len()), ("echo", 2));
    #[cfg(unix)]
    assert_eq!(mode(&path), 0o600);
}

#[tokio::test]
async fn only_whole_replies_are_kept() {
    let (_folder, path) = file();
    let echo = Echo::failing(1);
    let cache = Cache::open(echo.clone(), &path).unwrap();
    assert!(ask(&cache, "one").await.is_err());
    assert_eq!(words(&cache, "one").await, "one 2");
    for question in ["break off", "refuse"] {
        ask(&cache, question).await.unwrap();
        assert_eq!(ask(&cache, question).await.unwrap().origin, Origin::Model);
    }
    assert_eq!(echo.calls(), 6);
    assert_eq!(lines(&path).1.len(), 1);
}

/// A recording can be gone on with; what is not worth keeping in it is asked for again.
#[tokio::test]
async fn a_recording_is_a_memory() {
    let (_folder, path) = file();
    let recorder = Recorder::create(Echo::failing(1), &path).unwrap();
    for question in ["failed", "one", "one", "refuse"] {
        let _ = ask(&recorder, question).await;
    }
    drop(recorder);
    let cache = Cache::open(Echo::new(), &path).unwrap();
    assert_eq!(ask(&cache, "one").await.unwrap(), remembered("one 2"), "the first of several replies counts");
    for question in ["failed", "refuse"] {
        assert_eq!(ask(&cache, question).await.unwrap().origin, Origin::Model);
    }
}

#[rstest]
#[case::it_answers(0, 1)]
#[case::it_fails_twice(2, 3)]
#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn equal_requests_are_put_to_the_model_once(#[case] failures: usize, #[case] calls: usize) {
    let (_folder, path) = file();
    let echo = Echo::failing(failures);
    let cache = Cache::open(echo.clone(), &path).unwrap();
    let outcomes = join_all((0..20).map(|_| ask(&cache, "again and again"))).await;
    assert_eq!(echo.calls(), calls);
    let of = |origin| outcomes.iter().flatten().filter(|reply| reply.origin == origin).count();
    assert_eq!((of(Origin::Model), of(Origin::Memory)), (1, 19 - failures));
    assert_eq!(lines(&path).1.len(), 1);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn a_request_that_nobody_waits_for_holds_up_no_other() {
    let (_folder, path) = file();
    let echo = Echo::new();
    let cache = Cache::open(echo.clone(), &path).unwrap();
    let mut given_up = Box::pin(ask(&cache, "one"));
    while echo.calls() == 0 {
        assert!(futures::poll!(given_up.as_mut()).is_pending());
        tokio::task::yield_now().await;
    }
    drop(given_up);
    let asked_again = tokio::time::timeout(Duration::from_secs(10), words(&cache, "one")).await;
    assert_eq!(asked_again.unwrap(), "one 2");
}

/// Whatever byte a crash ends the file at, the whole lines stay, and the file is in order again.
#[tokio::test]
async fn a_torn_line_is_cut_off() {
    let (_folder, path) = file();
    recorded(&path, &["one", "zwölf"]).await;
    let whole = std::fs::read(&path).unwrap();
    for end in 0..whole.len() {
        std::fs::write(&path, &whole[..end]).unwrap();
        let kept = whole[..end].iter().filter(|byte| **byte == b'\n').count();
        let cache = Cache::open(Echo::new(), &path).unwrap();
        let (header, exchanges) = lines(&path);
        assert_eq!(
            (header.model.as_str(), exchanges.len()),
            ("echo", kept.saturating_sub(1)),
            "cut at {end}"
        );
        for question in ["zwölf", "one"] {
            ask(&cache, question).await.unwrap();
        }
        assert_eq!(lines(&path).1.len(), 2, "cut at byte {end}");
    }
}

/// Another process died over a line while this one has the file open.
#[tokio::test]
async fn what_another_process_left_behind_is_cut_off() {
    let (_folder, path) = file();
    let cache = Cache::open(Echo::new(), &path).unwrap();
    ask(&cache, "one").await.unwrap();
    File::options().append(true).open(&path).unwrap().write_all(b"{\"fingerprint\":\"0a").unwrap();
    assert_eq!(ask(&cache, "one").await.unwrap().origin, Origin::Memory);
    ask(&cache, "two").await.unwrap();
    assert_eq!(lines(&path).1.len(), 2);
}

#[tokio::test]
async fn a_file_that_somebody_emptied_begins_anew() {
    let (_folder, path) = file();
    let cache = Cache::open(Echo::new(), &path).unwrap();
    ask(&cache, "one").await.unwrap();
    std::fs::write(&path, "").unwrap();
    ask(&cache, "two").await.unwrap();
    assert_eq!(lines(&path).1.len(), 1);
    assert_eq!(words(&Cache::open(Echo::new(), &path).unwrap(), "two").await, "two 2");
}

#[tokio::test]
async fn two_caches_on_one_file_share_what_they_keep() {
    let (_folder, path) = file();
    let (left, right) = (Cache::open(Echo::new(), &path).unwrap(), Cache::open(Echo::new(), &path).unwrap());
    ask(&left, "one").await.unwrap();
    assert_eq!(ask(&right, "one").await.unwrap(), remembered("one 1"));
    ask(&right, "two").await.unwrap();
    assert_eq!(ask(&left, "two").await.unwrap(), remembered("two 1"));
    assert_eq!(lines(&path).1.len(), 2);
}

/// Each cache opens the file by itself, as a process of its own does.
#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn many_caches_on_one_file_write_whole_lines() {
    let (_folder, path) = file();
    let caches = (0..4).map(|cache| {
        let path = path.clone();
        tokio::spawn(async move {
            let cache_model = Cache::open(Echo::new(), &path).unwrap();
            join_all((0..25).map(async |number| {
                // Every second question is put by all of them.
                let whose = if number % 2 == 0 { 9 } else { cache };
                let question = format!("{whose}-{number} ").repeat(1 + number * 100);
                assert!(words(&cache_model, &question).await.starts_with(&question));
            }))
            .await;
        })
    });
    for outcome in join_all(caches).await {
        outcome.unwrap();
    }
    let fingerprints: Vec<Fingerprint> = lines(&path).1.iter().map(|exchange| exchange.fingerprint).collect();
    let different: std::collections::BTreeSet<Fingerprint> = fingerprints.iter().copied().collect();
    assert_eq!((fingerprints.len(), different.len()), (13 + 4 * 12, 13 + 4 * 12));
}

/// A file that is not ours is refused and left as it is, even where it looks torn.
#[tokio::test]
async fn what_keeps_no_replies_of_this_model_is_refused() {
    let (folder, path) = file();
    recorded(&path, &["one"]).await;
    let whole = std::fs::read_to_string(&path).unwrap();
    let refused = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let error = told(&Cache::open(Echo::new(), &path).err().unwrap(), &path);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        error
    };
    insta::assert_snapshot!(refused(&whole.replacen("echo", "other", 1)), @r#"tape.jsonl keeps replies of the model "other", and this is "echo"; name another file for it"#);
    let other = refused("hello");
    insta::assert_snapshot!(other, @r#"tape.jsonl is no tape: its first line is not {"tape_version": …, "model": …}; name a file that --record wrote"#);
    for text in ["hello\n", "{\"event\": 1}\n", "{\"tape_versions\"", "a photo\nof a cat"] {
        assert_eq!(refused(text), other);
    }
    insta::assert_snapshot!(refused("{\"tape_version\":2}\n{\"torn"), @r#"tape.jsonl is a tape of version 2, and this program reads version 1; record anew with --record FILE"#);
    insta::assert_snapshot!(refused(&format!("{whole}{{\"torn in the middle\n{{}}\n")), @r#"tape.jsonl:3: this is no exchange with a model: EOF while parsing a string at line 1 column 20; delete the line, or record anew"#);
    insta::assert_snapshot!(told(&Cache::open(Echo::new(), folder.path()).err().unwrap(), folder.path()), @r#"tape.jsonl is a folder; name a file for the tape"#);
}

/// A damaged line that appears while the file is in use ends the run with its place.
#[tokio::test]
async fn damage_is_told_when_it_is_met() {
    let (_folder, path) = file();
    let cache = Cache::open(Echo::new(), &path).unwrap();
    ask(&cache, "one").await.unwrap();
    File::options().append(true).open(&path).unwrap().write_all(b"{\"half\n").unwrap();
    let ModelError::Unusable { reason } = ask(&cache, "two").await.unwrap_err() else { panic!() };
    insta::assert_snapshot!(told(&reason, &path), @r#"tape.jsonl:3: this is no exchange with a model: EOF while parsing a string at line 1 column 6; delete the line, or record anew"#);
}
