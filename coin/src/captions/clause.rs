//! The grammar of a caption: its subject, its voice, its verb.
//!
//! A caption is short and says one thing, so no parser is needed: its words become tokens (a mention of a
//! member, or a word and what it does), and a few rules tell the actor. Wherever the rules do not reach there
//! is no actor.

use super::Action;
use super::action::action_at;
use super::lexicon::{Lexicon, Tag};
use super::tokens::{Kind, Token, is_one_of, is_possessive, keys, tokens};
use super::verbs::{Form, Sense};
use crate::language::people::People;
use crate::language::words::{Gap, Key};
use crate::roster::UserIndex;

const THE: Key = Key::of_folded("the");
const OF: Key = Key::of_folded("of");

/// "a photo of Bob taking the mug"
const PICTURES: [Key; 7] = keys(["photo", "picture", "image", "view", "shot", "frame", "video"]);

/// Who acts in the caption's text, and what is done.
pub(super) fn read(people: &People, lexicon: &Lexicon, text: &str) -> (Option<UserIndex>, Action) {
    let tokens = tokens(people, lexicon, text);
    let tokens = main_clause(tokens.values());
    if let Some(reading) = dangling(tokens) {
        return reading;
    }
    let subject = subject(tokens);
    if let Some(reading) = passive(tokens, subject) {
        return reading;
    }
    match subject {
        Some(at) => active(tokens, at),
        None => bare_passive(tokens).unwrap_or_else(|| (None, action_from(tokens, 0))),
    }
}

/// Leaves out a clause in front: "While Bob cooks, Mary …" tells of Mary.
fn main_clause(tokens: &[Token]) -> &[Token] {
    if tokens.first().is_some_and(|first| first.is(Tag::Subordinator))
        && let Some(comma) = tokens.iter().position(|token| token.gap == Gap::Comma)
    {
        return &tokens[comma..];
    }
    tokens
}

/// "Picking up the cup, Bob smiles": Bob picks it up.
fn dangling(tokens: &[Token]) -> Option<(Option<UserIndex>, Action)> {
    let (_, form) = tokens.first()?.verb()?;
    let comma = tokens.iter().position(|token| token.gap == Gap::Comma).filter(|_| form == Form::Gerund)?;
    let who = tokens[comma].plain_person()?;
    Some((who, action_at(&tokens[..comma], 0)?))
}

/// The place of the person who is the grammatical subject.
fn subject(tokens: &[Token]) -> Option<usize> {
    let start = tokens.iter().position(|token| !token.is(Tag::Opener) && !token.is(Tag::And))?;
    if is_agent(tokens, start) {
        return Some(start);
    }
    // Later in the sentence a person is the subject only in front of a verb, behind no preposition, and when
    // nothing has been done yet: "In the kitchen Bob takes …", "A photo shows Bob taking …".
    let mut place = start;
    while place < tokens.len() {
        if is_agent(tokens, place) && is_free(tokens, place) && verb_follows(tokens, place) {
            return Some(place);
        }
        let acted = tokens[place].verb().is_some() && !is_noun_place(tokens, place);
        if acted {
            return None;
        }
        place += 1;
    }
    None
}

/// A person who is not possessive, or is so in a contraction: "Bob's taking the mug", not "Bob's mug".
fn is_agent(tokens: &[Token], at: usize) -> bool {
    match tokens[at].kind {
        Kind::Person { possessive: false, .. } => true,
        Kind::Person { possessive: true, .. } => {
            let verb = tokens.get(at + 1).and_then(Token::verb);
            let contracted = verb.is_some_and(|(_, form)| matches!(form, Form::Gerund | Form::Participle));
            contracted
                && tokens.get(at + 2).is_some_and(|after| match after.kind {
                    Kind::Person { .. } => true,
                    Kind::Other { tag, possessive } => {
                        possessive
                            || matches!(tag, Tag::Determiner | Tag::Preposition | Tag::Particle)
                            || after.key == THE
                    }
                })
        }
        Kind::Other { .. } => false,
    }
}

fn is_free(tokens: &[Token], at: usize) -> bool {
    let Some(place) = tokens[..at].iter().rposition(|token| !token.is(Tag::Opener)) else { return true };
    let depicted = tokens[place].key == OF
        && place.checked_sub(1).is_some_and(|noun| is_one_of(&tokens[noun], &PICTURES));
    depicted || {
        let token = &tokens[place];
        tokens[at].gap >= Gap::Comma
            || !matches!(
                token.tag(),
                Some(Tag::Preposition | Tag::To | Tag::By | Tag::Or | Tag::Not | Tag::Determiner)
            )
    }
}

fn verb_follows(tokens: &[Token], at: usize) -> bool {
    tokens.get(at + 1).is_some_and(|next| {
        matches!(next.tag(), Some(Tag::Verb(..) | Tag::Be | Tag::Have | Tag::Helper | Tag::Relative))
    })
}

/// Behind an article or a possessor stands a noun, even if the word can be a verb: "the drinking glass"; and so
/// does behind a preposition, unless a gerund does: "in use", but "after using".
fn is_noun_place(tokens: &[Token], at: usize) -> bool {
    let gerund = matches!(tokens[at].verb(), Some((_, Form::Gerund)));
    at.checked_sub(1).and_then(|before| tokens.get(before)).is_some_and(|before| {
        is_possessive(before) && !is_agent(tokens, at - 1)
            || before.is(Tag::Determiner)
            || before.is(Tag::Preposition) && !gerund
            || before.key == THE
    })
}

/// "is picked up by Tom": the agent behind *by*, whoever else is named.
fn passive(tokens: &[Token], subject: Option<usize>) -> Option<(Option<UserIndex>, Action)> {
    for (at, token) in tokens.iter().enumerate() {
        let auxiliary = token.is(Tag::Be) || matches!(token.verb(), Some((Sense::Get, _)));
        let relative = at.checked_sub(1).is_some_and(|before| tokens[before].is(Tag::Relative));
        if !auxiliary || relative {
            continue;
        }
        let skipped = |token: &Token| matches!(token.tag(), Some(Tag::Be | Tag::Not));
        let Some(participle) = (at + 1..tokens.len()).find(|&place| !skipped(&tokens[place])) else {
            continue;
        };
        let known = tokens[participle].verb().is_some_and(|(_, form)| form.can_be_participle());
        let unknown = tokens[participle].is(Tag::UnknownParticiple);
        let person = subject.is_some_and(|subject| subject < at);
        // "Bob is tired" and "Bob gets used things" are not in the passive voice; "Bob is given the mug" is.
        if !(known && (!person || token.is(Tag::Be)) || unknown && !person) {
            continue;
        }
        let action =
            if known { action_at(tokens, participle).unwrap_or(Action::Other) } else { Action::Other };
        return Some((agent(tokens, participle + 1), action));
    }
    None
}

/// "Marker taken by Tom", where nobody is the subject.
fn bare_passive(tokens: &[Token]) -> Option<(Option<UserIndex>, Action)> {
    if tokens.iter().any(|token| token.is(Tag::Somebody)) {
        return None;
    }
    let participle =
        tokens.iter().position(|token| token.verb().is_some_and(|(_, form)| form.can_be_participle()))?;
    let who = agent(tokens, participle + 1)?;
    Some((Some(who), action_at(tokens, participle).unwrap_or(Action::Other)))
}

/// The first person behind *by*, from the token `start` on.
fn agent(tokens: &[Token], start: usize) -> Option<UserIndex> {
    let rest = tokens.get(start..)?;
    rest.iter().enumerate().filter(|(_, token)| token.is(Tag::By)).find_map(|(by, _)| {
        let place = (by + 1..rest.len()).find(|&place| !rest[place].is(Tag::Opener))?;
        let who = rest[place].plain_person()?;
        if is_alternative(rest.get(place + 1)) { None } else { who }
    })
}

/// "Bob or Mary", "Bob/Mary": not known which.
fn is_alternative(next: Option<&Token>) -> bool {
    next.is_some_and(|next| next.is(Tag::Or) || next.gap == Gap::Slash && next.plain_person().is_some())
}

fn active(tokens: &[Token], subject: usize) -> (Option<UserIndex>, Action) {
    let who = match tokens[subject].kind {
        Kind::Person { who, .. } => who,
        Kind::Other { .. } => None,
    };
    if is_alternative(tokens.get(subject + 1)) {
        return (None, action_from(tokens, subject + 1));
    }
    // "Bob, sitting next to Mary, takes …": what stands between the commas comes second.
    let aside = |token: &Token| matches!(token.verb(), Some((_, Form::Gerund))) && token.gap == Gap::Comma;
    let start = match tokens.get(subject + 1) {
        Some(next) if aside(next) => {
            (subject + 2..tokens.len()).find(|&place| tokens[place].gap == Gap::Comma).unwrap_or(subject + 1)
        }
        _ => subject + 1,
    };
    let Some((verb, action)) = find_action(tokens, start) else { return (who, Action::Other) };
    (nearer_subject(tokens, subject, verb).unwrap_or(who), action)
}

/// "Bob sees Mary taking the mug": somebody else stands right in front of the verb, and not as one of a list.
fn nearer_subject(tokens: &[Token], subject: usize, verb: usize) -> Option<Option<UserIndex>> {
    let helping = |token: &Token| matches!(token.tag(), Some(Tag::Be | Tag::Have | Tag::Helper | Tag::Not));
    let place = (subject + 1..verb).rev().find(|&place| !helping(&tokens[place]))?;
    let who = tokens[place].plain_person()?;
    let article = |token: &Token| matches!(token.tag(), Some(Tag::Opener | Tag::Determiner));
    let before = (subject..place).rev().find(|&before| !article(&tokens[before]))?;
    let listed = match tokens[before].tag() {
        None => tokens[place].gap < Gap::Stop,
        Some(Tag::And) => before > subject && tokens[before - 1].plain_person().is_some(),
        Some(Tag::Preposition | Tag::By | Tag::To | Tag::Or) => true,
        Some(_) => false,
    };
    (!listed).then_some(who)
}

fn action_from(tokens: &[Token], start: usize) -> Action {
    find_action(tokens, start).map_or(Action::Other, |(_, action)| action)
}

/// The first action at or after `start`, and where its verb stands. What is denied is no action.
fn find_action(tokens: &[Token], start: usize) -> Option<(usize, Action)> {
    let mut denied = false;
    for place in start..tokens.len() {
        denied |= tokens[place].is(Tag::Not);
        if is_noun_place(tokens, place) {
            continue;
        }
        if let Some(action) = action_at(tokens, place) {
            return Some((place, if denied { Action::Other } else { action }));
        }
    }
    None
}
