//! A language-model provider that is scripted: an HTTP server that speaks OpenAI's chat completions and embeddings and
//! Anthropic's messages, checks every request against what the providers publish, and answers out of a brain of the project's
//! own, or wrongly where the script says so.
//!
//! ```no_run
//! use coin_tests::provider::{Fault, FaultPlan, Script, ScriptedProvider};
//!
//! let provider = ScriptedProvider::start(Script {
//!     faults: FaultPlan::first(1, Fault::Status(503)),
//!     ..Script::default()
//! });
//! // OPENAI_BASE_URL=provider.openai_url(), ANTHROPIC_BASE_URL=provider.anthropic_url()
//! provider.assert_no_violations();
//! ```

mod anthropic;
mod brain;
mod faults;
mod openai;
mod programs;
mod record;
mod rules;
mod serve;
mod spoil;

use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread::JoinHandle;
use std::time::Duration;

use coin_schemas::episode::FEATURE_DIMENSIONS;
use tokio::sync::oneshot;

pub use self::brain::{Brain, EmbeddedBrain, Turn};
pub use self::faults::{Fault, FaultPlan, Manner, Occasion, RetryAfter};
pub use self::programs::KEY;
pub use self::record::Recorded;

use self::record::Log;

/// How words become an embedding.
pub type Encoder = dyn Fn(&str) -> Vec<f64> + Send + Sync;

/// What a scripted provider does. The default answers every request at once, rightly, and to anybody.
pub struct Script {
    /// Who thinks. By default the project's own evidence model.
    pub brain: Arc<dyn Brain>,
    /// How words become an embedding. By default all become the same, of 512 numbers.
    pub encoder: Arc<Encoder>,
    /// How long every answer takes.
    pub delay: Duration,
    /// What goes wrong.
    pub faults: FaultPlan,
    /// The chance in the fault plan follows from this and from what is asked, not from the order of requests.
    pub seed: u64,
    /// The only key that is let in. Without one, everybody is.
    pub key: Option<String>,
    /// The only model that is known. Without one, every model is.
    pub model: Option<String>,
    /// Parameters of a request that are refused with 400, such as `temperature`; `json_schema` and `json_object`
    /// stand for these forms of a reply.
    pub refuses: Vec<&'static str>,
    /// Whether such a refusal names the parameter.
    pub manner: Manner,
}

impl Default for Script {
    fn default() -> Self {
        Self {
            brain: Arc::new(EmbeddedBrain::default()),
            encoder: Arc::new(|_| vec![1.0; FEATURE_DIMENSIONS]),
            delay: Duration::ZERO,
            faults: FaultPlan::none(),
            seed: 0,
            key: None,
            model: None,
            refuses: Vec::new(),
            manner: Manner::Named,
        }
    }
}

impl Script {
    /// A provider that answers everything with this fault, if it can.
    pub fn always(fault: Fault) -> Self {
        Self { faults: FaultPlan::always(fault), ..Self::default() }
    }
}

/// A running scripted provider. It ends when this is dropped, and breaks off what it was saying.
#[derive(Debug)]
pub struct ScriptedProvider {
    address: SocketAddr,
    log: Arc<Log>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl ScriptedProvider {
    /// Starts it in a thread of its own, on a free port of this machine.
    pub fn start(script: Script) -> Self {
        let log = Arc::new(Log::default());
        let (stop, stopped) = oneshot::channel();
        let (sender, receiver) = channel();
        let thread = {
            let log = Arc::clone(&log);
            std::thread::spawn(move || {
                let runtime =
                    tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
                runtime.block_on(serve::serve(script, log, sender, stopped));
            })
        };
        let address = receiver.recv().expect("a free port of this machine can be bound");
        Self { address, log, stop: Some(stop), thread: Some(thread) }
    }

    /// The root, such as `http://127.0.0.1:40001`.
    pub fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// The base URL for `OPENAI_BASE_URL`.
    pub fn openai_url(&self) -> String {
        format!("{}/v1", self.url())
    }

    /// The base URL for `ANTHROPIC_BASE_URL`.
    pub fn anthropic_url(&self) -> String {
        self.url()
    }

    /// Everything that was asked so far, in the order in which it came.
    pub fn requests(&self) -> Vec<Recorded> {
        self.log.requests()
    }

    /// How many requests came.
    pub fn request_count(&self) -> usize {
        self.log.requests().len()
    }

    /// How often the brain was asked.
    pub fn turns(&self) -> usize {
        self.log.requests().iter().filter(|request| request.was_thought_about).count()
    }

    /// How many requests were under way at the same time at most.
    pub fn most_at_once(&self) -> usize {
        self.log.most_at_once()
    }

    /// How many requests are under way now.
    pub fn under_way(&self) -> usize {
        self.log.under_way()
    }

    /// How many clients left before they were answered.
    pub fn abandoned(&self) -> usize {
        self.log.requests().iter().filter(|request| request.was_abandoned).count()
    }

    /// What was wrong with the requests by the rules that the providers publish.
    pub fn violations(&self) -> Vec<String> {
        let requests = self.log.requests();
        let told = |request: &Recorded| {
            let number = request.number;
            request.violations.iter().map(|found| format!("request {number}: {found}")).collect::<Vec<_>>()
        };
        requests.iter().flat_map(told).collect()
    }

    /// Fails the test if a request was wrong, or if there was none.
    #[track_caller]
    pub fn assert_no_violations(&self) {
        assert!(self.request_count() > 0, "the provider was asked nothing");
        let violations = self.violations();
        assert!(violations.is_empty(), "the providers would refuse this: {violations:#?}");
    }
}

impl Drop for ScriptedProvider {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            let _ = stop.send(());
        }
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A root URL at which nobody listens: a port that was free a moment ago.
pub fn refused_url() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port of this machine can be bound");
    format!("http://{}", listener.local_addr().expect("a bound socket has an address"))
}
