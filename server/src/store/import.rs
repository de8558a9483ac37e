//! An episode becomes a home.

use std::borrow::Cow;
use std::collections::HashMap;

use coin::captions::{CaptionReader, Observation};
use coin::roster::Roster;
use coin_schemas::episode::{CaptionLine, EpisodeObject};

use super::map::ObjectKey;
use super::sightings::Recorded;
use super::usage::{UsageCounts, UsageRecord};
use super::{Store, StoreError, Writer};
use crate::episode::{Feature, LoadedEpisode};

/// What an import stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImportSummary {
    /// The people of the episode.
    pub users: usize,
    /// The things of the episode.
    pub objects: usize,
    /// Captions that were new, and those that were there already.
    pub usage: UsageCounts,
}

impl Store {
    /// Imports an episode in one transaction: all of it or nothing.
    ///
    /// A home that holds the same recording already is left as it is; captions that it lacks are added, so that
    /// a longer take of the same recording can follow a shorter one. Any other home that holds something is
    /// refused, because ids of one home mean nothing in another.
    ///
    /// # Errors
    /// [`StoreError::OtherHome`], and failures of the database.
    pub fn import(&self, episode: &LoadedEpisode) -> Result<ImportSummary, StoreError> {
        self.write(|writer| writer.import(episode))
    }
}

impl Writer<'_> {
    fn import(&self, loaded: &LoadedEpisode) -> Result<ImportSummary, StoreError> {
        let episode = &loaded.episode;
        let keys = if self.is_empty()? { self.furnish(loaded)? } else { self.recognise(loaded)? };
        self.put_recording(&episode.name, episode.now)?;
        let household = self.household()?.ok_or(StoreError::NobodyLivesHere)?;
        let observations = observed_by(household.roster(), loaded)?;
        let records = loaded
            .captions
            .iter()
            .zip(observations.iter())
            .map(|(line, observation)| {
                let object = keys.get(line.object_id.as_str()).copied();
                object
                    .map(|object| UsageRecord { object, observation: *observation, caption: &line.caption })
                    .ok_or_else(|| StoreError::UnknownObject { id: line.object_id.to_string() })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let usage = self.record_usage(&household, &records)?;
        Ok(ImportSummary { users: episode.users.len(), objects: episode.objects.len(), usage })
    }

    fn is_empty(&self) -> Result<bool, StoreError> {
        Ok(self.household()?.is_none() && self.objects()?.is_empty())
    }

    /// Puts the people, things and features of the episode into an empty home.
    fn furnish<'a>(&self, loaded: &'a LoadedEpisode) -> Result<HashMap<&'a str, ObjectKey>, StoreError> {
        for (name, background) in &loaded.episode.users {
            self.put_user(name, background)?;
        }
        let mut keys = HashMap::new();
        for (place, object) in loaded.episode.objects.iter().enumerate() {
            let key = self.add_object(object)?;
            if let Some(feature) = visible(loaded, place) {
                self.put_feature(key, feature)?;
            }
            keys.insert(object.id.as_str(), key);
        }
        Ok(keys)
    }

    /// Finds the people, things and features of the episode in the home that is there.
    fn recognise<'a>(&self, loaded: &'a LoadedEpisode) -> Result<HashMap<&'a str, ObjectKey>, StoreError> {
        let episode = &loaded.episode;
        match self.recording()? {
            Some(name) if name == episode.name => {}
            Some(name) => {
                return Err(other(format!(
                    "it was imported from {name:?}, the episode is {:?}",
                    episode.name
                )));
            }
            None => return Err(other("it was not imported from an episode".to_owned())),
        }
        let household = self.household()?;
        for name in episode.users.keys() {
            if household.as_ref().is_none_or(|home| home.roster().index_of(name.as_str()).is_err()) {
                return Err(other(format!("it does not know {name}")));
            }
        }
        let mut keys = HashMap::new();
        for (place, object) in episode.objects.iter().enumerate() {
            let key = self
                .object_key(object.id.as_str())?
                .ok_or_else(|| other(format!("it has no object {:?}", object.id.as_str())))?;
            let recorded = self.as_recorded(key)?;
            if !is_same(&recorded, object) {
                return Err(other(format!(
                    "object {:?} is a {} at {:?} there and a {} at {:?} in the episode",
                    object.id.as_str(),
                    recorded.class,
                    recorded.position.metres(),
                    object.class,
                    object.position.metres(),
                )));
            }
            if recorded.feature.as_deref() != visible(loaded, place).map(<[f32; _]>::as_slice) {
                return Err(other(format!("object {:?} has another embedding", object.id.as_str())));
            }
            keys.insert(object.id.as_str(), key);
        }
        Ok(keys)
    }
}

/// The feature of the object at `place`. A feature of zeros points nowhere: the thing was never seen.
fn visible(loaded: &LoadedEpisode, place: usize) -> Option<&Feature> {
    let feature = loaded.features.as_ref()?.get(place)?;
    feature.iter().any(|&component| component != 0.0).then_some(feature)
}

/// What the captions say to this household. They were read with the episode's people; where others have joined the
/// home since, they are read again, because people are told by their place among all.
fn observed_by<'a>(roster: &Roster, loaded: &'a LoadedEpisode) -> Result<Cow<'a, [Observation]>, StoreError> {
    if roster.names().eq(loaded.roster.names()) {
        return Ok(Cow::Borrowed(&loaded.observations));
    }
    let reader = CaptionReader::new(roster);
    let read = |line: &CaptionLine| Ok(reader.read(&line.caption)?);
    loaded.captions.iter().map(read).collect::<Result<Vec<_>, StoreError>>().map(Cow::Owned)
}

fn is_same(recorded: &Recorded, object: &EpisodeObject) -> bool {
    // The room of a thing that was seen elsewhere since is another one.
    let in_same_room = recorded.room.as_ref().is_none_or(|room| *room == object.room);
    recorded.class == object.class && recorded.position == object.position && in_same_room
}

fn other(difference: String) -> StoreError {
    StoreError::OtherHome { difference }
}
