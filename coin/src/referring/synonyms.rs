//! What people call a thing: which names mean the same, and which are kinds of another.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use super::labels::{joined, words_of};
use crate::common_sense;

const LINES: &str = include_str!("synonyms.txt");

/// How two names stand to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kinship {
    /// One is a kind of the other.
    Kind,
    /// They mean the same.
    Same,
}

/// A line of the file; names as [`joined`] writes them.
struct Line {
    names: Vec<String>,
    kinds: Vec<String>,
}

struct Synonyms {
    lines: Vec<Line>,
    /// The lines in which a name stands.
    places: BTreeMap<String, Vec<usize>>,
    /// Every single word of a name that is known: no misspelling of another.
    words: BTreeSet<String>,
}

static SYNONYMS: LazyLock<Synonyms> = LazyLock::new(|| {
    let mut synonyms = Synonyms { lines: Vec::new(), places: BTreeMap::new(), words: BTreeSet::new() };
    for line in LINES.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
        let (names, kinds) = line.split_once('|').unwrap_or((line, ""));
        synonyms.words.extend(names.split(',').chain(kinds.split(',')).flat_map(words_of));
        let line = Line { names: list(names), kinds: list(kinds) };
        for name in line.names.iter().chain(&line.kinds) {
            synonyms.places.entry(name.clone()).or_default().push(synonyms.lines.len());
        }
        synonyms.lines.push(line);
    }
    synonyms.words.extend(common_sense::class_names().flat_map(words_of));
    synonyms
});

fn list(column: &str) -> Vec<String> {
    column.split(',').map(|name| joined(&words_of(name))).filter(|name| !name.is_empty()).collect()
}

fn lines_of(name: &str) -> impl Iterator<Item = &'static Line> {
    SYNONYMS.places.get(name).into_iter().flatten().filter_map(|&place| SYNONYMS.lines.get(place))
}

/// How the names stand to each other, in either direction; both as [`joined`] writes them.
pub(super) fn kinship(one: &str, other: &str) -> Option<Kinship> {
    lines_of(one)
        .filter_map(|line| {
            let named = |name: &str| line.names.iter().any(|listed| listed == name);
            let kind = |name: &str| line.kinds.iter().any(|listed| listed == name);
            match (named(one), named(other)) {
                (true, true) => Some(Kinship::Same),
                (true, false) if kind(other) => Some(Kinship::Kind),
                (false, true) if kind(one) => Some(Kinship::Kind),
                _ => None,
            }
        })
        .max()
}

/// The names that mean the same as this one.
pub(super) fn names_like(name: &str) -> impl Iterator<Item = &'static str> {
    lines_of(name)
        .filter(move |line| line.names.iter().any(|listed| listed == name))
        .flat_map(|line| line.names.iter().map(String::as_str))
}

/// Whether the word belongs to a name of some household thing, and so is no misspelling of another.
pub(super) fn is_known(word: &str) -> bool {
    SYNONYMS.words.contains(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_file_has_names_and_two_columns() {
        for line in LINES.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
            let columns: Vec<&str> = line.split('|').collect();
            assert_eq!(columns.len(), 2, "{line}");
            assert!(!list(columns[0]).is_empty(), "{line}");
        }
    }

    #[test]
    fn a_name_stands_once_in_a_line() {
        for line in &SYNONYMS.lines {
            let all: BTreeSet<&String> = line.names.iter().chain(&line.kinds).collect();
            assert_eq!(all.len(), line.names.len() + line.kinds.len(), "{:?}", line.names);
        }
    }

    #[test]
    fn names_are_kin_in_both_directions() {
        for (one, other, kin) in [
            ("sofa", "couch", Some(Kinship::Same)),
            ("cup", "mug", Some(Kinship::Kind)),
            ("mug", "tumbler", None),
            ("glasses", "glass", None),
        ] {
            assert_eq!(kinship(one, other), kin);
            assert_eq!(kinship(other, one), kin);
        }
    }
}
