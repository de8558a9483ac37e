//! Every word that the grammar of captions knows, looked up by its key.

use super::verbs::{Form, IRREGULAR, REGULAR, Sense, inflect};
use crate::language::words::{Key, Word};

/// What a word does in a caption.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tag {
    /// An action verb.
    Verb(Sense, Form),
    /// is, was, being, …
    Be,
    /// has, have, had
    Have,
    /// A helping verb that says nothing of the action: can, does, starts, tries, goes, …
    Helper,
    /// What an onlooker does: "is seen taking".
    Seen,
    /// Does not change who does what: then, quickly, …
    Adverb,
    /// May stand before the subject: the, our, little, …
    Opener,
    /// a, her, this, …: a noun follows.
    Determiner,
    /// in, with, to, …: what follows is not the subject.
    Preposition,
    /// by
    By,
    /// to
    To,
    /// and, plus
    And,
    /// or
    Or,
    /// not, n't
    Not,
    /// someone, nobody, …
    Somebody,
    /// while, when, …: a clause follows that is not the main one.
    Subordinator,
    /// who, that, which
    Relative,
    /// on, off, up, down, back, away, out, around, …
    Particle,
    /// A word that the grammar does not know and that looks like a participle: knocked, broken.
    UnknownParticiple,
    /// Any other word.
    Unknown,
}

const FUNCTION_WORDS: &[(Tag, &[&str])] = &[
    (Tag::Be, &["is", "are", "was", "were", "be", "been", "being", "am"]),
    (Tag::Have, &["has", "have", "had", "having"]),
    (
        Tag::Helper,
        &[
            "do",
            "does",
            "did",
            "can",
            "could",
            "may",
            "might",
            "will",
            "would",
            "shall",
            "should",
            "must",
            "start",
            "starts",
            "started",
            "starting",
            "begin",
            "begins",
            "began",
            "beginning",
            "stop",
            "stops",
            "stopped",
            "stopping",
            "finish",
            "finishes",
            "finished",
            "finishing",
            "continue",
            "continues",
            "continued",
            "continuing",
            "keep",
            "keeps",
            "kept",
            "keeping",
            "want",
            "wants",
            "wanted",
            "go",
            "goes",
            "went",
            "gone",
            "going",
            "come",
            "comes",
            "came",
            "coming",
            "seem",
            "seems",
            "appear",
            "appears",
            "attempt",
            "attempts",
            "busy",
            "about",
            "lets",
            "let",
        ],
    ),
    (Tag::Seen, &["seen", "shown", "spotted", "observed", "noticed", "watched", "captured", "filmed"]),
    (
        Tag::Adverb,
        &[
            "then",
            "now",
            "again",
            "also",
            "just",
            "still",
            "once",
            "twice",
            "later",
            "already",
            "soon",
            "today",
            "yesterday",
            "often",
            "always",
            "sometimes",
            "afterwards",
            "meanwhile",
            "currently",
            "here",
            "there",
            "first",
            "finally",
            "next",
            "only",
            "even",
            "both",
            "together",
            "alone",
            "themselves",
            "himself",
            "herself",
            "all",
        ],
    ),
    (
        Tag::Opener,
        &[
            "the", "our", "little", "young", "old", "elderly", "big", "mr", "mrs", "ms", "miss", "dr",
            "user", "person", "resident", "but", "so",
        ],
    ),
    (
        Tag::Determiner,
        &[
            "a", "an", "another", "some", "his", "her", "their", "its", "my", "your", "every", "each", "no",
            "any", "other", "this", "these", "those", "neither", "either", "it", "them", "him", "me", "us",
        ],
    ),
    (
        Tag::Preposition,
        &[
            "in",
            "at",
            "with",
            "from",
            "of",
            "for",
            "near",
            "beside",
            "besides",
            "behind",
            "between",
            "under",
            "over",
            "above",
            "below",
            "opposite",
            "inside",
            "into",
            "onto",
            "toward",
            "towards",
            "through",
            "without",
            "against",
            "among",
            "around",
            "like",
            "than",
            "except",
            "nor",
            "as",
            "across",
            "past",
            "along",
            "upon",
            "within",
            "via",
            "per",
            "versus",
            "outside",
            "upstairs",
            "downstairs",
        ],
    ),
    (Tag::By, &["by"]),
    (Tag::To, &["to"]),
    (Tag::And, &["and", "plus"]),
    (Tag::Or, &["or"]),
    (
        Tag::Not,
        &[
            "not", "never", "doesn't", "don't", "didn't", "isn't", "wasn't", "won't", "can't", "cannot",
            "hasn't", "aren't", "couldn't",
        ],
    ),
    (
        Tag::Somebody,
        &[
            "someone",
            "somebody",
            "anyone",
            "anybody",
            "nobody",
            "everyone",
            "everybody",
            "one",
            "he",
            "she",
            "they",
            "i",
            "we",
            "you",
            "something",
        ],
    ),
    (Tag::Subordinator, &["while", "when", "after", "before", "until", "because", "although", "if", "since"]),
    (Tag::Relative, &["who", "that", "which", "whom", "whose"]),
    (Tag::Particle, &["on", "off", "up", "down", "back", "away", "out"]),
];

/// The lexicon has 2^`SLOT_BITS` slots, about as many as words.
const SLOT_BITS: u32 = 10;

/// The words and their tags, in the order of their slots.
#[derive(Debug, Clone)]
pub(crate) struct Lexicon {
    entries: Vec<(Key, Tag)>,
    /// Where the entries of each slot begin.
    starts: Vec<usize>,
}

impl Lexicon {
    pub(crate) fn new() -> Self {
        let mut entries = listed();
        // The sort is stable: of two readings of a word the one that is listed first is kept.
        entries.sort_by_key(|&(key, _)| (key.slot(SLOT_BITS), key));
        entries.dedup_by_key(|&mut (key, _)| key);
        let starts = (0..=1 << SLOT_BITS)
            .map(|slot| entries.partition_point(|(key, _)| key.slot(SLOT_BITS) < slot))
            .collect();
        Self { entries, starts }
    }

    pub(crate) fn tag(&self, text: &str, word: &Word) -> Tag {
        let slot = word.key.slot(SLOT_BITS);
        let entries = &self.entries[self.starts[slot]..self.starts[slot + 1]];
        entries
            .iter()
            .find(|&&(key, _)| key == word.key)
            .map_or_else(|| by_ending(word.text(text)), |&(_, tag)| tag)
    }
}

/// Function words first, then verbs.
fn listed() -> Vec<(Key, Tag)> {
    let mut entries: Vec<(Key, Tag)> = FUNCTION_WORDS
        .iter()
        .flat_map(|&(tag, words)| words.iter().map(move |word| (Key::of_folded(word), tag)))
        .collect();
    for &(sense, bases) in REGULAR {
        for base in bases {
            for (form, word) in inflect(base) {
                entries.push((Key::of_folded(&word), Tag::Verb(sense, form)));
            }
        }
    }
    for &(sense, [base, third, past, participle, gerund]) in IRREGULAR {
        let (base_form, past_form) = match (base == past, past == participle) {
            (true, _) => (Form::Unchanged, Form::Unchanged),
            (false, true) => (Form::Base, Form::PastOrParticiple),
            (false, false) => (Form::Base, Form::Past),
        };
        for (word, form) in [
            (base, base_form),
            (third, Form::Third),
            (past, past_form),
            (participle, if past == participle { past_form } else { Form::Participle }),
            (gerund, Form::Gerund),
        ] {
            entries.push((Key::of_folded(word), Tag::Verb(sense, form)));
        }
    }
    entries
}

fn by_ending(word: &str) -> Tag {
    if word.len() < 5 || !word.is_ascii() {
        return Tag::Unknown;
    }
    let ends = |ending: &str| word[word.len() - ending.len()..].eq_ignore_ascii_case(ending);
    if ends("ly") {
        Tag::Adverb
    } else if ends("ed") || ends("ken") {
        Tag::UnknownParticiple
    } else {
        Tag::Unknown
    }
}
