//! Things that moved: what was held to be a new thing is one that is missing elsewhere.
//!
//! An entry is *gone* when enough views in a row covered its place without it, and *missing* when it is gone or was not
//! seen for long. A newcomer may be a missing entry if they have one class, look the same, and the one was last seen
//! before the other was first seen. It is taken for that entry only if nothing else can be meant: no third entry that
//! looks the same has been unseen since the newcomer came, and no other newcomer looks the same. Without features
//! nothing is known to look the same, and nothing moves.

use std::collections::{BTreeMap, BTreeSet};

use jiff::civil::DateTime;

use super::detection::{Sighting, View};
use super::entry::{Entry, EntryId, SightingId};
use super::kind::Kind;
use super::{Change, SemanticMap};

/// A thing that moved and kept its id.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// The thing.
    pub entry: EntryId,
    /// The id under which it was seen at its new place until it was recognised. It is given to nothing else.
    pub newcomer: EntryId,
    /// The middle of the old place, in metres.
    pub from: [f64; 3],
    /// The middle of the new place, in metres.
    pub to: [f64; 3],
    /// When it was first seen at the new place.
    pub at: DateTime,
}

/// A thing that may have been elsewhere before, but it cannot be told which it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PerhapsMoved {
    /// The entry at the new place.
    pub newcomer: EntryId,
    /// The entries that it may be.
    pub candidates: Vec<EntryId>,
}

/// What a view brought that may show a move.
#[derive(Debug, Default)]
pub(super) struct News {
    /// Entries that it showed.
    pub(super) seen: BTreeSet<EntryId>,
    /// Entries that it confirmed, or gave another class.
    pub(super) confirmed: BTreeSet<EntryId>,
    /// Entries that are gone as of this view.
    pub(super) gone: BTreeSet<EntryId>,
}

/// What a newcomer may be.
enum Origin {
    /// Nothing that is missing.
    New,
    /// One of several, or one of several newcomers is it.
    Undecided,
    /// This entry.
    Known(EntryId),
}

impl SemanticMap {
    /// The newcomers that may be one of several missing things, each with these things.
    pub fn perhaps_moved(&self) -> Vec<PerhapsMoved> {
        let waiting = self.state.undecided.iter().filter_map(|id| self.state.entries.get(id));
        waiting
            .filter(|newcomer| matches!(self.origin(newcomer), Origin::Undecided))
            .map(|newcomer| PerhapsMoved {
                newcomer: newcomer.id,
                candidates: self.before(newcomer).map(|entry| entry.id).collect(),
            })
            .collect()
    }

    /// Whether enough views in a row covered an entry's place without it.
    pub fn is_gone(&self, entry: &Entry) -> bool {
        entry.absences >= self.parameters.absences
    }

    /// Counts a view as an absence of every entry that it covers and does not show. A view from before an entry was
    /// last seen tells nothing.
    pub(super) fn count_absences(&mut self, view: &View, news: &mut News) {
        let mut covered = BTreeSet::new();
        for region in &view.covered {
            covered.extend(self.grid.around(region.least.metres(), region.greatest.metres()));
        }
        for id in covered.difference(&news.seen) {
            let Some(entry) = self.state.entries.get_mut(id) else { continue };
            let deviation = libm::sqrt(entry.place.gaussian(self.parameters.spread).variance);
            let is_inside = view.covered.iter().any(|region| region.holds(entry.place.position, deviation));
            if is_inside && view.taken_at > entry.last_seen {
                entry.absences += 1;
                self.changed.insert(*id);
                if entry.absences == self.parameters.absences {
                    news.gone.insert(*id);
                }
            }
        }
    }

    /// Finds the moves that a view shows, and gives the things that moved their entries back.
    pub(super) fn follow_moves(&mut self, news: &News) {
        for newcomer in self.to_decide(news) {
            let Some(entry) = self.state.entries.get(&newcomer) else { continue };
            match self.origin(entry) {
                Origin::New => {
                    if self.state.undecided.remove(&newcomer) {
                        self.changed.insert(newcomer);
                    }
                }
                Origin::Undecided => {
                    if self.state.undecided.insert(newcomer) {
                        self.changed.insert(newcomer);
                    }
                }
                Origin::Known(entry) => {
                    self.state.undecided.remove(&newcomer);
                    self.reunite(entry, newcomer);
                }
            }
        }
    }

    /// The entries about which the news may decide: those just confirmed, those that came after something that is now
    /// gone, and those that waited for a thing of a class that was seen.
    fn to_decide(&self, news: &News) -> BTreeSet<EntryId> {
        let entry = |id: &EntryId| self.state.entries.get(id);
        let mut newcomers = news.confirmed.clone();
        for gone in news.gone.iter().filter_map(entry).filter(|gone| self.is_confirmed(gone)) {
            newcomers.extend(self.after(gone).map(|newcomer| newcomer.id));
        }
        let kind = |entry: &Entry| entry.class().map(Kind::of);
        let kinds: BTreeSet<Kind> = news.seen.union(&news.gone).filter_map(entry).filter_map(kind).collect();
        let waits = |id: &&EntryId| entry(id).and_then(kind).is_some_and(|kind| kinds.contains(&kind));
        if !self.state.undecided.is_empty() {
            newcomers.extend(self.state.undecided.iter().filter(waits));
        }
        newcomers
    }

    fn origin(&self, newcomer: &Entry) -> Origin {
        let is_missing = |entry: &Entry| {
            self.is_gone(entry)
                || newcomer.first_seen.duration_since(entry.last_seen) >= self.parameters.long_unseen
        };
        // Whether anything is missing at all is cheap to say, and mostly nothing is.
        if !self.before(newcomer).any(is_missing) {
            return Origin::New;
        }
        let mut candidates = self.before(newcomer);
        let (Some(candidate), None) = (candidates.next(), candidates.next()) else {
            return Origin::Undecided;
        };
        let is_only = self.after(candidate).all(|other| other.id == newcomer.id);
        if is_only { Origin::Known(candidate.id) } else { Origin::Undecided }
    }

    /// The confirmed entries that look the same as this one and were not seen since it was first seen.
    fn before<'a>(&'a self, newcomer: &'a Entry) -> impl Iterator<Item = &'a Entry> {
        self.of_class(newcomer)
            .filter(|entry| entry.last_seen < newcomer.first_seen && self.looks_same(entry, newcomer))
    }

    /// The confirmed entries that look the same as this one and were first seen after it was last seen.
    fn after<'a>(&'a self, gone: &'a Entry) -> impl Iterator<Item = &'a Entry> {
        self.of_class(gone).filter(|entry| entry.first_seen > gone.last_seen && self.looks_same(entry, gone))
    }

    fn of_class(&self, entry: &Entry) -> impl Iterator<Item = &Entry> {
        let ids = entry.class().and_then(|class| self.confirmed.get(&Kind::of(class)));
        ids.into_iter().flatten().filter_map(|id| self.state.entries.get(id))
    }

    /// Whether two entries look the same; those that a person told apart, or whose look is unknown, do not.
    pub(super) fn looks_same(&self, one: &Entry, other: &Entry) -> bool {
        match (&one.look, &other.look) {
            (Some(look), Some(other_look)) if !one.is_told_apart_from(other) => {
                look.cosine_with(other_look) >= self.parameters.same_look
            }
            _ => false,
        }
    }

    /// Makes a newcomer the entry that it was before.
    fn reunite(&mut self, id: EntryId, newcomer: EntryId) {
        let (Some(mut entry), Some(newcomer)) = (self.withdraw(id), self.withdraw(newcomer)) else { return };
        let moved = Moved {
            entry: id,
            newcomer: newcomer.id,
            from: entry.place.position,
            to: newcomer.place.position,
            at: newcomer.first_seen,
        };
        self.rename(newcomer.id, id, &newcomer.sightings);
        entry.move_to(newcomer);
        self.enter(entry);
        self.history.push(Change::Moved(moved));
    }

    /// Notes that these sightings are in another entry.
    pub(super) fn rename(&mut self, from: EntryId, to: EntryId, sightings: &BTreeMap<SightingId, Sighting>) {
        for sighting in sightings.values() {
            self.note(to, sighting);
            if let Some(entries) = sighting.view.as_ref().and_then(|view| self.state.views.get_mut(view)) {
                entries.remove(&from);
                entries.insert(to);
            }
        }
    }
}
