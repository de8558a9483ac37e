//! A small home for tests.

use coin::captions::CaptionReader;
use coin::roster::Roster;
use coin_schemas::episode::{CaptionLine, Episode, FEATURE_DIMENSIONS};
use serde_json::json;

use crate::episode::{Feature, LoadedEpisode};
use crate::store::Store;

/// Two markers of Bob's side by side, a cup of Mary's beside them, a shared sofa far away, and a key that nobody
/// has touched. The key was never looked at.
pub(crate) fn episode() -> LoadedEpisode {
    let episode: Episode = serde_json::from_value(json!({
        "name": "test home",
        "users": {
            "Bob": {"role": "father", "occupation": "office worker"},
            "Mary": {"role": "mother"},
            "Tom": {},
        },
        "objects": [
            {"id": "1", "class": "marker", "position": [0.0, 0.0, 0.0], "room": "office"},
            {"id": "2", "class": "marker", "position": [0.3, 0.0, 0.0]},
            {"id": "cup-a", "class": "coffee cup", "position": [0.0, 0.4, 0.0]},
            {"id": "sofa", "class": "sofa", "position": [5.0, 0.0, 0.0]},
            {"id": "key", "class": "key", "position": [0.0, 0.0, 9.0]},
        ],
        "captions": "captions.jsonl",
        "now": "2025-01-19T23:00:00",
    }))
    .unwrap();
    let captions: Vec<CaptionLine> = [
        ("1", "2025-01-17 08:00 Bob takes the Marker"),
        ("1", "2025-01-17 08:05 Bob is using the Marker"),
        ("1", "2025-01-18 09:00 Mary takes the Marker"),
        ("1", "2025-01-19 19:00 Bob is using the Marker"),
        ("1", "2025-01-19 20:00 Someone takes the Marker"),
        ("1", "2025-01-20 08:00 Tom takes the Marker"),
        ("cup-a", "2025-01-19 07:00 Mary drinks from the Coffee Cup"),
    ]
    .map(|(object, caption)| {
        serde_json::from_value(json!({"object_id": object, "caption": caption})).unwrap()
    })
    .to_vec();
    let roster = Roster::new(&episode.users).unwrap();
    let reader = CaptionReader::new(&roster);
    let observations = captions.iter().map(|line| reader.read(&line.caption).unwrap()).collect();
    let features = vec![
        feature(&[1.0, 0.0]),
        feature(&[3.0, 4.0]),
        feature(&[0.0, 2.0]),
        feature(&[-1.0, 0.0]),
        feature(&[]),
    ];
    LoadedEpisode { episode, roster, captions, observations, features: Some(features) }
}

fn feature(beginning: &[f32]) -> Feature {
    let mut feature = [0.0; FEATURE_DIMENSIONS];
    feature[..beginning.len()].copy_from_slice(beginning);
    feature
}

/// The home in a store.
pub(crate) fn store() -> Store {
    let store = Store::open_in_memory().unwrap();
    store.import(&episode()).unwrap();
    store
}
