//! An episode that was imported into a database.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tempfile::TempDir;

use crate::binaries::Program;
use crate::episode::EpisodeBuilder;
use crate::server::{Era, ServerProcess};

/// A home in a database file, made by `coin-server import`. The file is removed when the home and all its servers
/// are gone.
#[derive(Debug)]
pub struct Home {
    folder: Arc<TempDir>,
}

impl Home {
    /// Imports an episode that was written by hand.
    #[track_caller]
    pub fn of(episode: &EpisodeBuilder) -> Self {
        Self::import(episode.write().path())
    }

    /// Imports an episode's folder.
    #[track_caller]
    pub fn import(episode: &Path) -> Self {
        let home = Self { folder: Arc::new(tempfile::tempdir().expect("a temporary folder can be made")) };
        Program::new("coin-server")
            .args(["import".as_ref(), "--episode".as_ref(), episode.as_os_str()])
            .args(["--db".as_ref(), home.db().as_os_str()])
            .run()
            .expect_code(0);
        home
    }

    /// The database file.
    pub fn db(&self) -> PathBuf {
        self.folder.path().join("home.db")
    }

    /// A path beside the database.
    pub fn join(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A server of this home that speaks the older protocol, as most hosts do.
    #[track_caller]
    pub fn server(&self) -> ServerProcess {
        self.server_of(Era::Legacy)
    }

    /// A server of this home.
    #[track_caller]
    pub fn server_of(&self, era: Era) -> ServerProcess {
        ServerProcess::start(["--db".as_ref(), self.db().as_os_str()], era).in_folder(&self.folder)
    }
}
