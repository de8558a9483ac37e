//! A caption as a short row of tokens: people, and words that the lexicon knows or does not.

use super::lexicon::{Lexicon, Tag};
use super::verbs::{Form, Sense};
use crate::language::people::{Called, Kin, People, Relative};
use crate::language::words::{Gap, Key, Word, Words};
use crate::roster::UserIndex;

/// Captions of up to so many words are read without taking memory from the heap.
const USUAL_WORDS: usize = 32;

/// What counts of a word, or of the words that name one person.
#[derive(Debug, Clone, Copy)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) gap: Gap,
    pub(super) key: Key,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A member, or somebody whom no rule identifies ("a boy", "his mother").
    Person { who: Option<UserIndex>, possessive: bool },
    /// Any other word; possessive only where it names somebody unknown.
    Other { tag: Tag, possessive: bool },
}

impl Token {
    pub(super) fn tag(&self) -> Option<Tag> {
        match self.kind {
            Kind::Other { tag, .. } => Some(tag),
            Kind::Person { .. } => None,
        }
    }

    pub(super) fn is(&self, tag: Tag) -> bool {
        self.tag() == Some(tag)
    }

    pub(super) fn plain_person(&self) -> Option<Option<UserIndex>> {
        match self.kind {
            Kind::Person { who, possessive: false } => Some(who),
            _ => None,
        }
    }

    pub(super) fn verb(&self) -> Option<(Sense, Form)> {
        match self.tag() {
            Some(Tag::Verb(sense, form)) => Some((sense, form)),
            _ => None,
        }
    }
}

/// Values in a fixed place while they are few, on the heap beyond that.
pub(super) struct Few<T> {
    near: [T; USUAL_WORDS],
    length: usize,
    far: Vec<T>,
}

impl<T: Copy> Few<T> {
    fn new(filler: T) -> Self {
        Self { near: [filler; USUAL_WORDS], length: 0, far: Vec::new() }
    }

    fn push(&mut self, value: T) {
        if self.far.is_empty() && self.length < USUAL_WORDS {
            self.near[self.length] = value;
            self.length += 1;
        } else {
            if self.far.is_empty() {
                self.far.extend_from_slice(&self.near);
            }
            self.far.push(value);
        }
    }

    pub(super) fn values(&self) -> &[T] {
        if self.far.is_empty() { &self.near[..self.length] } else { &self.far }
    }

    fn last_mut(&mut self) -> Option<&mut T> {
        if self.far.is_empty() { self.near[..self.length].last_mut() } else { self.far.last_mut() }
    }
}

/// Makes the tokens of a caption's text. Adverbs are left out: they do not change who does what.
pub(super) fn tokens(people: &People, lexicon: &Lexicon, text: &str) -> Few<Token> {
    let mut words = Few::new(Word::FILLER);
    for word in Words::new(text) {
        words.push(word);
    }
    let words = words.values();
    let filler =
        Token { kind: Kind::Person { who: None, possessive: false }, gap: Gap::Space, key: Key::default() };
    let mut tokens = Few::new(filler);
    let mut at = 0;
    while at < words.len() {
        let word = &words[at];
        let Some(mention) = people.mention(text, words, at) else {
            // "Mary's husband": a relative whom no role names.
            if let Some(before) = tokens.last_mut()
                && is_possessive(before)
                && Kin::of_word(word.key).is_some()
            {
                let who = relative(people, before, word.key);
                before.kind = Kind::Person { who, possessive: word.possessive };
                at += 1;
                continue;
            }
            let tag = lexicon.tag(text, word);
            if tag != Tag::Adverb {
                let kind = Kind::Other { tag, possessive: word.possessive };
                tokens.push(Token { kind, gap: word.gap, key: word.key });
            }
            at += 1;
            continue;
        };
        at += mention.length;
        // "a boy", "his little sister": nobody in particular.
        let vague = mention.called == Called::Role
            && tokens
                .values()
                .iter()
                .rev()
                .find(|token| !token.is(Tag::Opener))
                .is_some_and(|token| token.is(Tag::Determiner));
        let who = mention.who.filter(|_| !vague);
        let kind = Kind::Person { who, possessive: mention.possessive };
        let person = Token { kind, gap: word.gap, key: word.key };
        match tokens.last_mut() {
            Some(before) if mention.called == Called::Role && is_possessive(before) => {
                let who = relative(people, before, word.key);
                before.kind = Kind::Person { who, possessive: mention.possessive };
            }
            // "the flatmate Bob": the name tells which one.
            Some(before)
                if mention.called == Called::Name
                    && matches!(person.gap, Gap::Space | Gap::Comma)
                    && before.plain_person().is_some_and(|who| who.is_none() || who == mention.who) =>
            {
                before.kind = kind;
            }
            _ => tokens.push(person),
        }
    }
    tokens
}

/// Whether something of this person's follows.
pub(super) fn is_possessive(token: &Token) -> bool {
    matches!(token.kind, Kind::Person { possessive: true, .. } | Kind::Other { possessive: true, .. })
}

/// Whom "`possessor`'s `role`" means.
fn relative(people: &People, possessor: &Token, role: Key) -> Option<UserIndex> {
    let Kind::Person { who: Some(of), .. } = possessor.kind else { return None };
    match people.relative(of, Kin::of_word(role)?) {
        Relative::Member(user) => Some(user),
        Relative::Outside | Relative::Unclear => None,
    }
}

/// Whether the token is one of these words.
pub(super) fn is_one_of(token: &Token, list: &[Key]) -> bool {
    list.contains(&token.key)
}

/// The keys of words, made when the program is compiled.
pub(super) const fn keys<const N: usize>(words: [&str; N]) -> [Key; N] {
    let mut keys = [Key::of_folded(""); N];
    let mut index = 0;
    while index < N {
        keys[index] = Key::of_folded(words[index]);
        index += 1;
    }
    keys
}
