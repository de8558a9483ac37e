//! The words of answers. Lists are written with commas; the longest phrase that fits is taken.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::units::{Mark, Place, Verb};
use crate::language::vocabulary::index;

/// Phrases and what they do. Words are folded; contractions are written out before.
const PHRASES: &[(Mark, &str)] = &[
    (
        Mark::Yes,
        "yes, yeah, yep, yup, yea, aye, right, correct, exactly, sure, sure thing, indeed, absolutely, \
         i think so, i believe so, that is right, that is correct, that is true, true, of course it is, \
         you are right",
    ),
    (
        Mark::No,
        "no, nope, nah, wrong, false, incorrect, not really, i do not think so, i do not believe so, \
         that is wrong, that is not right, that is not true, not true",
    ),
    (
        Mark::Doubt,
        "maybe, perhaps, possibly, might, could, may be, i guess, i suppose, my guess, guess, not sure, \
         not certain, not quite sure, not really sure, not so sure, unsure, no idea, no clue, dunno, \
         idk, who knows, beats me, i forgot, we forgot, do not know, did not know, does not know, \
         can not say, can not tell, could not say, can not remember, do not remember, do not recall, \
         i forget, hard to say, hard to tell, depends, if, unless, sometimes, mostly, mainly, usually, \
         whoever, whichever, whose, ask, i doubt, doubt, doubts, pretends, denies, hopes, wishes, \
         claims, may, someone, somebody, either, partly, half, wonder, officially, technically, \
         one of them, one of us, not all, not everyone, not everybody, no comment, unclear, unknown, \
         or so, as if, supposedly, apparently not",
    ),
    (
        Mark::Correction,
        "no wait, oh wait, wait no, wait, i mean, or rather, correction, scratch that, my bad, \
         my mistake, i meant, or actually, sorry no, no sorry",
    ),
    (Mark::Actually, "actually, rather, in fact"),
    (
        Mark::Not,
        "i do not think, i do not believe, i would not say, we do not think, not, never, no longer, \
         neither, hardly, no way, impossible, unlikely, no chance",
    ),
    (Mark::Only, "only, just, solely, exclusively"),
    (Mark::And, "and, plus, as well as, and also, along with, together with, &"),
    (Mark::Or, "or, nor"),
    (
        Mark::Except,
        "except, except for, excepting, apart from, aside from, other than, besides, excluding, but for, \
         bar",
    ),
    (Mark::Also, "also, too, as well"),
    (Mark::Now, "now, nowadays, these days, meanwhile"),
    (Mark::But, "but, however, yet"),
    (
        Mark::Break,
        "because, since, though, although, even though, so, while, whereas, when, that is why, which, \
         who, cause, cuz, and so",
    ),
    (
        Mark::Be,
        "is, are, am, be, been, being, has been, have been, has always been, have always been, \
         has long been",
    ),
    (
        Mark::Was,
        "was, were, had been, belonged, used to, formerly, previously, originally, once, at some point, \
         first, at first",
    ),
    (Mark::Auxiliary, "do, does, did, can, will, would, must, should"),
    (Mark::It, "it, this, that, these, those, one, thing, stuff, the one, this one, that one"),
    (Mark::Place(Place::To), "to"),
    (Mark::Place(Place::By), "by"),
    (Mark::Place(Place::From), "from"),
    (Mark::Place(Place::With), "with, between, among, amongst"),
    (Mark::Place(Place::Of), "of"),
    (Mark::Place(Place::For), "for"),
    (
        Mark::Place(Place::Elsewhere),
        "in, at, on, near, under, behind, beside, like, than, as, same as, next to, inside, into, onto, \
         about, after, before, over, close to, without, similar to, thanks to, according to, \
         in front of, on top of, around, against, until, via",
    ),
    (
        Mark::Verb(Verb::Own),
        "own, owns, owning, owned, belong, belongs, belonging, owner, owners, property, the owner, \
         the owners, the property",
    ),
    (
        Mark::Verb(Verb::Use),
        "use, uses, using, used, drink, drinks, drinking, wear, wears, wearing, play, plays, playing, \
         read, reads, reading, sleep, sleeps, eat, eats",
    ),
    (Mark::Verb(Verb::Share), "share, shares, sharing, shared, jointly own, jointly owned"),
    (
        Mark::Verb(Verb::Lend),
        "let, lets, letting, lend, lends, lent, lending, loans, loaned, allows, allowed, permits",
    ),
    (Mark::Verb(Verb::Borrow), "borrow, borrows, borrowed, borrowing, on loan, loan, a loan"),
    (
        Mark::Verb(Verb::Other),
        "has, have, had, got, get, gets, looks, look, looked, went, goes, broke, bought, buys, gave, \
         gives, given, knows, know, says, said, wants, want, likes, loves, needs, need, comes, came, \
         stands, lives, works, sits, lies, took, takes, taken, put, puts, found, saw, seen, made, \
         thinks, thought, told, asked, keeps, kept, brought, brings, stole, lost, sold, touch, claimed, \
         hates, prefers, received, think, means",
    ),
    (Mark::Verb(Verb::Leave), "left, forgot, left behind"),
    (
        Mark::OnlyOne,
        "the only one who, the only one that, the only person who, the only person that, the only owner, \
         the only one",
    ),
    (
        Mark::Filler,
        "the, a, an, well, oh, ah, hmm, hm, um, uh, er, ok, okay, of course, for sure, certainly, \
         definitely, clearly, obviously, surely, really, probably, likely, most likely, very likely, \
         i think, i do think, i believe, i would say, i am sure, i am pretty sure, i am fairly sure, \
         i am quite sure, i am certain, pretty sure, fairly sure, quite sure, i know, you know, \
         as far as i know, afaik, in my opinion, to my knowledge, in my view, as i said, always, still, \
         already, simply, alone, together, jointly, equally, entirely, completely, all together, there, \
         here, after all, at all, in general, anyway, in particular, for certain, without a doubt, \
         without doubt, no doubt, there is no doubt, by the way, i am afraid, else, quite, to be honest, \
         honestly, naturally, then, personally, in this house, in the house, in this family, \
         in the family, in the household, at home, in this household, in the home, in this home, \
         in the flat, in our house, in our family, that i know, each of, for all i know, exactly the, \
         alike, the one who, the person who, the one that, everything, each, please, pretty, all right, \
         that is all, let's, let me see, let me think",
    ),
    (Mark::Address, "thanks, thank you, hello, hi, hey, dear, good morning, good evening, sorry, excuse me"),
];

static MARKS: LazyLock<HashMap<&str, Mark>> = LazyLock::new(|| index(PHRASES));

/// What a phrase does.
pub(super) fn mark(phrase: &str) -> Option<Mark> {
    MARKS.get(phrase).copied()
}

/// "Bob's turn" does not say that the thing is Bob's.
pub(super) const NOT_POSSESSIONS: &str = "idea, fault, turn, job, birthday, choice, opinion, guess, problem, business, favourite, favorite, \
     present, gift, call, decision, responsibility, room, side";

/// What follows a person whose "'s" stands for "is" or "has": "Bob's in the kitchen".
pub(super) const BEHIND_CONTRACTED_IS: &str = "the, a, an, using, borrowing, sharing, wearing, got, been, always, never, in, at, on, out, away, \
     going, gone, asleep, here, there, very, currently, not, fine, good, right, wrong, sure, tired, \
     sick, busy, happy, angry, late, home, back, done, ok, okay, responsible, allowed, welcome";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_phrase_has_two_meanings() {
        let listed: usize = PHRASES.iter().map(|(_, list)| list.split(", ").count()).sum();
        assert_eq!(listed, MARKS.len());
    }
}
