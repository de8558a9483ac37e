//! How a thing is called in a sentence.

use crate::language::number::SINGULARS;

/// Head nouns that are always plural although they end in no s, or in a form that looks singular.
const PLURALS: &[&str] = &["dice", "feet", "teeth", "people", "children", "glasses", "dishes", "clothes"];

/// Labels that say no more than "thing".
const PLACEHOLDERS: &[&str] = &["object", "unknown", "unknown object", "item", "thing", "misc", "other"];

/// Words of labels that are spelled with capitals.
const CAPITALS: &[&str] = &["cd", "dvd", "tv", "pc", "usb", "led", "vr"];

/// Rooms that one is on and not in.
const ON: &[&str] = &["balcony", "terrace", "porch", "patio", "deck", "landing", "roof"];

/// A thing with its article and place, and the words that agree with it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Thing {
    /// "the scissors in the kitchen"
    pub(crate) name: String,
    /// "Is" or "Are"
    pub(crate) is: &'static str,
    /// "Does" or "Do"
    pub(crate) does: &'static str,
    /// "it" or "they"
    pub(crate) it: &'static str,
    /// "it" or "them"
    pub(crate) object: &'static str,
}

impl Thing {
    pub(crate) fn new(class: &str, room: Option<&str>, position: [f64; 3]) -> Self {
        let noun = noun(class);
        let room = room.map(tidy).filter(|room| !room.is_empty());
        let place = match (&room, &noun) {
            (Some(room), _) => format!(" {}", place(room)),
            (None, Some(_)) => String::new(),
            (None, None) => {
                let [x, y, z] = position;
                format!(" at {x:.1}, {y:.1}, {z:.1} metres on my map")
            }
        };
        let plural = noun.as_deref().is_some_and(is_plural);
        let name = format!("the {}{place}", noun.as_deref().unwrap_or("thing"));
        if plural {
            Self { name, is: "Are", does: "Do", it: "they", object: "them" }
        } else {
            Self { name, is: "Is", does: "Does", it: "it", object: "it" }
        }
    }
}

/// The label as a person would say it; `None` where it says nothing.
fn noun(class: &str) -> Option<String> {
    let label = tidy(class);
    let said: Vec<String> = label.split(' ').filter(|word| !word.is_empty()).map(spell).collect();
    let said = said.join(" ");
    (!said.is_empty() && !PLACEHOLDERS.contains(&said.to_lowercase().as_str())).then_some(said)
}

/// One space between words, none around them; underscores, as detectors write them, are spaces.
fn tidy(text: &str) -> String {
    let spaced: String = text.chars().map(|letter| if letter == '_' { ' ' } else { letter }).collect();
    spaced.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// "Marker" is said "marker"; "TV" and "iPhone" stay, and "cd" becomes "CD".
fn spell(word: &str) -> String {
    let mut letters = word.chars();
    let rest_is_lower = letters.next().is_some() && letters.all(|letter| !letter.is_uppercase());
    if CAPITALS.contains(&word.to_lowercase().as_str()) {
        word.to_uppercase()
    } else if rest_is_lower {
        word.to_lowercase()
    } else {
        word.to_owned()
    }
}

/// Whether "are" goes with the noun: with "pants" and "painkillers", not with "glass" or "deck of cards".
fn is_plural(noun: &str) -> bool {
    let head = noun
        .split(" of ")
        .next()
        .and_then(|start| start.split(" for ").next())
        .and_then(|start| start.split(" with ").next())
        .and_then(|start| start.split(' ').next_back())
        .unwrap_or(noun)
        .to_lowercase();
    PLURALS.contains(&head.as_str())
        || head.ends_with('s')
            && !head.ends_with("ss")
            && !head.ends_with("us")
            && !head.ends_with("is")
            && !SINGULARS.contains(&head.as_str())
}

fn place(room: &str) -> String {
    let owned = room.contains("'s") || room.contains('’') || room.contains("s' ");
    let said = room.split(' ').map(spell).collect::<Vec<_>>().join(" ");
    let named = ["the ", "my ", "our "].iter().any(|start| said.starts_with(start)) || owned;
    let last = said.split(' ').next_back().unwrap_or_default();
    let within = if ON.contains(&last) { "on" } else { "in" };
    match (owned, named) {
        (true, _) => format!("{within} {room}"),
        (false, true) => format!("{within} {said}"),
        (false, false) => format!("{within} the {said}"),
    }
}
