//! Writing an episode to its folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use npyz::WriterBuilder;
use serde::Serialize;
use thiserror::Error;

use coin_schemas::episode::FEATURE_DIMENSIONS;

use super::GeneratedEpisode;

/// The file that makes a folder an episode.
const EPISODE_FILE: &str = "episode.json";
/// What the other files are called.
pub(super) const CAPTIONS_FILE: &str = "captions.jsonl";
pub(super) const EMBEDDINGS_FILE: &str = "embeddings.npy";
pub(super) const TRUTH_FILE: &str = "truth.json";

/// Why an episode was not written. The whole reason is in the message, so nothing is named as its source: whoever
/// prints the chain would say it twice.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The folder holds other people's files.
    #[error(
        "{} is not empty and holds no {EPISODE_FILE}, so it is left alone; name an empty or new folder, or one \
         that holds an episode, which is then replaced",
        folder.display()
    )]
    NotAnEpisode {
        /// The folder.
        folder: PathBuf,
    },
    /// The path is taken by something that is not a folder.
    #[error("{} is not a folder; name a new or an empty one", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("cannot write {}: {reason}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What it said.
        reason: io::Error,
    },
    /// A value has no JSON form.
    #[error("cannot write {file} as JSON: {reason}")]
    Json {
        /// The file.
        file: &'static str,
        /// What is wrong.
        reason: serde_json::Error,
    },
}

/// Writes `episode.json`, `captions.jsonl`, `embeddings.npy` and `truth.json` into the folder, which is made
/// where it is missing.
///
/// All contents are ready before the first file is touched; every file is written beside its name and then
/// renamed, `episode.json` last, so that a folder that is new and half-written is no episode.
pub fn write(episode: &GeneratedEpisode, folder: &Path) -> Result<(), WriteError> {
    check_folder(folder)?;
    let files = [
        (CAPTIONS_FILE, captions_bytes(episode)?),
        (EMBEDDINGS_FILE, embeddings_bytes(episode, folder)?),
        (TRUTH_FILE, json_bytes(TRUTH_FILE, &episode.truth)?),
        (EPISODE_FILE, json_bytes(EPISODE_FILE, &episode.episode)?),
    ];
    let refused = |path: &Path| {
        let path = path.to_owned();
        move |reason| WriteError::Io { path, reason }
    };
    fs::create_dir_all(folder).map_err(refused(folder))?;
    let mut renames = Vec::with_capacity(files.len());
    for (name, bytes) in files {
        let partial = folder.join(format!("{name}.partial"));
        fs::write(&partial, bytes).map_err(refused(&partial))?;
        renames.push((partial, folder.join(name)));
    }
    for (partial, file) in renames {
        fs::rename(&partial, &file).map_err(refused(&file))?;
    }
    Ok(())
}

fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
            return Err(WriteError::NotAFolder { path: folder.to_owned() });
        }
        Err(reason) => return Err(WriteError::Io { path: folder.to_owned(), reason }),
    };
    if entries.next().is_some() && !folder.join(EPISODE_FILE).is_file() {
        return Err(WriteError::NotAnEpisode { folder: folder.to_owned() });
    }
    Ok(())
}

fn json_bytes(file: &'static str, value: &impl Serialize) -> Result<Vec<u8>, WriteError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|reason| WriteError::Json { file, reason })?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn captions_bytes(episode: &GeneratedEpisode) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Vec::new();
    for line in &episode.captions {
        serde_json::to_writer(&mut bytes, line)
            .map_err(|reason| WriteError::Json { file: CAPTIONS_FILE, reason })?;
        bytes.push(b'\n');
    }
    Ok(bytes)
}

fn embeddings_bytes(episode: &GeneratedEpisode, folder: &Path) -> Result<Vec<u8>, WriteError> {
    let encode = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut writer = npyz::WriteOptions::<f32>::new()
            .default_dtype()
            .shape(&[episode.features.len() as u64, FEATURE_DIMENSIONS as u64])
            .writer(&mut bytes)
            .begin_nd()?;
        writer.extend(episode.features.iter().flatten().copied())?;
        writer.finish()?;
        Ok(bytes)
    };
    encode().map_err(|reason| WriteError::Io { path: folder.join(EMBEDDINGS_FILE), reason })
}
