//! Cuts an answer into sentences and these into segments that each say one thing.

use super::units::{Kind, Mark, Unit, Units, Verb};
use crate::language::parties::Party;
use crate::language::words::Gap;
use crate::owners::OwnerSet;

/// The groups that "everyone" and "both" mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Named {
    pub(super) everyone: OwnerSet,
    pub(super) in_question: OwnerSet,
}

/// What one segment says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Statement {
    /// These own the thing.
    Claim {
        owners: OwnerSet,
        outside: bool,
    },
    /// These own the thing now, whoever did before.
    Instead {
        owners: OwnerSet,
        outside: bool,
    },
    /// These own it too.
    Also {
        owners: OwnerSet,
        outside: bool,
    },
    /// These own it, and others do.
    Partial(OwnerSet),
    /// These do not own it.
    Deny(OwnerSet),
    /// Nobody of the household owns it.
    DenyAll,
    /// These alone, or all of these together, use it.
    Use {
        owners: OwnerSet,
    },
    /// It is shared; by whom is not said.
    Shared,
    Yes,
    No,
    /// The answer does not settle the matter, whatever else it says.
    Doubt,
    /// What was said before is taken back.
    Correction,
    /// Nothing but fillers.
    Silence,
    /// Something that the reader does not understand, or that does not tell owners.
    Unread,
}

/// What begins a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Opening {
    Sentence,
    Comma,
    Word,
}

/// A run of units that says one thing.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    opening: Opening,
    pub(super) units: Vec<Unit>,
}

impl Segment {
    /// Whether it speaks of anybody.
    pub(super) fn names_somebody(&self) -> bool {
        self.units.iter().any(|unit| unit.party().is_some())
    }
}

/// Segments up to a full stop or a question mark.
#[derive(Debug, Clone)]
pub(super) struct Sentence {
    pub(super) segments: Vec<Segment>,
    pub(super) end: Gap,
}

/// Cuts the units of an answer.
pub(super) fn sentences(units: Units) -> Vec<Sentence> {
    let mut sentences = Vec::new();
    let mut row: Vec<Unit> = Vec::new();
    for unit in units.row {
        if unit.gap >= Gap::Stop && !row.is_empty() {
            sentences.push(Sentence { segments: segments(&row), end: unit.gap });
            row.clear();
        }
        row.push(unit);
    }
    sentences.push(Sentence { segments: segments(&row), end: units.end });
    sentences
}

/// The segments of a yes-or-no question that stand before its "or"; `None` where the question is open, or where
/// what follows the "or" names other members, so that "yes" would not say which.
pub(super) fn first_alternative(units: Units) -> Option<Vec<Segment>> {
    if units.asks_openly {
        return None;
    }
    let mut row = units.row;
    let last = row.iter().rposition(|unit| unit.gap >= Gap::Stop).unwrap_or(0);
    row.drain(..last);
    let names = |units: &[Unit]| {
        units
            .iter()
            .filter_map(Unit::party)
            .any(|(party, _)| matches!(party, Party::Members(_) | Party::Everyone))
    };
    let alternatives = row.iter().position(|unit| unit.is(Mark::Or));
    if let Some(or) = alternatives {
        let shared = row[..or].iter().any(|unit| {
            unit.is(Mark::Verb(Verb::Share)) || matches!(unit.party(), Some((Party::Everyone, _)))
        });
        if names(&row[or..]) && !shared {
            return None;
        }
        row.truncate(or);
    }
    // "Isn't this Bob's?" is answered like "Is this Bob's?".
    if row.get(1).is_some_and(|unit| unit.is(Mark::Not)) {
        row.remove(1);
    }
    (!row.iter().any(|unit| unit.is(Mark::Not))).then(|| segments(&row))
}

fn segments(row: &[Unit]) -> Vec<Segment> {
    let mut cutter = Cutter { segments: Vec::new(), current: Vec::new(), opening: Opening::Sentence };
    for at in 0..row.len() {
        cutter.take(row, at);
    }
    cutter.cut(Opening::Sentence);
    join_lists(cutter.segments)
}

struct Cutter {
    segments: Vec<Segment>,
    current: Vec<Unit>,
    opening: Opening,
}

impl Cutter {
    fn cut(&mut self, next: Opening) {
        if !self.current.is_empty() {
            let units = std::mem::take(&mut self.current);
            self.segments.push(Segment { opening: self.opening, units });
        }
        self.opening = next;
    }

    fn alone(&mut self, unit: Unit) {
        self.cut(self.opening);
        self.current.push(unit);
        self.cut(Opening::Word);
    }

    fn take(&mut self, row: &[Unit], at: usize) {
        let unit = row[at];
        if unit.gap == Gap::Comma {
            self.cut(Opening::Comma);
        }
        let opens = self.current.iter().all(|unit| unit.is(Mark::Filler));
        match unit.kind {
            Kind::Mark(Mark::Yes | Mark::No) if opens => self.alone(unit),
            Kind::Mark(Mark::Correction) => self.alone(unit),
            Kind::Mark(Mark::Actually) if opens => {
                self.alone(Unit { kind: Kind::Mark(Mark::Correction), gap: unit.gap });
            }
            // "I don't know who uses it" is one clause.
            Kind::Mark(Mark::Break) if self.current.last().is_some_and(|last| last.is(Mark::Doubt)) => {}
            Kind::Mark(Mark::Yes | Mark::No) => {
                self.current.push(Unit { kind: Kind::Word { capital: false }, gap: unit.gap });
            }
            Kind::Mark(Mark::But) if self.excepts(row, at) => {
                self.current.push(Unit { kind: Kind::Mark(Mark::Except), gap: unit.gap });
            }
            Kind::Mark(Mark::But | Mark::Break) => self.cut(Opening::Word),
            Kind::Mark(Mark::Not) if self.current.last().is_some_and(|last| last.party().is_some()) => {
                self.cut(Opening::Word);
                self.current.push(unit);
            }
            Kind::Mark(Mark::It) if self.restarts(row, at) => {
                self.cut(Opening::Word);
                self.current.push(unit);
            }
            Kind::Mark(Mark::And) if self.current.iter().any(|unit| unit.party().is_some()) => {
                match continues_list(row, at, &self.current) {
                    true => self.current.push(unit),
                    false => self.cut(Opening::Word),
                }
            }
            _ => self.current.push(unit),
        }
    }

    /// "everyone but Tom", not "it's everyone's, but Tom uses it".
    fn excepts(&self, row: &[Unit], at: usize) -> bool {
        let group = self.current.iter().rev().find(|unit| !unit.is(Mark::Filler)).and_then(Unit::party);
        let Some((party, _)) = group else { return false };
        let except = next_party(row, at + 1);
        let clause = except.is_some_and(|place| row.get(place + 1).is_some_and(Unit::is_verb));
        let predicate = self.current.iter().any(Unit::is_verb);
        except.is_some()
            && match party {
                Party::Nobody | Party::Anyone => true,
                Party::Everyone | Party::Ours | Party::Three => !(clause && predicate),
                _ => false,
            }
    }

    /// "… Bob's it is Mary's": a new clause without any mark.
    fn restarts(&self, row: &[Unit], at: usize) -> bool {
        let clause = row.get(at + 1).is_some_and(|next| next.is(Mark::Be) && next.gap == Gap::Space);
        let party = self.current.iter().rposition(|unit| unit.party().is_some());
        let denial = self.current.iter().rposition(|unit| unit.is(Mark::Not));
        // "I don't believe it is Bob's" is one clause.
        clause && party.is_some() && denial.is_none_or(|denial| party > Some(denial))
    }
}

/// The next unit that is a party, fillers and such left out.
fn next_party(row: &[Unit], from: usize) -> Option<usize> {
    let place = (from..row.len())
        .find(|&place| !matches!(row[place].kind, Kind::Mark(Mark::Filler | Mark::Only | Mark::Also)))?;
    row[place].party().map(|_| place)
}

/// Whether an "and" joins people and not clauses.
fn continues_list(row: &[Unit], and: usize, current: &[Unit]) -> bool {
    let Some(place) = next_party(row, and + 1) else { return false };
    let (_, possessive) = row[place].party().unwrap_or((Party::Unknown, false));
    let verb = row.get(place + 1).is_some_and(Unit::is_verb);
    let predicate = current.iter().any(|unit| {
        unit.is(Mark::Be) || unit.is(Mark::Verb(Verb::Own)) || matches!(unit.party(), Some((_, true)))
    });
    possessive || !verb || !predicate
}

/// Puts "Bob, Mary and Tom" together again, which the commas have cut.
fn join_lists(segments: Vec<Segment>) -> Vec<Segment> {
    let mut joined: Vec<Segment> = Vec::with_capacity(segments.len());
    for segment in segments {
        match joined.last_mut() {
            Some(before) if segment.opening == Opening::Comma && continues(before, &segment) => {
                let linked = segment.units.first().is_some_and(|first| {
                    matches!(first.kind, Kind::Mark(Mark::And | Mark::Or | Mark::Except))
                });
                if !linked {
                    before.units.push(Unit { kind: Kind::Mark(Mark::And), gap: Gap::Space });
                }
                before.units.extend(segment.units);
            }
            // "Thanks, Mary": she is spoken to, not of.
            Some(before) if segment.opening == Opening::Comma && addresses(before, &segment) => {
                before.units.extend(segment.units);
            }
            _ => joined.push(segment),
        }
    }
    joined
}

fn addresses(before: &Segment, segment: &Segment) -> bool {
    before.units.iter().any(|unit| unit.is(Mark::Address))
        && is_list(&segment.units)
        && !segment.units.iter().any(|unit| matches!(unit.party(), Some((_, true))))
}

fn continues(before: &Segment, segment: &Segment) -> bool {
    let people = |units: &[Unit]| units.iter().any(|unit| unit.party().is_some());
    let ends_with_party = before
        .units
        .iter()
        .rev()
        .find(|unit| !matches!(unit.kind, Kind::Mark(Mark::Filler) | Kind::Word { .. }))
        .is_some_and(|last| last.party().is_some());
    let excepts = segment.units.first().is_some_and(|first| first.is(Mark::Except));
    if excepts {
        return people(&before.units);
    }
    if !ends_with_party || before.units.iter().any(|unit| unit.is(Mark::Address)) {
        return false;
    }
    let denied = before.units.iter().any(|unit| unit.is(Mark::Not));
    let alternative = segment.units.iter().any(|unit| unit.is(Mark::Or));
    if is_list(&segment.units) {
        return !denied || alternative;
    }
    // "Bob, Mary and Tom own it"
    let first_and = segment.units.iter().position(|unit| unit.is(Mark::And));
    is_list(&before.units)
        && segment.units.first().is_some_and(|first| first.party().is_some())
        && first_and == Some(1)
}

/// Nothing but people, joined.
fn is_list(units: &[Unit]) -> bool {
    let listed = |unit: &Unit| {
        matches!(
            unit.kind,
            Kind::Party { .. }
                | Kind::Mark(Mark::And | Mark::Or | Mark::Only | Mark::Also | Mark::Filler | Mark::Except)
        )
    };
    units.iter().all(listed) && units.iter().any(|unit| unit.party().is_some())
}
