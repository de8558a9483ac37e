//! The members of a household as a text calls them: by name, by role, by kinship.

use std::collections::BTreeMap;

use super::words::{Gap, Key, Word, Words, fold};
use crate::owners::OwnerSet;
use crate::roster::{Roster, UserIndex};

/// What a member is to the others, as far as the role says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kin {
    Mother,
    Father,
    Parent,
    Son,
    Daughter,
    Child,
    Brother,
    Sister,
    Husband,
    Wife,
    Partner,
    Grandmother,
    Grandfather,
    Flatmate,
}

/// The everyday words for each [`Kin`].
const KIN_WORDS: &[(Kin, &[&str])] = &[
    (Kin::Mother, &["mother", "mom", "mum", "mommy", "mummy", "mama", "mamma", "momma"]),
    (Kin::Father, &["father", "dad", "daddy", "papa"]),
    (Kin::Parent, &["parent"]),
    (Kin::Son, &["son", "boy"]),
    (Kin::Daughter, &["daughter", "girl"]),
    (Kin::Child, &["child", "kid"]),
    (Kin::Brother, &["brother"]),
    (Kin::Sister, &["sister"]),
    (Kin::Husband, &["husband", "hubby"]),
    (Kin::Wife, &["wife"]),
    (Kin::Partner, &["partner", "spouse"]),
    (Kin::Grandmother, &["grandmother", "grandma", "granny", "gran", "nana"]),
    (Kin::Grandfather, &["grandfather", "grandpa", "granddad", "grandad"]),
    (Kin::Flatmate, &["flatmate", "roommate", "housemate"]),
];

/// Names that are also everyday words. They count only with a capital letter or as a possessive.
const EVERYDAY_NAMES: &[&str] = &[
    "an", "art", "bill", "can", "chase", "do", "drew", "faith", "grace", "grant", "guy", "hope", "in", "joy",
    "mark", "may", "me", "mine", "my", "no", "rob", "rose", "so", "son", "sue", "van", "will", "you",
];

impl Kin {
    /// The kin that a word means.
    pub(crate) fn of_word(key: Key) -> Option<Self> {
        KIN_WORDS
            .iter()
            .find(|(_, words)| words.iter().any(|word| Key::of_folded(word) == key))
            .map(|&(kin, _)| kin)
    }

    fn words(self) -> &'static [&'static str] {
        KIN_WORDS.iter().find(|&&(kin, _)| kin == self).map_or(&[], |&(_, words)| words)
    }

    /// Whether a member of this kind is what the other word asks for: a son is a child.
    fn satisfies(self, asked: Self) -> bool {
        match asked {
            Self::Parent => matches!(self, Self::Mother | Self::Father | Self::Parent),
            Self::Child => matches!(self, Self::Son | Self::Daughter | Self::Child),
            _ => self == asked,
        }
    }

    fn is_child(self) -> bool {
        self.satisfies(Self::Child)
    }

    fn is_parent(self) -> bool {
        self.satisfies(Self::Parent)
    }

    /// Whether such a person lives in the household if there is one.
    fn is_chosen(self) -> bool {
        matches!(self, Self::Flatmate | Self::Husband | Self::Wife | Self::Partner)
    }

    /// Whether a household of only such members is a family of parents and children.
    fn is_nuclear(self) -> bool {
        self.is_child() || self.is_parent() || matches!(self, Self::Husband | Self::Wife)
    }
}

/// How a text calls a member.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Called {
    /// By name.
    Name,
    /// By role.
    Role,
}

/// A member found in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Mention {
    /// Who; `None` for a role that several members have.
    pub(crate) who: Option<UserIndex>,
    /// By name or by role.
    pub(crate) called: Called,
    /// How many words the mention takes.
    pub(crate) length: usize,
    /// Whether its last word is possessive.
    pub(crate) possessive: bool,
}

/// Whom a kinship word means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Relative {
    /// Exactly this member.
    Member(UserIndex),
    /// Nobody of the household.
    Outside,
    /// The household does not tell.
    Unclear,
}

#[derive(Debug, Clone)]
struct Phrase {
    /// Key, folded letters and the gap before each word.
    words: Vec<(Key, String, Gap)>,
    who: Option<UserIndex>,
    called: Called,
    guarded: bool,
}

/// There are 2^`SLOT_BITS` slots for first words.
const SLOT_BITS: u32 = 10;

/// Names and roles, prepared for being found.
#[derive(Debug, Clone)]
pub(crate) struct People {
    /// In the order of the first word's key, longer phrases first.
    phrases: Vec<Phrase>,
    /// The slots of the first words: most words of a text begin no phrase, and are told so at once.
    first_words: [bool; 1 << SLOT_BITS],
    /// What the role of each member says, in the order of the roster.
    kin: Vec<Vec<Kin>>,
}

impl People {
    pub(crate) fn new(roster: &Roster) -> Self {
        let mut found: BTreeMap<Vec<String>, Phrase> = BTreeMap::new();
        for user in roster.indices() {
            let spelled = roster.name(user).as_str();
            add(&mut found, spelled, user, Called::Name);
        }
        let mut kin: Vec<Vec<Kin>> = Vec::with_capacity(roster.len());
        for user in roster.indices() {
            let role = roster.background(user).role.as_deref().unwrap_or_default();
            add(&mut found, role, user, Called::Role);
            kin.push(kin_of_role(role));
        }
        for &(asked, words) in KIN_WORDS {
            for user in roster.indices() {
                if kin[user.place()].iter().any(|&held| held.satisfies(asked)) {
                    for word in words {
                        add(&mut found, word, user, Called::Role);
                    }
                }
            }
        }
        let mut phrases: Vec<Phrase> = found.into_values().collect();
        phrases.sort_by_key(|phrase| (phrase.words[0].0, std::cmp::Reverse(phrase.words.len())));
        let mut first_words = [false; 1 << SLOT_BITS];
        for phrase in &phrases {
            first_words[phrase.words[0].0.slot(SLOT_BITS)] = true;
        }
        Self { phrases, first_words, kin }
    }

    /// The longest name or role that begins at the word `at`.
    pub(crate) fn mention(&self, text: &str, words: &[Word], at: usize) -> Option<Mention> {
        let first = words[at];
        if !self.first_words[first.key.slot(SLOT_BITS)] {
            return None;
        }
        let start = self.phrases.partition_point(|phrase| phrase.words[0].0 < first.key);
        self.phrases[start..]
            .iter()
            .take_while(|phrase| phrase.words[0].0 == first.key)
            .find(|phrase| phrase.stands_at(text, words, at))
            .map(|phrase| {
                let length = phrase.words.len();
                Mention {
                    who: phrase.who,
                    called: phrase.called,
                    length,
                    possessive: words[at + length - 1].possessive,
                }
            })
    }

    /// All members of a kind: the boys, the children, the parents.
    pub(crate) fn all(&self, kin: Kin) -> OwnerSet {
        self.members().filter(|user| self.is(*user, kin)).collect()
    }

    /// Whom "`of`'s `kin`" means.
    pub(crate) fn relative(&self, of: UserIndex, kin: Kin) -> Relative {
        let candidates = self.relatives(of, kin);
        match (candidates.iter().next(), candidates.len()) {
            (Some(user), 1) => Relative::Member(user),
            // A family has no second husband somewhere else; it has grandparents, aunts, grown-up children.
            (None, _) if !kin.is_chosen() && self.is_nuclear() => Relative::Outside,
            _ => Relative::Unclear,
        }
    }

    /// All members who can be meant by "`of`'s `kin`".
    pub(crate) fn relatives(&self, of: UserIndex, kin: Kin) -> OwnerSet {
        let others: OwnerSet = self.members().filter(|&user| user != of).collect();
        let child = self.kin[of.place()].iter().any(|held| held.is_child());
        let parent = self.kin[of.place()].iter().any(|held| held.is_parent());
        let candidates = match kin {
            Kin::Mother | Kin::Father | Kin::Parent if child => self.all(kin),
            Kin::Son | Kin::Daughter | Kin::Child if parent => self.all(kin),
            Kin::Brother if child => self.all(Kin::Son).union(self.all(Kin::Brother)),
            Kin::Sister if child => self.all(Kin::Daughter).union(self.all(Kin::Sister)),
            Kin::Wife if self.is(of, Kin::Father) || self.is(of, Kin::Husband) => {
                self.all(Kin::Mother).union(self.all(Kin::Wife))
            }
            Kin::Husband if self.is(of, Kin::Mother) || self.is(of, Kin::Wife) => {
                self.all(Kin::Father).union(self.all(Kin::Husband))
            }
            Kin::Partner => self.spouses(of),
            Kin::Flatmate if self.is(of, Kin::Flatmate) => self.all(Kin::Flatmate),
            _ => OwnerSet::EMPTY,
        };
        candidates.intersection(others)
    }

    /// Whom a kinship word means that no member's role answers to, such as "grandma".
    pub(crate) fn stranger(&self) -> Relative {
        if self.kin.iter().all(|held| !held.is_empty()) { Relative::Outside } else { Relative::Unclear }
    }

    fn spouses(&self, of: UserIndex) -> OwnerSet {
        let wives = self.all(Kin::Mother).union(self.all(Kin::Wife));
        let husbands = self.all(Kin::Father).union(self.all(Kin::Husband));
        match (wives.contains(of), husbands.contains(of)) {
            (true, false) => husbands,
            (false, true) => wives,
            _ => self.all(Kin::Partner),
        }
    }

    fn is(&self, user: UserIndex, kin: Kin) -> bool {
        self.kin[user.place()].iter().any(|held| held.satisfies(kin))
    }

    fn is_nuclear(&self) -> bool {
        self.kin.iter().all(|held| held.iter().any(|kin| kin.is_nuclear()))
    }

    fn members(&self) -> impl Iterator<Item = UserIndex> + use<> {
        (0..self.kin.len()).filter_map(UserIndex::new)
    }
}

impl Phrase {
    fn stands_at(&self, text: &str, words: &[Word], at: usize) -> bool {
        let Some(there) = words.get(at..at + self.words.len()) else { return false };
        let same = self.words.iter().zip(there).enumerate().all(|(index, ((key, folded, gap), word))| {
            *key == word.key
                && (folded.len() <= Key::EXACT_BYTES || *folded == fold(word.text(text)))
                && (index == 0 || word.gap == Gap::Space || word.gap == *gap)
                && (index + 1 == self.words.len() || !word.possessive)
        });
        same && !(self.guarded && !there[0].capital && !there[0].possessive)
    }
}

/// Adds a phrase. A name keeps its words against any role; words that several members answer to mean nobody.
fn add(found: &mut BTreeMap<Vec<String>, Phrase>, spelled: &str, user: UserIndex, called: Called) {
    let words: Vec<(Key, String, Gap)> = Words::new(spelled)
        .map(|word| {
            let folded = fold(word.text(spelled));
            (Key::of_folded(&folded), folded, word.gap)
        })
        .collect();
    if words.is_empty() {
        return;
    }
    let guarded = called == Called::Name && words.len() == 1 && EVERYDAY_NAMES.contains(&words[0].1.as_str());
    let letters = words.iter().map(|(_, folded, _)| folded.clone()).collect();
    found
        .entry(letters)
        .and_modify(|known| {
            if known.called == called && known.who != Some(user) {
                known.who = None;
            }
        })
        .or_insert(Phrase { words, who: Some(user), called, guarded });
}

/// "elder daughter" says daughter; "father's friend" says nothing of the member.
fn kin_of_role(role: &str) -> Vec<Kin> {
    let words: Vec<Word> = Words::new(role).collect();
    if words.iter().any(|word| word.possessive) {
        return Vec::new();
    }
    let mut kin: Vec<Kin> = words.iter().filter_map(|word| Kin::of_word(word.key)).collect();
    kin.dedup();
    kin
}

/// The kin that the plural of its words means: parents, kids, the boys.
pub(crate) fn kin_of_plural(key: Key) -> Option<Kin> {
    KIN_WORDS.iter().map(|&(kin, _)| kin).find(|kin| {
        kin.words().iter().any(|word| Key::of_folded(&format!("{word}s")) == key)
            || *kin == Kin::Child && Key::of_folded("children") == key
    })
}
