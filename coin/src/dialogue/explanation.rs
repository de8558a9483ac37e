//! Says in two sentences whose a thing is held to be and why, for a person who did not see the numbers.

use jiff::civil::Date;

use super::thing::Thing;
use super::wording::{Joined, join, list};
use crate::common_sense::{Tendency, tendency};
use crate::dialogue::Reading;
use crate::owners::OwnerSet;
use crate::roster::{Roster, UserIndex};

/// How many people are named with what they did; the others are counted.
const NAMED_USERS: usize = 3;

/// What an explanation is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained<'a> {
    /// The household.
    pub roster: &'a Roster,
    /// The class of the thing.
    pub class: &'a str,
    /// The room that it is in.
    pub room: Option<&'a str>,
    /// Where it is, in metres. Told only if there is nothing else to say.
    pub position: [f64; 3],
    /// What is believed.
    pub conclusion: Conclusion<'a>,
    /// What speaks for it.
    pub grounds: Grounds,
}

/// What is believed of a thing, and how it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conclusion<'a> {
    /// A person said so.
    Answered {
        /// How the answer was read.
        reading: Reading,
        /// The person's words.
        words: &'a str,
        /// Who answered, where known.
        by: Option<UserIndex>,
        /// When.
        on: Date,
        /// Whom everything else that is known of the thing speaks for, where that makes the answer doubtful.
        against: Option<OwnerSet>,
    },
    /// A person said so, but the use of the thing since fits other owners better.
    Outdated {
        /// How the answer was read.
        said: Reading,
        /// Who answered, where known.
        by: Option<UserIndex>,
        /// When.
        on: Date,
        /// The owners that fit better.
        owners: OwnerSet,
        /// Their probability, 0…1.
        confidence: f64,
    },
    /// It was inferred.
    Inferred {
        /// The most probable owners.
        owners: OwnerSet,
        /// Their probability, 0…1.
        confidence: f64,
        /// Whether that is enough to do without a question.
        standing: Standing,
        /// Who else is plausible.
        others: OwnerSet,
        /// The model that scored, where it is not the evidence model; empty where it did not tell its name.
        model: Option<&'a str>,
    },
}

/// Whether a belief needs a question.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It does not.
    Settled,
    /// It does.
    Open,
}

/// What was seen of a thing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grounds {
    /// Who used it: most sessions first.
    pub users: Vec<UserGrounds>,
    /// The thing with answered owners that bears on it most.
    pub relative: Option<RelativeGrounds>,
}

/// How one person used a thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UserGrounds {
    /// Who.
    pub user: UserIndex,
    /// In how many sessions.
    pub sessions: u64,
    /// How many days ago the last one was.
    pub days_ago: f64,
}

/// A thing whose owners a person named.
#[derive(Debug, Clone, PartialEq)]
pub struct RelativeGrounds {
    /// Its class.
    pub class: String,
    /// Its owners.
    pub owners: OwnerSet,
    /// How it is related.
    pub relation: SeenRelation,
}

/// How another thing is related to the thing in question.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeenRelation {
    /// It lies near.
    Near {
        /// In metres.
        distance: f64,
    },
    /// It looks alike.
    LooksAlike,
}

/// Two sentences: what is believed and how surely; what it rests on.
pub fn explain(explained: &Explained<'_>) -> String {
    let thing = Thing::new(explained.class, explained.room, explained.position);
    let name = capitalised(&thing.name);
    let roster = explained.roster;
    match explained.conclusion {
        Conclusion::Answered { reading, words, by, on, against } => {
            let person = by.map_or("A person".to_owned(), |user| roster.name(user).to_string());
            let belongs = belongs(roster, reading, &thing, "");
            let although = against.map_or(String::new(), |owners| {
                let owners = list(roster, owners, Joined::And);
                format!(", although everything else that is known speaks for {owners}")
            });
            let words = quoted(words);
            format!("{person} said on {on} that {} {belongs}{although}. The words were: {words}", thing.name)
        }
        Conclusion::Outdated { said, by, on, owners, confidence } => {
            let person = by.map_or("A person".to_owned(), |user| roster.name(user).to_string());
            let said = belongs(roster, said, &thing, "");
            let now = belongs(roster, Reading { owners, outside_household: false }, &thing, "now ");
            format!(
                "{person} said on {on} that {} {said}, but judging by who has used {} since, {it} {now} ({}). Only a \
                 person can tell whether {it} changed hands.",
                thing.name,
                thing.object,
                percent(confidence),
                it = thing.it,
            )
        }
        Conclusion::Inferred { owners, confidence, standing, others, model } => {
            let reading = Reading { owners, outside_household: false };
            let belongs = belongs(roster, reading, &thing, adverb(standing, confidence));
            let percent = percent(confidence);
            let source = match model {
                None => String::new(),
                Some("") => ", says the model that scored it".to_owned(),
                Some(model) => format!(", says the model {model:?}"),
            };
            let conclusion = match standing {
                Standing::Settled => format!("{name} {belongs} ({percent}{source})."),
                Standing::Open if others.is_empty() => {
                    format!("{name} {belongs} ({percent}{source}), which is not sure enough to act on.")
                }
                Standing::Open => {
                    let others = list(roster, others, Joined::Or);
                    let it = thing.object;
                    format!("{name} {belongs} ({percent}{source}), but {others} may own {it} too.")
                }
            };
            format!("{conclusion} {}", grounds(explained, &thing))
        }
    }
}

/// How sure a belief sounds.
fn adverb(standing: Standing, confidence: f64) -> &'static str {
    match standing {
        Standing::Open => "most probably ",
        Standing::Settled if confidence >= 0.95 => "almost certainly ",
        Standing::Settled if confidence >= 0.80 => "very probably ",
        Standing::Settled => "probably ",
    }
}

/// "probably belongs to Bob", "is probably shared by Bob and Mary", "belongs to somebody outside the household".
fn belongs(roster: &Roster, reading: Reading, thing: &Thing, adverb: &str) -> String {
    let (belongs, is) = if thing.is == "Are" { ("belong", "are") } else { ("belongs", "is") };
    let Reading { owners, outside_household } = reading;
    let named = || list(roster, owners, Joined::And);
    match (owners.len(), outside_household) {
        (0, _) => format!("{adverb}{belongs} to somebody outside the household"),
        (_, true) => format!("{is} {adverb}shared by {} with somebody outside the household", named()),
        (1, _) => format!("{adverb}{belongs} to {}", named()),
        (shared, _) if shared == roster.len() && shared > 2 => format!("{is} {adverb}shared by everybody"),
        _ => format!("{is} {adverb}shared by {}", named()),
    }
}

fn grounds(explained: &Explained<'_>, thing: &Thing) -> String {
    let Grounds { users, relative } = &explained.grounds;
    let used = match users.as_slice() {
        [] => {
            let expectation = match tendency(explained.class) {
                Some(Tendency::Personal) => "; such things mostly have one owner",
                Some(Tendency::Shared) => "; such things are mostly everybody's",
                Some(Tendency::Either) | None => "",
            };
            format!("Nobody was seen using {}{expectation}", thing.object)
        }
        users => {
            let named: Vec<String> =
                users.iter().take(NAMED_USERS).map(|user| in_sessions(explained.roster, user)).collect();
            let named = join(&named, Joined::And);
            let first =
                users.first().map(|user| explained.roster.name(user.user).as_str()).unwrap_or_default();
            let named =
                format!("{first} used {}{}", thing.object, named.strip_prefix(first).unwrap_or(&named));
            let rest = match users.len().saturating_sub(NAMED_USERS) {
                0 => String::new(),
                1 => ", and one other person did too".to_owned(),
                more => format!(", and {more} others did too"),
            };
            format!("{named}{rest}")
        }
    };
    let beside = relative.as_ref().map_or(String::new(), |relative| {
        let other = Thing::new(&relative.class, None, [0.0; 3]);
        let owned = belongs(
            explained.roster,
            Reading { owners: relative.owners, outside_household: false },
            &other,
            "",
        );
        match relative.relation {
            SeenRelation::Near { distance } => format!("; {}, {distance:.1} m away, {owned}", other.name),
            SeenRelation::LooksAlike => format!("; {}, which looks alike, {owned}", other.name),
        }
    });
    format!("{used}{beside}.")
}

/// "Bob in 3 sessions (last 2 days ago)".
fn in_sessions(roster: &Roster, user: &UserGrounds) -> String {
    let UserGrounds { user, sessions, days_ago } = *user;
    let sessions = if sessions == 1 { "1 session".to_owned() } else { format!("{sessions} sessions") };
    let last = match days_ago.round() {
        _ if days_ago < 1.0 => "within a day".to_owned(),
        1.0 => "a day ago".to_owned(),
        days => format!("{days:.0} days ago"),
    };
    format!("{} in {sessions} (last {last})", roster.name(user))
}

/// A probability in whole percent; what is not certain is never said to be.
fn percent(probability: f64) -> String {
    match (probability * 100.0).round() {
        whole if whole >= 100.0 && probability < 1.0 => "over 99 %".to_owned(),
        whole if whole < 1.0 => "under 1 %".to_owned(),
        whole => format!("{whole:.0} %"),
    }
}

/// The words in quotation marks, on one line, with a full stop where they have no end of their own.
fn quoted(words: &str) -> String {
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    let stop = if words.ends_with(['.', '!', '?']) { "" } else { "." };
    format!("{words:?}{stop}")
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests;
