//! The resolver before its judges: the files of `fixtures/referring`, each written before the resolver was run on it.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};

use coin_schemas::episode::{Episode, Truth};
use coin_schemas::household::{ObjectId, Score};

use super::{Decision, Finding, MappedThing, find};
use crate::roster::{Roster, UserIndex};

/// The share of expressions that have to be understood.
const LEAST_RIGHT: f64 = 0.95;

/// A home whose owners are known.
pub(super) struct Home {
    pub(super) roster: Roster,
    pub(super) episode: Episode,
    /// Of every thing, in the order of the episode.
    pub(super) scores: Vec<Vec<Score>>,
}

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures")
}

impl Home {
    /// `sure` is the score of an owner; that of the others is what is left to 1.
    pub(super) fn read(name: &str, sure: f64) -> Self {
        let folder = ["episodes", "referring/homes"]
            .into_iter()
            .map(|room| fixtures().join(room).join(name))
            .find(|folder| folder.exists())
            .unwrap();
        let read = |file: &str| fs::read_to_string(folder.join(file)).unwrap();
        let episode: Episode = serde_json::from_str(&read("episode.json")).unwrap();
        let truth: Truth = serde_json::from_str(&read("truth.json")).unwrap();
        let roster = Roster::new(&episode.users).unwrap();
        let scores = episode
            .objects
            .iter()
            .map(|object| {
                let owners = roster.owner_set(&truth.owners[&object.id]).unwrap();
                roster
                    .indices()
                    .map(|user| Score::new(if owners.contains(user) { sure } else { 1.0 - sure }).unwrap())
                    .collect()
            })
            .collect();
        Self { roster, episode, scores }
    }

    pub(super) fn things(&self) -> Vec<MappedThing<'_>> {
        self.episode
            .objects
            .iter()
            .map(|object| MappedThing {
                id: &object.id,
                class: object.class.as_str(),
                room: object.room.as_deref(),
                position: object.position,
                likeness: None,
            })
            .collect()
    }

    pub(super) fn find(&self, things: &[MappedThing<'_>], said: &str, speaker: Option<UserIndex>) -> Finding {
        find_among(&self.roster, things, |thing| self.scores[thing].clone(), said, speaker)
    }
}

/// Finds a thing where all scores are known.
pub(super) fn find_among(
    roster: &Roster,
    things: &[MappedThing<'_>],
    scores: impl Fn(usize) -> Vec<Score>,
    said: &str,
    speaker: Option<UserIndex>,
) -> Finding {
    match find(roster, things, said, speaker, |thing| Ok::<_, Infallible>(scores(thing))) {
        Ok(finding) => finding,
        Err(never) => match never {},
    }
}

/// One line of the file.
#[derive(Debug, Clone)]
pub(super) struct Expression {
    pub(super) home: String,
    pub(super) speaker: Option<String>,
    pub(super) said: String,
    meant: String,
}

pub(super) fn expressions(file: &str) -> Vec<Expression> {
    let text = fs::read_to_string(fixtures().join("referring").join(file)).unwrap();
    let mut home = String::new();
    let mut expressions = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            name.clone_into(&mut home);
            continue;
        }
        let columns: Vec<&str> = line.split('|').map(str::trim).collect();
        let [speaker, said, meant] = columns[..] else { panic!("three columns, not {line:?}") };
        expressions.push(Expression {
            home: home.clone(),
            speaker: (speaker != "-").then(|| speaker.to_owned()),
            said: said.to_owned(),
            meant: meant.to_owned(),
        });
    }
    expressions
}

/// A decision as the file writes it.
fn written(decision: &Decision) -> String {
    let list = |kind: &str, ids: &[ObjectId]| {
        let ids: BTreeSet<u32> = ids.iter().map(|id| id.as_str().parse().unwrap()).collect();
        ids.iter().fold(kind.to_owned(), |text, id| format!("{text} {id}"))
    };
    match decision {
        Decision::Found(id) => format!("found {id}"),
        Decision::Ambiguous { candidates, .. } => list("ambiguous", candidates),
        Decision::None { instead, .. } => list("none", instead),
    }
}

/// The lines that are decided otherwise than the file says, and how many lines there are.
fn failures(file: &str, sure: f64) -> (Vec<String>, usize) {
    let expressions = expressions(file);
    let mut failures = Vec::new();
    for home in expressions.iter().map(|expression| &expression.home).collect::<BTreeSet<_>>() {
        let known = Home::read(home, sure);
        for Expression { speaker, said, meant, .. } in expressions.iter().filter(|line| line.home == *home) {
            let user = speaker.as_ref().map(|name| known.roster.index_of(name).unwrap());
            let finding = known.find(&known.things(), said, user);
            let decided = written(&finding.decision);
            if decided != *meant {
                let speaker = speaker.as_deref().unwrap_or("-");
                failures.push(format!("[{home}] {speaker} | {said} | {meant}, not {decided}"));
            }
        }
    }
    (failures, expressions.len())
}

/// The failures, once it is clear that there are few.
fn judge(file: &str) -> String {
    let (failures, lines) = failures(file, 1.0);
    let right = 1.0 - failures.len() as f64 / lines as f64;
    let failures = failures.join("\n");
    assert!(right >= LEAST_RIGHT, "{right:.3} of {lines}:\n{failures}");
    failures
}

#[test]
fn what_people_say_is_understood() {
    assert!(expressions("expressions.txt").len() >= 150);
    insta::assert_snapshot!(judge("expressions.txt"), @"[three-generations] Paul | our board game | none 15, not found 17");
}

#[test]
fn what_people_say_less_plainly_is_understood() {
    insta::assert_snapshot!(judge("winding.txt"), @r"
    [small-house] Mary | my tea towel | none 5 11, not found 5
    [three-generations] Ruth | my grandson's teddy | found 7, not none 7
    ");
}

#[test]
fn what_people_say_in_a_third_round_is_understood() {
    insta::assert_snapshot!(judge("unseen.txt"), @r"
    [shared-flat] Chloe | where is my book with the red cover | found 16, not none
    [small-house] Tom | Bob's shoes or mine | found 15, not none 15
    [three-generations] Max | the bedroom lamp | found 20, not ambiguous 19 20
    ");
}

#[test]
fn what_people_say_of_heights_is_understood() {
    insta::assert_snapshot!(judge("heights.txt"), @"[loft] Ida | the vase by the shelf | ambiguous 17 18, not found 17");
}

#[test]
fn a_little_doubt_about_owners_changes_no_decision() {
    for file in ["expressions.txt", "winding.txt", "unseen.txt", "heights.txt"] {
        assert_eq!(failures(file, 0.97), failures(file, 1.0));
    }
}
