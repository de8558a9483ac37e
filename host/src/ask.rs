//! `host ask`: a request in a person's words, and what the home's server makes of it.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{ArgGroup, Args};
use coin_schemas::tools::{AskedFor, FindDecision, FindObject, FindObjectResult, FoundObject};
use coin_server::service::{CoinService, ServiceOptions, service};
use coin_server::store::{Access, Store, StoreError};
use thiserror::Error;

use crate::client::{ServerError, ToolServer};
use crate::home::{self, HomeError};
use crate::model::ModelError;
use crate::model::provider::{EncoderName, ProviderSettings, RemoteEncoder};
use coin_server::display::plain_text;

const EXAMPLES: &str = "\
Examples:
  host ask 'bring me my cup' --speaker Bob --db home.db
      The thing that Bob means, where it is, and why it is his; or a question, or why he does not get it.
  host ask \"the book under Mary's desk\" --episode HOME
      In a home that is only looked at: nothing is kept.
  host ask 'whose mug is this?' --db home.db --json
      The whole result of find_object, and it alone, on standard output.
  host ask 'the striped mug' --encoder openai:clip --db home.db
      By its looks as well: no label need say that it is striped.

Exit status: 0 the thing is found; 1 failed; 2 wrong use, a refused file or an unknown speaker;
3 no thing is found: a question has to come first, or nothing is handed out.";

/// Arguments of `host ask`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("home").required(true).args(["db", "episode"])))]
pub struct AskArguments {
    /// What the person says
    pub words: String,
    /// The member of the household who says it; without, "my" is nobody's
    #[arg(long, value_name = "NAME")]
    pub speaker: Option<String>,
    /// The home's database; it is only read
    #[arg(long, value_name = "FILE")]
    pub db: Option<PathBuf>,
    /// The folder of an episode
    #[arg(long, value_name = "DIR")]
    pub episode: Option<PathBuf>,
    /// The encoder that made the features of the things, to find them by their looks as well: openai:NAME (any server
    /// that speaks OpenAI's Embeddings, at OPENAI_BASE_URL)
    #[arg(long, value_name = "ENCODER")]
    pub encoder: Option<EncoderName>,
    /// Print the result as JSON
    #[arg(long)]
    pub json: bool,
}

/// Why there is no result.
#[derive(Debug, Error)]
pub enum AskError {
    /// The home is refused, or its server fails.
    #[error(transparent)]
    Home(#[from] HomeError),
    /// The encoder cannot be used.
    #[error(transparent)]
    Encoder(#[from] ModelError),
    /// The result cannot be written as JSON.
    #[error("the result cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl AskError {
    /// Whether what was given is at fault.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Home(HomeError::Server(error)) => matches!(error, ServerError::Tool { .. }),
            Self::Home(_) => true,
            Self::Encoder(_) | Self::Json(_) => false,
        }
    }
}

/// What a request comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Reply {
    /// What is printed.
    pub text: String,
    /// What was decided.
    pub decision: FindDecision,
}

/// Asks a home's server, which runs in this process.
///
/// # Errors
/// If the home, the speaker or the encoder is refused, or the server or the encoder fails.
pub async fn ask(arguments: &AskArguments) -> Result<Reply, AskError> {
    let encoder = arguments.encoder.clone();
    let encoder = encoder
        .map(|name| RemoteEncoder::from_environment(name, &ProviderSettings::default()))
        .transpose()?;
    let server = ToolServer::in_process(open(arguments).await?).await.map_err(HomeError::from)?;
    let result = find(&server, arguments, encoder.as_ref()).await?;
    server.close().await;
    let text = match arguments.json {
        true => format!("{}\n", serde_json::to_string_pretty(&result)?),
        false => in_words(&result),
    };
    Ok(Reply { text, decision: result.decision })
}

/// The words for the thing alone are encoded, as the server has read them: neither whose it is nor where it is said to
/// be can be seen on it.
async fn find(
    server: &ToolServer,
    arguments: &AskArguments,
    encoder: Option<&RemoteEncoder>,
) -> Result<FindObjectResult, AskError> {
    let mut request = FindObject {
        query: arguments.words.clone(),
        speaker: arguments.speaker.clone(),
        ..FindObject::default()
    };
    let by_words: FindObjectResult = server.call("find_object", &request).await.map_err(HomeError::from)?;
    let Some(encoder) = encoder.filter(|_| !by_words.interpretation.words.is_empty()) else {
        return Ok(by_words);
    };
    request.query_embedding = Some(encoder.embed(&by_words.interpretation.words).await?);
    Ok(server.call("find_object", &request).await.map_err(HomeError::from)?)
}

async fn open(arguments: &AskArguments) -> Result<CoinService, HomeError> {
    let db = arguments.db.clone();
    let loaded = match &arguments.episode {
        Some(folder) => Some(home::load(folder).await?),
        None => None,
    };
    home::blocking(move || {
        let store = match (loaded, db) {
            (Some(loaded), _) => {
                let store = Store::open_in_memory()?;
                store.import(&loaded)?;
                store
            }
            (None, Some(file)) => Store::open(&file, Access::ReadOnly)?,
            (None, None) => return Err(StoreError::NobodyLivesHere.into()),
        };
        Ok(service(Arc::new(store), ServiceOptions::default()))
    })
    .await
}

/// The thing and why, the question, or the reason, in plain words.
fn in_words(result: &FindObjectResult) -> String {
    let lines = match (&result.object, result.interpretation.asked_for) {
        (Some(object), AskedFor::Object) => vec![place(object), object.explanation.clone()],
        (Some(object), AskedFor::Owner) => vec![object.explanation.clone(), place(object)],
        (None, _) => result.question.iter().chain(&result.reason).cloned().collect(),
    };
    lines.iter().map(|line| format!("{}\n", plain_text(line))).collect()
}

fn place(object: &FoundObject) -> String {
    let [x, y, z] = object.position.metres();
    let room = object.room.as_ref().map(|room| format!(" in the {room}")).unwrap_or_default();
    format!("{} (id {}){room}, at {x:.2}, {y:.2}, {z:.2} m.", object.name, object.id)
}
