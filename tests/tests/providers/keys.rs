//! Keys go to the server and nowhere else.

use std::io::Write;
use std::sync::{Arc, Mutex};

use coin_host::model::provider::{Provider, RemoteModel};
use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider};

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
        let model = RemoteModel::at(provider, "scripted-1", &url, Some(&key), &settings()).unwrap();
        first_turn(&model).await.unwrap();
        assert_eq!(server.requests()[0].headers[header], value);
    }
}

#[tokio::test]
async fn a_server_of_ones_own_needs_no_key() {
    let server = ScriptedProvider::start(Script::default());
    let model = RemoteModel::at(Provider::OpenAi, "llama", &server.openai_url(), None, &settings()).unwrap();
    first_turn(&model).await.unwrap();
    assert!(!server.requests()[0].headers.contains_key("authorization"));
    server.assert_no_violations();
}

#[tokio::test]
async fn a_server_of_ones_own_that_wants_a_key_says_so() {
    let server = ScriptedProvider::start(Script { key: Some(KEY.to_owned()), ..Script::default() });
    let url = server.openai_url();
    let model = RemoteModel::at(Provider::OpenAi, "llama", &url, None, &settings()).unwrap();
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

/// Everything that is logged on this thread while a test runs.
#[derive(Clone, Default)]
struct Logged(Arc<Mutex<Vec<u8>>>);

impl Logged {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
    }

    fn start(&self) -> tracing::subscriber::DefaultGuard {
        let log = self.clone();
        let subscriber = tracing_subscriber::fmt()
            .with_max_level(tracing::Level::TRACE)
            .with_ansi(false)
            .with_writer(move || log.clone())
            .finish();
        tracing::subscriber::set_default(subscriber)
    }
}

impl Write for Logged {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[tokio::test]
async fn no_log_shows_the_key() {
    let logged = Logged::default();
    let _logging = logged.start();
    for provider in super::BOTH {
        // Every one of these answers repeats the key.
        let faults = [Fault::Status(503), Fault::Html, Fault::OtherJson].map(Some).to_vec();
        let server = ScriptedProvider::start(Script {
            faults: FaultPlan::script(faults),
            refuses: vec!["temperature"],
            ..Script::default()
        });
        first_turn(&model(&server, provider)).await.unwrap();
    }
    let log = logged.text();
    for told in ["trying again", "a parameter was refused", "your key is [key]", "Hello [key]"] {
        assert!(log.contains(told), "{log}");
    }
    assert!(!log.contains(KEY), "{log}");
}

#[test]
fn a_key_in_the_clear_is_warned_of_once() {
    let warnings = |url: &str, key: Option<&str>| {
        let logged = Logged::default();
        let _logging = logged.start();
        RemoteModel::at(Provider::OpenAi, "llama", url, key, &settings()).unwrap();
        assert!(!logged.text().contains(KEY));
        logged.text().matches("sent over plain http").count()
    };
    assert_eq!(warnings("http://192.0.2.7/v1", Some(KEY)), 1);
    assert_eq!(warnings("http://192.0.2.7/v1", None), 0);
    assert_eq!(warnings("https://192.0.2.7/v1", Some(KEY)), 0);
    assert_eq!(warnings("http://127.0.0.1:1/v1", Some(KEY)), 0);
}
