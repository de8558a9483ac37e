//! Reading the HOMER data set's own folder: persona histograms, activity scripts, the scene graph.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::error::HomerError;
use super::sampler::{COMING_HOME, LEAVING_HOME};
use super::script::{self, Script, Verb};

/// Where the folder keeps what.
pub(super) const HISTOGRAMS: &str = "personaBasedSchedules/cluster_histograms.json";
pub(super) const PERSONAS: &str = "personaBasedSchedules/optimized_persona.json";
pub(super) const SCRIPTS: &str = "executableScriptsByActivity";
pub(super) const SCENE: &str = "CustomScene2_graph.json";

/// The hours of a histogram: from six in the morning to midnight.
pub(super) const SLOTS: usize = 18;
/// The hour of the first of them.
const FIRST_HOUR: usize = 6;

/// What is part of the building, and so nobody's thing.
const FIXED: [&str; 9] =
    ["Rooms", "Furniture", "Floor", "Ceiling", "Walls", "Doors", "Windows", "Characters", "Lamps"];

/// What is known of a class of things.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct ClassFacts {
    /// The room in which the scene has it, where it has.
    pub(super) room: Option<String>,
    /// Everything that scripts do with it.
    pub(super) verbs: BTreeSet<Verb>,
}

/// Somebody to live like.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Persona {
    pub(super) name: String,
    /// The share of each activity in each hour.
    pub(super) hours: BTreeMap<String, [f64; SLOTS]>,
}

impl Persona {
    /// Everything that the persona ever does.
    pub(super) fn activities(&self) -> impl Iterator<Item = &str> {
        self.hours.keys().map(String::as_str)
    }

    /// What the persona does at home or begins there, with the share of each hour.
    pub(super) fn at_home(&self) -> impl Iterator<Item = (&str, &[f64; SLOTS])> {
        let named = self.hours.iter().map(|(activity, hours)| (activity.as_str(), hours));
        named.filter(|(activity, _)| *activity != COMING_HOME)
    }

    /// The share of an activity in an hour of the histogram.
    pub(super) fn share(&self, activity: &str, hour: usize) -> f64 {
        self.hours.get(activity).and_then(|hours| hours.get(hour)).copied().unwrap_or(0.0)
    }

    /// The sum of the shares of the busiest hour.
    pub(super) fn busiest(&self) -> f64 {
        let sum = |hour: usize| self.at_home().map(|(_, hours)| hours[hour]).sum::<f64>();
        (0..SLOTS).map(sum).fold(0.0, f64::max)
    }
}

/// The part of HOMER that days are sampled from.
#[derive(Debug, Clone, PartialEq)]
pub struct HomerData {
    pub(super) folder: PathBuf,
    pub(super) personas: Vec<Persona>,
    /// The ways to do each activity, at least one.
    pub(super) scripts: BTreeMap<String, Vec<Script>>,
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
    /// The first file that is missing, damaged or not in its form, and the first thing of one file that another lacks.
    pub fn read(folder: &Path) -> Result<Self, HomerError> {
        let scripts = read_scripts(&folder.join(SCRIPTS))?;
        let personas = read_personas(folder)?;
        check(&personas, &scripts, &folder.join(PERSONAS))?;
        let scene = read_scene(&folder.join(SCENE))?;
        let classes = classes(&scene, &scripts);
        Ok(Self { folder: folder.to_owned(), personas, scripts, classes })
    }

    /// The error of a persona whose every day ends away from home.
    pub(super) fn never_home(&self, persona: &Persona) -> HomerError {
        HomerError::NeverHome { path: self.folder.join(PERSONAS), persona: persona.name.clone() }
    }
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, HomerError> {
    let text = script::read_text(path)?;
    serde_json::from_str(&text).map_err(|reason| HomerError::Form { path: path.to_owned(), reason })
}

/// A cluster of people who do an activity at the same hours: what share of them does it in each.
type Histogram = [f64; SLOTS];

fn read_histograms(path: &Path) -> Result<BTreeMap<String, Vec<Histogram>>, HomerError> {
    let given: BTreeMap<String, Vec<Vec<f64>>> = read_json(path)?;
    let checked = |activity: &str, cluster: usize, shares: Vec<f64>| {
        if let Some(hour) = shares.iter().position(|share| !(0.0..=1.0).contains(share)) {
            return Err(HomerError::HistogramShare {
                path: path.to_owned(),
                activity: activity.to_owned(),
                cluster,
                hour: FIRST_HOUR + hour,
                given: shares[hour],
            });
        }
        Histogram::try_from(shares).map_err(|shares| HomerError::HistogramLength {
            path: path.to_owned(),
            activity: activity.to_owned(),
            cluster,
            given: shares.len(),
        })
    };
    given
        .into_iter()
        .map(|(activity, clusters)| {
            let clusters: Result<Vec<Histogram>, HomerError> = clusters
                .into_iter()
                .enumerate()
                .map(|(cluster, shares)| checked(&activity, cluster, shares))
                .collect();
            Ok((activity, clusters?))
        })
        .collect()
}

/// A persona is, for every activity, a cluster of people who do it at the same hours, or none.
fn read_personas(folder: &Path) -> Result<Vec<Persona>, HomerError> {
    let histograms = read_histograms(&folder.join(HISTOGRAMS))?;
    let path = folder.join(PERSONAS);
    let given: BTreeMap<String, BTreeMap<String, Option<usize>>> = read_json(&path)?;
    if given.is_empty() {
        return Err(HomerError::Empty { path, what: "no persona" });
    }
    given
        .into_iter()
        .map(|(name, activities)| {
            let mut hours = BTreeMap::new();
            for (activity, cluster) in activities {
                let Some(cluster) = cluster else { continue };
                let clusters = histograms.get(&activity).map_or(&[][..], Vec::as_slice);
                let Some(shares) = clusters.get(cluster) else {
                    let (path, known) = (path.clone(), clusters.len());
                    return Err(HomerError::UnknownCluster { path, persona: name, activity, cluster, known });
                };
                hours.insert(activity, *shares);
            }
            Ok(Persona { name, hours })
        })
        .collect()
}

/// Refuses a persona who has nothing to do, nothing to do it by, or no way home.
fn check(
    personas: &[Persona],
    scripts: &BTreeMap<String, Vec<Script>>,
    path: &Path,
) -> Result<(), HomerError> {
    for persona in personas {
        let name = || persona.name.clone();
        if let Some(activity) = persona.activities().find(|activity| !scripts.contains_key(*activity)) {
            let activity = activity.to_owned();
            return Err(HomerError::NoScript { path: path.to_owned(), persona: name(), activity });
        }
        if persona.busiest() <= 0.0 {
            return Err(HomerError::IdlePersona { path: path.to_owned(), persona: name() });
        }
        let ever = |activity: &str| (0..SLOTS).any(|hour| persona.share(activity, hour) > 0.0);
        if ever(LEAVING_HOME) && !ever(COMING_HOME) {
            return Err(HomerError::NeverHome { path: path.to_owned(), persona: name() });
        }
    }
    Ok(())
}

fn read_scene(path: &Path) -> Result<Scene, HomerError> {
    let scene: Scene = read_json(path)?;
    let missing = match scene.nodes.iter().any(|node| node.category == "Rooms") {
        true => return Ok(scene),
        false if scene.nodes.is_empty() => "no node",
        false => "no node of the category Rooms",
    };
    Err(HomerError::Empty { path: path.to_owned(), what: missing })
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, HomerError> {
    let failed = |reason| HomerError::Read { path: folder.to_owned(), reason };
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    // The order of a folder differs from system to system.
    paths.sort();
    Ok(paths)
}

fn read_scripts(folder: &Path) -> Result<BTreeMap<String, Vec<Script>>, HomerError> {
    let mut scripts: BTreeMap<String, Vec<Script>> = BTreeMap::new();
    for activity in entries(folder)?.into_iter().filter(|path| path.is_dir()) {
        let name = activity.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        for path in entries(&activity)? {
            if path.extension().is_some_and(|extension| extension == "txt") {
                scripts.entry(name.clone()).or_default().push(script::read(&path)?);
            }
        }
    }
    if scripts.is_empty() {
        return Err(HomerError::Empty { path: folder.to_owned(), what: "no activity script" });
    }
    Ok(scripts)
}

/// The words for HOMER's name of a class: `food_peanut_butter` is peanut butter.
pub(super) fn class_label(name: &str) -> String {
    let name = name.strip_prefix("food_").or_else(|| name.strip_prefix("clothes_")).unwrap_or(name);
    name.replace('_', " ")
}

/// The classes that somebody takes or switches on in a script and that are no part of the building.
fn classes(scene: &Scene, scripts: &BTreeMap<String, Vec<Script>>) -> BTreeMap<String, ClassFacts> {
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
            room_of.entry(class_label(&node.class_name)).or_insert(room);
        }
        if FIXED.contains(&node.category.as_str()) {
            fixed.insert(class_label(&node.class_name));
        }
    }
    let mut verbs: BTreeMap<&str, BTreeSet<Verb>> = BTreeMap::new();
    for step in scripts.values().flatten().flat_map(|script| &script.steps) {
        if let Some(class) = &step.class {
            verbs.entry(class).or_default().insert(step.verb);
        }
    }
    verbs
        .into_iter()
        .filter(|(class, verbs)| {
            !fixed.contains(*class) && (verbs.contains(&Verb::Grab) || verbs.contains(&Verb::SwitchOn))
        })
        .map(|(class, verbs)| {
            let room = room_of.get(class).map(|room| (*room).to_owned());
            (class.to_owned(), ClassFacts { room, verbs })
        })
        .collect()
}
