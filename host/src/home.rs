//! From an episode's folder to a served home: what the host needs to know before a run, and the connection to
//! the server that knows the rest.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use coin::owners::OwnerSet;
use coin::roster::{Roster, RosterError};
use coin_schemas::episode::Episode;
use coin_schemas::household::{ObjectId, Source, UserName};
use coin_schemas::model::TaskObject;
use coin_schemas::tools::{
    ListObjects, ListObjectsResult, ListUsers, ListUsersResult, MAX_LIMIT, display_name,
};
use coin_server::episode::{EpisodeError, LoadedEpisode};
use coin_server::service::{CoinService, ServiceOptions, service};
use coin_server::store::{Access, Store, StoreError};
use thiserror::Error;

use crate::client::{ServerAddress, ServerError, ToolServer};

/// Why a home cannot be served.
#[derive(Debug, Error)]
pub enum HomeError {
    /// The episode is refused.
    #[error(transparent)]
    Episode(#[from] EpisodeError),
    /// The database is refused.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The household is refused.
    #[error("the episode's household is refused: {0}")]
    Roster(#[from] RosterError),
    /// The server cannot be used.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// The server knows another home.
    #[error(
        "the server's home is not that of the episode: {difference}; import it first with \
         `coin-server import --episode DIR --db FILE` and start the server on that FILE"
    )]
    OtherHome {
        /// What differs.
        difference: String,
    },
    /// A database was named that this host would not use.
    #[error("--db is for the server in this process; give the database to the server that --server names")]
    DatabaseOfOtherServer,
}

/// A served home.
#[derive(Debug)]
pub struct Home {
    /// The episode's description; it holds no truth.
    pub episode: Episode,
    /// The household.
    pub roster: Roster,
    /// The things as tasks name them.
    pub things: BTreeMap<ObjectId, TaskObject>,
    /// Owners that people named before this run.
    pub answered: BTreeMap<ObjectId, OwnerSet>,
    /// The connection.
    pub server: ToolServer,
}

impl Home {
    /// The things that a person would name in one word: all of a class in a room, where there are several.
    pub fn alike(&self) -> Vec<Vec<ObjectId>> {
        let mut groups: BTreeMap<(String, &str), Vec<ObjectId>> = BTreeMap::new();
        for thing in self.things.values() {
            if let Some(room) = &thing.room {
                groups.entry((display_name(&thing.class), room)).or_default().push(thing.id.clone());
            }
        }
        groups.into_values().filter(|group| group.len() > 1).collect()
    }

    /// Connects an episode to its server. In this process the episode is imported first, into `db` or into
    /// memory; another server must know the episode's home already.
    pub async fn open(
        loaded: LoadedEpisode,
        db: Option<PathBuf>,
        address: &ServerAddress,
    ) -> Result<Self, HomeError> {
        let in_process = *address == ServerAddress::InProcess;
        if db.is_some() && !in_process {
            return Err(HomeError::DatabaseOfOtherServer);
        }
        let (loaded, service) = if in_process {
            blocking(move || {
                let service = import(&loaded, db.as_deref())?;
                Ok((loaded, Some(service)))
            })
            .await?
        } else {
            (loaded, None)
        };
        let episode = loaded.episode;
        let roster = Roster::new(&episode.users)?;
        let server = match (address, service) {
            (ServerAddress::Command(words), _) => ToolServer::child(words).await?,
            (ServerAddress::Url(url), _) => ToolServer::url(url).await?,
            (ServerAddress::InProcess, Some(service)) => ToolServer::in_process(service).await?,
            (ServerAddress::InProcess, None) => {
                return Err(HomeError::OtherHome { difference: "nothing was imported".to_owned() });
            }
        };
        let things = episode.objects.iter().map(|object| (object.id.clone(), object.clone())).collect();
        let mut home = Self { episode, roster, things, answered: BTreeMap::new(), server };
        home.answered = home.compare_with_server().await?;
        Ok(home)
    }

    /// Refuses a server that knows other people or things, and returns what people have answered before.
    async fn compare_with_server(&self) -> Result<BTreeMap<ObjectId, OwnerSet>, HomeError> {
        let users: ListUsersResult = self.server.call("list_users", &ListUsers {}).await?;
        let names: Vec<&str> = users.users.iter().map(|user| user.name.as_str()).collect();
        let own: Vec<&str> = self.roster.names().map(UserName::as_str).collect();
        if names != own {
            let difference = format!("its people are {names:?}, those of the episode {own:?}");
            return Err(HomeError::OtherHome { difference });
        }
        let mut answered = BTreeMap::new();
        let mut seen = 0;
        let mut request = ListObjects { limit: MAX_LIMIT, ..ListObjects::default() };
        loop {
            let page: ListObjectsResult = self.server.call("list_objects", &request).await?;
            for object in page.objects {
                if !self.things.contains_key(&object.id) {
                    let difference = format!("its thing {} is not in the episode", object.id);
                    return Err(HomeError::OtherHome { difference });
                }
                seen += 1;
                if object.source == Some(Source::Answer) {
                    answered.insert(object.id, self.roster.owner_set(&object.owners)?);
                }
            }
            match page.next_cursor {
                Some(cursor) => request.cursor = Some(cursor),
                None => break,
            }
        }
        if seen != self.things.len() {
            let difference = format!("it knows {seen} of the episode's {} things", self.things.len());
            return Err(HomeError::OtherHome { difference });
        }
        Ok(answered)
    }
}

/// Loads an episode's folder, but not its truth.
pub async fn load(folder: &Path) -> Result<LoadedEpisode, HomeError> {
    let folder = folder.to_owned();
    blocking(move || Ok(coin_server::episode::load(&folder)?)).await
}

/// Loading and importing a large home would stall every other task.
pub(crate) async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, HomeError> + Send + 'static,
) -> Result<T, HomeError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(panic) => std::panic::resume_unwind(panic.into_panic()),
    }
}

fn import(loaded: &LoadedEpisode, db: Option<&Path>) -> Result<CoinService, HomeError> {
    let store = match db {
        Some(file) => Store::open(file, Access::ReadWrite)?,
        None => Store::open_in_memory()?,
    };
    store.import(loaded)?;
    Ok(service(Arc::new(store), ServiceOptions::default()))
}
