//! Tells what one segment of an answer says.

use super::clauses::{Named, Segment, Statement};
use super::units::{Kind, Mark, Place, Unit, Verb};
use crate::language::parties::Party;
use crate::owners::OwnerSet;

/// A party and where it stands.
#[derive(Debug, Clone, Copy)]
struct Placed {
    party: Party,
    possessive: bool,
    at: usize,
    /// The preposition that governs it.
    place: Option<Place>,
}

/// Owners within the household, and whether somebody outside is one.
type Owners = (OwnerSet, bool);

/// Reads a segment.
pub(super) fn read(segment: &Segment, named: &Named) -> Statement {
    let units = &segment.units;
    let clause = Clause { units, parties: &placed(units), named };
    let silent = |unit: &Unit| {
        matches!(unit.kind, Kind::Mark(Mark::Filler | Mark::Address | Mark::Actually | Mark::And))
    };
    if units.iter().all(silent) || clause.has(Mark::Address) {
        return Statement::Silence;
    }
    match units.iter().find(|unit| !unit.is(Mark::Filler)).map(|unit| unit.kind) {
        Some(Kind::Mark(Mark::Yes)) => return Statement::Yes,
        Some(Kind::Mark(Mark::No)) => return Statement::No,
        Some(Kind::Mark(Mark::Correction)) => return Statement::Correction,
        _ => {}
    }
    if let Some(statement) = clause.short_reply() {
        return statement;
    }
    let verb = |verb: Verb| clause.position(Mark::Verb(verb));
    if clause.has(Mark::Doubt) {
        let of_use = [Verb::Use, Verb::Lend, Verb::Borrow].into_iter().any(|of| verb(of).is_some());
        return if of_use { Statement::Unread } else { Statement::Doubt };
    }
    if clause.has(Mark::Was) {
        return Statement::Unread;
    }
    if let Some(at) = verb(Verb::Lend) {
        clause.lender(at)
    } else if verb(Verb::Borrow).is_some() {
        clause.borrowed()
    } else if let Some(at) = verb(Verb::Own) {
        clause.owned(at)
    } else if verb(Verb::Share).is_some() {
        clause.shared()
    } else if let Some(at) = verb(Verb::Use) {
        clause.used(at)
    } else if verb(Verb::Leave).is_some() {
        clause.left_behind()
    } else if verb(Verb::Other).is_some() {
        Statement::Unread
    } else {
        clause.plain()
    }
}

struct Clause<'units> {
    units: &'units [Unit],
    parties: &'units [Placed],
    named: &'units Named,
}

impl Clause<'_> {
    fn has(&self, mark: Mark) -> bool {
        self.position(mark).is_some()
    }

    fn position(&self, mark: Mark) -> Option<usize> {
        self.units.iter().position(|unit| unit.is(mark))
    }

    fn denials(&self) -> usize {
        self.units.iter().filter(|unit| unit.is(Mark::Not)).count()
    }

    /// "It is", "they do", "he isn't": yes or no.
    fn short_reply(&self) -> Option<Statement> {
        let mut verbs = 0;
        let mut pronouns = 0;
        for unit in self.units {
            match unit.kind {
                Kind::Mark(Mark::It)
                | Kind::Party { party: Party::They | Party::Unknown | Party::Ours, possessive: false } => {
                    pronouns += 1;
                }
                Kind::Mark(Mark::Be | Mark::Auxiliary) => verbs += 1,
                Kind::Mark(Mark::Not | Mark::Filler) => {}
                _ => return None,
            }
        }
        match (pronouns, verbs, self.denials()) {
            (1, 1, 0) => Some(Statement::Yes),
            (1, 1, 1) => Some(Statement::No),
            _ => None,
        }
    }

    /// "Mary lets Tom use it", "the neighbours lent it to us"
    fn lender(&self, verb: usize) -> Statement {
        let lenders = self.select(|placed| placed.at < verb && placed.place.is_none() && !placed.possessive);
        self.claim(&lenders)
    }

    /// "Tom borrowed it from Mary", "Tom borrows Mary's"
    fn borrowed(&self) -> Statement {
        let from = self.select(|placed| placed.place == Some(Place::From));
        let possessors = self.select(|placed| placed.place.is_none() && placed.possessive);
        if from.is_empty() { self.claim(&possessors) } else { self.claim(&from) }
    }

    fn owned(&self, verb: usize) -> Statement {
        let owners = self.select(|placed| {
            matches!(placed.place, None | Some(Place::To | Place::By))
                || placed.place == Some(Place::Of) && placed.possessive
        });
        let across = owners.windows(2).any(|pair| pair[0].at < verb && verb < pair[1].at);
        if across || self.has(Mark::NoPossession) {
            return Statement::Doubt;
        }
        match self.denials() {
            0 => self.claim(&owners),
            1 => match owners.first() {
                Some(first) if self.denial_reaches(first.at.max(verb)) => self.deny(&owners),
                _ => Statement::Unread,
            },
            _ => Statement::Doubt,
        }
    }

    fn shared(&self) -> Statement {
        if self.denials() > 0 {
            return Statement::Unread;
        }
        let sharers = self.select(|placed| {
            matches!(placed.place, None | Some(Place::With | Place::By | Place::For | Place::To))
        });
        let unnamed = |placed: &Placed| matches!(placed.party, Party::They | Party::Unknown);
        if sharers.iter().all(unnamed) {
            let they = sharers.iter().any(|placed| placed.party == Party::They);
            return match self.named.in_question {
                owners if they && owners.len() > 1 => self.state((owners, false)),
                _ => Statement::Shared,
            };
        }
        let together = self.unite(&sharers);
        match together {
            Some((owners, false)) if owners.len() > 1 => self.state((owners, false)),
            Some((owners, true)) if !owners.is_empty() => self.state((owners, true)),
            _ => Statement::Doubt,
        }
    }

    /// Using tells an owner only where one person alone uses the thing, or several do together.
    fn used(&self, verb: usize) -> Statement {
        let possessors =
            self.select(|placed| placed.place.is_none() && placed.possessive && placed.at > verb);
        if !possessors.is_empty() {
            return self.claim(&possessors);
        }
        let users = self
            .select(|placed| placed.place.is_none() && placed.at < verb || placed.place == Some(Place::By));
        let by = users.first().is_some_and(|user| user.place == Some(Place::By));
        let exclusive = self.has(Mark::OnlyOne)
            || self.has(Mark::Only) && (by || self.position(Mark::Only) < users.first().map(|user| user.at))
            || users.first().is_some_and(|user| user.party == Party::Nobody);
        if self.denials() > 0 {
            return Statement::Unread;
        }
        match self.resolve(&users) {
            Some((owners, false)) if owners.len() > 1 || exclusive && !owners.is_empty() => {
                Statement::Use { owners }
            }
            _ => Statement::Unread,
        }
    }

    fn left_behind(&self) -> Statement {
        match self.parties.first() {
            Some(first) if first.party == Party::Outside && self.denials() == 0 => {
                self.claim(&self.parties[..1])
            }
            _ => Statement::Unread,
        }
    }

    /// No verb but "is": "Bob", "it is Bob's mug", "not Mary's".
    fn plain(&self) -> Statement {
        let possessors =
            self.select(|placed| placed.possessive && matches!(placed.place, None | Some(Place::Of)));
        let people = self.select(|placed| {
            !placed.possessive
                && (placed.place.is_none()
                    || placed.place == Some(Place::Of) && placed.party == Party::Outside
                    || placed.place == Some(Place::For) && is_group(placed.party))
        });
        let mut all: Vec<Placed> = possessors.iter().chain(&people).copied().collect();
        all.sort_by_key(|placed| placed.at);
        let Some(first) = all.first() else { return self.pointless() };
        if self.has(Mark::NoPossession) {
            return Statement::Unread;
        }
        let understood = if possessors.is_empty() { self.is_understood() } else { !self.describes(first) };
        let mixed = !possessors.is_empty() && !people.is_empty() && !self.are_joined(&all);
        if !understood || mixed {
            return Statement::Unread;
        }
        match self.denials() {
            0 => self.claim(&all),
            1 if self.only_denied() => match self.unite(&all) {
                Some((owners, false)) => Statement::Partial(owners),
                _ => Statement::Doubt,
            },
            1 if self.denial_reaches(first.at) => self.deny(&all),
            1 => Statement::Unread,
            _ => Statement::Doubt,
        }
    }

    /// Nobody is named as an owner: the segment may still not settle anything.
    fn pointless(&self) -> Statement {
        let quiet = |unit: &Unit| {
            matches!(
                unit.kind,
                Kind::Mark(
                    Mark::Filler
                        | Mark::It
                        | Mark::Be
                        | Mark::Only
                        | Mark::Also
                        | Mark::Now
                        | Mark::Not
                        | Mark::And
                )
            )
        };
        if self.units.iter().all(quiet) { Statement::Silence } else { Statement::Unread }
    }

    /// Whether every unit has its place in "it is Bob and Mary".
    fn is_understood(&self) -> bool {
        self.units.iter().all(|unit| match unit.kind {
            Kind::Party { .. } => true,
            Kind::Word { .. } => false,
            Kind::Mark(mark) => !matches!(
                mark,
                Mark::Place(Place::To | Place::By | Place::From | Place::With | Place::Elsewhere)
                    | Mark::Verb(_)
            ),
        })
    }

    /// "Bob's is the blue one": the possessor stands first and something is said of what he has.
    fn describes(&self, first: &Placed) -> bool {
        let opens = self.units[..first.at]
            .iter()
            .all(|unit| matches!(unit.kind, Kind::Mark(Mark::Filler | Mark::Only | Mark::Also | Mark::And)));
        opens && first.possessive && self.units[first.at..].iter().any(Unit::is_verb)
    }

    /// "not only Bob's"
    fn only_denied(&self) -> bool {
        self.units.windows(2).any(|pair| pair[0].is(Mark::Not) && pair[1].is(Mark::Only))
    }

    /// Whether "not" denies what stands at `at`: nothing stands in between that could be denied instead.
    fn denial_reaches(&self, at: usize) -> bool {
        let Some(not) = self.position(Mark::Not) else { return false };
        let (from, to) = (not.min(at), not.max(at));
        self.units[from + 1..to].iter().all(|unit| {
            matches!(
                unit.kind,
                Kind::Party { .. }
                    | Kind::Mark(
                        Mark::Be
                            | Mark::It
                            | Mark::Filler
                            | Mark::Auxiliary
                            | Mark::And
                            | Mark::Or
                            | Mark::Place(Place::To | Place::By)
                            | Mark::Verb(Verb::Own)
                    )
            )
        })
    }

    fn select(&self, wanted: impl Fn(&Placed) -> bool) -> Vec<Placed> {
        self.parties.iter().copied().filter(wanted).collect()
    }

    fn claim(&self, parties: &[Placed]) -> Statement {
        match parties {
            [] => Statement::Unread,
            [one] if matches!(one.party, Party::NoneOfUs) => Statement::DenyAll,
            [one] if matches!(one.party, Party::Nobody) => Statement::Unread,
            _ => self.resolve(parties).map_or(Statement::Doubt, |owners| self.state(owners)),
        }
    }

    fn state(&self, (owners, outside): Owners) -> Statement {
        let joined = self.units.first().is_some_and(|first| first.is(Mark::And));
        if owners.is_empty() && !outside {
            Statement::Doubt
        } else if self.has(Mark::Also) || joined {
            Statement::Also { owners, outside }
        } else if self.has(Mark::Now) {
            Statement::Instead { owners, outside }
        } else {
            Statement::Claim { owners, outside }
        }
    }

    fn deny(&self, parties: &[Placed]) -> Statement {
        let all = |placed: &Placed| matches!(placed.party, Party::Ours | Party::AnyOfUs);
        let vague = |placed: &Placed| {
            matches!(
                placed.party,
                Party::Anyone | Party::Everyone | Party::Unknown | Party::Nobody | Party::NoneOfUs
            )
        };
        if parties.iter().any(all) {
            Statement::DenyAll
        } else if parties.iter().any(vague) {
            Statement::Silence
        } else {
            match self.unite(parties) {
                Some((owners, _)) if owners != self.named.everyone => Statement::Deny(owners),
                Some(_) => Statement::Silence,
                None => Statement::Doubt,
            }
        }
    }

    /// Whom a list means; `None` where it leaves a choice or names somebody unknown.
    fn resolve(&self, parties: &[Placed]) -> Option<Owners> {
        if self.has(Mark::Or) || !self.are_joined(parties) {
            return None;
        }
        let Some(except) = self.position(Mark::Except) else { return self.unite(parties) };
        let (whole, left_out): (Vec<Placed>, Vec<Placed>) =
            parties.iter().partition(|placed| placed.at < except);
        let (left_out, _) = self.unite(&left_out).filter(|(_, outside)| !outside)?;
        if whole.first().is_some_and(|first| matches!(first.party, Party::Nobody | Party::NoneOfUs)) {
            return Some((left_out, false));
        }
        // "Anyone but Tom" is a way to say "not Tom".
        let choice = |placed: &Placed| matches!(placed.party, Party::Anyone | Party::AnyOfUs);
        let groups =
            !whole.is_empty() && whole.iter().all(|placed| is_group(placed.party) && !choice(placed));
        let (whole, outside) = self.unite(&whole).filter(|_| groups)?;
        Some((whole.iter().filter(|&user| !left_out.contains(user)).collect(), outside))
    }

    fn unite(&self, parties: &[Placed]) -> Option<Owners> {
        let listed: OwnerSet = parties
            .iter()
            .filter_map(|placed| match placed.party {
                Party::Members(members) => Some(members),
                _ => None,
            })
            .fold(OwnerSet::EMPTY, OwnerSet::union);
        let mut owners = OwnerSet::EMPTY;
        let mut outside = false;
        for placed in parties {
            match placed.party {
                Party::Members(members) => owners = owners.union(members),
                Party::Everyone | Party::Ours | Party::Anyone | Party::AnyOfUs => {
                    owners = self.named.everyone;
                }
                Party::Both if listed.len() == 2 => {}
                Party::Both => owners = owners.union(self.both()?),
                Party::Three if self.named.everyone.len() == 3 => owners = self.named.everyone,
                Party::Outside => outside = true,
                Party::Three
                | Party::SomeoneElse
                | Party::Nobody
                | Party::NoneOfUs
                | Party::They
                | Party::OneOf(_)
                | Party::Unknown => return None,
            }
        }
        Some((owners, outside))
    }

    fn both(&self) -> Option<OwnerSet> {
        [self.named.in_question, self.named.everyone].into_iter().find(|set| set.len() == 2)
    }

    /// Whether an "and" stands between each and the next; "both" needs none.
    fn are_joined(&self, parties: &[Placed]) -> bool {
        parties.windows(2).all(|pair| {
            let between = &self.units[pair[0].at + 1..pair[1].at];
            let both =
                pair.iter().any(|placed| placed.party == Party::Both) || pair[0].party == pair[1].party;
            let joint = |unit: &Unit| {
                matches!(
                    unit.kind,
                    Kind::Mark(
                        Mark::And
                            | Mark::Or
                            | Mark::Except
                            | Mark::Place(Place::With)
                            | Mark::Verb(Verb::Share)
                    )
                )
            };
            both || between.iter().any(joint)
        })
    }
}

fn is_group(party: Party) -> bool {
    matches!(
        party,
        Party::Everyone | Party::Ours | Party::Three | Party::Anyone | Party::AnyOfUs | Party::Both
    )
}

/// The parties and what governs them; "with Bob and Mary" governs both.
fn placed(units: &[Unit]) -> Vec<Placed> {
    let mut found: Vec<Placed> = Vec::new();
    for (at, unit) in units.iter().enumerate() {
        let Some((party, possessive)) = unit.party() else { continue };
        // "They are Tom's": the things, not the people.
        if party == Party::They && units.get(at + 1).is_some_and(|next| next.is(Mark::Be)) {
            continue;
        }
        let before =
            (0..at).rev().find(|&place| !matches!(units[place].kind, Kind::Mark(Mark::Filler | Mark::Only)));
        let place = match before.map(|place| units[place].kind) {
            Some(Kind::Mark(Mark::Place(place))) => Some(place),
            Some(Kind::Mark(Mark::And | Mark::Or | Mark::Also)) => found.last().and_then(|last| last.place),
            Some(Kind::Party { .. }) => found.last().and_then(|last| last.place),
            _ => None,
        };
        found.push(Placed { party, possessive, at, place });
    }
    found
}
