//! What the small words of a request do. Lists are written with commas; the longest phrase that fits is taken.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::interpretation::Relation;
use crate::language::vocabulary::index;

/// What a phrase does in a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    /// Polite words and what the robot is to do: they say nothing of the thing.
    Frame,
    /// Asks whose the thing is.
    Whose,
    /// The thing is to be put somewhere: the place behind is no hint.
    Put,
    /// What follows is where or to whom the thing goes.
    Destination,
    /// An owner follows, or a part of the name.
    Of,
    /// What follows is not meant.
    Not,
    /// Behind a person: the thing is this person's.
    Own,
    /// Joins two owners.
    And,
    /// A place follows.
    Place(Relation),
    /// Above a place, where the thing was named before ("the lamp over the table"); otherwise it says nothing of the
    /// thing ("bring over the lamp").
    Over,
}

const PHRASES: &[(Mark, &str)] = &[
    (
        Mark::Frame,
        "bring, bringing, brings, give, giving, get, getting, fetch, fetching, find, finding, show, take, taking, \
         carry, grab, pick up, hand me, hand us, pass me, pass us, hand over, hand, go and get, go get, could, can, \
         would, will, please, me, us, i, we, you, want, wants, need, needs, like, would like, have, has, seen, look, \
         looking, look for, looking for, search for, searching for, where, where is, where are, did, do, does, am, \
         are, is, was, were, be, leave, left, lost, lose, forgot, hey, hi, hello, robot, coin, ok, okay, thanks, \
         thank you, thank, the, a, an, some, any, mind, tell, know, there, here, this, that, these, those, or, it, one, \
         ones, again, now, quickly, quick, kindly, just, so, with, back, thing, things, stuff, something, \
         anything, for me, for us, over here, over there, right now, at once, if you can, anywhere, somewhere, which, \
         what, called, try, let's, let, see, ever, possible, if, when, time, may, might, must, should, read, use, wear, play, play with, drink, drink from, write with, eat, wash, \
         charge, borrow, open, lying, standing, hanging, sitting, kept, pair of, pairs of, set of, bunch of, who",
    ),
    (
        Mark::Whose,
        "whose, who owns, who own, who does, who do, who is the owner of, who is the owner, to whom, to whom does, \
         to whom do",
    ),
    (Mark::Not, "not, rather than, instead of, but not"),
    (Mark::Own, "own, owns, share, shares, all share, both share"),
    (Mark::Put, "put, place, set, lay, store, drop, move"),
    (Mark::Destination, "to, into, onto, for, over to, back to, back in, back on"),
    (
        Mark::Of,
        "of, belonging to, belongs to, belong to, owned by, that belongs to, which belongs to, that belong to, \
         which belong to, that is, which is, that are, which are, property of",
    ),
    (Mark::And, "and, plus, as well as, and also, &"),
    (
        Mark::Place(Relation::Near),
        "next to, near, near to, close to, by, beside, alongside, behind, in front of, at, nearest to, closest to, \
         between, opposite, that is next to, that is near, which is next to, left of, right of, to the left of, \
         to the right of, around",
    ),
    (
        Mark::Place(Relation::Above),
        "on, on top of, on the top of, from on, from on top of, off, from off, above, from above, upon, that is on, \
         which is on",
    ),
    (
        Mark::Place(Relation::Below),
        "under, underneath, beneath, below, from under, from underneath, from beneath, from below, out from under, \
         out from underneath, out from beneath",
    ),
    (Mark::Over, "over"),
    (
        Mark::Place(Relation::In),
        "in, inside, from, out of, within, that is in, which is in, that are in, down in, up in, over in",
    ),
];

/// The longest phrase, in words.
pub(super) const LONGEST_PHRASE: usize = 5;

static MARKS: LazyLock<HashMap<&str, Mark>> = LazyLock::new(|| index(PHRASES));

/// What a phrase does; `None` for the words of a thing.
pub(super) fn mark(phrase: &str) -> Option<Mark> {
    MARKS.get(phrase).copied()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn no_phrase_does_two_things() {
        let once: usize =
            PHRASES.iter().map(|(_, list)| list.split(", ").collect::<BTreeSet<_>>().len()).sum();
        assert_eq!(once, MARKS.len());
        assert!(MARKS.keys().all(|phrase| phrase.split(' ').count() <= LONGEST_PHRASE));
    }
}
