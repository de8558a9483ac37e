//! Words one question to a person (the paper's QUESTION-GENERATION, Section 4.4).
//!
//! The sentence names the thing and the one or two likeliest owners; the others are "someone else". It is made
//! of the context alone, so that the same context gives the same words, and it says nothing that only the
//! robot understands: no id, and no coordinate unless neither class nor room is known.

use coin_schemas::household::{Score, UserName};

use super::thing::Thing;
use crate::roster::{Roster, UserIndex};

/// From this score on somebody is a probable owner.
const PROBABLE: f64 = 0.5;

/// From this score on somebody who is not a probable owner is worth being named beside one.
const POSSIBLE: f64 = 0.2;

/// What a question is made from.
#[derive(Debug, Clone, Copy)]
pub struct QuestionContext<'a> {
    /// The household.
    pub roster: &'a Roster,
    /// The class of the thing.
    pub class: &'a str,
    /// The room that it is in.
    pub room: Option<&'a str>,
    /// Where it is, in metres. Told to the person only if there is nothing else to say.
    pub position: [f64; 3],
    /// The present scores in the order of the roster; missing ones count as 0.
    pub scores: &'a [Score],
    /// How often the thing has been asked about before.
    pub times_asked: u32,
}

/// What is worth asking.
enum Ask<'a> {
    /// Is it this one's, or not?
    One(&'a str),
    /// Which of two?
    Two(&'a str, &'a str),
    /// Do two share it?
    Pair(&'a str, &'a str),
    /// Do all share it, or is it one of the likeliest two?
    All(&'a str, &'a str),
}

/// Words one question: one sentence that ends with a question mark. A thing that has been asked about before is
/// asked about in other words, with an apology.
pub fn word_question(context: &QuestionContext<'_>) -> String {
    let thing = Thing::new(context.class, context.room, context.position);
    let ask = what_to_ask(context);
    match context.times_asked {
        0 => first_words(context, &thing, &ask),
        1 => format!("Sorry to ask again: {}", other_words(context, &thing, &ask)),
        _ => format!("Sorry, I still do not know this: {}", other_words(context, &thing, &ask)),
    }
}

fn what_to_ask<'a>(context: &QuestionContext<'a>) -> Ask<'a> {
    let score = |user: UserIndex| context.scores.get(user.place()).map_or(0.0, |score| score.value());
    let mut order: Vec<UserIndex> = context.roster.indices().collect();
    // The sort is stable: equal scores stay in the order of the roster.
    order.sort_by(|&left, &right| score(right).total_cmp(&score(left)));
    let probable = order.iter().filter(|&&user| score(user) >= PROBABLE).count();
    let name = |place: usize| order.get(place).map(|&user| context.roster.name(user).as_str());
    let (Some(first), Some(second)) = (name(0), name(1)) else {
        return Ask::One(name(0).unwrap_or_default());
    };
    match probable {
        1 if score(order[1]) < POSSIBLE => Ask::One(first),
        0 | 1 => Ask::Two(first, second),
        all if all == order.len() && all > 2 => Ask::All(first, second),
        _ => Ask::Pair(first, second),
    }
}

fn first_words(context: &QuestionContext<'_>, thing: &Thing, ask: &Ask<'_>) -> String {
    let Thing { name, is, does, it, .. } = thing;
    let members = context.roster.len();
    match ask {
        Ask::One(owner) if members == 2 => {
            format!("{is} {name} just {owner}'s, or {} {it} {}'s too?", lower(is), other_name(context, owner))
        }
        Ask::One(owner) => {
            format!("{is} {name} {owner}'s, or {} {it} belong to someone else?", lower(does))
        }
        Ask::Two(first, second) if members == 2 => {
            format!("{is} {name} {first}'s or {second}'s, or do they share {}?", thing.object)
        }
        Ask::Two(first, second) => {
            format!("{does} {name} belong to {first} or {second}, or to someone else?")
        }
        Ask::Pair(first, second) => {
            format!(
                "Do {first} and {second} share {name}, or {} {it} belong to just one of them?",
                lower(does)
            )
        }
        Ask::All(first, second) => {
            format!("Do you all share {name}, or {} {it} just {first}'s or {second}'s?", lower(is))
        }
    }
}

fn other_words(context: &QuestionContext<'_>, thing: &Thing, ask: &Ask<'_>) -> String {
    let Thing { name, does, .. } = thing;
    let whom = format!("who {} {name} belong to", lower(does));
    match ask {
        Ask::One(owner) if context.roster.len() == 1 => format!("{whom}, {owner} or someone from outside?"),
        Ask::One(owner) if context.roster.len() == 2 => {
            format!("{whom}, {owner}, {} or both?", other_name(context, owner))
        }
        Ask::One(owner) => format!("{whom}, {owner} or someone else?"),
        Ask::Two(first, second) | Ask::Pair(first, second) if context.roster.len() == 2 => {
            format!("{whom}, {first}, {second} or both?")
        }
        Ask::Two(first, second) => format!("{whom}, {first}, {second} or someone else?"),
        Ask::Pair(first, second) => format!("{whom}, {first}, {second}, both or someone else?"),
        Ask::All(first, second) => format!("{whom}, {first}, {second} or all of you?"),
    }
}

/// The other one of two.
fn other_name<'a>(context: &QuestionContext<'a>, owner: &str) -> &'a str {
    context.roster.names().map(UserName::as_str).find(|name| *name != owner).unwrap_or_default()
}

fn lower(word: &str) -> String {
    word.to_lowercase()
}

#[cfg(test)]
mod tests;
