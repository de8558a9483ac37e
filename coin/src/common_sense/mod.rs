//! Common sense about classes: whose such a thing tends to be before anybody has used it.
//!
//! A language model brings this along. The embedded model reads it from `classes.txt`, a file of reasoned entries
//! that a person can check line by line.

use std::sync::LazyLock;

use thiserror::Error;

use crate::roster::Roster;

const CLASSES: &str = include_str!("classes.txt");

/// How much likelier a person whose role or occupation suits a class is to own such a thing alone than one whom it
/// does not: a word such as *student* beside *textbook* tells much, but homes differ.
const SUITED: f64 = 3.0;

/// Whose things of a class tend to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tendency {
    /// One person's.
    Personal,
    /// Either one person's or everybody's.
    Either,
    /// Everybody's.
    Shared,
}

impl Tendency {
    /// The probabilities of one owner and of everybody; sets between share what is left.
    fn of_sizes(self) -> (f64, f64) {
        match self {
            Self::Personal => (0.88, 0.04),
            Self::Either => (0.55, 0.30),
            Self::Shared => (0.22, 0.66),
        }
    }
}

/// What common sense expects of one class in one household.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// The probability that one member owns it.
    pub single: f64,
    /// The probability that everybody owns it.
    pub everyone: f64,
    /// How well every member is suited, in the order of the roster; only ratios count.
    pub suitability: Vec<f64>,
}

/// A line of the file that is no entry.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "line {line} of the class knowledge is {given:?}, expected `names | personal, either or shared | words`"
)]
pub struct MalformedEntry {
    line: usize,
    given: String,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Entry {
    names: Vec<&'static str>,
    tendency: Tendency,
    suits: Vec<&'static str>,
}

static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    // A test reads the file strictly, so that nothing is passed over in a program that was built from it.
    entries(CLASSES).filter_map(Result::ok).collect()
});

fn entries(text: &'static str) -> impl Iterator<Item = Result<Entry, MalformedEntry>> {
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#')).map(
        |(place, line)| entry(line).ok_or_else(|| MalformedEntry { line: place + 1, given: line.to_owned() }),
    )
}

fn entry(line: &'static str) -> Option<Entry> {
    let mut columns = line.split('|');
    let (names, tendency, suits) = (columns.next()?, columns.next()?, columns.next()?);
    if columns.next().is_some() {
        return None;
    }
    let words = |column: &'static str| {
        column.split(',').map(str::trim).filter(|word| !word.is_empty()).collect::<Vec<_>>()
    };
    let tendency = match tendency.trim() {
        "personal" => Tendency::Personal,
        "either" => Tendency::Either,
        "shared" => Tendency::Shared,
        _ => return None,
    };
    Some(Entry { names: words(names), tendency, suits: words(suits) }).filter(|entry| !entry.names.is_empty())
}

/// The names under which a label is looked up: the whole label before its last word, as it stands before its
/// singular.
fn names_of(class: &str) -> Vec<String> {
    let label = class.trim().to_lowercase().replace(['_', '-'], " ");
    let last = label.rsplit(' ').next().unwrap_or(&label).to_owned();
    [label, last]
        .into_iter()
        .flat_map(|name| {
            let singular = name.strip_suffix('s').map(str::to_owned);
            std::iter::once(name).chain(singular)
        })
        .collect()
}

fn entry_of(class: &str) -> Option<&'static Entry> {
    names_of(class).iter().find_map(|name| {
        ENTRIES.iter().find(|entry| entry.names.iter().any(|known| known.replace('-', " ") == *name))
    })
}

/// The names of all classes that something is known of.
pub(crate) fn class_names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().flat_map(|entry| entry.names.iter().copied())
}

/// Whose things of the class tend to be; `None` where nothing is known of the class.
pub fn tendency(class: &str) -> Option<Tendency> {
    entry_of(class).map(|entry| entry.tendency)
}

/// What is expected of a thing of this class among these people; `None` where nothing is known of the class. Roles
/// and occupations that are left out say nothing.
pub fn expect(class: &str, roster: &Roster) -> Option<Expectation> {
    let entry = entry_of(class)?;
    let (single, everyone) = entry.tendency.of_sizes();
    let suitability = roster
        .indices()
        .map(|user| {
            let background = roster.background(user);
            let words = [&background.role, &background.occupation];
            let suited = words
                .into_iter()
                .flatten()
                .flat_map(|text| text.split(|letter: char| !letter.is_alphanumeric()))
                .any(|word| entry.suits.iter().any(|suits| suits.eq_ignore_ascii_case(word)));
            if suited { SUITED } else { 1.0 }
        })
        .collect();
    Some(Expectation { single, everyone, suitability })
}

#[cfg(test)]
mod tests;
