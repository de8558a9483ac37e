//! Reading the HOMER data set's own folder: persona histograms, activity scripts, the scene graph.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Where the folder keeps what.
const HISTOGRAMS: &str = "personaBasedSchedules/cluster_histograms.json";
const PERSONAS: &str = "personaBasedSchedules/optimized_persona.json";
const SCRIPTS: &str = "executableScriptsByActivity";
const SCENE: &str = "CustomScene2_graph.json";

/// The hours of a histogram: from six in the morning to midnight.
pub(super) const SLOTS: usize = 18;

/// What is part of the building, and so nobody's thing.
const FIXED: [&str; 9] =
    ["Rooms", "Furniture", "Floor", "Ceiling", "Walls", "Doors", "Windows", "Characters", "Lamps"];

/// Why the data cannot be used.
#[derive(Debug, Error)]
pub enum HomerError {
    /// A file or folder cannot be read.
    #[error("cannot read {}: {source}; --data names the folder that holds {SCRIPTS}, personaBasedSchedules and {SCENE}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file is not in its form.
    #[error("{} is not in HOMER's form: {source}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        source: serde_json::Error,
    },
    /// A histogram has another length or holds what is no probability.
    #[error(
        "{HISTOGRAMS}: cluster {cluster} of {activity:?} is not {SLOTS} numbers from 0 to 1, one for each hour from six"
    )]
    Histogram {
        /// The activity.
        activity: String,
        /// The cluster.
        cluster: usize,
    },
    /// A persona names a cluster that is not there.
    #[error("{PERSONAS}: {persona} has cluster {cluster} of {activity:?}, which {HISTOGRAMS} does not hold")]
    Persona {
        /// The persona.
        persona: String,
        /// The activity.
        activity: String,
        /// The cluster.
        cluster: usize,
    },
    /// A line of a script is not a step.
    #[error("{}, line {line}: {given:?} is no step such as `[GRAB] <bowl> (1024) [5]`", path.display())]
    Step {
        /// The script.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        given: String,
    },
    /// There is nothing to live by.
    #[error("{} holds {what}", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
        /// What is missing.
        what: &'static str,
    },
    /// HOMER is a home.
    #[error(
        "HOMER is a home and knows no office; take another protocol, or `host generate routine --protocol office`"
    )]
    NoSuchPlace,
}

/// One step of a script: what is done with a thing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ScriptStep {
    /// The verb as the script has it, such as `GRAB`.
    pub(super) verb: String,
    /// The class of the thing.
    pub(super) class: String,
}

/// What is known of a class of things.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct ClassFacts {
    /// The room in which the scene has it, where it has.
    pub(super) room: Option<String>,
    /// Everything that scripts do with it.
    pub(super) verbs: BTreeSet<String>,
}

/// The part of HOMER that days are sampled from.
#[derive(Debug, Clone, PartialEq)]
pub struct HomerData {
    /// For every persona, the probability of each activity in each hour.
    pub(super) personas: Vec<BTreeMap<String, Vec<f64>>>,
    /// The ways to do each activity.
    pub(super) scripts: BTreeMap<String, Vec<Vec<ScriptStep>>>,
    /// The things that people handle.
    pub(super) classes: BTreeMap<String, ClassFacts>,
}

#[derive(Deserialize)]
struct Scene {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
}

#[derive(Deserialize)]
struct Node {
    id: u64,
    class_name: String,
    #[serde(default)]
    category: String,
}

#[derive(Deserialize)]
struct Edge {
    from_id: u64,
    to_id: u64,
    relation_type: String,
}

impl HomerData {
    /// Reads a folder in the public data set's own layout.
    ///
    /// # Errors
    /// The first file that is missing or not in its form.
    pub fn read(folder: &Path) -> Result<Self, HomerError> {
        let personas = read_personas(folder)?;
        let scene: Scene = read_json(&folder.join(SCENE))?;
        let scripts = read_scripts(&folder.join(SCRIPTS))?;
        if personas.is_empty() || scripts.is_empty() {
            let what = if personas.is_empty() { "no persona" } else { "no activity script" };
            return Err(HomerError::Empty { path: folder.to_owned(), what });
        }
        let classes = classes(&scene, &scripts);
        Ok(Self { personas, scripts, classes })
    }
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, HomerError> {
    let text =
        fs::read_to_string(path).map_err(|source| HomerError::Read { path: path.to_owned(), source })?;
    serde_json::from_str(&text).map_err(|source| HomerError::Form { path: path.to_owned(), source })
}

/// A persona is, for every activity, a cluster of people who do it at the same hours, or none.
fn read_personas(folder: &Path) -> Result<Vec<BTreeMap<String, Vec<f64>>>, HomerError> {
    let histograms: BTreeMap<String, Vec<Vec<f64>>> = read_json(&folder.join(HISTOGRAMS))?;
    for (activity, clusters) in &histograms {
        for (cluster, hours) in clusters.iter().enumerate() {
            if hours.len() != SLOTS || hours.iter().any(|share| !(0.0..=1.0).contains(share)) {
                return Err(HomerError::Histogram { activity: activity.clone(), cluster });
            }
        }
    }
    let personas: BTreeMap<String, BTreeMap<String, Option<usize>>> = read_json(&folder.join(PERSONAS))?;
    personas
        .into_iter()
        .map(|(persona, activities)| {
            activities
                .into_iter()
                .filter_map(|(activity, cluster)| Some((activity, cluster?)))
                .map(|(activity, cluster)| match histograms.get(&activity).and_then(|of| of.get(cluster)) {
                    Some(hours) => Ok((activity, hours.clone())),
                    None => Err(HomerError::Persona { persona: persona.clone(), activity, cluster }),
                })
                .collect()
        })
        .collect()
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, HomerError> {
    let failed = |source| HomerError::Read { path: folder.to_owned(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    // The order of a folder differs from system to system.
    paths.sort();
    Ok(paths)
}

fn read_scripts(folder: &Path) -> Result<BTreeMap<String, Vec<Vec<ScriptStep>>>, HomerError> {
    let mut scripts: BTreeMap<String, Vec<Vec<ScriptStep>>> = BTreeMap::new();
    for activity in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
        let name = activity.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        for path in entries(&activity)? {
            if path.extension().is_some_and(|extension| extension == "txt") {
                scripts.entry(name.clone()).or_default().push(read_script(&path)?);
            }
        }
    }
    Ok(scripts)
}

fn read_script(path: &Path) -> Result<Vec<ScriptStep>, HomerError> {
    let text =
        fs::read_to_string(path).map_err(|source| HomerError::Read { path: path.to_owned(), source })?;
    text.lines()
        .enumerate()
        // A script may begin with a title and a description.
        .skip_while(|(_, line)| !line.trim_start().starts_with('['))
        .filter(|(_, line)| !line.trim().is_empty())
        .filter_map(|(place, line)| {
            let refuse = || HomerError::Step {
                path: path.to_owned(),
                line: place + 1,
                given: line.chars().take(80).collect(),
            };
            step(line).ok_or_else(refuse).transpose()
        })
        .collect()
}

/// `[VERB] <thing> (id) …`: the first thing is the one that is handled; a step without a thing handles nothing.
#[allow(clippy::option_option, reason = "a line may be malformed, and a step may be without a thing")]
fn step(line: &str) -> Option<Option<ScriptStep>> {
    let (verb, rest) = line.trim().strip_prefix('[')?.split_once(']')?;
    if verb.is_empty() || !verb.chars().all(|letter| letter.is_ascii_uppercase()) {
        return None;
    }
    let Some((_, rest)) = rest.split_once('<') else { return Some(None) };
    let (class, _) = rest.split_once('>')?;
    let class = class.strip_prefix("food_").or_else(|| class.strip_prefix("clothes_")).unwrap_or(class);
    Some(Some(ScriptStep { verb: verb.to_owned(), class: class.replace('_', " ") }))
}

/// The classes that somebody takes or switches on in a script and that are no part of the building.
fn classes(scene: &Scene, scripts: &BTreeMap<String, Vec<Vec<ScriptStep>>>) -> BTreeMap<String, ClassFacts> {
    let named = |node: &Node| {
        let class = node.class_name.as_str();
        let class = class.strip_prefix("food_").or_else(|| class.strip_prefix("clothes_")).unwrap_or(class);
        class.replace('_', " ")
    };
    let rooms: BTreeMap<u64, &str> = scene
        .nodes
        .iter()
        .filter(|node| node.category == "Rooms")
        .map(|node| (node.id, node.class_name.as_str()))
        .collect();
    let inside: BTreeMap<u64, &str> = scene
        .edges
        .iter()
        .filter(|edge| edge.relation_type == "INSIDE")
        .filter_map(|edge| Some((edge.from_id, *rooms.get(&edge.to_id)?)))
        .collect();
    let mut room_of: BTreeMap<String, &str> = BTreeMap::new();
    let mut fixed: BTreeSet<String> = BTreeSet::new();
    for node in &scene.nodes {
        if let Some(room) = inside.get(&node.id) {
            room_of.entry(named(node)).or_insert(room);
        }
        if FIXED.contains(&node.category.as_str()) {
            fixed.insert(named(node));
        }
    }
    let mut verbs: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for step in scripts.values().flatten().flatten() {
        verbs.entry(step.class.clone()).or_default().insert(step.verb.clone());
    }
    verbs
        .into_iter()
        .filter(|(class, verbs)| {
            !fixed.contains(class) && (verbs.contains("GRAB") || verbs.contains("SWITCHON"))
        })
        .map(|(class, verbs)| {
            let room = room_of.get(&class).map(|room| (*room).to_owned());
            (class, ClassFacts { room, verbs })
        })
        .collect()
}
