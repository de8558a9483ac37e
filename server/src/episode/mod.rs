//! Reading an episode folder: `episode.json` and the files that it names.
//!
//! Either an episode is loaded whole or it is refused with one message that says where the fault is, what was
//! given and what is expected. The truth is read by [`load_truth`] alone, so that whoever holds a
//! [`LoadedEpisode`] holds no truth.

mod captions;
mod error;
mod features;
mod files;
mod json;
#[cfg(test)]
mod tests;
mod truth;

use std::collections::HashSet;
use std::path::Path;

use coin::captions::{CaptionReader, Observation};
use coin::roster::Roster;
use coin_schemas::episode::{CaptionLine, Episode, FEATURE_DIMENSIONS};
use jiff::civil::DateTime;
use serde_json::Value;

pub use error::{EpisodeError, Place, Within};
use files::Folder;

/// The visual feature of a thing, as the file holds it.
pub type Feature = [f32; FEATURE_DIMENSIONS];

/// The file that every episode has.
pub const EPISODE_FILE: &str = "episode.json";

/// The longest line of a caption file, in bytes: a caption of the longest kind, every byte of it escaped.
pub const MAX_LINE_BYTES: usize = 16_384;

/// The largest episode.json or truth file, in bytes.
pub const MAX_JSON_BYTES: u64 = 64 * 1024 * 1024;

/// An episode without its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedEpisode {
    /// The home.
    pub episode: Episode,
    /// Its people.
    pub roster: Roster,
    /// The caption lines, in the order of the file. Lines later than the episode's `now` are among them; they
    /// are stored and stay hidden until the home's present passes them.
    pub captions: Vec<CaptionLine>,
    /// What was read from each caption line.
    pub observations: Vec<Observation>,
    /// The visual features in the order of `episode.objects`, where the episode has any.
    pub features: Option<Vec<Feature>>,
}

impl LoadedEpisode {
    /// The same home as it stood at an earlier moment: without the captions from then on.
    #[must_use]
    pub fn as_it_stood(mut self, moment: DateTime) -> Self {
        let seen = |observation: &Observation| observation.at < moment;
        let lines = self.captions.into_iter().zip(&self.observations);
        self.captions = lines.filter(|(_, observation)| seen(observation)).map(|(line, _)| line).collect();
        self.observations.retain(seen);
        self.episode.now = moment;
        self
    }
}

/// Loads the episode in a folder, but for its truth.
///
/// # Errors
/// The first thing that is wrong, by file and line or key.
pub fn load(folder: &Path) -> Result<LoadedEpisode, EpisodeError> {
    let folder = Folder::open(folder)?;
    let (episode, roster) = read_home(&folder)?;
    let reader = CaptionReader::new(&roster);
    let (captions, observations) = captions::read(&folder, &episode, &reader)?;
    let features = episode
        .embeddings
        .as_deref()
        .map(|name| features::read(&folder, name, &episode.objects))
        .transpose()?;
    Ok(LoadedEpisode { episode, roster, captions, observations, features })
}

pub use truth::load_truth;

/// Reads episode.json and checks all of it that needs no other file.
fn read_home(folder: &Folder) -> Result<(Episode, Roster), EpisodeError> {
    let bytes = folder.read(EPISODE_FILE, MAX_JSON_BYTES)?;
    let episode: Episode =
        json::parse_document(EPISODE_FILE, &bytes).map_err(|error| explain_time(error, &bytes))?;
    if episode.name.trim().is_empty() {
        return Err(EpisodeError::at_key(EPISODE_FILE, "name", "it is empty; give the episode a short name"));
    }
    let roster = Roster::new(&episode.users)
        .map_err(|source| EpisodeError::at_key(EPISODE_FILE, "users", source.to_string()))?;
    let mut seen = HashSet::new();
    for (place, object) in episode.objects.iter().enumerate() {
        if !seen.insert(object.id.as_str()) {
            return Err(EpisodeError::at_key(
                EPISODE_FILE,
                format!("objects[{place}].id"),
                format!("the id {:?} stands twice; ids are unique in an episode", object.id.as_str()),
            ));
        }
    }
    if let Some(split) = episode.train_until.filter(|&split| split > episode.now) {
        return Err(EpisodeError::at_key(
            EPISODE_FILE,
            "train_until",
            format!("{split} is after now ({}); the first part ends before the whole", episode.now),
        ));
    }
    let names = [
        ("captions", Some(&episode.captions)),
        ("embeddings", episode.embeddings.as_ref()),
        ("truth", episode.truth.as_ref()),
    ];
    for (key, name) in names {
        if let Some(name) = name {
            files::check_name(name).map_err(|problem| EpisodeError::at_key(EPISODE_FILE, key, problem))?;
        }
    }
    Ok((episode, roster))
}

/// Says of a time that was refused what was given and what a time looks like.
fn explain_time(error: EpisodeError, document: &[u8]) -> EpisodeError {
    let EpisodeError::Malformed { place, problem } = error else { return error };
    let given = match &place.within {
        Within::Key(key) if key == "now" || key == "train_until" => {
            serde_json::from_slice(document).ok().and_then(|document: Value| document.get(key).cloned())
        }
        _ => None,
    };
    let problem = given.map_or(problem, |given| {
        format!(
            "{given} is no local time that exists; expected one without a time zone, such as \
             \"2025-01-19T23:00:00\""
        )
    });
    EpisodeError::Malformed { place, problem }
}
