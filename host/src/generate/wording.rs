//! How a sighting is put into words: plainly (`Bob takes the Mug`), or in one of many other ways.

use jiff::civil::DateTime;
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::catalogue::Thing;
use super::people::Person;
use super::sessions::{Action, Putting};

/// Ways of using what has no verb of its own left.
const GENERAL_USES: [&str; 2] = ["is using", "briefly uses"];

/// A way to say an action: the words before the thing and those after it.
type Active = (&'static str, &'static str);

/// Who is to be named.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) people: &'a [Person],
    pub(super) seen: Option<usize>,
    pub(super) thing: &'a Thing,
    /// The thing's class, every word with a capital.
    pub(super) display_name: &'a str,
    pub(super) action: Action,
}

/// The caption `YYYY-MM-DD HH:MM TEXT`.
pub(super) fn caption(time: DateTime, text: &str) -> String {
    format!("{} {text}", time.strftime("%Y-%m-%d %H:%M"))
}

impl Scene<'_> {
    /// The plain wording: name, verb, thing.
    pub(super) fn plain(&self) -> String {
        let (before, after) = plain_verb(self.thing, self.action);
        let subject = self.seen.map_or("Someone", |person| self.people[person].name);
        format!("{subject} {before} the {}{after}", self.display_name)
    }

    /// Another wording of the same: other verbs, the passive voice, a role for a name, small letters.
    pub(super) fn paraphrase(&self, generator: &mut ChaCha8Rng) -> String {
        let thing = if generator.random_bool(0.5) { self.thing.class } else { self.display_name };
        let wordings = Wordings::of(self.action);
        if generator.random_bool(0.35)
            && let Some(passive) = wordings.passive.choose(generator)
        {
            let be = if is_plural(self.thing.class) { "are" } else { "is" };
            return match self.seen {
                Some(_) => {
                    format!("The {thing} {be} {passive} by {}", self.actor(Position::Object, generator))
                }
                None => format!("The {thing} {be} {passive}"),
            };
        }
        let (before, after) = match wordings.active.choose(generator) {
            Some(&other) if generator.random_bool(0.7) => other,
            _ => plain_verb(self.thing, self.action),
        };
        format!("{} {before} the {thing}{after}", self.actor(Position::Subject, generator))
    }

    /// The actor by name, or by a role that nobody else has; somebody unknown where nobody was recognised.
    fn actor(&self, position: Position, generator: &mut ChaCha8Rng) -> String {
        let Some(person) = self.seen.map(|person| &self.people[person]) else {
            let unknown = ["Someone", "Somebody", "A person"];
            return (*unknown.choose(generator).unwrap_or(&"Someone")).to_owned();
        };
        let unique = self.people.iter().filter(|other| other.role == person.role).count() == 1;
        if !unique || generator.random_bool(0.6) {
            return person.name.to_owned();
        }
        let familiar = match person.role {
            "father" => Some("Dad"),
            "mother" => Some("Mom"),
            _ => None,
        };
        match (familiar, position) {
            (Some(word), _) if generator.random_bool(0.3) => word.to_owned(),
            (_, Position::Subject) => format!("The {}", person.role),
            (_, Position::Object) => format!("the {}", person.role),
        }
    }
}

/// Whether the class stands in the plural, as `car keys` does and `drinking glass` and `deck of cards` do not.
fn is_plural(class: &str) -> bool {
    class.ends_with('s') && !class.ends_with("ss") && !class.contains(" of ")
}

/// Where in the sentence the actor stands.
#[derive(Debug, Clone, Copy)]
enum Position {
    Subject,
    Object,
}

fn plain_verb(thing: &Thing, action: Action) -> Active {
    match action {
        Action::Search => ("looks for", ""),
        Action::Take => ("takes", ""),
        Action::Use(way) => match thing.uses.get(way) {
            Some(verb) => (verb, ""),
            None => (GENERAL_USES[(way - thing.uses.len()) % GENERAL_USES.len()], ""),
        },
        Action::Move => ("carries", ""),
        Action::Clean => (thing.cleaning.unwrap_or("cleans"), ""),
        Action::Place(Putting::Back) => ("puts", " back"),
        Action::Place(Putting::Away) => ("puts", " away"),
        Action::Place(Putting::Down) => ("puts", " down"),
    }
}

/// The other wordings of an action.
struct Wordings {
    active: &'static [Active],
    /// Participles, the form of *to be* going before them.
    passive: &'static [&'static str],
}

impl Wordings {
    fn of(action: Action) -> Self {
        match action {
            Action::Search => Self {
                active: &[("searches for", ""), ("is looking for", ""), ("finds", "")],
                passive: &["searched for", "found"],
            },
            Action::Take => Self {
                active: &[("picks up", ""), ("grabs", ""), ("gets", ""), ("is picking up", "")],
                passive: &["taken", "picked up", "grabbed"],
            },
            Action::Use(_) => Self {
                active: &[("uses", ""), ("is using", ""), ("briefly uses", "")],
                passive: &["used", "being used"],
            },
            Action::Move => Self {
                active: &[("moves", ""), ("brings", " along"), ("carries", " to another room")],
                passive: &["carried", "moved"],
            },
            Action::Clean => Self {
                active: &[("cleans", ""), ("wipes", ""), ("is cleaning", "")],
                passive: &["cleaned", "wiped"],
            },
            Action::Place(_) => Self {
                active: &[
                    ("returns", ""),
                    ("places", " on the table"),
                    ("stores", ""),
                    ("leaves", " on the shelf"),
                    ("is putting", " back"),
                ],
                passive: &["put back", "returned", "put away"],
            },
        }
    }
}
