//! Small episodes, written by hand into temporary folders, whole until a test breaks them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

/// The number of components of a visual feature.
const DIMENSIONS: usize = 512;

/// An episode in the making. Every part is open, so that a test can break it.
#[derive(Debug, Clone)]
pub struct EpisodeBuilder {
    /// What becomes `episode.json`.
    pub description: Value,
    /// The lines of `captions.jsonl`.
    pub captions: Vec<String>,
    /// The rows of `embeddings.npy`, if there are any.
    pub features: Option<Vec<Vec<f32>>>,
    /// What becomes `truth.json`, if there is one.
    pub truth: Option<Value>,
    /// Files that replace or join the others, as they are.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// An episode in a folder that is removed at the end.
#[derive(Debug)]
pub struct EpisodeFolder {
    folder: TempDir,
}

impl Default for EpisodeBuilder {
    fn default() -> Self {
        Self::new()
    }
}

impl EpisodeBuilder {
    /// Bob, Mary and Tom at the end of 2025-01-19, without things.
    pub fn new() -> Self {
        Self {
            description: json!({
                "name": "small",
                "users": {
                    "Bob": {"role": "father", "occupation": "office worker"},
                    "Mary": {"role": "mother", "occupation": "nurse"},
                    "Tom": {"role": "son", "occupation": "student"},
                },
                "objects": [],
                "captions": "captions.jsonl",
                "now": "2025-01-19T23:00:00",
            }),
            captions: Vec::new(),
            features: None,
            truth: None,
            files: BTreeMap::new(),
        }
    }

    /// Bob's marker, Mary's mug and everybody's kettle, seen on three days, with their truth.
    pub fn three_things() -> Self {
        let mut episode = Self::new()
            .object("1", "marker", [0.0, 0.0, 0.8])
            .object("2", "mug", [4.0, 0.0, 0.8])
            .object("3", "kettle", [8.0, 0.0, 0.8]);
        for day in 16..=18 {
            for hour in [8, 13, 18] {
                episode = episode
                    .caption("1", &format!("2025-01-{day} {hour:02}:00 Bob is using the Marker"))
                    .caption("2", &format!("2025-01-{day} {hour:02}:10 Mary is using the Mug"));
            }
            for (hour, user) in [(7, "Bob"), (9, "Mary"), (11, "Tom"), (15, "Mary"), (17, "Tom"), (19, "Bob")]
            {
                episode =
                    episode.caption("3", &format!("2025-01-{day} {hour:02}:20 {user} is using the Kettle"));
            }
        }
        episode.truth = Some(json!({
            "owners": {"1": ["Bob"], "2": ["Mary"], "3": ["Bob", "Mary", "Tom"]},
        }));
        episode
    }

    /// Adds a thing.
    #[must_use]
    pub fn object(mut self, id: &str, class: &str, position: [f64; 3]) -> Self {
        let objects = self.description["objects"].as_array_mut().expect("objects is a list");
        objects.push(json!({"id": id, "class": class, "position": position}));
        self
    }

    /// Adds a caption.
    #[must_use]
    pub fn caption(mut self, object_id: &str, caption: &str) -> Self {
        self.captions.push(json!({"object_id": object_id, "caption": caption}).to_string());
        self
    }

    /// Gives every thing a visual feature, in the order of the things.
    #[must_use]
    pub fn features(mut self, features: impl IntoIterator<Item = Vec<f32>>) -> Self {
        self.features = Some(features.into_iter().collect());
        self
    }

    /// Puts a file of these bytes into the folder, in place of any other of its name.
    #[must_use]
    pub fn file(mut self, name: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.insert(name.to_owned(), bytes.into());
        self
    }

    /// Sets a value of `episode.json` by JSON pointer (`/now`); `null` removes the key.
    #[must_use]
    pub fn with(mut self, pointer: &str, value: Value) -> Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
        let parent = self.description.pointer_mut(parent).expect("the pointer leads somewhere");
        match (parent, value) {
            (Value::Object(parent), Value::Null) => drop(parent.remove(key)),
            (parent, value) if parent.is_object() => parent[key] = value,
            (parent, value) => parent[key.parse::<usize>().expect("an index")] = value,
        }
        self
    }

    /// Writes the files.
    pub fn write(&self) -> EpisodeFolder {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut description = self.description.clone();
        let mut files: BTreeMap<&str, Vec<u8>> = BTreeMap::new();
        let mut lines = self.captions.join("\n");
        lines.push('\n');
        files.insert("captions.jsonl", lines.into_bytes());
        if let Some(features) = &self.features {
            files.insert("embeddings.npy", npy(features));
            description["embeddings"] = json!("embeddings.npy");
        }
        if let Some(truth) = &self.truth {
            files.insert("truth.json", truth.to_string().into_bytes());
            description["truth"] = json!("truth.json");
        }
        files.insert("episode.json", description.to_string().into_bytes());
        for (name, bytes) in &self.files {
            files.insert(name, bytes.clone());
        }
        for (name, bytes) in files {
            fs::write(folder.path().join(name), bytes).expect("a file can be written");
        }
        EpisodeFolder { folder }
    }
}

impl EpisodeFolder {
    /// The folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// A path beside the episode's files.
    pub fn join(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

/// A feature with the given components; all others are 0.
pub fn feature(components: &[(usize, f32)]) -> Vec<f32> {
    let mut feature = vec![0.0; DIMENSIONS];
    for &(place, value) in components {
        feature[place] = value;
    }
    feature
}

/// The rows as NumPy writes them: version 1.0, float32, little endian, C order.
fn npy(rows: &[Vec<f32>]) -> Vec<u8> {
    let columns = rows.first().map_or(DIMENSIONS, Vec::len);
    let mut header =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {columns}), }}", rows.len());
    // Magic, version and length take 10 bytes; the data begins at a multiple of 64.
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let length = u16::try_from(header.len()).expect("a header is short");
    bytes.extend(length.to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(rows.iter().flatten().flat_map(|component| component.to_le_bytes()));
    bytes
}
