//! Every exchange is a line as soon as it has ended.

use futures::future::join_all;

use super::*;

#[tokio::test]
async fn an_exchange_is_a_line_that_is_there_at_once() {
    let (_folder, path) = file();
    let echo = Echo::failing(1);
    let recorder = Recorder::create(echo.clone(), &path).unwrap();
    assert_eq!(recorder.name(), "echo");
    assert_eq!(lines(&path).1, []);
    let outcomes = [ask(&recorder, "one").await, ask(&recorder, "one").await];
    assert!(outcomes[0].is_err() && outcomes[1].is_ok());
    insta::assert_snapshot!(std::fs::read_to_string(&path).unwrap().replace(env!("CARGO_PKG_VERSION"), "VERSION"), @r#"
    {"tape_version":1,"model":"echo","created_with":"coin-host VERSION"}
    {"fingerprint":"2beaaf533cb2f00dda3ca7f385834f112f149d49ff59460651a7c3220f7b311f","conversation":[{"from":"system","text":"Answer."},{"from":"user","text":"one"}],"tools":[],"reply_format":"text","outcome":{"error":{"why":"unanswered","reason":"busy 1"}}}
    {"fingerprint":"2beaaf533cb2f00dda3ca7f385834f112f149d49ff59460651a7c3220f7b311f","conversation":[{"from":"system","text":"Answer."},{"from":"user","text":"one"}],"tools":[],"reply_format":"text","outcome":{"reply":{"text":"one 2","ending":{"how":"finished"},"usage":{"prompt_tokens":7,"completion_tokens":3}}}}
    "#);
    ask(&recorder, "two\nlines").await.unwrap();
    assert_eq!(lines(&path).1.len(), 3);
}

#[cfg(unix)]
#[tokio::test]
async fn only_the_owner_can_read_it() {
    use std::os::unix::fs::PermissionsExt;
    let (_folder, path) = file();
    recorded(&path, &["one"]).await;
    assert_eq!(mode(&path), 0o600);

    std::fs::write(&path, "of an earlier run\n".repeat(100)).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o644)).unwrap();
    recorded(&path, &["one"]).await;
    assert_eq!(mode(&path), 0o600);
    assert_eq!(lines(&path).1.len(), 1, "a new tape replaces what was there");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn lines_are_whole_whoever_talks_at_the_same_time() {
    let (_folder, path) = file();
    let recorder = Recorder::create(Echo::new(), &path).unwrap();
    let questions: Vec<String> = (0..60).map(|number| format!("{number} ").repeat(1 + number * 50)).collect();
    join_all(questions.iter().map(|question| ask(&recorder, question))).await;
    let (_, exchanges) = lines(&path);
    let mut fingerprints: Vec<Fingerprint> = exchanges.iter().map(|exchange| exchange.fingerprint).collect();
    fingerprints.sort();
    fingerprints.dedup();
    assert_eq!(fingerprints.len(), 60);
}

#[tokio::test]
async fn what_cannot_be_written_is_told() {
    let (folder, path) = file();
    let refused = |path: &Path| told(&Recorder::create(Echo::new(), path).err().unwrap(), folder.path());
    insta::assert_snapshot!(refused(folder.path()), @r#"tape.jsonl is a folder; name a file for the tape"#);
    insta::assert_snapshot!(refused(&folder.path().join("none/tape.jsonl")), @r#"the tape tape.jsonl/none/tape.jsonl cannot be opened: No such file or directory (os error 2); name another file"#);

    let recording = Recorder::create(Echo::new(), &path).unwrap();
    ask(&recording, "one").await.unwrap();
    insta::assert_snapshot!(refused(&path), @r#"another run is recording to tape.jsonl/tape.jsonl; wait for its end or name another file"#);
    assert_eq!(lines(&path).1.len(), 1, "the other run's tape is left alone");
}

#[cfg(target_os = "linux")]
#[tokio::test]
async fn a_full_disk_makes_the_model_unusable() {
    insta::assert_snapshot!(Recorder::create(Echo::new(), "/dev/full").err().unwrap(), @r#"the tape /dev/full cannot be written: No space left on device (os error 28); make room there or name another file"#);
    let full = File::options().write(true).open("/dev/full").unwrap();
    let recorder = Recorder::over(Echo::new(), PathBuf::from("tape.jsonl"), full);
    let ModelError::Unusable { reason } = ask(&recorder, "one").await.unwrap_err() else { panic!() };
    insta::assert_snapshot!(reason, @r#"the tape tape.jsonl cannot be written: No space left on device (os error 28); make room there or name another file"#);
}
