//! What a verb says was done, told by the verb and the words behind it (the paper's action categories).

use super::Action;
use super::lexicon::Tag;
use super::tokens::{Token, is_one_of, keys};
use super::verbs::Sense;
use crate::language::words::Key;

/// The action of the verb at `place`; `None` where it is no verb, or one that says nothing of the thing.
pub(super) fn action_at(tokens: &[Token], place: usize) -> Option<Action> {
    let (sense, _) = tokens[place].verb()?;
    let rest = &tokens[place + 1..];
    let next_is = |list: &[Key]| rest.first().is_some_and(|token| is_one_of(token, list));
    let later_is = |list: &[Key]| rest.iter().any(|token| is_one_of(token, list));
    let last_is = |list: &[Key]| rest.last().is_some_and(|token| is_one_of(token, list));
    match sense {
        Sense::Plain(action) => Some(action),
        Sense::Take if next_is(&const { keys(["off"]) }) || last_is(&const { keys(["off"]) }) => {
            Some(Action::Use)
        }
        Sense::Take
            if next_is(&const { keys(["a", "an"]) })
                && rest.get(1).is_some_and(|noun| is_one_of(noun, &HELPINGS)) =>
        {
            Some(Action::Use)
        }
        Sense::Take if goes_somewhere(rest) => Some(Action::Transport),
        Sense::Take => Some(Action::Take),
        Sense::Get
            if next_is(
                &const { keys(["up", "ready", "into", "out", "off", "in", "on", "down", "dressed"]) },
            ) =>
        {
            None
        }
        Sense::Get => Some(Action::Take),
        Sense::Put if next_is(&const { keys(["on"]) }) || last_is(&const { keys(["on"]) }) => {
            Some(Action::Use)
        }
        Sense::Put => Some(Action::Place),
        Sense::Turn
            if next_is(
                &const { keys(["around", "to", "toward", "towards", "away", "back", "left", "right"]) },
            ) =>
        {
            None
        }
        Sense::Turn => Some(Action::Use),
        Sense::Look if later_is(&const { keys(["for"]) }) => Some(Action::Search),
        Sense::Look => Some(Action::Other),
        Sense::Pull if next_is(&const { keys(["out"]) }) || last_is(&const { keys(["out"]) }) => {
            Some(Action::Take)
        }
        Sense::Pull => Some(Action::Transport),
        Sense::Leave if next_is(&const { keys(["with", "for"]) }) => Some(Action::Transport),
        Sense::Leave => Some(Action::Place),
        Sense::Return if next_is(&const { keys(["to", "from", "with"]) }) || rest.is_empty() => None,
        Sense::Return => Some(Action::Place),
        Sense::Set if next_is(&const { keys(["up"]) }) => Some(Action::Use),
        Sense::Set => Some(Action::Place),
        Sense::Tidy if later_is(&const { keys(["away"]) }) => Some(Action::Place),
        Sense::Tidy => Some(Action::Clean),
        Sense::Wash if later_is(&BODY) => Some(Action::Use),
        Sense::Wash => Some(Action::Clean),
        Sense::Check if later_is(&const { keys(["for"]) }) => Some(Action::Search),
        Sense::Check => Some(Action::Use),
        Sense::Reach if next_is(&const { keys(["for"]) }) || later_is(&const { keys(["for"]) }) => {
            Some(Action::Take)
        }
        Sense::Reach => None,
        Sense::Try if next_is(&const { keys(["on", "out"]) }) => Some(Action::Use),
        Sense::Try => None,
    }
}

/// "takes a sip from the mug"
const HELPINGS: [Key; 11] =
    keys(["sip", "drink", "bite", "look", "photo", "picture", "gulp", "nap", "pill", "dose", "shower"]);

/// "washes her hands with the soap"
const BODY: [Key; 9] = keys(["hand", "hands", "face", "hair", "teeth", "body", "feet", "himself", "herself"]);

/// "takes the mug upstairs"
const DIRECTIONS: [Key; 9] =
    keys(["into", "onto", "toward", "towards", "upstairs", "downstairs", "outside", "inside", "across"]);

/// "takes the mug to the kitchen", but not "takes the book to read".
fn goes_somewhere(rest: &[Token]) -> bool {
    rest.iter().enumerate().any(|(place, token)| match token.tag() {
        Some(Tag::To) => rest.get(place + 1).is_some_and(|next| {
            !next.verb().is_some_and(|(_, form)| form.can_be_base())
                && !next.is(Tag::Be)
                && !next.is(Tag::Helper)
        }),
        _ => is_one_of(token, &DIRECTIONS),
    })
}
