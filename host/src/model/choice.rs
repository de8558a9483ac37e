//! Which model runs, and what is put around it: a cache, a budget, a recording.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

use coin::calibration::EMBEDDED_MODEL;
use thiserror::Error;

use super::embedded::EmbeddedModel;
use super::metered::{Metered, TokenBudget};
use super::provider::{Provider, ProviderSettings, RemoteModel};
use super::tape::{Cache, Recorder, Replay, TapeError};
use super::{ChatModel, ModelError};

/// A model by the name under which it is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ModelChoice {
    /// The evidence model, which needs no service.
    Embedded,
    /// A language model of a provider.
    Remote(Provider, String),
    /// What a model said while it was recorded.
    Replay(PathBuf),
}

/// Why a text names no model.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{given:?} names no model; give {EMBEDDED_MODEL}, openai:NAME (any server that speaks OpenAI's Chat Completions, at \
     OPENAI_BASE_URL), anthropic:NAME, or replay:FILE"
)]
pub struct UnknownModel {
    given: String,
}

impl FromStr for ModelChoice {
    type Err = UnknownModel;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let unknown = || UnknownModel { given: text.to_owned() };
        if text == EMBEDDED_MODEL {
            return Ok(Self::Embedded);
        }
        match text.split_once(':') {
            Some((_, "")) | None => Err(unknown()),
            Some(("openai", name)) => Ok(Self::Remote(Provider::OpenAi, name.to_owned())),
            Some(("anthropic", name)) => Ok(Self::Remote(Provider::Anthropic, name.to_owned())),
            Some(("replay", file)) => Ok(Self::Replay(PathBuf::from(file))),
            Some(_) => Err(unknown()),
        }
    }
}

/// Why a model cannot be made ready.
#[derive(Debug, Error)]
pub enum ReadyError {
    /// The model itself cannot be used, such as without a key.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A tape, a cache or a recording is refused.
    #[error(transparent)]
    File(#[from] TapeError),
    /// The recording would empty what is to be played or kept.
    #[error("--record names the same file as the tape or the cache, {}; give the recording another one", path.display())]
    SameFile {
        /// The file.
        path: PathBuf,
    },
}

impl ReadyError {
    /// Whether what was given is at fault, so that the same call will fail again.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Model(_) => false,
            Self::File(_) | Self::SameFile { .. } => true,
        }
    }
}

/// What is put around a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ModelSettings<'a> {
    /// The seed that is sent to a provider that takes one.
    pub seed: u64,
    /// How long a provider may take for one request.
    pub timeout: Duration,
    /// How many tokens may be spent.
    pub budget: Option<TokenBudget>,
    /// Where replies are kept, so that the same conversation is not paid for twice.
    pub cache: Option<&'a Path>,
    /// Where every exchange is written.
    pub record: Option<&'a Path>,
}

/// Makes a model ready. From the inside out: the model itself, what it costs, the cache, which costs nothing, and the
/// recording, which holds everything that was said.
///
/// # Errors
/// If the model cannot be used, such as without a key, or a file cannot.
pub fn ready(choice: &ModelChoice, settings: &ModelSettings<'_>) -> Result<Arc<dyn ChatModel>, ReadyError> {
    let read = match choice {
        ModelChoice::Embedded => None,
        ModelChoice::Remote(..) => settings.cache,
        ModelChoice::Replay(tape) => Some(tape.as_path()),
    };
    if let Some(path) = read.filter(|path| settings.record.is_some_and(|record| real(path) == real(record))) {
        return Err(ReadyError::SameFile { path: path.to_owned() });
    }
    let mut model: Arc<dyn ChatModel> = match choice {
        ModelChoice::Embedded => Arc::new(EmbeddedModel::default()),
        ModelChoice::Remote(provider, name) => {
            let ModelSettings { seed, timeout, .. } = *settings;
            let settings = ProviderSettings { seed, timeout, ..ProviderSettings::default() };
            Arc::new(RemoteModel::from_environment(*provider, name, &settings)?)
        }
        ModelChoice::Replay(file) => Arc::new(Replay::open(file)?),
    };
    let counts = match choice {
        ModelChoice::Remote(..) => true,
        // The embedded model takes no tokens, and a recording tells what was taken.
        ModelChoice::Embedded | ModelChoice::Replay(_) => settings.budget.is_some(),
    };
    if counts {
        model = Arc::new(match settings.budget {
            Some(budget) => Metered::with_budget(model, budget),
            None => Metered::new(model),
        });
    }
    if let (ModelChoice::Remote(..), Some(file)) = (choice, settings.cache) {
        model = Arc::new(Cache::open(model, file)?);
    }
    if let Some(file) = settings.record {
        model = Arc::new(Recorder::create(model, file)?);
    }
    Ok(model)
}

/// A path by which files can be told apart, also one that is not there yet.
fn real(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let within = |folder: PathBuf| path.file_name().map(|name| folder.join(name));
    path.canonicalize()
        .ok()
        .or_else(|| folder.canonicalize().ok().and_then(within))
        .unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case("embedded", ModelChoice::Embedded)]
    #[case("openai:gpt-4o-2024-11-20", ModelChoice::Remote(Provider::OpenAi, "gpt-4o-2024-11-20".to_owned()))]
    #[case("openai:qwen3:8b", ModelChoice::Remote(Provider::OpenAi, "qwen3:8b".to_owned()))]
    #[case("anthropic:claude-sonnet-4-5", ModelChoice::Remote(Provider::Anthropic, "claude-sonnet-4-5".to_owned()))]
    #[case("replay:week.tape", ModelChoice::Replay(PathBuf::from("week.tape")))]
    fn a_model_is_named_with_its_provider(#[case] text: &str, #[case] expected: ModelChoice) {
        assert_eq!(text.parse(), Ok(expected));
    }

    #[rstest]
    #[case("gpt-4o")]
    #[case("openai:")]
    #[case("replay:")]
    #[case("mistral:large")]
    #[case("")]
    fn anything_else_is_told_what_there_is(#[case] text: &str) {
        let error = text.parse::<ModelChoice>().unwrap_err().to_string();
        assert!(error.contains("openai:NAME") && error.contains("anthropic:NAME"), "{error}");
    }
}
