//! The files of an episode, none of which may lie outside its folder.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use super::error::EpisodeError;

/// An episode folder.
#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
}

impl Folder {
    pub(super) fn open(path: &Path) -> Result<Self, EpisodeError> {
        let refuse = |reason: String| EpisodeError::NoFolder { path: path.to_owned(), reason };
        let canonical = path.canonicalize().map_err(|source| refuse(in_words(&source)))?;
        if !canonical.is_dir() {
            return Err(refuse("it is a file".to_owned()));
        }
        Ok(Self { path: canonical })
    }

    /// Opens a file of the folder. A symbolic link may lead to another place in the folder and nowhere else.
    pub(super) fn file(&self, name: &str) -> Result<File, EpisodeError> {
        let refuse = |reason: String| EpisodeError::Unreadable { file: name.to_owned(), reason };
        check_name(name).map_err(|problem| refuse(problem.clone()))?;
        let path = self.path.join(name).canonicalize().map_err(|source| refuse(in_words(&source)))?;
        if !path.starts_with(&self.path) {
            return Err(refuse(
                "it is a link that leaves the episode's folder; put the file itself there".to_owned(),
            ));
        }
        // Opening a pipe would wait for ever, so the kind of file is looked at before.
        if !fs::metadata(&path).map_err(|source| refuse(in_words(&source)))?.is_file() {
            return Err(refuse("it is not a regular file".to_owned()));
        }
        File::open(&path).map_err(|source| refuse(in_words(&source)))
    }

    /// The whole content of a file of at most `limit` bytes.
    pub(super) fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, EpisodeError> {
        let mut content = Vec::new();
        self.file(name)?
            .take(limit + 1)
            .read_to_end(&mut content)
            .map_err(|source| unreadable(name, &source))?;
        if content.len() as u64 > limit {
            return Err(EpisodeError::in_file(name, format!("the file is larger than {limit} bytes")));
        }
        Ok(content)
    }
}

pub(super) fn unreadable(name: &str, source: &io::Error) -> EpisodeError {
    EpisodeError::Unreadable { file: name.to_owned(), reason: in_words(source) }
}

/// Whether a name from episode.json stays in the folder, as far as its text tells.
pub(super) fn check_name(name: &str) -> Result<(), String> {
    if name.is_empty() {
        return Err("the file name is empty".to_owned());
    }
    let path = Path::new(name);
    let stays = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if stays && !name.contains('\\') {
        Ok(())
    } else {
        Err(format!(
            "{name:?} leaves the episode's folder; give a name relative to it, such as \"captions.jsonl\""
        ))
    }
}

fn in_words(source: &io::Error) -> String {
    match source.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "it may not be read (permission denied)".to_owned(),
        _ => source.to_string(),
    }
}
